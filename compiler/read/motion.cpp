#include "compiler/read/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/room.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/unlimited.hpp"
#include "wale/batch.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

// m/s, speeds of an exploring hand; fewer for programs whose ticks must run one after another
constexpr std::array<double, 8> speeds = {0.02, 0.035, 0.05, 0.075, 0.1, 0.15, 0.2, 0.4};
constexpr std::array<double, 4> few_speeds = {0.05, 0.1, 0.2, 0.4};
constexpr double stretch = 0.024;             // m, length of a stroke, which goes there and back
constexpr double least_stretch = 0.5;         // of the patch's extent, if that is smaller
constexpr double looked_at = 0.5;             // of the stretch, in its middle: there a program with memory has settled
constexpr int shortened = 3;                  // times by half, what is looked at
constexpr int lines = 4;                      // parallel strokes
constexpr int places = 64;                    // of a stroke, for programs without memory
constexpr double push = 1;                    // m/s^2
constexpr double nothing = 1e-5;              // N
constexpr double unlike = 0.1;                // relative: two principal values that differ by more have an axis
constexpr double least_below = 0.125;         // of the places of a stroke: below the device's limit
constexpr double least_below_strokes = 0.25;  // of the strokes: likewise
constexpr double surely = 3;                  // standard errors of a mean over lines
constexpr double speed_aside = 0.2;           // m/s at which a push aside is told

/// A stroke goes over half of its stretch, back over the whole, and forward over the whole. The first half settles a
/// program with memory. The middles of the other two are evaluated: they pass the same positions, so that forces that
/// depend on position cancel.
struct Stroke {
  glm::dvec2 direction{0}, middle{0};
  double speed = 0;
  long pass = 0;      // ticks, an even number
  double counts = 0;  // m on either side of the middle: what is looked at
  /// Rounding must not leave one way a place more than the other.
  bool counts_at(double along) const { return std::abs(along) <= counts + 1e-9; }

  long ticks() const { return pass / 2 + 2 * pass; }

  /// A hand at `along` (m from the middle of the stroke), moving there or back.
  Hand hand(double along, bool forth) const {
    Hand hand;
    hand.position = hand.workspace = glm::vec2(middle + along * direction);
    hand.velocity = hand.raw_velocity = glm::vec2((forth ? 1 : -1) * speed * direction);
    return hand;
  }

  /// The distance from the middle in m at a tick, and whether the hand moves there or back.
  std::pair<double, bool> at(long tick, double rate) const {
    const double half = 0.5 * static_cast<double>(pass) * speed / rate;
    const long since = tick + pass / 2;  // as if the stroke had begun at the end of its stretch
    const double gone = (static_cast<double>(since % pass) + 0.5) * speed / rate;
    const bool forth = since / pass % 2 == 0;
    return {forth ? gone - half : half - gone, forth};
  }
};

/// Half the extent of the patch without its rim, m.
glm::dvec2 half_of(const Bank& bank) {
  const PatchSize patch = bank.size();
  return 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
}

/// m on either side of the middle of a stroke.
double reach_of(const Bank& bank) {
  const glm::dvec2 half = half_of(bank);
  return std::min(stretch / 2, least_stretch * std::min(half.x, half.y));
}

/// Where strokes count.
struct Outside {
  const WallFace* wall = nullptr;

  bool at(glm::dvec2 place) const { return !wall || glm::dot(place - wall->place, wall->inward) <= 0; }
  /// The middle of the patch, or of what a wall leaves of it, m.
  glm::dvec2 middle(glm::dvec2 half) const {
    if (!wall) return {0, 0};
    const double face = glm::dot(wall->place, wall->inward), far = glm::dot(glm::abs(wall->inward), half);
    return std::clamp(0.5 * (face - far), -far, 0.0) * wall->inward;
  }
};

/// Strokes along `axis` (of length 1), then as many across it. Where a resting hand feels all that the device gives,
/// strokes say nothing: they go elsewhere.
std::vector<Stroke> strokes_over(const Bank& bank, bool alone, glm::dvec2 axis, const Outside& outside,
                                 const Room& space) {
  const double rate = bank.program().description().device.rate, reach = reach_of(bank);
  const glm::dvec2 middle = outside.middle(half_of(bank));
  std::vector<Stroke> strokes;
  for (const glm::dvec2 direction : {axis, glm::dvec2(-axis.y, axis.x)}) {
    std::vector<glm::dvec2> taken;
    for (int line = 0; line < lines; ++line) {
      const glm::dvec2 across = glm::abs(glm::dvec2(direction.y, direction.x));
      const double room = glm::dot(half_of(bank), across) / (across.x + across.y);
      const glm::dvec2 aside = room * ((line + 0.5) / (0.5 * lines) - 1) * glm::dvec2(-direction.y, direction.x);
      const glm::dvec2 wanted = outside.wall ? middle + 0.5 * aside : aside;
      // Between the steep sides of a valley there may be room for a short stroke only.
      double counts = looked_at * reach;
      glm::dvec2 place = space.nearest({wanted, direction, counts, counts}, taken);
      for (int turn = 0; turn < shortened && !space.is_along({place, direction, counts, counts}); ++turn)
        counts *= 0.5, place = space.nearest({wanted, direction, counts, counts}, taken);
      taken.push_back(place);
      for (const double speed : alone ? std::span<const double>(speeds) : std::span<const double>(few_speeds))
        strokes.push_back({direction, place, speed, 2 * std::max(2L, std::lround(reach / speed * rate)), counts});
    }
  }
  return strokes;
}

/// Gives strokes where the device's limit cuts everything off the mean of the others at their speed and along their
/// axis, if there are any.
void tell_cut_strokes(const std::vector<Stroke>& strokes, const std::vector<bool>& cut,
                      std::vector<glm::dvec2>& means) {
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (!cut[i]) continue;
    glm::dvec2 sum{0};
    double others = 0;
    for (std::size_t k = 0; k < strokes.size(); ++k)
      if (!cut[k] && strokes[k].speed == strokes[i].speed && strokes[k].direction == strokes[i].direction)
        sum += means[k], others += 1;
    if (others > 0) means[i] = sum / others;
  }
}

/// The mean force on each stroke, N, turned about for a hand that goes forth: its part along the stroke opposes the
/// hand, and the other part pushes it aside. For a program whose ticks are independent; both ways are at the same
/// moment, so that forces that depend on time cancel too. Places where the device's limit cuts a force off say nothing
/// about its law, unless there are hardly any others.
std::vector<glm::dvec2> opposed_anywhere(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside) {
  std::vector<Hand> hands;
  hands.reserve(strokes.size() * 2 * places);
  for (const Stroke& stroke : strokes)
    for (const bool forth : {true, false})
      for (int i = 0; i < places; ++i)
        hands.push_back(stroke.hand(stroke.counts * (2 * (i + 0.5) / places - 1), forth));
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  const double most = bank.program().description().device.most();
  std::vector<glm::dvec2> means(strokes.size());
  std::vector<bool> cut(strokes.size());
  for (std::size_t stroke = 0; stroke < strokes.size(); ++stroke) {
    const Force *there = &forces[2 * places * stroke], *back = there + places;
    glm::dvec2 whole{0}, below{0};
    int count = 0;
    for (int i = 0; i < places; ++i) {
      // The places of both passes are the same, in the same order.
      const glm::dvec2 change = 0.5 * (glm::dvec2(back[i]) - glm::dvec2(there[i]));
      whole += change;
      if (at_limit(there[i], most) || at_limit(back[i], most)) continue;
      if (!outside.at(glm::dvec2(hands[2 * places * stroke + i].position))) continue;
      below += change, ++count;
    }
    cut[stroke] = count < least_below * places;
    means[stroke] = count == places || cut[stroke] ? whole / (1.0 * places) : below / (1.0 * count);
  }
  tell_cut_strokes(strokes, cut, means);
  return means;
}

/// For each stroke, the force on a hand that rests in its middle, tick by tick: what changes with time is felt there
/// too. One tick alone where nothing changes.
std::vector<std::vector<Force>> felt_in_the_middles(const Bank& bank, const std::vector<Stroke>& strokes) {
  constexpr std::size_t some = 64;
  const double rate = bank.program().description().device.rate;
  const auto longest = static_cast<std::size_t>(std::ranges::max(strokes, {}, &Stroke::ticks).ticks());
  Bank own = bank;
  Memory memory(own.program());
  std::vector<std::vector<Force>> felt(strokes.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (i > 0 && strokes[i].middle == strokes[i - 1].middle) {
      felt[i] = felt[i - 1];
      continue;
    }
    Hand still;
    still.position = still.workspace = glm::vec2(strokes[i].middle);
    memory.enter(own, still);
    for (std::size_t now = 0; now < longest; ++now) {
      still.time = static_cast<double>(now) / rate;
      felt[i].push_back(tick(own, memory, still));
      if (now + 1 != some || std::ranges::any_of(felt[i], [&](Force each) { return each != felt[i].back(); })) continue;
      felt[i].resize(1);
      break;
    }
  }
  return felt;
}

/// The same for a program that remembers in states only, tick by tick. The hands run one after another: there are too
/// few to fill the lanes of a block.
std::vector<glm::dvec2> opposed_one_by_one(const Bank& bank, const std::vector<Stroke>& strokes,
                                           const Outside& outside) {
  const double rate = bank.program().description().device.rate;
  Bank own = bank;
  Memory memory(own.program());
  const std::vector<std::vector<Force>> resting = felt_in_the_middles(bank, strokes);
  std::vector<glm::dvec2> means(strokes.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const Stroke& stroke = strokes[i];
    glm::dvec2 sum{0};
    long count = 0;
    for (long now = 0; now < stroke.ticks(); ++now) {
      const auto [along, forth] = stroke.at(now, rate);
      Hand hand = stroke.hand(along, forth);
      hand.time = static_cast<double>(now) / rate;
      if (now == 0) memory.enter(own, hand);
      const Force force = tick(own, memory, hand) - resting[i][std::min<std::size_t>(now, resting[i].size() - 1)];
      if (now < stroke.pass / 2 || !stroke.counts_at(along) || !outside.at(glm::dvec2(hand.position))) continue;
      sum -= (forth ? 1.0 : -1.0) * glm::dvec2(force);
      ++count;
    }
    means[i] = sum / static_cast<double>(std::max(1L, count));
  }
  return means;
}

/// The same for any program; memories stay as they are at the start.
std::vector<glm::dvec2> opposed_on_the_way(const Bank& bank, const std::vector<Stroke>& strokes,
                                           const Outside& outside) {
  if (bank.program().description().grids.empty()) return opposed_one_by_one(bank, strokes, outside);
  const double rate = bank.program().description().device.rate;
  const long longest = std::ranges::max(strokes, {}, &Stroke::ticks).ticks();
  std::vector<glm::dvec2> sums(strokes.size());
  std::vector<long> counts(strokes.size());
  const auto move = [&](std::size_t first, long tick, std::span<const Force> forces, std::span<Hand> hands) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      const Stroke& stroke = strokes[first + i];
      const bool counts_now = tick > stroke.pass / 2 && tick <= stroke.ticks();
      if (counts_now && stroke.counts_at(stroke.at(tick - 1, rate).first) &&
          outside.at(glm::dvec2(hands[i].position))) {
        sums[first + i] -= (stroke.at(tick - 1, rate).second ? 1.0 : -1.0) * glm::dvec2(forces[i]);
        ++counts[first + i];
      }
      const auto [along, forth] = stroke.at(tick, rate);
      hands[i] = stroke.hand(along, forth);
      hands[i].time = static_cast<double>(tick) / rate;
    }
  };
  run_batch(bank, strokes.size(), longest, move);
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= static_cast<double>(std::max(1L, counts[i]));
  return sums;
}

/// The laws of friction that are tried, simplest first: which of friction and damping there is, and whether the
/// friction rises with the speed until it is whole.
struct FrictionLaw {
  bool friction, damping, rises;
};
constexpr std::array<FrictionLaw, 5> laws = {
    {{false, true, false}, {true, false, false}, {true, true, false}, {true, false, true}, {true, true, true}}};
constexpr double well_fitted = 0.02;  // of the largest force: a law that leaves less is good enough
constexpr int rises_tried = 60;

/// One law by least squares, with a friction that is whole from the speed `whole` on.
OpposingForce fitted(const FrictionLaw& law, double whole, const std::vector<Stroke>& strokes,
                     const std::vector<double>& opposed) {
  double ss = 0, sv = 0, vv = 0, sf = 0, vf = 0;
  const auto share = [&](double speed) { return !law.friction ? 0.0 : whole > 0 ? std::min(1.0, speed / whole) : 1.0; };
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double v = law.damping ? strokes[i].speed : 0, s = share(strokes[i].speed), f = opposed[i];
    ss += s * s, sv += s * v, vv += v * v, sf += s * f, vf += v * f;
  }
  OpposingForce found;
  const double area = ss * vv - sv * sv;
  if (law.friction && law.damping) {
    if (area < 1e-6 * ss * vv) return {0, 0, 0, HUGE_VAL};
    found.friction = (vv * sf - sv * vf) / area, found.damping = (ss * vf - sv * sf) / area;
  } else if (law.friction) {
    found.friction = sf / ss;
  } else {
    found.damping = vf / vv;
  }
  found.saturation_speed = law.rises ? whole : 0;
  double squares = 0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double v = strokes[i].speed, off = opposed[i] - found.friction * share(v) - found.damping * v;
    squares += off * off;
  }
  found.scatter = std::sqrt(squares / static_cast<double>(strokes.size()));
  return found;
}

/// The simplest law that fits the strokes, or the one that fits best. Speeds at which the device's limit `most` (N)
/// cuts the force off say nothing about the law if some others do.
OpposingForce law_of(std::vector<Stroke> strokes, std::vector<double> opposed, double most) {
  std::vector<Stroke> below;
  std::vector<double> opposed_below;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (!at_limit({opposed[i], 0}, most)) below.push_back(strokes[i]), opposed_below.push_back(opposed[i]);
  if (below.size() >= least_below_strokes * static_cast<double>(strokes.size()))
    strokes = std::move(below), opposed = std::move(opposed_below);
  double largest = 0;
  for (const double force : opposed) largest = std::max(largest, std::abs(force));
  if (largest < nothing) return {};
  OpposingForce best{0, 0, 0, HUGE_VAL};
  for (const FrictionLaw& law : laws) {
    OpposingForce found{0, 0, 0, HUGE_VAL};
    const auto [slow, fast] = std::ranges::minmax_element(strokes, {}, &Stroke::speed);
    const double slowest = slow->speed, fastest = fast->speed;
    for (int i = 0; i < (law.rises ? rises_tried : 1); ++i) {
      const double whole = law.rises ? slowest * std::pow(fastest / slowest, (i + 0.5) / rises_tried) : 0;
      const OpposingForce other = fitted(law, whole, strokes, opposed);
      if (other.scatter < found.scatter) found = other;
    }
    if (found.scatter < 0.7 * best.scatter) best = found;
    if (best.scatter < well_fitted * largest) break;
  }
  return best;
}

}  // namespace

Principal principal_of(glm::dvec2 by_x, glm::dvec2 by_y, double least) {
  // Of the symmetric part; the other one turns the hand aside and neither opposes it nor pushes it on.
  const double both = 0.5 * (by_x.y + by_y.x), mean = 0.5 * (by_x.x + by_y.y), half = 0.5 * (by_x.x - by_y.y);
  const double apart = std::hypot(half, both);
  const double one = mean + apart, other = mean - apart, angle = 0.5 * std::atan2(both, half);
  if (2 * apart <= std::max(least, unlike * std::max(std::abs(one), std::abs(other)))) return {mean, mean, {0, 0}};
  const glm::dvec2 axis(std::cos(angle), std::sin(angle));
  return std::abs(one) >= std::abs(other) ? Principal{one, other, axis}
                                          : Principal{other, one, glm::dvec2(-axis.y, axis.x)};
}

namespace {

/// The principal values of two laws along an axis and across it, each value of the reading's.
Principal of_two(double along, double across, glm::dvec2 axis, double least) {
  return principal_of(along * axis.x * axis + across * axis.y * glm::dvec2(axis.y, -axis.x),
                      along * axis.y * axis + across * axis.x * glm::dvec2(-axis.y, axis.x), least);
}

/// The forces along the strokes.
std::vector<double> along_strokes(const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed) {
  std::vector<double> along(strokes.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) along[i] = glm::dot(opposed[i], strokes[i].direction);
  return along;
}

/// N: what two means over half of the strokes each may differ by, when a force is alike in all directions and differs
/// from one line to the next.
double chance_of(const std::vector<Stroke>& strokes, const std::vector<double>& along) {
  const std::size_t half = strokes.size() / 2, a_line = half / lines;
  double variance = 0;
  for (const std::size_t first : {std::size_t{0}, half}) {
    std::array<double, lines> means{};
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < half; ++i) means[i / a_line] += along[first + i] / static_cast<double>(a_line);
    for (const double each : means) mean += each / lines;
    for (const double each : means) squares += (each - mean) * (each - mean);
    variance += squares / (lines * (lines - 1));
  }
  return surely * std::sqrt(variance);
}

/// The mean forces on the strokes along an axis and across it, turned about for a hand that goes forth.
struct MeanOpposed {
  glm::dvec2 along{0}, across{0};
  /// N: on a hand at `speed_aside`, what turns with it. It pushes aside both times, once to the left and once to the
  /// right of an axis.
  double aside = 0;
};
MeanOpposed mean_of(const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed) {
  const std::size_t half = strokes.size() / 2;
  const auto count = static_cast<double>(half);
  MeanOpposed mean;
  glm::dvec2 aside_x{0}, aside_y{0};
  double fast = 0;
  for (std::size_t i = 0; i < half; ++i) {
    mean.along += opposed[i] / count, mean.across += opposed[half + i] / count;
    if (strokes[i].speed != speed_aside) continue;
    aside_x += opposed[i], aside_y += opposed[half + i], fast += 1;
  }
  if (aside_x.y * aside_y.x < 0) mean.aside = std::min(std::abs(aside_x.y), std::abs(aside_y.x)) / fast;
  return mean;
}

}  // namespace

OpposingForce opposing_force(const Bank& bank, const WallFace* wall) {
  const PatchProgram& program = bank.program().description();
  if (!depends_on_the_moment(program) && !remembers_anything(program)) return {};
  const bool alone = !remembers_anything(program);
  const Outside outside{wall};
  const Room space(bank);
  const auto felt = [&](const std::vector<Stroke>& strokes) {
    return alone ? opposed_anywhere(bank, strokes, outside) : opposed_on_the_way(bank, strokes, outside);
  };
  std::vector<Stroke> strokes = strokes_over(bank, alone, {1, 0}, outside, space);
  std::vector<glm::dvec2> opposed = felt(strokes);
  const std::size_t half = strokes.size() / 2;
  const MeanOpposed mean = mean_of(strokes, opposed);
  const double chance = chance_of(strokes, along_strokes(strokes, opposed));
  const Principal whole = principal_of(mean.along, mean.across, std::max(least_force, chance));
  if (!whole.directed()) {
    OpposingForce found = law_of(strokes, along_strokes(strokes, opposed), program.device.most());
    found.friction_across = found.friction, found.damping_across = found.damping, found.aside = mean.aside;
    return found;
  }
  glm::dvec2 axis = whole.axis;
  // Friction along an oblique axis is no matrix: it pushes along its axis whatever the stroke's, and strokes along that
  // axis show its size.
  const bool oblique = std::min(std::abs(axis.x), std::abs(axis.y)) > 0.02;
  if (oblique) {
    for (int turn = 0; turn < 2; ++turn) {
      strokes = strokes_over(bank, alone, axis, outside, space), opposed = felt(strokes);
      glm::dvec2 push{0};
      for (std::size_t i = 0; i < half; ++i) push += opposed[i];
      const bool turned = std::abs(push.x * axis.y - push.y * axis.x) > 0.01 * glm::length(push);
      if (turn > 0 || !turned) break;
      axis = glm::normalize(push);
    }
  } else {
    axis = std::abs(axis.x) > 0.5 ? glm::dvec2(1, 0) : glm::dvec2(0, 1);
  }
  const std::vector<double> along = along_strokes(strokes, opposed);
  const auto law_along = [&](std::size_t first) {
    const auto part = [&](const auto& all) {
      return std::vector(all.begin() + static_cast<std::ptrdiff_t>(first),
                         all.begin() + static_cast<std::ptrdiff_t>(first + half));
    };
    return law_of(part(strokes), part(along), program.device.most());
  };
  const bool second = !oblique && axis.y > 0.5;
  const OpposingForce one = law_along(second ? half : 0), other = law_along(second ? 0 : half);
  const Principal friction = of_two(one.friction, other.friction, axis, std::max(least_force, chance));
  const Principal damping = of_two(one.damping, other.damping, axis, std::max(least_damping, chance / speed_aside));
  OpposingForce found = std::abs(one.friction) >= std::abs(other.friction) ? one : other;
  found.friction = friction.greatest, found.friction_across = friction.across, found.friction_axis = friction.axis;
  found.damping = damping.greatest, found.damping_across = damping.across, found.damping_axis = damping.axis;
  found.scatter = std::hypot(one.scatter, other.scatter) / std::numbers::sqrt2;
  found.aside = mean.aside;
  return found;
}

Principal inertia(const Bank& bank) {
  if (!reads(bank.program().description(),
             {Input::acceleration_x, Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y}))
    return {};
  const glm::dvec2 half = half_of(bank);
  constexpr int side = 8;
  // One place is sure to have room, if there is any.
  std::vector<glm::dvec2> at = {Room(bank).nearest({})};
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      at.push_back(half * ((glm::dvec2(column, row) + 0.5) / (0.5 * side) - 1.0));
  std::vector<Hand> hands;
  for (const glm::dvec2 place : at)
    for (const glm::dvec2 direction : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
      Hand& hand = hands.emplace_back();
      hand.position = hand.workspace = glm::vec2(place);
      hand.acceleration = hand.raw_acceleration = glm::vec2(push * direction);
    }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  const double most = bank.program().description().device.most();
  glm::dvec2 by_x{0}, by_y{0};
  double places = 0;
  for (std::size_t i = 0; i < hands.size(); i += 4) {
    const auto cut = [&](const Force& force) { return at_limit(force, most); };
    if (std::any_of(&forces[i], &forces[i] + 4, cut)) continue;
    by_x -= glm::dvec2(forces[i]) - glm::dvec2(forces[i + 1]);
    by_y -= glm::dvec2(forces[i + 2]) - glm::dvec2(forces[i + 3]);
    places += 1;
  }
  return places > 0 ? principal_of(by_x / (2 * push * places), by_y / (2 * push * places), least_mass) : Principal{};
}

}  // namespace wale
