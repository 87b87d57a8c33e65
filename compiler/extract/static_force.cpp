#include "compiler/extract/static_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "compiler/extract/band_spectrum.hpp"
#include "compiler/extract/dependence.hpp"
#include "compiler/extract/tolerances.hpp"

namespace wale {
namespace {

constexpr std::size_t first_side = 64;  // to find where a texture is strongest
/// Over the whole patch, 0.8 mm apart or less on a patch of 160 mm. This is enough for the size of the force, unless it
/// has periods that look slow at one spacing and not at the next. Transforms of these sides are fast.
constexpr std::array<std::size_t, 3> whole_sides = {192, 216, 256};
// of the patch: not round, so that round periods are sampled at ever different phases
constexpr double crooked = 0.987;
constexpr std::size_t close_side = 128;  // 0.3 mm apart, so that periods of 0.6 mm and more are resolved
constexpr double close_window = 0.0384;  // m
constexpr std::size_t blocks = 8;        // per side, among which the strongest is chosen
constexpr double deceptive = 0.01;       // of a texture's power: aliases above this count
constexpr std::size_t every_line = 8;    // only these lines are checked for aliases
constexpr double seems_slow = 8e-3;      // m: longer than the period of any texture, or nearly
constexpr double least_plane = 0.05;     // of the whole force

/// The patch without its rim, m.
glm::dvec2 inside_of(const Bank& bank) {
  const glm::dvec2 size(bank.size().width, bank.size().height);
  return glm::max(size - 2.0 * bank.size().rim, 0.25 * size);
}

/// The middle of the block in which the texture varies most.
glm::dvec2 busiest_place(const ForceField& whole) {
  double most = -1;
  glm::dvec2 found{0};
  const std::size_t block = whole.side / blocks;
  for (std::size_t top = 0; top < whole.side; top += block)
    for (std::size_t left = 0; left < whole.side; left += block) {
      float change = 0;
      for (std::size_t row = top; row + 1 < top + block; ++row)
        for (std::size_t column = left; column + 1 < left + block; ++column) {
          const std::size_t at = row * whole.side + column;
          change += squared(whole.forces[at + 1] - whole.forces[at]) +
                    squared(whole.forces[at + whole.side] - whole.forces[at]);
        }
      // The middle is preferred to blocks that are hardly stronger.
      const glm::dvec2 middle = whole.place(left + block / 2, top + block / 2);
      const double preferred =
          change * (1 - 0.1 * std::min(1.0, glm::length(middle) / glm::length(0.5 * whole.extent())));
      if (preferred > most) most = preferred, found = middle;
    }
  return found;
}

/// The periods of a texture along some of its lines and columns.
class LinePeriods {
 public:
  explicit LinePeriods(const ForceField& close) : extent_(close.extent()), count_(close.side) {
    const std::vector<float> window = hann_window(count_);
    for (const int axis : {0, 1}) {
      std::vector<std::complex<float>> values;
      for (std::size_t line = every_line / 2; line < count_; line += every_line)
        for (std::size_t i = 0; i < count_; ++i) {
          const Force force = window[i] * close.forces[axis == 0 ? line * count_ + i : i * count_ + line];
          values.emplace_back(force.x, force.y);
          all_ += squared(force);
        }
      power_[axis].resize(count_ / 2 + 1);
      const Spectrum spectrum = fourier_of_lines(count_, values);
      // The transform of x + i y holds one of theirs in a coefficient and the other in its mirror image.
      for (std::size_t line = 0; line < spectrum.size(); line += count_)
        for (std::size_t periods = 0; periods <= count_ / 2; ++periods)
          power_[axis][periods] +=
              0.5 * (std::norm(spectrum[line + periods]) + std::norm(spectrum[line + (count_ - periods) % count_]));
    }
  }

  /// Whether a considerable part of it has periods so near to the spacing (m) of another field that they would look
  /// slow there: such waves go along its lines or columns.
  bool deceive(glm::dvec2 spacing) const {
    double deceiving = 0;
    const double half = 0.5 * static_cast<double>(count_);
    for (const int axis : {0, 1}) {
      const double waves = extent_[axis] / spacing[axis], more = extent_[axis] / seems_slow;
      for (double periods = std::max(0.0, std::ceil(waves - more)); periods <= std::min(waves + more, half); ++periods)
        deceiving += power_[axis][static_cast<std::size_t>(periods)];
    }
    return deceiving > deceptive * half * all_;
  }

 private:
  glm::dvec2 extent_;
  std::size_t count_;
  std::array<std::vector<double>, 2> power_;  // by periods over the extent
  double all_ = 0;
};

}  // namespace

StaticForce::StaticForce(const Bank& bank) {
  const glm::dvec2 inside = crooked * inside_of(bank);
  if (!depends_on_place(bank.program().description())) {
    const ForceField anywhere = sample_force_field(bank, {0, 0}, inside, 1);
    slope.mean = anywhere.forces.front();
    largest = glm::length(slope.mean);
    whole = {whole_sides.front(), {0, 0}, inside / static_cast<double>(whole_sides.front()), {}};
    whole.forces.resize(whole.side * whole.side);
    return;
  }
  const glm::dvec2 window = glm::min(glm::dvec2(close_window), inside), room = 0.5 * (inside - window);
  const ForceField first = sample_force_field(bank, {0, 0}, inside, first_side);
  busiest = glm::clamp(busiest_place(without(first, linear_part(first))), -room, room);
  close = sample_force_field(bank, busiest, window, close_side);
  std::size_t side = whole_sides.back();
  const LinePeriods periods(close);
  for (const std::size_t each : whole_sides)
    if (!periods.deceive(inside / static_cast<double>(each))) {
      side = each;
      break;
    }
  whole = sample_force_field(bank, {0, 0}, inside, side);
  slope = linear_part(whole);
  std::vector<float> sizes;
  for (std::size_t i = 0; i < whole.forces.size(); i += 7) sizes.push_back(std::sqrt(squared(whole.forces[i])));
  largest = quantile(std::move(sizes), 0.99);
  // The plane that incomplete waves at the edges leave is ignored.
  const glm::dvec2 half = 0.5 * whole.extent();
  const double plane = glm::length(slope.mean) + glm::length(slope.by_x) * half.x + glm::length(slope.by_y) * half.y;
  if (plane > least_plane * largest) whole = without(std::move(whole), slope);
  float most = 0;
  for (const Force& each : whole.forces) most = std::max(most, squared(each));
  bent = std::sqrt(most);
  if (bent >= least_amplitude) slow = SlowForce(whole);
}

}  // namespace wale
