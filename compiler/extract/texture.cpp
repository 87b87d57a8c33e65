#include "compiler/extract/texture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "compiler/extract/band_spectrum.hpp"
#include "compiler/extract/regularity.hpp"
#include "compiler/extract/tolerances.hpp"
#include "compiler/measure/hands.hpp"

namespace wale {
namespace {

constexpr double edge = 0.1;  // of a window on each side: the ends of a transform ring there
constexpr std::size_t change_places = 1024;
constexpr double difference = 2e-5;    // m: the step for the change of the force
constexpr double fewest_waves = 14;    // over a window: with fewer waves noise looks regular
constexpr std::size_t most_waves = 4;  // that are reported ...
constexpr double least_share = 0.1;    // ... each with that much of the power
constexpr double a_multiple = 0.05;    // tolerance for a whole multiple of another wave
constexpr double periodic = 0.9;       // regularity above which the texture counts as periodic
constexpr double coarser = 3;          // than the band: the regularity of a coarse texture is read there
constexpr double no_direction = 0.05;  // below this anisotropy the direction is chance

/// The part of a field in which the ends of a transform do not ring.
template <typename Visit>
void each_inside(std::size_t side, const Visit& visit) {
  const auto margin = static_cast<std::size_t>(edge * static_cast<double>(side));
  for (std::size_t row = margin; row < side - margin; ++row)
    for (std::size_t column = margin; column < side - margin; ++column) visit(row * side + column);
}

/// The half of a field around its strongest place.
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

/// The strength of a texture, from a field without slower parts; this share of its amplitude counts.
void tell_size(TextureForce& texture, const ForceField& field, double share) {
  std::vector<float> sizes;
  sizes.reserve(field.forces.size());
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

/// The direction in [0, pi).
double half_turn(double angle) {
  while (angle < 0) angle += std::numbers::pi;
  while (angle >= std::numbers::pi) angle -= std::numbers::pi;
  return angle;
}

/// Whether one wave fits a whole number of times into another.
bool multiple(glm::dvec2 waves, glm::dvec2 of) {
  const double times = std::round(glm::length(waves) / glm::length(of));
  const auto near = [&](glm::dvec2 expected) { return glm::length(waves - expected) < a_multiple * glm::length(of); };
  return times >= 1 && (near(times * of) || near(-times * of));
}

/// The waves of a texture and its direction.
void tell_waves(TextureForce& texture, const BandSpectrum& spectrum, const std::vector<WaveComponent>& components) {
  const glm::dvec2 strongest = components.front().waves, directions = spectrum.directions();
  texture.anisotropy = std::min(1.0, glm::length(directions) / spectrum.whole_power());
  texture.orientation = half_turn(texture.anisotropy < no_direction ? std::atan2(strongest.y, strongest.x)
                                                                    : 0.5 * std::atan2(directions.y, directions.x));
  // Each wave has two sign changes per period; the mean square of the numbers of periods gives the number of all.
  texture.transitions = 2 * std::sqrt(spectrum.mean_square_waves(glm::normalize(strongest)));
  std::vector<glm::dvec2> told;
  for (const WaveComponent& each : components) {
    if (std::ranges::any_of(told, [&](glm::dvec2 other) { return multiple(each.waves, other); })) continue;
    told.push_back(each.waves);
    texture.waves.push_back(
        {1 / glm::length(each.waves), half_turn(std::atan2(each.waves.y, each.waves.x)), each.share});
  }
}

/// The regularity of a texture and its period. A few waves may repeat by chance, so a window should hold many: if the
/// closer window does not, half of the patch or the whole is used. Waves that are too fine for their samples count
/// there as regular as they are anywhere.
void tell_regularity(TextureForce& texture, const StaticForce& force, const PeriodBand& band,
                     const BandSpectrum& spectrum, const std::vector<WaveComponent>& components) {
  std::optional<BandSpectrum> wider;
  const double waves = glm::length(components.front().waves), all = force.whole.extent().x;
  if (waves * spectrum.extent().x < fewest_waves && spectrum.extent().x < 0.5 * all) {
    // Only the finest part of a coarse noise is in the band, and a narrow band of waves always repeats for a while.
    if (waves * 0.5 * all < fewest_waves)
      wider.emplace(thinned(force.whole), PeriodBand{band.low, coarser * band.high});
    else
      wider.emplace(busiest_half(force), band);
  }
  texture.regularity = regularity(wider && wider->whole_power() > 0 ? *wider : spectrum, components.front().waves);
  texture.period = texture.regularity >= periodic ? repetition(spectrum, components) : 1 / waves;
}

/// The steepness of the force, relative to its size.
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

}  // namespace

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
