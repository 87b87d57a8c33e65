#include "compiler/read/relief_figures.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/fundamental.hpp"
#include "compiler/read/only_direction.hpp"
#include "compiler/read/sign_changes.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/window_spectrum.hpp"

namespace wale {
namespace {

constexpr std::size_t change_places = 1024;
constexpr double difference = 1e-5;                          // m: half the step for the change of the force
constexpr double small_part = 0.04;                          // of the mean square: not worth its own spectrum
constexpr double no_direction = 0.05;                        // below this anisotropy the direction is chance
constexpr double perhaps_lines = 0.8, surely_lines = 0.999;  // anisotropies
constexpr double weak = 0.02;                                // of the mean square: a wave that is not told
constexpr double along_one_axis = 0.95;                      // of the mean square of a relief's forces
constexpr std::size_t octave_parts = 12;                     // in which the periods of irregular parts are counted

/// The direction in [0, pi). Hardly less than half a turn is none.
double half_turned(double angle) {
  angle = std::fmod(angle, std::numbers::pi);
  if (angle < 0) angle += std::numbers::pi;
  return std::numbers::pi - angle < 1e-3 ? 0 : angle;
}

/// Adds up where the mean square lies: by period, and by direction.
struct Distribution {
  std::vector<double> octaves = std::vector<double>(24 * octave_parts, 0.0);  // from a micrometre on
  std::complex<double> doubled = 0;  // power times the direction of twice the angle
  double sum = 0;

  void add(glm::dvec2 waves, double share) {
    const double far = glm::length(waves);
    const double place = std::log2(1e6 / far) * octave_parts;
    octaves[std::clamp<std::size_t>(static_cast<std::size_t>(std::max(place, 0.0)), 0, octaves.size() - 1)] += share;
    const std::complex<double> direction(waves.x / far, waves.y / far);
    doubled += share * direction * direction;
    sum += share;
  }
  static double period(std::size_t place) {
    return 1e-6 * std::exp2((static_cast<double>(place) + 0.5) / octave_parts);
  }
  /// The period in the middle of the irregular parts.
  double middle() const {
    double all = 0, part = 0;
    for (const double share : octaves) all += share;
    for (std::size_t i = 0; i < octaves.size(); ++i)
      if ((part += octaves[i]) >= 0.5 * all) return period(i);
    return 0;
  }
};

constexpr double much_larger = 3;  // than the amplitude: the largest force of a small feature

/// The largest change of a waveform within a 16th of its period, against that of a sine with this maximum.
double abruptness_of(const std::vector<glm::dvec2>& profile, double most) {
  constexpr double parts = 16;
  const auto count = profile.size();
  const auto apart = std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(count) / parts));
  double change = 0;
  for (std::size_t i = 0; i < count; ++i)
    change = std::max(change, glm::length(profile[(i + apart) % count] - profile[i]));
  const double turned = std::numbers::pi * static_cast<double>(apart) / static_cast<double>(count);
  return change / (2 * most * std::sin(turned));
}

/// The third moment of some values over their mean square to the power 3/2.
double skew_of(const std::vector<double>& values) {
  double squares = 0, cubes = 0;
  for (const double value : values) squares += value * value, cubes += value * value * value;
  const auto count = static_cast<double>(values.size());
  return squares > 0 ? cubes / count / std::pow(squares / count, 1.5) : 0;
}

/// Adds the sides of a wave, in so great a part of all waves.
void tell_sides(Relief& relief, const FoldedWave& wave, double part) {
  constexpr std::size_t parts = 16;  // of a period, over which it rises or falls
  const std::vector<glm::dvec2>& profile = wave.profile;
  const auto count = profile.size();
  const glm::dvec2 along = glm::normalize(wave.waves), left(-along.y, along.x);
  glm::dvec2 mean{0}, cubes{0};
  for (const glm::dvec2& force : profile) mean += force / static_cast<double>(count);
  double squares = 0;
  std::vector<double> rises, rises_left;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 force = profile[i] - mean;
    squares += glm::dot(force, force), cubes += glm::dot(force, force) * force;
    const glm::dvec2 rise = profile[(i + std::max<std::size_t>(1, count / parts)) % count] - profile[i];
    rises.push_back(glm::dot(rise, along)), rises_left.push_back(glm::dot(rise, left));
  }
  if (!(squares > 0)) return;
  const auto of = static_cast<double>(count);
  relief.skew += part * cubes / of / std::pow(squares / of, 1.5);
  // A part of the force that is next to none has a shape by chance.
  double rise = 0, rise_left = 0;
  for (std::size_t i = 0; i < count; ++i) rise += rises[i] * rises[i], rise_left += rises_left[i] * rises_left[i];
  if (rise > weak * rise_left) relief.steeper_along += part * skew_of(rises);
  if (rise_left > weak * rise) relief.steeper_across += part * skew_of(rises_left);
}

/// Tells the figures of one relief.
class ReliefFigures {
 public:
  explicit ReliefFigures(const SplitRelief& from) : from_(from) {}

  /// `felt` (N): the forces where they are felt. Less than `misfit` (N) without a wave is what a trend leaves.
  Relief told(const std::vector<glm::dvec2>& felt, double misfit) {
    if (felt.empty()) return relief_;
    std::vector<double> sizes;
    sizes.reserve(felt.size());
    double sum = 0, squares = 0;
    for (const glm::dvec2& force : felt) {
      sizes.push_back(glm::length(force));
      sum += sizes.back(), squares += glm::dot(force, force);
      relief_.maximum = std::max(relief_.maximum, sizes.back());
    }
    const auto count = static_cast<double>(sizes.size());
    relief_.mean = sum / count, relief_.rms = std::sqrt(squares / count);
    relief_.amplitude = percentile(sizes, percentile_of_amplitude);
    const bool waved = !from_.waves.waves.empty() || from_.waves.lattice;
    if (relief_.amplitude < least_amplitude || (!waved && relief_.amplitude < misfit)) {
      Relief small;  // What fills less than a hundredth of the patch is felt all the same.
      if (relief_.maximum > much_larger * std::max(relief_.amplitude, misfit)) small.maximum = relief_.maximum;
      return small;
    }
    const bool hilly = std::ranges::any_of(from_.features, [](const Feature& each) { return !each.monotone; });
    tell_parts(hilly);
    if (!hilly) tell_feature_beside_waves();
    tell_push();
    tell_sign_changes();
    tell_steepness();
    return relief_;
  }

 private:
  /// What the waves leave, if that is in one place of less than a hundredth of the patch.
  void tell_feature_beside_waves() {
    constexpr double plainly = 0.2;       // of the amplitude
    constexpr double small_place = 0.12;  // of the patch's shorter side
    constexpr std::size_t fewest = 4;     // of the places
    const std::vector<glm::dvec2>& rest = from_.waves.rest;
    if (from_.waves.waves.empty() || from_.waves.lattice || from_.waves.local || rest.empty()) return;
    double most = 0;
    for (const glm::dvec2& force : rest) most = std::max(most, glm::length(force));
    if (most < std::max(2 * least_force, plainly * relief_.amplitude)) return;
    std::vector<glm::dvec2> there;
    glm::dvec2 middle{0};
    for (std::size_t i = 0; i < rest.size(); ++i)
      if (glm::length(rest[i]) > 0.5 * most) there.push_back(from_.whole.places[i]), middle += there.back();
    middle /= static_cast<double>(there.size());
    const double far = small_place * std::min(from_.whole.size.x, from_.whole.size.y);
    const bool together =
        std::ranges::all_of(there, [&](glm::dvec2 place) { return glm::distance(place, middle) <= far; });
    const auto most_places = (1 - percentile_of_amplitude) * static_cast<double>(rest.size());
    if (together && there.size() >= fewest && static_cast<double>(there.size()) <= 2 * most_places)
      relief_.beside_waves = most;
  }

  /// The axis along which the relief pushes, if it pushes along one.
  void tell_push() {
    double xx = 0, xy = 0, yy = 0;
    for (const glm::dvec2& force : from_.forces)
      xx += force.x * force.x, xy += force.x * force.y, yy += force.y * force.y;
    const double apart = std::hypot(0.5 * (xx - yy), xy);
    if (0.5 * (xx + yy) + apart < along_one_axis * (xx + yy)) return;
    relief_.push = half_turned(0.5 * std::atan2(2 * xy, xx - yy));
  }

  /// Where the mean square lies: waves by their fundamental, a hill, and the irregular rest.
  void tell_parts(bool hilly) {
    const double all = relief_.rms * relief_.rms;
    Distribution regular, irregular;
    double of_waves = 0;
    for (const FoundWave& each : from_.waves.waves) of_waves += each.power;
    double rest = std::min(all, mean_square(from_.waves.rest));
    if (hilly) rest = std::max(rest, all - of_waves);
    if (from_.waves.local || from_.waves.lattice) rest = (1 - from_.waves.share) * all;
    if (rest < small_part * all) rest = 0;
    const double scale = of_waves > 0 ? (all - rest) / of_waves : 0;
    for (const FoundWave& each : from_.waves.waves) {
      const double share = each.power * scale / all;
      const std::vector<WavePart> parts = parts_of(each);
      // A sum of waves repeats after their common multiple, but is felt by its waves.
      for (const WavePart& part : parts)
        relief_.parts.push_back({each.wave.period() / static_cast<double>(part.number), share * part.share});
      regular.add(each.wave.waves, share);
      tell_sides(relief_, each.wave, each.power / of_waves);
      tell_wave(each, share, parts);
    }
    if (from_.waves.lattice && from_.waves.waves.empty()) {
      relief_.parts.push_back({from_.waves.lattice->period(), from_.waves.share});
      // Its directions are those of all its waves, not of two.
      WindowSpectrum(from_.whole, from_.forces).each([&](glm::dvec2 waves, double part) {
        if (waves != glm::dvec2(0)) regular.add(waves, part * from_.waves.share);
      });
      for (const glm::dvec2 waves : {from_.waves.lattice->one, from_.waves.lattice->other}) {
        relief_.waves.push_back(
            {1 / glm::length(waves), half_turned(std::atan2(waves.y, waves.x)), 0.5 * from_.waves.share});
      }
    }
    for (const Relief::Part& each : relief_.parts) relief_.regularity += each.share;
    relief_.regularity = std::min(1.0, relief_.regularity);
    // A hill is no part of the texture that it carries.
    if (hilly && of_waves > 0) relief_.regularity = of_waves / (of_waves + mean_square(from_.waves.rest));
    if (rest > 0 && hilly)
      relief_.parts.push_back({0.5 * std::min(from_.whole.size.x, from_.whole.size.y), rest / all});
    else if (rest > 0)
      distribute(irregular, rest / all);
    for (std::size_t i = 0; i < irregular.octaves.size(); ++i)
      if (irregular.octaves[i] > 0) relief_.parts.push_back({Distribution::period(i), irregular.octaves[i]});
    tell_direction(regular, irregular);
    if (relief_.regular()) {
      const bool lattice = from_.waves.lattice && (from_.waves.waves.empty() || from_.waves.share > 0.5);
      relief_.period = lattice ? from_.waves.lattice->period() : from_.waves.period(from_.whole.size);
      if (!lattice && !from_.waves.local) tell_sum();
    } else if (!hilly) {
      relief_.period = irregular.middle();
    }
  }

  /// Of several waves along one direction the waveform is that of all, over as much as the patch holds. Waves that do
  /// not repeat together after the period told are not wholly regular.
  void tell_sum() {
    const glm::dvec2 way = glm::normalize(from_.waves.waves.front().felt()), common = way / relief_.period;
    double together = 0, all = 0;
    std::vector<const FoundWave*> along;
    for (const FoundWave& each : from_.waves.waves) {
      all += each.power;
      const glm::dvec2 across = each.felt() - glm::dot(each.felt(), way) * way;
      const bool aside = glm::length(across * from_.whole.size) > out_of_place;
      if (!aside) along.push_back(&each);
      if (aside || whole_periods(common, each.felt(), from_.whole.size) != 0) together += each.power;
    }
    const bool repeats = together >= (1 - weak) * all;
    if (!repeats) {
      relief_.repeating = relief_.regularity;
      relief_.regularity *= together / all;
    } else if (along.size() < 2) {
      return;
    }
    constexpr double parts = 64;  // of a period
    const double length = length_along(from_.whole.size, way);
    const auto count = static_cast<std::size_t>(parts * length / relief_.period);
    std::vector<glm::dvec2> places, forces(count);
    for (std::size_t i = 0; i < count; ++i)
      places.push_back(from_.whole.centre + (static_cast<double>(i) / parts * relief_.period - 0.5 * length) * way);
    for (const FoundWave* each : along) each->wave.add_to(places, forces, 1);
    std::vector<double> sizes;
    double change = 0;
    constexpr std::size_t apart = 4;  // a 16th of a period, as `abruptness_of` looks at
    for (std::size_t i = 0; i < count; ++i) {
      sizes.push_back(glm::length(forces[i]));
      if (i >= apart) change = std::max(change, glm::length(forces[i] - forces[i - apart]));
    }
    const double most = repeats ? *std::ranges::max_element(sizes) : percentile(sizes, percentile_of_amplitude);
    const double rms = std::sqrt(mean_square(forces));
    if (!(rms > 0)) return;
    relief_.crest = most / rms;
    relief_.abruptness = change / (2 * most * std::sin(std::numbers::pi * apart / parts));
  }

  void tell_wave(const FoundWave& each, double share, const std::vector<WavePart>& parts) {
    const double orientation = half_turned(std::atan2(each.wave.waves.y, each.wave.waves.x));
    if (share >= weak)
      for (const WavePart& part : parts)
        relief_.waves.push_back(
            {each.wave.period() / static_cast<double>(part.number), orientation, share * part.share});
    if (relief_.crest > 0) return;
    // The strongest wave's own waveform, along the direction in which it pushes most.
    glm::dvec2 way{0};
    double largest = 0;
    for (const glm::dvec2& force : each.wave.profile)
      if (glm::length(force) > largest) largest = glm::length(force), way = force / largest;
    double squares = 0, most = 0;
    int changes = 0, sign = 0;
    for (int round : {0, 1})
      for (const glm::dvec2& force : each.wave.profile) {
        const double along = glm::dot(force, way);
        squares += round * along * along, most = std::max(most, std::abs(along));
        if (std::abs(along) < 0.05 * largest) continue;
        const int now = along > 0 ? 1 : -1;
        changes += round == 1 && now != sign;
        sign = now;
      }
    relief_.crest = most / std::sqrt(squares / static_cast<double>(each.wave.profile.size()));
    relief_.abruptness = abruptness_of(each.wave.profile, most);
    relief_.transitions = changes / each.wave.period();
  }

  /// Spreads a share of the mean square over the periods of what the waves leave.
  void distribute(Distribution& irregular, double share) const {
    // Features that are trends have been taken off; they are no noise.
    std::vector<glm::dvec2> forces = from_.forces;
    if (!from_.waves.local && !from_.waves.lattice)
      for (const FoundWave& each : from_.waves.waves) each.wave.add_to(from_.whole.places, forces, -1);
    StillForces window = from_.whole;
    double coarser = HUGE_VAL;
    const double longest = std::max(from_.whole.size.x, from_.whole.size.y);
    for (double closer : {4.0, 16.0, 0.0}) {
      const WindowSpectrum spectrum(window, forces);
      double known = 0;
      spectrum.each([&](glm::dvec2 waves, double part) { known += glm::length(waves) * coarser > 1 ? part : 0; });
      const double fine = spectrum.finer();
      if (!(known + fine > 0)) break;
      spectrum.each([&](glm::dvec2 waves, double part) {
        const double far = glm::length(waves);
        if (far > 0 && far * coarser > 1) irregular.add(waves, share * part / (known + fine));
      });
      share *= fine / (known + fine);
      if (share < small_part || closer == 0) {
        if (share > 0) irregular.add({0.5 * std::numbers::sqrt2 * 2 / spectrum.finest(), 1 / spectrum.finest()}, share);
        return;
      }
      coarser = spectrum.finest();
      const glm::dvec2 size = glm::min(glm::dvec2(longest / closer), from_.whole.size),
                       room = 0.5 * (from_.whole.size - size);
      window = still_forces(from_.field, glm::clamp(busiest_place(from_.whole, from_.forces), -room, room), size, 128);
      forces = window.forces;
      for (std::size_t i = 0; i < forces.size(); ++i) forces[i] -= from_.trend.at(window.places[i]);
      if (!from_.waves.local && !from_.waves.lattice)
        for (const FoundWave& each : from_.waves.waves) each.wave.add_to(window.places, forces, -1);
    }
  }

  void tell_direction(const Distribution& regular, const Distribution& irregular) {
    std::complex<double> doubled = regular.doubled + irregular.doubled;
    double sum = regular.sum + irregular.sum;
    // Single features change along their own directions.
    const bool only_features = !(sum > 0);
    for (const Feature& each : from_.features) {
      if (each.monotone || !only_features) continue;
      const double weight = each.range * each.range;
      const std::complex<double> direction(each.direction.x, each.direction.y);
      doubled += weight * direction * direction, sum += weight;
    }
    if (!(sum > 0)) return;
    relief_.anisotropy = std::min(1.0, std::abs(doubled) / sum);
    if (!from_.waves.waves.empty() && (relief_.anisotropy < no_direction || from_.waves.waves.size() == 1)) {
      const glm::dvec2 waves = from_.waves.waves.front().wave.waves;
      relief_.orientation = half_turned(std::atan2(waves.y, waves.x));
    } else {
      relief_.orientation = half_turned(0.5 * std::arg(doubled));
    }
    look_along_lines();
  }

  /// A relief whose parts are fitted a little awry may change along one direction alone.
  void look_along_lines() {
    const bool trends = std::ranges::any_of(from_.features, [](const Feature& each) { return each.monotone; });
    if (trends || relief_.anisotropy < perhaps_lines || relief_.anisotropy >= surely_lines) return;
    double grain = HUGE_VAL;
    for (const Relief::Part& each : relief_.parts)
      if (each.share >= weak) grain = std::min(grain, each.period);
    const auto found = std::isfinite(grain) ? only_direction(from_.field, from_.whole, from_.trend, relief_.orientation,
                                                             relief_.rms, grain)
                                            : std::nullopt;
    if (found) relief_.anisotropy = 1, relief_.orientation = half_turned(*found);
  }

  /// Those of a single wave are known from its waveform.
  void tell_sign_changes() {
    if (relief_.parts.size() == 1 && relief_.transitions > 0) return;
    double finest = 0, seen = 0;
    std::vector<Relief::Part> parts = relief_.parts;
    std::ranges::sort(parts, std::ranges::greater{}, &Relief::Part::period);
    for (const Relief::Part& each : parts) {
      // What is finer than all but a twentieth changes few signs.
      if (seen < 0.95) finest = each.period;
      seen += each.share;
    }
    if (finest > 0) relief_.transitions = sign_changes(from_, relief_, finest);
  }

  /// The steepness of the relief, relative to its size.
  void tell_steepness() {
    std::vector<glm::dvec2> places;
    const std::size_t every = from_.whole.places.size() / change_places;
    for (std::size_t i = every / 2; i < from_.whole.places.size(); i += every)
      for (const glm::dvec2 aside : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
        places.push_back(from_.whole.places[i] + difference * aside);
    const std::vector<glm::dvec2> forces = from_.field(places);
    std::vector<double> changes;
    for (std::size_t i = 0; i < forces.size(); i += 4) {
      const glm::dvec2 x = (forces[i] - forces[i + 1]) / (2 * difference) - from_.trend.by_x;
      const glm::dvec2 y = (forces[i + 2] - forces[i + 3]) / (2 * difference) - from_.trend.by_y;
      changes.push_back(std::sqrt(glm::dot(x, x) + glm::dot(y, y)));
    }
    relief_.steepness = percentile(changes, percentile_of_amplitude) / relief_.amplitude;
  }

  const SplitRelief& from_;
  Relief relief_;
};

}  // namespace

double percentile(const std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto rank = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  // Only the values above what a sample puts well below it are put in order.
  constexpr std::size_t every = 16;
  std::vector<double> sample;
  for (std::size_t i = 0; i < values.size(); i += every) sample.push_back(values[i]);
  const auto below = static_cast<std::ptrdiff_t>((2 * share - 1) * static_cast<double>(sample.size()));
  std::ranges::nth_element(sample, sample.begin() + below);
  const double least = sample[static_cast<std::size_t>(below)];
  std::vector<double> top;
  for (const double value : values)
    if (value >= least) top.push_back(value);
  if (top.size() < values.size() - rank) top = values;
  const auto from_the_top = static_cast<std::ptrdiff_t>(top.size() - (values.size() - rank));
  std::ranges::nth_element(top, top.begin() + from_the_top);
  return top[static_cast<std::size_t>(from_the_top)];
}

double Relief::within(const PeriodBand& band) const {
  double share = 0;
  for (const Part& part : parts)
    if (part.period >= band.low && part.period < band.high) share += part.share;
  return amplitude * std::sqrt(std::min(1.0, share));
}

double Relief::beside_strongest() const {
  double share = 0;
  for (std::size_t i = 1; i < waves.size(); ++i) share += waves[i].share;
  return amplitude * std::sqrt(std::min(1.0, share));
}

double Relief::small_feature() const { return maximum > much_larger * amplitude ? maximum : beside_waves; }

Relief figures_of(const SplitRelief& split, const std::vector<glm::dvec2>& felt, double misfit) {
  return ReliefFigures(split).told(felt, misfit);
}

}  // namespace wale
