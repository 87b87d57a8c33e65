#include "compiler/read/relief.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/dependence.hpp"
#include "compiler/read/fundamental.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/window_spectrum.hpp"
#include "wale/picture.hpp"

namespace wale {
namespace {

constexpr std::size_t side_of_whole = 160;  // 0.9 mm apart on a patch of 160 mm
constexpr double ratio = 0.99;              // the percentile that is an amplitude
constexpr std::size_t change_places = 1024;
constexpr double difference = 1e-5;  // m: half the step for the change of the force
constexpr std::size_t cells_a_mean = 4;
constexpr double plainly_explained = 0.03;  // of the mean square, left by a trend that is found before the waves
constexpr double little = 0.04;             // of the mean square: not worth its own spectrum
constexpr double curved = 0.02;             // of the mean square without waves, beyond a line
constexpr double much_better = 0.3;         // of what a line leaves, left by features
constexpr double a_micrometre = 1e-6;       // m: heights are read in these, since the least that counts is for newtons
constexpr double misfit = 0.03;             // of the largest force: what a trend may leave as if it were relief
constexpr double no_direction = 0.05;       // below this anisotropy the direction is chance
constexpr double weak = 0.02;               // of the mean square: a wave that is not told
constexpr std::size_t octave_parts = 12;    // in which the periods of irregular parts are counted

/// The patch without its rim, m.
glm::dvec2 inside_of(PatchSize patch) {
  const glm::dvec2 size(patch.width, patch.height);
  return glm::max(size - 2.0 * patch.rim, 0.25 * size);
}

/// The direction in [0, pi). Hardly less than half a turn is none.
double half_turned(double angle) {
  angle = std::fmod(angle, std::numbers::pi);
  if (angle < 0) angle += std::numbers::pi;
  return std::numbers::pi - angle < 1e-3 ? 0 : angle;
}

/// The value that so large a share of all values, at least a half, lies below.
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

/// Adds up where the mean square lies: by period, and by direction.
struct Distribution {
  std::vector<double> octaves = std::vector<double>(24 * octave_parts, 0.0);  // from a micrometre on
  std::complex<double> doubled = 0;  // power times the direction of twice the angle
  double squared_waves = 0, sum = 0;

  void add(glm::dvec2 waves, double share) {
    const double far = glm::length(waves);
    const double place = std::log2(1e6 / far) * octave_parts;
    octaves[std::clamp<std::size_t>(static_cast<std::size_t>(std::max(place, 0.0)), 0, octaves.size() - 1)] += share;
    const std::complex<double> direction(waves.x / far, waves.y / far);
    doubled += share * direction * direction;
    squared_waves += share * far * far, sum += share;
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

/// Reads the relief of one program.
class ReliefReader {
 public:
  ReliefReader(const StillField& field, PatchSize patch)
      : field_(field), whole_(still_forces(field, {0, 0}, inside_of(patch), side_of_whole)) {}

  StaticForce read() {
    std::vector<double> sizes;
    for (const glm::dvec2& force : whole_.forces) sizes.push_back(glm::length(force));
    found_.largest = percentile(sizes, ratio);
    const LinearForce line = linear_force(whole_.places, whole_.forces);
    std::vector<glm::dvec2> beyond = whole_.forces;
    double most = 0;
    for (std::size_t i = 0; i < beyond.size(); ++i)
      beyond[i] -= line.at(whole_.places[i]), most = std::max(most, glm::dot(beyond[i], beyond[i]));
    found_.trend = line;
    const double half = 0.25 * (whole_.size.x + whole_.size.y);
    found_.pushes_away = -line.stiffness() * half > 0.1 * found_.largest;
    if (std::sqrt(most) < std::max(least_amplitude, 1e-5 * found_.largest)) return found_;
    find_plain_trend(beyond);
    waves_ = find_waves(field_, whole_, found_.features);
    if (!found_.features.empty() && !waves_.waves.empty() && !waves_.local) {
      // What the features took of the waves goes back to them.
      refine_features(found_.features, whole_.places, without_waves_and_with(found_.features));
      waves_ = find_waves(field_, whole_, found_.features);
    }
    relief_ = whole_.forces;
    take_trend_off();
    tell_size();
    return found_;
  }

 private:
  /// The forces without waves: trends, features, noise.
  std::vector<glm::dvec2> without_waves() const {
    std::vector<glm::dvec2> forces = waves_.rest;
    for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += waves_.trend.at(whole_.places[i]);
    return forces;
  }

  void take_trend_off() {
    find_trend();
    found_.trend = waves_.trend;
    // The relief is what no trend explains. Hills belong to it.
    std::vector<Feature> trends;
    for (const Feature& each : found_.features)
      if (each.monotone) trends.push_back(each);
    for (std::size_t i = 0; i < relief_.size(); ++i)
      relief_[i] = beside(trends, whole_.places[i], relief_[i] - found_.trend.at(whole_.places[i]));
    drop_small_trend();
  }

  /// Adds the means over small cells, which are nearly free of texture.
  void add_means(const std::vector<glm::dvec2>& forces, std::vector<glm::dvec2>& places,
                 std::vector<glm::dvec2>& means) const {
    for (std::size_t top = 0; top < whole_.side; top += cells_a_mean)
      for (std::size_t left = 0; left < whole_.side; left += cells_a_mean) {
        glm::dvec2 place{0}, force{0};
        for (std::size_t row = top; row < top + cells_a_mean; ++row)
          for (std::size_t column = left; column < left + cells_a_mean; ++column)
            place += whole_.places[row * whole_.side + column], force += forces[row * whole_.side + column];
        places.push_back(place / (1.0 * cells_a_mean * cells_a_mean));
        means.push_back(force / (1.0 * cells_a_mean * cells_a_mean));
      }
  }

  /// Looks for a trend that bends before any wave: a spring that saturates looks like a slow square wave.
  void find_plain_trend(const std::vector<glm::dvec2>& beyond) {
    std::vector<glm::dvec2> places, means, bent;
    add_means(beyond, places, bent);
    if (mean_square(bent) < 0.5 * mean_square(beyond)) return;
    places.clear();
    add_means(whole_.forces, places, means);
    std::vector<Feature> features = find_features(places, means, false);
    if (features.empty()) return;
    double left = 0, all = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      glm::dvec2 rest = means[i];
      for (const Feature& each : features) rest -= each.at(places[i]);
      left += glm::dot(rest, rest), all += glm::dot(means[i], means[i]);
    }
    if (left > plainly_explained * all) return;
    refine_features(features, whole_.places, whole_.forces);
    if (!std::ranges::all_of(features, &Feature::monotone)) return;
    found_.features = std::move(features);
  }

  /// Adds places where a small feature would be: about what is busiest, if little lies elsewhere.
  void add_closer_places(std::vector<glm::dvec2>& places, std::vector<glm::dvec2>& forces) const {
    const glm::dvec2 size = whole_.size / 4.0, room = 0.5 * (whole_.size - size);
    const glm::dvec2 centre = glm::clamp(busiest_place(whole_, waves_.rest), -room, room);
    double inside = 0, all = 0;
    for (std::size_t i = 0; i < waves_.rest.size(); ++i) {
      const double power = glm::dot(waves_.rest[i], waves_.rest[i]);
      const glm::dvec2 off = glm::abs(whole_.places[i] - centre);
      all += power, inside += off.x < 0.5 * size.x && off.y < 0.5 * size.y ? power : 0;
    }
    if (inside < 0.6 * all || !waves_.waves.empty()) return;
    const StillForces close = still_forces(field_, centre, size, 64);
    places.insert(places.end(), close.places.begin(), close.places.end());
    forces.insert(forces.end(), close.forces.begin(), close.forces.end());
  }

  /// Looks for features where a line and the waves leave much. If there are any, the waves beside them are found anew.
  void find_trend() {
    const std::vector<glm::dvec2> forces = without_waves();
    const double left = mean_square(waves_.rest);
    if (!found_.features.empty() || waves_.local || waves_.lattice || left < curved * mean_square(forces) ||
        left < little * mean_square(whole_.forces))
      return;
    std::vector<glm::dvec2> places, some;
    add_means(forces, places, some);
    add_closer_places(places, some);
    std::vector<Feature> features = find_features(places, some);
    if (features.empty() && waves_.waves.empty()) {
      // Without a texture to be free of, single places show more.
      places.clear(), some.clear();
      for (std::size_t i = 0; i < forces.size(); i += 7) places.push_back(whole_.places[i]), some.push_back(forces[i]);
      features = find_features(places, some);
    }
    if (!features.empty()) refine_features(features, whole_.places, forces);
    if (features.empty()) return;
    double after = 0;
    for (std::size_t i = 0; i < forces.size(); ++i) {
      glm::dvec2 rest = forces[i];
      for (const Feature& each : features) rest -= each.at(whole_.places[i]);
      after += glm::dot(rest, rest) / static_cast<double>(forces.size());
    }
    if (after > much_better * left) return;
    found_.features = std::move(features);
    const bool waved = !waves_.waves.empty();
    waves_ = find_waves(field_, whole_, found_.features);
    if (waved || waves_.waves.empty() || waves_.local) return;
    // What the features took of the waves goes back to them.
    refine_features(found_.features, whole_.places, without_waves_and_with(found_.features));
    waves_ = find_waves(field_, whole_, found_.features);
  }
  /// The forces without waves, with the features.
  std::vector<glm::dvec2> without_waves_and_with(const std::vector<Feature>& features) const {
    std::vector<glm::dvec2> forces = without_waves();
    for (std::size_t i = 0; i < forces.size(); ++i)
      for (const Feature& each : features) forces[i] += each.at(whole_.places[i]);
    return forces;
  }

  /// A slope that is hardly more than the waves' incomplete periods is none.
  void drop_small_trend() {
    const LinearForce& line = found_.trend;
    const glm::dvec2 half = 0.5 * whole_.size;
    const double slope = glm::length(line.by_x) * half.x + glm::length(line.by_y) * half.y;
    if (glm::length(line.mean) + slope > 0.01 * found_.largest) return;
    for (std::size_t i = 0; i < relief_.size(); ++i) relief_[i] += line.at(whole_.places[i]);
    found_.trend = {};
  }

  void tell_size() {
    Relief& relief = found_.relief;
    std::vector<double> sizes;
    double sum = 0, squares = 0;
    for (const glm::dvec2& force : relief_) {
      sizes.push_back(glm::length(force));
      sum += sizes.back(), squares += glm::dot(force, force);
      relief.maximum = std::max(relief.maximum, sizes.back());
    }
    const auto count = static_cast<double>(sizes.size());
    relief.mean = sum / count, relief.rms = std::sqrt(squares / count);
    relief.amplitude = percentile(sizes, ratio);
    const bool hilly = std::ranges::any_of(found_.features, [](const Feature& each) { return !each.monotone; });
    if (relief.amplitude < least_amplitude ||
        (waves_.waves.empty() && !waves_.lattice && relief.amplitude < misfit * found_.largest)) {
      relief = {};
      return;
    }
    tell_parts(hilly);
    tell_steepness();
  }

  /// Where the mean square lies: waves by their fundamental, a hill, and the irregular rest.
  void tell_parts(bool hilly) {
    Relief& relief = found_.relief;
    const double all = relief.rms * relief.rms;
    Distribution regular, irregular;
    double of_waves = 0;
    for (const FoundWave& each : waves_.waves) of_waves += each.power;
    double rest = std::min(all, mean_square(waves_.rest));
    if (hilly) rest = std::max(rest, all - of_waves);
    if (waves_.local || waves_.lattice) rest = (1 - waves_.share) * all;
    if (rest < little * all) rest = 0;
    const double scale = of_waves > 0 ? (all - rest) / of_waves : 0;
    for (const FoundWave& each : waves_.waves) {
      const double share = each.power * scale / all;
      const std::vector<WavePart> parts = parts_of(each);
      // Waves with a small common multiple have that as their fundamental.
      if (each.parts.size() > 1) relief.parts.push_back({each.wave.period(), share});
      for (const WavePart& part : parts)
        if (each.parts.size() == 1)
          relief.parts.push_back({each.wave.period() / static_cast<double>(part.number), share * part.share});
      regular.add(each.wave.waves, share);
      tell_wave(each, share, parts);
    }
    if (waves_.lattice && waves_.waves.empty()) {
      relief.parts.push_back({waves_.lattice->period(), waves_.share});
      // Its directions are those of all its waves, not of two.
      WindowSpectrum(whole_, relief_).each([&](glm::dvec2 waves, double part) {
        if (waves != glm::dvec2(0)) regular.add(waves, part * waves_.share);
      });
      for (const glm::dvec2 waves : {waves_.lattice->one, waves_.lattice->other}) {
        relief.waves.push_back({1 / glm::length(waves), half_turned(std::atan2(waves.y, waves.x)), 0.5 * waves_.share});
      }
    }
    for (const Relief::Part& each : relief.parts) relief.regularity += each.share;
    relief.regularity = std::min(1.0, relief.regularity);
    // A hill is no part of the texture that it carries.
    if (hilly && of_waves > 0) relief.regularity = of_waves / (of_waves + mean_square(waves_.rest));
    if (rest > 0 && hilly)
      relief.parts.push_back({0.5 * std::min(whole_.size.x, whole_.size.y), rest / all});
    else if (rest > 0)
      distribute(irregular, rest / all);
    for (std::size_t i = 0; i < irregular.octaves.size(); ++i)
      if (irregular.octaves[i] > 0) relief.parts.push_back({Distribution::period(i), irregular.octaves[i]});
    tell_direction(regular, irregular);
    if (relief.regular()) {
      const bool lattice = waves_.lattice && (waves_.waves.empty() || waves_.share > 0.5);
      relief.period = lattice ? waves_.lattice->period() : waves_.waves.front().wave.period();
    } else if (!hilly) {
      relief.period = irregular.middle();
    }
  }

  void tell_wave(const FoundWave& each, double share, const std::vector<WavePart>& parts) {
    Relief& relief = found_.relief;
    const double orientation = half_turned(std::atan2(each.wave.waves.y, each.wave.waves.x));
    if (share >= weak)
      for (const WavePart& part : parts)
        relief.waves.push_back(
            {each.wave.period() / static_cast<double>(part.number), orientation, share * part.share});
    if (relief.crest > 0) return;
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
    relief.crest = most / std::sqrt(squares / static_cast<double>(each.wave.profile.size()));
    relief.transitions = changes / each.wave.period();
  }

  /// Spreads a share of the mean square over the periods of what the waves leave.
  void distribute(Distribution& irregular, double share) const {
    // Features that are trends have been taken off; they are no noise.
    std::vector<glm::dvec2> forces = relief_;
    if (!waves_.local && !waves_.lattice)
      for (std::size_t i = 0; i < forces.size(); ++i)
        for (const FoundWave& each : waves_.waves) forces[i] -= each.wave.at(whole_.places[i]);
    StillForces window = whole_;
    double coarser = HUGE_VAL;
    const double longest = std::max(whole_.size.x, whole_.size.y);
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
      if (share < little || closer == 0) {
        if (share > 0) irregular.add({0.5 * std::numbers::sqrt2 * 2 / spectrum.finest(), 1 / spectrum.finest()}, share);
        return;
      }
      coarser = spectrum.finest();
      const glm::dvec2 size = glm::min(glm::dvec2(longest / closer), whole_.size), room = 0.5 * (whole_.size - size);
      window = still_forces(field_, glm::clamp(busiest_place(whole_, relief_), -room, room), size, 128);
      forces = window.forces;
      for (std::size_t i = 0; i < forces.size(); ++i) {
        forces[i] -= found_.trend.at(window.places[i]);
        if (!waves_.local && !waves_.lattice)
          for (const FoundWave& each : waves_.waves) forces[i] -= each.wave.at(window.places[i]);
      }
    }
  }

  void tell_direction(const Distribution& regular, const Distribution& irregular) {
    Relief& relief = found_.relief;
    const std::complex<double> doubled = regular.doubled + irregular.doubled;
    const double sum = regular.sum + irregular.sum;
    if (!(sum > 0)) return;
    relief.anisotropy = std::min(1.0, std::abs(doubled) / sum);
    if (!waves_.waves.empty() && (relief.anisotropy < no_direction || waves_.waves.size() == 1)) {
      const glm::dvec2 waves = waves_.waves.front().wave.waves;
      relief.orientation = half_turned(std::atan2(waves.y, waves.x));
    } else {
      relief.orientation = half_turned(0.5 * std::arg(doubled));
    }
    if (relief.transitions == 0) {
      // An irregular wave changes its sign as often as one of its mean square number of periods does.
      const double across = 0.5 * (irregular.squared_waves + regular.squared_waves) * (1 + relief.anisotropy) / sum;
      relief.transitions = 2 * std::sqrt(across);
    }
  }

  /// The steepness of the relief, relative to its size.
  void tell_steepness() {
    std::vector<glm::dvec2> places;
    const std::size_t every = whole_.places.size() / change_places;
    for (std::size_t i = every / 2; i < whole_.places.size(); i += every)
      for (const glm::dvec2 aside : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
        places.push_back(whole_.places[i] + difference * aside);
    const std::vector<glm::dvec2> forces = field_(places);
    std::vector<double> changes;
    for (std::size_t i = 0; i < forces.size(); i += 4) {
      const glm::dvec2 x = (forces[i] - forces[i + 1]) / (2 * difference) - found_.trend.by_x;
      const glm::dvec2 y = (forces[i + 2] - forces[i + 3]) / (2 * difference) - found_.trend.by_y;
      changes.push_back(std::sqrt(glm::dot(x, x) + glm::dot(y, y)));
    }
    found_.relief.steepness = percentile(changes, ratio) / found_.relief.amplitude;
  }

  const StillField& field_;
  StillForces whole_;
  StaticForce found_;
  FoundWaves waves_;
  std::vector<glm::dvec2> relief_;  // N, at the places of the whole
};

}  // namespace

double Relief::within(const PeriodBand& band) const {
  double share = 0;
  for (const Part& part : parts)
    if (part.period >= band.low && part.period < band.high) share += part.share;
  return amplitude * std::sqrt(std::min(1.0, share));
}

StaticForce static_force(const Bank& bank) {
  const StillField field = [&](std::span<const glm::dvec2> places) { return forces_at(bank, places); };
  if (depends_on_place(bank.program().description())) return ReliefReader(field, bank.size()).read();
  StaticForce found;
  const glm::dvec2 middle{0};
  found.trend.mean = forces_at(bank, {&middle, 1}).front();
  found.largest = glm::length(found.trend.mean);
  return found;
}

Relief picture_relief(const Bank& bank, const Memory* memory) {
  const StillField field = [&](std::span<const glm::dvec2> places) {
    std::vector<glm::vec2> positions(places.begin(), places.end());
    std::vector<float> heights(positions.size());
    surface_all(bank, memory, positions, heights);
    std::vector<glm::dvec2> found;
    for (const float height : heights) found.emplace_back(std::isfinite(height) ? height / a_micrometre : 0, 0);
    return found;
  };
  return ReliefReader(field, bank.size()).read().relief;
}

}  // namespace wale
