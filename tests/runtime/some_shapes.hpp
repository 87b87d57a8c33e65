#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/shape.hpp"
#include "wale/stage.hpp"

/// Shapes, and what tests put on a stage to tell where they are.
namespace wale::shape_test {

constexpr double pi = std::numbers::pi;

class Places {
 public:
  explicit Places(std::uint32_t seed) : random_(seed) {}
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  float metres(float low, float high) { return static_cast<float>(within(low, high)); }
  glm::vec2 in(glm::vec2 size) { return {metres(-size.x / 2, size.x / 2), metres(-size.y / 2, size.y / 2)}; }
  bool coin() { return random_() % 2 == 0; }
  std::uint32_t below(std::uint32_t count) { return random_() % count; }

 private:
  std::mt19937 random_;
};

/// A polygon without crossings: corners around the centre, each at a distance of its own.
inline std::vector<glm::vec2> star(Places& places, std::size_t corners) {
  std::vector<glm::vec2> all;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * pi * (static_cast<double>(i) + places.within(0.0, 0.7)) / static_cast<double>(corners);
    const double radius = places.within(0.005, 0.04);
    all.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  if (places.coin()) std::ranges::reverse(all);
  return all;
}

inline std::vector<std::uint8_t> random_bits(Places& places, std::size_t count, std::uint32_t one_in) {
  std::vector<std::uint8_t> bits(count);
  for (std::uint8_t& bit : bits) bit = places.below(one_in) == 0;
  bits[places.below(static_cast<std::uint32_t>(count))] = 1;
  return bits;
}

/// Force x = the distance to the shape's edge times `newton_per_metre`, y = its slope along y.
inline Program feeling_edge(float newton_per_metre) {
  Assembly a({newton_per_metre, 9});
  const auto x = a.tick(Operation::multiply, a.constant(0), Assembly::input(Input::shape_edge));
  a.push(0, x, a.constant(1));
  a.push(1, Assembly::input(Input::shape_edge_y), a.constant(1));
  return a.load();
}

/// A device whose hand is where the test puts it.
class Still : public Device {
 public:
  explicit Still(glm::dvec2 metres)
      : counts_(std::lround(metres.x / sandpaper().position_step()),
                std::lround(metres.y / sandpaper().position_step())) {}
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override { return {.counts = counts_}; }
  Force command(Force force) noexcept override { return force; }

 private:
  DeviceProfile profile_ = sandpaper();
  glm::ivec2 counts_;
};

}  // namespace wale::shape_test
