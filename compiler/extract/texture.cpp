#include "compiler/extract/texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "compiler/extract/dependence.hpp"
#include "compiler/extract/regularity.hpp"
#include "compiler/measure/hands.hpp"

namespace wale {
namespace {

constexpr std::size_t first_side = 64;  // to find where a texture is busiest
/// Of the whole patch, 0.8 mm apart or less on one of 160 mm: enough for the size of the force, unless it has periods
/// that would seem slow on the one and do not on the next. Sides of which transforms are quick.
constexpr std::array<std::size_t, 3> whole_sides = {192, 216, 256};
constexpr double crooked = 0.987;         // of the patch: so that round periods fall on ever other places
constexpr std::size_t close_side = 128;   // 0.3 mm apart, so that periods of 0.6 mm and more are told
constexpr double close_window = 0.0384;   // m
constexpr std::size_t blocks = 8;         // on a side, among which the busiest is looked for
constexpr double deceptive = 0.01;        // of a texture's power, from which what seems slow counts
constexpr std::size_t every_line = 8;     // on which that is looked for
constexpr double seems_slow = 8e-3;       // m: a period that is longer than any texture's, or nearly
constexpr double edge = 0.1;              // of a window on each side: what a transform rings at its ends
constexpr double least_amplitude = 1e-4;  // N: a tenth of the finest step that any device has
constexpr std::size_t change_places = 1024;
constexpr double difference = 2e-5;    // m: the distance over which the force's change is taken
constexpr double fewest_waves = 14;    // over a window, from which noise is told from what comes back
constexpr std::size_t most_waves = 4;  // that are told ...
constexpr double least_share = 0.1;    // ... each with that much of the power
constexpr double a_multiple = 0.05;    // how near to a whole multiple of another's wave counts as one
constexpr double least_plane = 0.05;   // of the whole force
constexpr double periodic = 0.9;       // regularity from which all may come back
constexpr double coarser = 3;          // than the band: where a coarse texture is looked at for its regularity
constexpr double no_direction = 0.05;  // anisotropy of which the direction is chance

/// Where between the lines and columns of a field nothing of a transform's ends is seen.
template <typename Visit>
void each_inside(std::size_t side, const Visit& visit) {
  const auto margin = static_cast<std::size_t>(edge * static_cast<double>(side));
  for (std::size_t row = margin; row < side - margin; ++row)
    for (std::size_t column = margin; column < side - margin; ++column) visit(row * side + column);
}

float squared(Force force) { return force.x * force.x + force.y * force.y; }

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

/// The half of a field about its busiest place.
ForceField busiest_half(const StaticForce& force) {
  const ForceField& whole = force.whole;
  const std::size_t side = whole.side / 2;
  const glm::dvec2 corner = (force.busiest - whole.place(0, 0)) / whole.spacing - 0.5 * static_cast<double>(side);
  const auto first = [&](double at) {
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(whole.side - side)));
  };
  return part_of(whole, first(corner.x), first(corner.y), side);
}

/// Every other line and column of a field.
ForceField thinned(const ForceField& field) {
  ForceField thin{field.side / 2, field.centre - 0.5 * field.spacing, 2.0 * field.spacing, {}};
  for (std::size_t row = 0; row < field.side; row += 2)
    for (std::size_t column = 0; column < field.side; column += 2)
      thin.forces.push_back(field.forces[row * field.side + column]);
  return thin;
}

ForceField less(const ForceField& field, const ForceField& slow) {
  ForceField rest = field;
  for (std::size_t i = 0; i < rest.forces.size(); ++i) rest.forces[i] -= slow.forces[i];
  return rest;
}

/// Whether the closer window holds enough periods of a band.
bool seen_closely(const StaticForce& force, const PeriodBand& band) {
  const double window = force.close.extent().x;
  return 3 * band.low < window && band.high <= window;
}

/// How strong a texture is, of a field that has nothing slower; this share of its amplitude counts.
void tell_size(TextureForce& texture, const ForceField& field, double share) {
  std::vector<float> sizes;
  double sum = 0, squares = 0;
  each_inside(field.side, [&](std::size_t i) {
    const float size = std::sqrt(squared(field.forces[i])) * static_cast<float>(share);
    sizes.push_back(size);
    sum += size, squares += size * size;
    texture.maximum = std::max(texture.maximum, static_cast<double>(size));
  });
  texture.mean = sum / static_cast<double>(sizes.size());
  texture.rms = std::sqrt(squares / static_cast<double>(sizes.size()));
  texture.amplitude = quantile(std::move(sizes), 0.99);
}

/// In [0, pi).
double half_turn(double angle) {
  while (angle < 0) angle += std::numbers::pi;
  while (angle >= std::numbers::pi) angle -= std::numbers::pi;
  return angle;
}

/// Whether one wave goes a whole number of times into another.
bool multiple(glm::dvec2 waves, glm::dvec2 of) {
  const double times = std::round(glm::length(waves) / glm::length(of));
  const auto near = [&](glm::dvec2 expected) { return glm::length(waves - expected) < a_multiple * glm::length(of); };
  return times >= 1 && (near(times * of) || near(-times * of));
}

/// The waves that it is made of, and which way they go.
void tell_waves(TextureForce& texture, const BandSpectrum& spectrum, const std::vector<WaveComponent>& components) {
  const glm::dvec2 strongest = components.front().waves, directions = spectrum.directions();
  texture.anisotropy = std::min(1.0, glm::length(directions) / spectrum.whole_power());
  texture.orientation = half_turn(texture.anisotropy < no_direction ? std::atan2(strongest.y, strongest.x)
                                                                    : 0.5 * std::atan2(directions.y, directions.x));
  // Each wave has two changes of sign a period; the mean square of their numbers tells how many there are.
  texture.transitions = 2 * std::sqrt(spectrum.mean_square_waves(glm::normalize(strongest)));
  std::vector<glm::dvec2> told;
  for (const WaveComponent& each : components) {
    if (std::ranges::any_of(told, [&](glm::dvec2 other) { return multiple(each.waves, other); })) continue;
    told.push_back(each.waves);
    texture.waves.push_back(
        {1 / glm::length(each.waves), half_turn(std::atan2(each.waves.y, each.waves.x)), each.share});
  }
}

/// How far it comes back, and after which period. Few waves come back by chance, so a window should hold many: where
/// the closer one does not, half of the patch is looked at or the whole. What is too fine for their samples is among
/// these as regular as it is anywhere.
void tell_regularity(TextureForce& texture, const StaticForce& force, const PeriodBand& band,
                     const BandSpectrum& spectrum, const std::vector<WaveComponent>& components) {
  std::optional<BandSpectrum> wider;
  const double waves = glm::length(components.front().waves), all = force.whole.extent().x;
  if (waves * spectrum.extent().x < fewest_waves && spectrum.extent().x < 0.5 * all) {
    // Of a coarse noise only the finest part is in the band, and any narrow band of waves comes back for a while.
    if (waves * 0.5 * all < fewest_waves)
      wider.emplace(thinned(force.whole), PeriodBand{band.low, coarser * band.high});
    else
      wider.emplace(busiest_half(force), band);
  }
  texture.regularity = regularity(wider && wider->whole_power() > 0 ? *wider : spectrum, components.front().waves);
  texture.period = texture.regularity >= periodic ? repetition(spectrum, components) : 1 / waves;
}

/// How suddenly the force changes, as against its size.
void tell_steepness(TextureForce& texture, const Bank& bank, const ForceField& seen) {
  std::vector<Hand> hands;
  hands.reserve(4 * change_places);
  for (const Hand& hand : hands_at_rest(change_places, glm::vec2(0.5 * seen.extent())))
    for (const glm::dvec2 aside : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
      Hand& moved = hands.emplace_back();
      moved.position = moved.workspace = glm::vec2(glm::dvec2(hand.position) + seen.centre + difference * aside);
    }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  std::vector<float> changes;
  for (std::size_t i = 0; i < forces.size(); i += 4)
    changes.push_back(std::sqrt(squared(forces[i] - forces[i + 1]) + squared(forces[i + 2] - forces[i + 3])));
  texture.steepness = quantile(std::move(changes), 0.99) / (2 * difference) / texture.amplitude;
}

/// The patch less its rim, m.
glm::dvec2 inside_of(const Bank& bank) {
  const glm::dvec2 size(bank.size().width, bank.size().height);
  return glm::max(size - 2.0 * bank.size().rim, 0.25 * size);
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

TextureForce texture_force(const Bank& bank, const StaticForce& force, const PeriodBand& band, double least) {
  least = std::max(least, least_amplitude);
  if (force.bent < least) return {};
  TextureForce texture;
  std::optional<BandSpectrum> spectrum;
  if (seen_closely(force, band)) {
    spectrum.emplace(force.close, band);
    const double share = spectrum->share_of_amplitude();
    const PeriodBand slower{band.high * gradual, std::numeric_limits<double>::infinity()};
    if (force.slow.ceiling_within(slower) > least)
      tell_size(texture, less(force.whole, refined(force.slow.within(slower))), share);
    else
      tell_size(texture, force.whole, share);
  } else {
    if (force.slow.ceiling_within(band) < least) return {};
    tell_size(texture, force.slow.within(band), 1);
    if (texture.amplitude >= least) spectrum.emplace(force.slow.coarsely_within(band), band);
  }
  if (texture.amplitude < least) return {};
  const auto components = spectrum->components(most_waves, least_share);
  if (components.empty()) return {};
  tell_waves(texture, *spectrum, components);
  tell_regularity(texture, force, band, *spectrum, components);
  tell_steepness(texture, bank, seen_closely(force, band) ? force.close : force.whole);
  return texture;
}

}  // namespace wale
