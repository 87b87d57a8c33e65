#include "compiler/extract/static_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "compiler/extract/band_spectrum.hpp"
#include "compiler/extract/dependence.hpp"
#include "compiler/extract/tolerances.hpp"

namespace wale {
namespace {

constexpr std::size_t first_side = 64;  // to find where a texture is busiest
/// Of the whole patch, 0.8 mm apart or less on one of 160 mm: enough for the size of the force, unless it has periods
/// that would seem slow on the one and do not on the next. Sides of which transforms are quick.
constexpr std::array<std::size_t, 3> whole_sides = {192, 216, 256};
constexpr double crooked = 0.987;        // of the patch: so that round periods fall on ever other places
constexpr std::size_t close_side = 128;  // 0.3 mm apart, so that periods of 0.6 mm and more are told
constexpr double close_window = 0.0384;  // m
constexpr std::size_t blocks = 8;        // on a side, among which the busiest is looked for
constexpr double deceptive = 0.01;       // of a texture's power, from which what seems slow counts
constexpr std::size_t every_line = 8;    // on which that is looked for
constexpr double seems_slow = 8e-3;      // m: a period that is longer than any texture's, or nearly
constexpr double least_plane = 0.05;     // of the whole force

/// The patch less its rim, m.
glm::dvec2 inside_of(const Bank& bank) {
  const glm::dvec2 size(bank.size().width, bank.size().height);
  return glm::max(size - 2.0 * bank.size().rim, 0.25 * size);
}

/// Where the texture varies most, of the blocks into which the patch is cut: its middle.
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
      // The middle is preferred to what is hardly busier.
      const glm::dvec2 middle = whole.place(left + block / 2, top + block / 2);
      const double preferred =
          change * (1 - 0.1 * std::min(1.0, glm::length(middle) / glm::length(0.5 * whole.extent())));
      if (preferred > most) most = preferred, found = middle;
    }
  return found;
}

/// Whether a good part of a texture has periods so near to the spacing (m) of another field that they seem slow there:
/// such as go along its lines or its columns.
bool deceives(const ForceField& close, glm::dvec2 spacing) {
  const std::vector<float> window = hann_window(close.side);
  const auto count = static_cast<double>(close.side);
  double deceiving = 0, all = 0;
  for (const int axis : {0, 1}) {
    const double extent = close.extent()[axis], waves = extent / spacing[axis], more = extent / seems_slow;
    for (std::size_t line = every_line / 2; line < close.side; line += every_line) {
      std::vector<glm::dvec2> values(close.side);
      for (std::size_t i = 0; i < close.side; ++i) {
        const Force force = close.forces[axis == 0 ? line * close.side + i : i * close.side + line];
        values[i] = static_cast<double>(window[i]) * glm::dvec2(force);
        all += glm::dot(values[i], values[i]) * count / 2;
      }
      for (double periods = std::ceil(waves - more); periods <= std::min(waves + more, count / 2); ++periods) {
        // A recurrence spares the sines.
        const double angle = 2 * std::numbers::pi * periods / count;
        const glm::dvec2 turn{std::cos(angle), std::sin(angle)};
        glm::dvec2 at{1, 0}, cosines{0}, sines{0};
        for (const glm::dvec2& value : values) {
          cosines += at.x * value, sines += at.y * value;
          at = {at.x * turn.x - at.y * turn.y, at.x * turn.y + at.y * turn.x};
        }
        deceiving += glm::dot(cosines, cosines) + glm::dot(sines, sines);
      }
    }
  }
  return deceiving > deceptive * all;
}

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
  for (const std::size_t each : whole_sides)
    if (!deceives(close, inside / static_cast<double>(each))) {
      side = each;
      break;
    }
  whole = sample_force_field(bank, {0, 0}, inside, side);
  slope = linear_part(whole);
  std::vector<float> sizes;
  for (std::size_t i = 0; i < whole.forces.size(); i += 7) sizes.push_back(std::sqrt(squared(whole.forces[i])));
  largest = quantile(std::move(sizes), 0.99);
  // What is left of waves that do not fit the patch is not worth a plane.
  const glm::dvec2 half = 0.5 * whole.extent();
  const double plane = glm::length(slope.mean) + glm::length(slope.by_x) * half.x + glm::length(slope.by_y) * half.y;
  if (plane > least_plane * largest) whole = without(std::move(whole), slope);
  float most = 0;
  for (const Force& each : whole.forces) most = std::max(most, squared(each));
  bent = std::sqrt(most);
  if (bent >= least_amplitude) slow = SlowForce(whole);
}

}  // namespace wale
