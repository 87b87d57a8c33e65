#include "calibration/experiment/felt_size.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace wale {
namespace {

/// Forces are counted when the high-passes have settled: after half a second, and of a short presentation after a
/// third of it, so that something of it is counted.
constexpr double settling = 0.5;          // s
constexpr double settling_share = 1 / 3.0;
constexpr double slowest_texture = 5;   // Hz; a hand goes to and fro about once a second

/// Two first-order high-passes, one behind the other, of a force.
class HighPass {
 public:
  explicit HighPass(double seconds_per_tick)
      : keep_(1 / (1 + 2 * std::numbers::pi * slowest_texture * seconds_per_tick)) {}

  glm::dvec2 step(glm::dvec2 force) {
    for (Stage& each : stages_) {
      if (!begun_) each.in = force;
      each.out = keep_ * (each.out + force - each.in);
      each.in = force;
      force = each.out;
    }
    begun_ = true;
    return force;
  }

 private:
  struct Stage {
    glm::dvec2 in{0}, out{0};
  };
  double keep_;
  bool begun_ = false;
  Stage stages_[2];
};

struct Sum {
  std::vector<double> sizes;
  double squares = 0, changes = 0;
  glm::dvec2 last{0};

  void add(glm::dvec2 force) {
    const double square = force.x * force.x + force.y * force.y;
    if (!sizes.empty()) {
      const glm::dvec2 change = force - last;
      changes += change.x * change.x + change.y * change.y;
    }
    squares += square;
    sizes.push_back(std::sqrt(square));
    last = force;
  }

  TextureForce force(double seconds_per_tick) {
    if (sizes.size() < 2) return {};
    const auto count = static_cast<double>(sizes.size());
    const auto p99 = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * (count - 1));
    std::ranges::nth_element(sizes, p99);
    const double rms = std::sqrt(squares / count);
    const double rate = std::sqrt(changes / (count - 1)) / seconds_per_tick;
    return {*p99, rms, rms > 0 ? rate / (2 * std::numbers::pi * rms) : 0.0};
  }
};

}  // namespace

FeltSize felt_size(const Record& record) {
  FeltSize felt;
  HighPass interaction(record.seconds_per_tick), actuator(record.seconds_per_tick);
  Sum of_interaction, of_actuator;
  double speeds = 0;
  long ticks = 0;
  felt.interaction_known = !record.ticks.empty();
  const double begin =
      record.ticks.empty() ? 0 : std::min(settling, settling_share * static_cast<double>(record.ticks.back().time));
  for (const TickRecord& tick : record.ticks) {
    const bool known = std::isfinite(tick.interaction.x) && std::isfinite(tick.interaction.y);
    felt.interaction_known = felt.interaction_known && known;
    const glm::dvec2 between = interaction.step(known ? glm::dvec2(tick.interaction.x, tick.interaction.y) : glm::dvec2(0));
    const glm::dvec2 exerted = actuator.step(glm::dvec2(tick.force.x, tick.force.y));
    if (tick.time < begin || !tick.inside) continue;
    of_interaction.add(between);
    of_actuator.add(exerted);
    speeds += static_cast<double>(tick.velocity.x) * tick.velocity.x + static_cast<double>(tick.velocity.y) * tick.velocity.y;
    ++ticks;
  }
  if (ticks == 0) return felt;
  felt.speed = std::sqrt(speeds / static_cast<double>(ticks));
  felt.actuator = of_actuator.force(record.seconds_per_tick);
  if (felt.interaction_known) felt.interaction = of_interaction.force(record.seconds_per_tick);
  return felt;
}

}  // namespace wale
