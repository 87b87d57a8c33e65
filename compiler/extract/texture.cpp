#include "compiler/extract/texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/extract/fourier.hpp"
#include "compiler/measure/hands.hpp"

namespace wale {
namespace {

constexpr std::size_t whole_side = 256;  // 0.6 mm apart on a patch of 160 mm: enough for the size of the force
constexpr std::size_t close_side = 128;  // 0.3 mm apart, so that periods of 0.6 mm and more are told
constexpr double close_window = 0.0384;  // m
constexpr std::size_t block = whole_side / 8;
constexpr double edge = 0.1;              // of a window on each side: what a transform rings at its ends
constexpr double least_amplitude = 1e-4;  // N: a tenth of the finest step that any device has
constexpr std::size_t change_places = 2048;
constexpr double difference = 2e-5;  // m: the distance over which the force's change is taken

using Spectrum = std::vector<std::complex<float>>;

/// Of the force as x + i y.
Spectrum spectrum_of(const ForceField& field) {
  Spectrum values;
  for (const Force& force : field.forces) values.emplace_back(force.x, force.y);
  return fourier(field.side, values);
}

/// Hann's window over `count` samples, so that a component that does not fit a whole number of times stays in its
/// place.
std::vector<double> window_of(std::size_t count) {
  std::vector<double> window(count);
  for (std::size_t i = 0; i < count; ++i)
    window[i] =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
  return window;
}

/// A field of twice the side, the given one under a window in its corner: so that nothing meets itself from behind.
ForceField windowed(const ForceField& field) {
  const std::vector<double> window = window_of(field.side);
  ForceField wide{2 * field.side, field.centre, field.spacing, std::vector<Force>(4 * field.side * field.side)};
  for (std::size_t row = 0; row < field.side; ++row)
    for (std::size_t column = 0; column < field.side; ++column)
      wide.forces[row * wide.side + column] =
          field.forces[row * field.side + column] * static_cast<float>(window[row] * window[column]);
  return wide;
}

/// Periods over a metre of coefficient (column, row).
glm::dvec2 wave_number(const ForceField& field, std::size_t column, std::size_t row) {
  const auto periods = [&](std::size_t index) {
    return index <= field.side / 2 ? static_cast<double>(index)
                                   : static_cast<double>(index) - static_cast<double>(field.side);
  };
  return glm::dvec2(periods(column), periods(row)) / (field.spacing * static_cast<double>(field.side));
}

/// From 1 to 0 as the period goes from one to the other, on a logarithmic scale.
double fade(double period, double from, double to) {
  if (period <= from) return 1;
  if (period >= to) return 0;
  const double u = std::log(period / from) / std::log(to / from);
  return 0.5 + 0.5 * std::cos(std::numbers::pi * u);
}

constexpr double gradual = 1.2;

double share_let_through(const PeriodBand& band, double waves) {
  if (waves <= 0) return 0;
  const double period = 1 / waves;
  return fade(period, band.high, band.high * gradual) * (1 - fade(period, band.low / gradual, band.low));
}

/// Where between the lines and columns of the field nothing of a transform's ends is seen.
template <typename Visit>
void each_inside(const ForceField& field, const Visit& visit) {
  const auto margin = static_cast<std::size_t>(edge * static_cast<double>(field.side));
  for (std::size_t row = margin; row < field.side - margin; ++row)
    for (std::size_t column = margin; column < field.side - margin; ++column) visit(row * field.side + column);
}

/// Where the texture varies most, of the blocks into which the patch is cut: the middle of a window that stays inside.
glm::dvec2 busiest(const ForceField& whole, glm::dvec2 window) {
  double most = -1;
  glm::dvec2 found{0};
  for (std::size_t top = 0; top < whole.side; top += block)
    for (std::size_t left = 0; left < whole.side; left += block) {
      double change = 0;
      for (std::size_t row = top; row + 1 < top + block; ++row)
        for (std::size_t column = left; column + 1 < left + block; ++column) {
          const std::size_t at = row * whole.side + column;
          const Force right = whole.forces[at + 1] - whole.forces[at];
          const Force below = whole.forces[at + whole.side] - whole.forces[at];
          change += glm::dot(right, right) + glm::dot(below, below);
        }
      // The middle is preferred to what is hardly busier.
      const glm::dvec2 middle = whole.place(left + block / 2, top + block / 2);
      change *= 1 - 0.1 * std::min(1.0, glm::length(middle) / glm::length(whole.spacing * (0.5 * whole_side)));
      if (change > most) most = change, found = middle;
    }
  const glm::dvec2 room = glm::max(0.5 * (whole.spacing * static_cast<double>(whole.side) - window), glm::dvec2(0));
  return glm::clamp(found, -room, room);
}

/// The field's slow part, whose periods are longer than those of the band.
std::vector<Force> slow_part(const ForceField& field, const PeriodBand& band) {
  Spectrum spectrum = spectrum_of(field);
  for (std::size_t row = 0; row < field.side; ++row)
    for (std::size_t column = 0; column < field.side; ++column) {
      const double waves = glm::length(wave_number(field, column, row));
      spectrum[row * field.side + column] *=
          static_cast<float>(waves > 0 ? 1 - fade(1 / waves, band.high, band.high * gradual) : 1);
    }
  std::vector<Force> slow;
  for (const auto& value : inverse_fourier(field.side, spectrum)) slow.emplace_back(value.real(), value.imag());
  return slow;
}

/// Neighbours two by two: what is slow, on fewer places.
ForceField halved(const ForceField& field) {
  ForceField half{field.side / 2, field.centre, 2.0 * field.spacing, {}};
  for (std::size_t row = 0; row + 1 < field.side; row += 2)
    for (std::size_t column = 0; column + 1 < field.side; column += 2) {
      const std::size_t at = row * field.side + column;
      half.forces.push_back(0.25f * (field.forces[at] + field.forces[at + 1] + field.forces[at + field.side] +
                                     field.forces[at + field.side + 1]));
    }
  return half;
}

/// How well what has this power agrees with itself at distances along `direction`, in steps of half a sample, 1 at the
/// start; as far as the windows over `field`, which is one of them in a corner, still share a good part.
std::vector<double> agreement_along(const ForceField& field, const std::vector<double>& power, glm::dvec2 direction) {
  const Spectrum agreement = inverse_fourier(field.side, Spectrum(power.begin(), power.end()));
  const std::vector<double> window = window_of(field.side / 2);
  const auto shared = [&](double distance) {  // by the window and itself, so far away
    double sum = 0;
    const auto whole = static_cast<std::size_t>(std::abs(distance));
    const double part = std::abs(distance) - static_cast<double>(whole);
    for (std::size_t i = 0; i + whole + 1 < window.size(); ++i)
      sum += window[i] * ((1 - part) * window[i + whole] + part * window[i + whole + 1]);
    return sum;
  };
  std::vector<double> along;
  const double side = static_cast<double>(field.side), all = shared(0) * shared(0);
  for (double steps = 0; steps < side / 2; steps += 0.5) {
    const glm::dvec2 offset = steps * direction;
    const double common = shared(offset.x) * shared(offset.y) / all;
    if (common < 0.1) break;
    const glm::dvec2 at = offset + side, low = glm::floor(at), part = at - low;
    const auto value = [&](double column, double row) {
      const auto index = [&](double at_least) { return static_cast<std::size_t>(at_least) % field.side; };
      return static_cast<double>(agreement[index(low.y + row) * field.side + index(low.x + column)].real());
    };
    const double here = ((1 - part.x) * value(0, 0) + part.x * value(1, 0)) * (1 - part.y) +
                        ((1 - part.x) * value(0, 1) + part.x * value(1, 1)) * part.y;
    along.push_back(here / common / agreement.front().real());
  }
  return along;
}

}  // namespace

StaticForce::StaticForce(const Bank& bank) {
  const PatchSize patch = bank.size();
  const glm::dvec2 inside =
      glm::max(glm::dvec2(patch.width, patch.height) - 2.0 * patch.rim, 0.25 * glm::dvec2(patch.width, patch.height));
  whole = sample_force_field(bank, {0, 0}, inside, whole_side);
  slope = linear_part(whole);
  const glm::dvec2 window = glm::min(glm::dvec2(close_window), inside);
  close = sample_force_field(bank, busiest(whole, window), window, close_side);
}

TextureForce texture_force(const Bank& bank, const StaticForce& force, const PeriodBand& band) {
  TextureForce texture;
  // Periods of which the closer window holds too few are looked for in the whole patch.
  const bool near =
      3 * band.low < force.close.spacing.x * close_side && band.high <= force.close.spacing.x * close_side;
  const ForceField straight = without(force.whole, force.slope);
  // What is faster than the band would be mistaken for what is slow on fewer places.
  ForceField smooth = straight;
  if (!near) smooth.forces = slow_part(straight, {0, band.low / gradual});
  const ForceField source = near ? force.close : halved(smooth);
  const ForceField field = windowed(without(source, linear_part(source)));
  const Spectrum spectrum = spectrum_of(field);

  // The strongest component, and in which directions how much there is of them.
  std::vector<double> power(field.side * field.side);
  double let_through = 0, fast = 0, strongest = 0, xx = 0, xy = 0, yy = 0;
  std::array<std::size_t, 2> peak{};
  // Of both components: the transform of x + i y holds one of theirs in a coefficient and the other in its mirror
  // image.
  const auto power_at = [&](std::size_t column, std::size_t row) {
    const std::size_t u = column % field.side, v = row % field.side;
    const std::size_t mirror = (field.side - v) % field.side * field.side + (field.side - u) % field.side;
    return 0.5 * static_cast<double>(std::norm(spectrum[v * field.side + u]) + std::norm(spectrum[mirror]));
  };
  for (std::size_t row = 0; row < field.side; ++row)
    for (std::size_t column = 0; column < field.side; ++column) {
      const glm::dvec2 waves = wave_number(field, column, row);
      const double count = glm::length(waves), share = share_let_through(band, count);
      const double here = power_at(column, row) * share * share;
      if (count > 1 / band.low && share < 1) fast += power_at(column, row) * (1 - share * share);
      if (here <= 0) continue;
      power[row * field.side + column] = here;
      let_through += here;
      xx += here * waves.x * waves.x / (count * count);
      xy += here * waves.x * waves.y / (count * count);
      yy += here * waves.y * waves.y / (count * count);
      // Of the two that are each other's mirror images one is enough.
      if (here > strongest && column <= field.side / 2) strongest = here, peak = {column, row};
    }

  // How strong it is, over the whole patch: what is left of the force without its slow part.
  const std::vector<Force> slow = slow_part(straight, band);
  double in_band = 1;
  if (near) in_band = let_through + fast > 0 ? std::sqrt(let_through / (let_through + fast)) : 0;
  std::vector<float> sizes;
  double sum = 0, squares = 0;
  each_inside(straight, [&](std::size_t i) {
    const float size = glm::length(smooth.forces[i] - slow[i]) * static_cast<float>(in_band);
    sizes.push_back(size);
    sum += size, squares += static_cast<double>(size) * size;
    texture.maximum = std::max(texture.maximum, static_cast<double>(size));
  });
  texture.mean = sum / static_cast<double>(sizes.size());
  texture.rms = std::sqrt(squares / static_cast<double>(sizes.size()));
  texture.amplitude = quantile(std::move(sizes), 0.99);
  if (texture.amplitude < least_amplitude || strongest <= 0) return {};

  // Under such a window the logarithm of the power about a component is nearly a parabola.
  const auto beside = [&](std::size_t right, std::size_t down) {
    return std::log(power_at(peak[0] + right, peak[1] + down) + 1e-30);
  };
  const auto top = [&](double before, double after) {
    const double bend = before - 2 * beside(0, 0) + after;
    return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
  };
  const glm::dvec2 off{top(beside(field.side - 1, 0), beside(1, 0)), top(beside(0, field.side - 1), beside(0, 1))};
  const glm::dvec2 at = wave_number(field, peak[0], peak[1]) + off / (field.spacing * static_cast<double>(field.side));
  texture.period = 1 / glm::length(at);
  const double between = std::hypot(xx - yy, 2 * xy);
  texture.anisotropy = between / (xx + yy);
  texture.orientation = 0.5 * std::atan2(2 * xy, xx - yy);
  if (texture.anisotropy < 0.05) texture.orientation = std::atan2(at.y, at.x);
  if (texture.orientation < 0) texture.orientation += std::numbers::pi;
  if (texture.orientation >= std::numbers::pi) texture.orientation -= std::numbers::pi;

  // A period further on what is regular agrees with itself again. In steps of half a sample.
  const std::vector<double> along = agreement_along(field, power, glm::normalize(at));
  std::size_t i = 1;
  while (i + 1 < along.size() && along[i] > along[i + 1]) ++i;
  const double least = along[i];
  double best = least;
  const auto reach = static_cast<std::size_t>(2 * 1.5 * texture.period / field.spacing.x);
  for (; i < along.size() && i <= std::max<std::size_t>(reach, 4); ++i) best = std::max(best, along[i]);
  texture.regularity = least < 0.5 ? std::clamp(best, 0.0, 1.0) : 0;
  // Each component has two changes of sign a period; the mean square of its wave numbers tells how many there are.
  double waves_squared = 0;
  for (std::size_t row = 0; row < field.side; ++row)
    for (std::size_t column = 0; column < field.side; ++column) {
      const double along_it = glm::dot(wave_number(field, column, row), glm::normalize(at));
      waves_squared += power[row * field.side + column] * along_it * along_it;
    }
  texture.transitions = 2 * std::sqrt(waves_squared / let_through);

  std::vector<Hand> hands;
  const glm::dvec2 extent = 0.5 * static_cast<double>(source.side) * source.spacing;
  for (const Hand& hand : hands_at_rest(change_places, glm::vec2(extent)))
    for (const glm::dvec2 aside : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
      Hand& moved = hands.emplace_back();
      moved.position = moved.workspace = glm::vec2(glm::dvec2(hand.position) + source.centre + difference * aside);
    }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  std::vector<float> changes;
  for (std::size_t k = 0; k < forces.size(); k += 4)
    changes.push_back(std::hypot(glm::length(forces[k] - forces[k + 1]), glm::length(forces[k + 2] - forces[k + 3])));
  texture.steepness = quantile(std::move(changes), 0.99) / (2 * difference) / texture.amplitude;
  return texture;
}

}  // namespace wale
