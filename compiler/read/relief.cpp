#include "compiler/read/relief.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "compiler/read/bent_wall.hpp"
#include "compiler/read/beside_waves.hpp"
#include "compiler/read/cut_part.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/motion.hpp"
#include "compiler/read/relief_figures.hpp"
#include "compiler/read/slow_sine.hpp"
#include "compiler/read/spring_end.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/unlimited.hpp"
#include "wale/picture.hpp"

namespace wale {
namespace {

constexpr std::size_t side_of_whole = 160;  // 0.9 mm apart on a patch of 160 mm
constexpr double bending_periods = 20;      // over the patch: slower waves bend like what stands in it
constexpr double plainly_explained = 0.03;  // of the mean square, left by a trend that is found before the waves
constexpr double little = 0.04;             // of the mean square: not worth its own spectrum
constexpr double repeats = 0.02;            // of the mean square beyond a line, left by waves alone
constexpr double curved = 0.02;             // of the mean square without waves, beyond a line
constexpr double much_better = 0.3;         // of what a line leaves, left by features
constexpr double a_micrometre = 1e-6;       // m: heights are read in these, since the least that counts is for newtons
constexpr double misfit = 0.03;             // of the largest force: what a trend may leave as if it were relief
constexpr double least_cut = 2e-3;          // of the places: cut off by a device's limit
constexpr double least_cut_by_author = 1.5 * (1 - percentile_of_amplitude);  // `lateral` cuts all above it

/// The patch without its rim, m.
glm::dvec2 inside_of(PatchSize patch) {
  const glm::dvec2 size(patch.width, patch.height);
  return glm::max(size - 2.0 * patch.rim, 0.25 * size);
}

/// Reads the relief of one program.
class ReliefReader {
 public:
  /// `limit`: what is beyond it, a device or the program's author cuts off.
  ReliefReader(const StillField& field, PatchSize patch, const ForceLimit& limit = {})
      : field_(field), whole_(still_forces(field, {0, 0}, inside_of(patch), side_of_whole)), limit_(limit) {}

  /// Whether some forces are at this limit.
  bool reaches(const ForceLimit& limit) const {
    return std::ranges::any_of(whole_.forces, [&](glm::dvec2 force) { return limit.reached_by(force); });
  }

  /// Whether the limit cuts so much off that it may be of a trend.
  bool may_be_cut_off() const {
    return is_enough_cut(static_cast<std::size_t>(
        std::ranges::count_if(whole_.forces, [&](glm::dvec2 force) { return limit_.reached_by(force); })));
  }

  const StillForces& whole() const { return whole_; }

  /// Reads a law whose trends are cut off at some size (N), while all else beside them is felt; `felt` are the forces
  /// at the same places, and `asked` the same without a device's limit. Nothing if more than trends is cut off.
  std::optional<StaticForce> read_beside_cut(const std::vector<glm::dvec2>& felt, const std::vector<glm::dvec2>& asked,
                                             double cut_at) {
    whole_felt_ = &felt;
    StaticForce found = read();
    double cut = 0, other = 0, cut_squares = 0, other_squares = 0;
    for (std::size_t i = 0; i < relief_.size(); ++i) {
      const bool is_cut = glm::length(whole_.forces[i] - asked[i]) > least_force;
      (is_cut ? cut : other) += 1, (is_cut ? cut_squares : other_squares) += glm::dot(relief_[i], relief_[i]);
    }
    // A texture that is cut off is strongest there.
    constexpr double much_stronger = 1.5;
    const double little_force = 0.5 * least_force;
    const double usual = other > 0 ? std::max(other_squares / other, little_force * little_force) : 0;
    if (cut == 0 || (cut_squares / cut > much_stronger * usual && found.relief.amplitude >= least_force &&
                     !is_even_where_cut(asked, cut_at)))
      return std::nullopt;
    found.cut_off = found.part_is_cut = true, found.cut_at = cut_at;
    return found;
  }

  StaticForce read() {
    std::vector<double> sizes;
    for (const glm::dvec2& force : whole_.forces) sizes.push_back(glm::length(force));
    found_.largest = percentile(sizes, percentile_of_amplitude);
    const LinearForce line = linear_force(whole_.places, whole_.forces);
    std::vector<glm::dvec2> beyond = whole_.forces;
    double most = 0;
    for (std::size_t i = 0; i < beyond.size(); ++i)
      beyond[i] -= line.at(whole_.places[i]), most = std::max(most, glm::dot(beyond[i], beyond[i]));
    found_.trend = line;
    const double half = 0.25 * (whole_.size.x + whole_.size.y);
    found_.pushes_away = -line.stiffness() * half > 0.1 * found_.largest;
    if (std::sqrt(most) < std::max(least_amplitude, 1e-5 * found_.largest)) {
      relief_.assign(whole_.forces.size(), glm::dvec2(0));
      tell_cut();
      return found_;
    }
    find_plain_trend(beyond);
    waves_ = find_waves(field_, whole_, found_.features, slow_sine_ ? std::optional(slow_sine_->waves) : std::nullopt);
    if (!found_.features.empty() && !waves_.waves.empty() && !waves_.local) {
      refine(found_.features);
      waves_ = find_waves(field_, whole_, found_.features);
    }
    find_beside_waves(beyond);
    bend_wall_beside_waves();
    relief_ = whole_.forces;
    take_trend_off();
    tell_cut();
    found_.relief = figures_of({field_, whole_, waves_, found_.features, found_.trend, relief_}, all_felt(),
                               found_.obstacles.hill ? 0 : misfit * found_.largest);
    return found_;
  }

 private:
  /// Whether the part that is cut off at some size (N) changes evenly with the place, so that the relief is none of it.
  /// By what is cut off, where something is, its size and its direction are known.
  bool is_even_where_cut(const std::vector<glm::dvec2>& asked, double cut_at) const {
    constexpr double little_of_relief = 0.1;  // of its mean square
    std::vector<glm::dvec2> places, part, relief;
    for (std::size_t i = 0; i < relief_.size(); ++i) {
      const glm::dvec2 off = whole_.forces[i] - asked[i];
      const double size = glm::length(off);
      if (size <= least_force) continue;
      places.push_back(whole_.places[i]), part.push_back((size + cut_at) / size * off), relief.push_back(relief_[i]);
    }
    const LinearForce line = linear_force(places, part);
    for (std::size_t i = 0; i < part.size(); ++i) part[i] -= line.at(places[i]);
    return mean_square(part) < little_of_relief * mean_square(relief);
  }

  /// The forces without waves: trends, features, noise.
  std::vector<glm::dvec2> without_waves() const { return waves_.without_waves(whole_.places); }

  void take_trend_off() {
    find_trend();
    // Over hardly more than a period a waveform that is folded takes a little of the line.
    found_.trend = slow_sine_ && found_.features.empty() && waves_.waves.size() == 1 ? slow_sine_->line : waves_.trend;
    // The relief is what no trend explains. Hills belong to it.
    std::vector<Feature> trends;
    for (const Feature& each : found_.features)
      if (each.monotone) trends.push_back(each);
    for (std::size_t i = 0; i < relief_.size(); ++i)
      relief_[i] = beside(trends, whole_.places[i], relief_[i] - found_.trend.at(whole_.places[i]));
    drop_small_trend();
  }

  /// Whether a trend counts as cut off at so many places.
  bool is_enough_cut(std::size_t places) const {
    const double least = limit_.any_way > limit_.along_axis ? least_cut : least_cut_by_author;
    return static_cast<double>(places) > least * static_cast<double>(whole_.forces.size());
  }

  /// A texture is felt less where the limit takes a part of it, and not at all where a trend alone is beyond.
  bool felt_at(std::size_t i) const { return !limit_.reached_by(whole_.forces[i] - relief_[i]); }
  glm::dvec2 felt(std::size_t i) const {
    const glm::dvec2 trend = whole_.forces[i] - relief_[i];
    return limit_.least() == HUGE_VAL ? relief_[i] : limit_.cut(whole_.forces[i]) - trend;
  }

  /// Tells where the limit cuts trends off, and the forces that are left.
  void tell_cut() {
    std::vector<double> sizes;
    if (whole_felt_) {
      for (const glm::dvec2& force : *whole_felt_) sizes.push_back(glm::length(force));
      found_.largest = percentile(sizes, percentile_of_amplitude);
    }
    if (limit_.least() == HUGE_VAL) return;
    std::size_t cut = 0;
    for (std::size_t i = 0; i < relief_.size(); ++i) {
      // A trend that is fitted awry asks for more than the law does.
      cut += !felt_at(i) && limit_.reached_by(whole_.forces[i]);
      sizes.push_back(glm::length(limit_.cut(whole_.forces[i])));
    }
    found_.largest = percentile(sizes, percentile_of_amplitude);
    // What pushes everywhere alike has no law beyond what is felt of it.
    const LinearForce& line = found_.trend;
    const bool slopes =
        glm::length(line.by_x) * whole_.size.x + glm::length(line.by_y) * whole_.size.y > limit_.least();
    found_.cut_off = is_enough_cut(cut) && (cut < relief_.size() || slopes);
    found_.cut_at = found_.cut_off ? found_.largest : 0;
  }

  /// Fits features anew beside the waves that were found. What the features took of the waves goes back to them.
  void refine(std::vector<Feature>& features) {
    if (found_.obstacles.empty() || is_bent_)
      return refine_features(features, whole_.places, without_waves_and_with(features));
    std::vector<glm::dvec2> forces = whole_.forces;
    std::vector<SlowWave> slow;
    for (const FoundWave& each : waves_.waves) {
      if (glm::length(each.wave.waves * whole_.size) < bending_periods) {
        slow.push_back({each.wave.waves, harmonics_worth(each)});
        continue;
      }
      each.wave.add_to(whole_.places, forces, -1);
    }
    found_.obstacles = fitted_beside(found_.obstacles, slow, whole_.places, forces);
    features = features_of(found_.obstacles, whole_.places);
  }

  /// Looks for walls and steps in forces.
  bool are_obstacles(const std::vector<glm::dvec2>& forces) {
    const auto obstacles = find_obstacles(whole_, forces);
    if (!obstacles) return false;
    found_.obstacles = *obstacles;
    found_.features = features_of(found_.obstacles, whole_.places);
    return true;
  }

  /// A wall alone may push otherwise than in proportion to the depth. `forces` are all but the waves.
  bool bend_wall(const std::vector<glm::dvec2>& forces) {
    const Obstacles& all = found_.obstacles;
    if (is_bent_ || all.walls.size() != 1 || !all.steps.empty() || all.hill) return false;
    auto bent = bent_wall(whole_, forces, all.walls.front(), limit_.least());
    if (!bent) return false;
    is_bent_ = true;
    found_.obstacles.walls = {bent->wall}, found_.features = {std::move(bent->push)};
    return true;
  }

  void bend_wall_beside_waves() {
    if (waves_.waves.empty() || waves_.local || !bend_wall(without_waves_and_with(found_.features))) return;
    waves_ = find_waves(field_, whole_, found_.features);
    refine(found_.features);
    waves_ = find_waves(field_, whole_, found_.features);
  }

  /// Looks for a trend that bends before any wave: a spring that saturates looks like a slow square wave.
  void find_plain_trend(const std::vector<glm::dvec2>& beyond) {
    if (auto edge = obstacle_at_edge(whole_, whole_.forces)) {
      found_.obstacles = *std::move(edge);
      found_.features = features_of(found_.obstacles, whole_.places);
      bend_wall(whole_.forces);
      return;
    }
    const std::vector<glm::dvec2> bent = cell_means(whole_.side, beyond);
    if (mean_square(bent) < 0.5 * mean_square(beyond)) return;
    // Over a period or two a sine looks like walls, steps and springs that cancel, which are many more figures.
    slow_sine_ = slow_sine(whole_);
    if (slow_sine_) return;
    no_obstacles_in_whole_ = !are_obstacles(whole_.forces);
    if (!no_obstacles_in_whole_) {
      // Steps that repeat are a wave.
      if (found_.obstacles.steps.size() < 2) return void(bend_wall(whole_.forces));
      const FoundWaves waves = find_waves(field_, whole_);
      if (waves.waves.empty() || waves.local || mean_square(waves.rest) > repeats * mean_square(beyond)) return;
      found_.obstacles = {}, found_.features.clear();
      return;
    }
    const std::vector<glm::dvec2> places = cell_means(whole_.side, whole_.places),
                                  means = cell_means(whole_.side, whole_.forces);
    std::vector<Feature> features = find_features(places, means, false);
    if (features.empty()) return;
    double left = 0, all = 0, beside_line = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      glm::dvec2 rest = means[i];
      for (const Feature& each : features) rest -= each.at(places[i]);
      left += glm::dot(rest, rest), all += glm::dot(means[i], means[i]), beside_line += glm::dot(bent[i], bent[i]);
    }
    // A waveform that is a small part of a strong spring is no bend of the spring.
    if (left > plainly_explained * all || left > much_better * beside_line) return;
    refine_features(features, whole_.places, whole_.forces);
    if (!std::ranges::all_of(features, &Feature::monotone)) return;
    found_.features = std::move(features);
  }

  /// Looks for walls and steps beside a slow wave.
  void find_beside_waves(const std::vector<glm::dvec2>& beyond) {
    if (!found_.obstacles.empty() || slow_sine_) return;
    auto beside = obstacles_beside_waves(field_, whole_, beyond, found_.features, waves_);
    if (!beside) return;
    found_.obstacles = std::move(beside->obstacles), found_.features = std::move(beside->features);
    waves_ = std::move(beside->waves);
    refine(found_.features);
    waves_ = find_waves(field_, whole_, found_.features);
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
    if (!found_.features.empty() || waves_.local || waves_.lattice) return;
    // A strong spring hides no step: beside it a line and the waves leave all of that.
    std::vector<glm::dvec2> beyond = whole_.forces;
    for (std::size_t i = 0; i < beyond.size(); ++i) beyond[i] -= waves_.trend.at(whole_.places[i]);
    const bool even = mean_square(cell_means(whole_.side, waves_.rest)) > 0.5 * left;
    // Without a wave these are the forces in which none were found before.
    const bool new_forces = !no_obstacles_in_whole_ || !waves_.waves.empty();
    if (even && new_forces && left > little * mean_square(beyond) && are_obstacles(forces)) {
      waves_ = find_waves(field_, whole_, found_.features);
      if (waves_.waves.empty() || waves_.local) return;
      refine(found_.features);
      waves_ = find_waves(field_, whole_, found_.features);
      return bend_wall_beside_waves();
    }
    if (left < curved * mean_square(forces) || left < little * mean_square(whole_.forces)) return;
    std::vector<glm::dvec2> places = cell_means(whole_.side, whole_.places), some = cell_means(whole_.side, forces);
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
    refine(found_.features);
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
    // Beside walls and steps alone, no waves leave any.
    if (!found_.obstacles.empty() && waves_.waves.empty()) return;
    const glm::dvec2 half = 0.5 * whole_.size;
    const double slope = glm::length(line.by_x) * half.x + glm::length(line.by_y) * half.y;
    // Beside a wall, the waves are little of the largest force.
    double largest = found_.largest;
    if (!found_.features.empty()) {
      std::vector<double> sizes;
      for (std::size_t i = 0; i < relief_.size(); ++i)
        sizes.push_back(glm::length(relief_[i] + line.at(whole_.places[i])));
      largest = std::min(largest, percentile(sizes, percentile_of_amplitude));
    }
    if (glm::length(line.mean) + slope > 0.01 * largest) return;
    for (std::size_t i = 0; i < relief_.size(); ++i) relief_[i] += line.at(whole_.places[i]);
    found_.trend = {};
  }

  /// The relief that is felt, where it is.
  std::vector<glm::dvec2> all_felt() const {
    std::vector<glm::dvec2> forces;
    forces.reserve(relief_.size());
    for (std::size_t i = 0; i < relief_.size(); ++i)
      if (felt_at(i)) forces.push_back(felt(i));
    return forces;
  }

  const StillField& field_;
  StillForces whole_;
  ForceLimit limit_;
  const std::vector<glm::dvec2>* whole_felt_ = nullptr;  // N, at the same places: of a law that is not felt whole
  StaticForce found_;
  bool is_bent_ = false;                // the one wall, whose push is a feature
  bool no_obstacles_in_whole_ = false;  // they were looked for in all of the force
  std::optional<SlowSine> slow_sine_;
  FoundWaves waves_;
  std::vector<glm::dvec2> relief_;  // N, at the places of the whole
};

}  // namespace

namespace {

/// N/m: along the axis along which a linear force draws a hand back most; 0 if it does along none.
double stiffest_of(const LinearForce& force) {
  return std::max(0.0, principal_of(-force.by_x, -force.by_y, least_stiffness).greatest);
}

/// The force with the laws of its parts that the author limits: each is told as it is where it is not cut, and what is
/// beside it as it is felt. Nothing if no law is cut. `felt` is the force itself, `asked` the same without the device's
/// limit.
std::optional<StaticForce> beside_limited_parts(const Bank& bank, const StillForces& felt,
                                                const std::vector<glm::dvec2>& asked) {
  constexpr std::size_t every = 7;  // of the places
  const std::vector<PartLimit> parts = part_limits(bank);
  if (parts.empty()) return std::nullopt;
  std::vector<glm::dvec2> places, there;
  for (std::size_t i = 0; i < felt.places.size(); i += every) places.push_back(felt.places[i]), there.push_back(asked[i]);
  std::vector<PartLimit> cut;
  double cut_at = 0;
  for (const PartLimit& part : parts) {
    const auto found = cut_part(bank, part, places, there);
    if (found) cut.push_back(found->limit), cut_at = std::max(cut_at, found->newton);
  }
  if (cut.empty()) return std::nullopt;
  const auto law = without_part_limits(bank, cut);
  const auto rest = without_parts(bank, cut);
  if (!law || !rest) return std::nullopt;
  const StillField whole = field_of(*law);
  ReliefReader without(whole, bank.size());
  if (without.reaches(limit_of(bank) * law->scale)) return std::nullopt;
  auto found = without.read_beside_cut(felt.forces, asked, cut_at);
  // A spring beside it goes on where it ends.
  if (const std::vector<glm::dvec2> others = field_of(*rest)(places); found && changes_evenly(places, others))
    found->beyond_cut = stiffest_of(linear_force(places, others));
  return found;
}

}  // namespace

namespace {

bool are_same(std::span<const glm::dvec2> one, std::span<const glm::dvec2> other) {
  return std::ranges::equal(std::as_bytes(one), std::as_bytes(other));
}

/// Whether a field answers all questions as they were answered; the first one was asked already.
bool answers_alike(const StillField& field, const StillForces& whole, PatchSize size,
                   const StaticTranscript& transcript) {
  if (size != transcript.size) return false;
  bool is_first = true;
  return std::ranges::all_of(transcript.questions, [&](const StaticTranscript::Question& each) {
    if (std::exchange(is_first, false)) return are_same(whole.forces, each.forces);
    return are_same(field(each.places), each.forces);
  });
}

}  // namespace

StaticForce static_force(const Bank& bank, StaticTranscript* transcript) {
  const bool writes = transcript && transcript->questions.empty();
  const StillField field = [&](std::span<const glm::dvec2> places) {
    std::vector<glm::dvec2> forces = forces_at(bank, places);
    if (writes) transcript->questions.push_back({{places.begin(), places.end()}, forces});
    return forces;
  };
  if (depends_on_place(bank.program().description())) {
    ReliefReader reader(field, bank.size());
    const ForceLimit limit = limit_of(bank);
    if (!reader.reaches(limit)) {
      if (auto beside = beside_limited_parts(bank, reader.whole(), reader.whole().forces)) return *std::move(beside);
      if (!transcript) return reader.read();
      if (!writes) {
        const bool alike = transcript->found && answers_alike(field, reader.whole(), bank.size(), *transcript);
        return alike ? *transcript->found : reader.read();
      }
      transcript->size = bank.size(), transcript->found = reader.read();
      return *transcript->found;
    }
    for (const int times : {1, 2}) {
      const auto unlimited = without_limit(bank, times);
      if (!unlimited) break;
      // What saturates is neither a bump nor the end of a wall. A texture alone is told as it is felt.
      const StillField whole = field_of(*unlimited);
      ReliefReader without(whole, bank.size(), limit);
      if (times == 1 && without.reaches(limit * unlimited->scale)) continue;
      if (auto beside = beside_limited_parts(bank, reader.whole(), without.whole().forces)) return *std::move(beside);
      if (!without.may_be_cut_off()) return reader.read();
      StaticForce found = without.read();
      return found.cut_off ? found : reader.read();
    }
    return reader.read();
  }
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
