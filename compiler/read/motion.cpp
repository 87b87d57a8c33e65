#include "compiler/read/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "compiler/read/breakaway.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/drag_by_place.hpp"
#include "compiler/read/drag_by_time.hpp"
#include "compiler/read/drag_by_use.hpp"
#include "compiler/read/long_way.hpp"
#include "compiler/read/motion_law.hpp"
#include "compiler/read/room.hpp"
#include "compiler/read/strokes.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/two_axes.hpp"
#include "compiler/read/unlimited.hpp"

namespace wale {
namespace {

constexpr double unlike = 0.1;                // relative: two principal values that differ by more have an axis
constexpr double surely = 3;                  // standard errors of a mean over lines
constexpr double speed_aside = 0.2;           // m/s at which a push aside is told
constexpr double with_a_margin = 1.1;         // on the way on which a bristle turns about
constexpr double mostly_one_way = 1.0 / 3;    // of the resistance to the other way, or less
constexpr double too_slow_to_matter = 0.015;  // m/s: a friction that is whole from less on is a dry one
constexpr double in_a_part = 0.5;             // of the greatest resistance, or less, is the least

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

double Principal::along(glm::dvec2 way) const {
  const double share = glm::dot(axis, way);
  return directed() ? across + share * share * (greatest - across) : greatest;
}

std::pair<double, double> where_they_differ(const Principal& one, const Principal& other, double least) {
  const auto by = [&](glm::dvec2 way) {
    const auto of = [&](const Principal& size) {
      return size.directed() ? size.across * way + (size.greatest - size.across) * glm::dot(size.axis, way) * size.axis
                             : size.greatest * way;
    };
    return of(one) - of(other);
  };
  const Principal difference = principal_of(by({1, 0}), by({0, 1}), least);
  const glm::dvec2 axis = difference.directed() ? difference.axis : one.directed() ? one.axis : other.axis;
  return {one.along(axis), other.along(axis)};
}

namespace {

/// N: of drags at some speeds, between them in proportion.
double drag_at(const std::vector<DragAt>& by_speed, double speed) {
  if (by_speed.empty()) return 0;
  const DragAt* before = &by_speed.front();
  for (const DragAt& each : by_speed) {
    if (each.speed >= speed) {
      const double part = each.speed > before->speed ? (speed - before->speed) / (each.speed - before->speed) : 0;
      return before->newton + part * (each.newton - before->newton);
    }
    before = &each;
  }
  return before->newton;
}

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
  const std::size_t half = strokes.size() / 2, a_line = half / stroke_lines;
  double variance = 0;
  for (const std::size_t first : {std::size_t{0}, half}) {
    std::array<double, stroke_lines> means{};
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < half; ++i) means[i / a_line] += along[first + i] / static_cast<double>(a_line);
    for (const double each : means) mean += each / stroke_lines;
    for (const double each : means) squares += (each - mean) * (each - mean);
    variance += squares / (stroke_lines * (stroke_lines - 1));
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

/// m: how far the shortest of the strokes goes on before it counts.
double least_reach(const std::vector<Stroke>& strokes, double rate) {
  double least = HUGE_VAL;
  for (const Stroke& each : strokes)
    least = std::min(least, 0.5 * static_cast<double>(each.pass) * each.speed / rate - each.counts);
  return least;
}

/// m: so long a hand goes on after it has turned, before what is felt counts: a bristle turns about on twice its path.
/// 0 if the strokes do so anyway, which go on for `settled`.
double settling_of(const std::array<LongWay, 2>& ways, double settled) {
  constexpr double hardly_more = 1.1;
  double longest = 0;
  for (const LongWay& way : ways) longest = std::max(longest, way.path);
  return longest > std::min(usual_path, 0.5 * hardly_more * settled) ? with_a_margin * 2 * longest : 0;
}

/// Where a bristle needs a longer way to turn about than the patch has, the way through the patch tells its friction,
/// and strokes to and fro do not. Whether it does.
bool tell_long_ways(OpposingForce& found, const std::array<LongWay, 2>& ways, double settled) {
  glm::dvec2 whole{0};
  bool longer = false;
  for (const std::size_t axis : {0, 1}) {
    const LongWay& way = ways[axis];
    longer |= way.grows || way.cut || 2 * way.path > settled;
    whole[static_cast<int>(axis)] = way.force;
    found.friction_grows |= way.grows, found.friction_cut |= way.cut;
  }
  if (!longer || std::max(whole.x, whole.y) < std::abs(found.friction)) return false;
  const Principal told = principal_of({whole.x, 0}, {0, whole.y}, least_force);
  found.friction = told.greatest, found.friction_across = told.across, found.friction_axis = told.axis;
  if (!found.explained) found.damping = found.damping_across = 0, found.damping_axis = {0, 0};
  found.saturation_speed = found.limit = found.exponent = 0, found.explained = true;
  return true;
}

void tell_no_law(OpposingForce& found) {
  found.explained = false;
  found.friction = found.friction_across = found.damping = found.damping_across = found.saturation_speed = found.limit =
      0;
  found.friction_axis = found.damping_axis = {0, 0}, found.friction_grows = found.friction_cut = false;
}

/// Where motion makes a force that swings, or goes by what is remembered of the place, the mean of it over some strokes is
/// chance. A law of that mean is none.
void drop_law_by_chance(OpposingForce& found, const Bank& bank, const std::vector<Stroke>& strokes,
                        const Outside& outside) {
  const PatchProgram& program = bank.program().description();
  if (!found.explained || !remembers_anything(program) || !program.grids.empty()) return;
  if (found.friction == 0 && found.damping == 0) return;
  if (steadiness_of(bank, strokes, outside).told_by_mean()) return;
  tell_no_law(found);
  found.explained = true, found.exponent = found.scatter = 0;
}

/// What changes with time is told by the law of its mean, if it has one.
void tell_changes(OpposingForce& found, const DragByTime& drag) {
  found.changes_in_time = true, found.least_in_time = drag.least, found.most_in_time = drag.most;
  if (!drag.has_mean || !found.explained) tell_no_law(found);
  if (!drag.has_mean) found.exponent = 0;
}

/// What differs between the ways that a hand may go, and from place to place. One figure tells no force that is mostly
/// on one way or in a part of the patch.
void tell_differences(OpposingForce& found, const DragByPlace& drag) {
  found.forward = drag.forward, found.backward = drag.backward;
  found.least_by_place = drag.least, found.most_by_place = drag.most;
  const auto apart = [](double a, double b, double share) {
    const double greater = std::max(std::abs(a), std::abs(b)), smaller = std::min(std::abs(a), std::abs(b));
    return greater >= least_force && !(a * b > 0 && smaller > share * greater);
  };
  const bool differs = apart(drag.forward.x, drag.backward.x, mostly_one_way) ||
                       apart(drag.forward.y, drag.backward.y, mostly_one_way) ||
                       apart(drag.least, drag.most, in_a_part);
  if (!found.explained || differs) {
    tell_no_law(found);
    if (differs) found.exponent = 0;
  }
}

}  // namespace

namespace {

/// What resists, but for what use makes of it; `strokes` become those that told it, slow ones too if they are wanted.
OpposingForce opposing_law(const Bank& bank, const Outside& outside, std::vector<Stroke>& strokes, double& settling,
                           bool slowly = false) {
  const PatchProgram& program = bank.program().description();
  const Room space(bank);
  strokes = strokes_over(bank, {1, 0}, outside, space, 0, slowly);
  const DragByTime in_time = drag_by_time(bank, strokes);
  std::array<LongWay, 2> ways;
  if (!in_time.changes) ways = long_ways(bank, space);
  settling = settling_of(ways, least_reach(strokes, program.device.rate));
  if (settling > 0) strokes = strokes_over(bank, {1, 0}, outside, space, settling, slowly);
  const auto opposed_by = [&] {
    return in_time.changes ? opposed_over_time(bank, strokes, outside) : opposed_on(bank, strokes, outside);
  };
  std::vector<glm::dvec2> opposed = opposed_by();
  // What moments differ by is no difference between places.
  DragByPlace differences;
  if (!in_time.changes) differences = drag_by_place(bank, strokes, opposed, outside, settling == 0);
  const std::size_t half = strokes.size() / 2;
  const MeanOpposed mean = mean_of(strokes, opposed);
  std::array<std::vector<DragAt>, 2> by_axis;
  for (const std::size_t axis : {0, 1}) {
    const auto part = [&](const auto& all) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(axis * half);
      return std::vector(first, first + static_cast<std::ptrdiff_t>(half));
    };
    by_axis[axis] = mean_drags(part(strokes), part(along_strokes(strokes, opposed)));
  }
  const double chance = chance_of(strokes, along_strokes(strokes, opposed));
  const bool no_differences = differences.forward == differences.backward && differences.least == differences.most;
  const bool everywhere = !in_time.changes && settling == 0 && no_differences;
  auto two = everywhere ? two_axes(strokes, opposed) : std::nullopt;
  if (everywhere && !two) {
    two = two_frictions(strokes, opposed);
    if (two) {
      const std::vector<Stroke> turned = strokes_over(bank, two->friction.axis, outside, space, 0, slowly);
      if (!shows(*two, turned, opposed_on(bank, turned, outside))) two.reset();
    }
  }
  if (two) {
    OpposingForce found{.friction = two->friction.greatest, .damping = two->damping.greatest};
    found.friction_across = two->friction.across, found.friction_axis = two->friction.axis;
    found.damping_across = two->damping.across, found.damping_axis = two->damping.axis;
    found.by_speed = by_axis[0], found.aside = mean.aside, found.along = std::move(by_axis);
    return found;
  }
  const Principal whole = principal_of(mean.along, mean.across, std::max(least_force, chance));
  if (!whole.directed()) {
    OpposingForce found = law_of(strokes, along_strokes(strokes, opposed), program.device.most());
    found.friction_across = found.friction, found.damping_across = found.damping, found.aside = mean.aside;
    if (!tell_long_ways(found, ways, least_reach(strokes, program.device.rate))) {
      tell_differences(found, differences);
      if (settling == 0) drop_law_by_chance(found, bank, strokes, outside);
    }
    if (in_time.changes) tell_changes(found, in_time);
    found.along = std::move(by_axis);
    return found;
  }
  glm::dvec2 axis = whole.axis;
  // Friction along an oblique axis is no matrix: it pushes along its axis whatever the stroke's, and strokes along that
  // axis show its size.
  const bool oblique = std::min(std::abs(axis.x), std::abs(axis.y)) > 0.02;
  if (oblique) {
    for (int turn = 0; turn < 2; ++turn) {
      strokes = strokes_over(bank, axis, outside, space, settling, slowly), opposed = opposed_by();
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
  found.explained = one.explained && other.explained;
  found.limit = std::max(one.limit, other.limit);
  found.aside = mean.aside;
  if (oblique || !tell_long_ways(found, ways, least_reach(strokes, program.device.rate))) {
    tell_differences(found, differences);
    if (settling == 0) drop_law_by_chance(found, bank, strokes, outside);
  }
  if (in_time.changes) tell_changes(found, in_time);
  found.along = std::move(by_axis);
  return found;
}

/// Whether slow hands are resisted otherwise than faster ones tell, or these by no law, so that slow ones are to be
/// looked at.
bool differs_slowly(const OpposingForce& found, const Bank& bank, const std::vector<Stroke>& strokes,
                    const Outside& outside) {
  constexpr double plainly = 0.1;  // of what the law says
  const PatchProgram& program = bank.program().description();
  if (!remembers_anything(program) || remembers_time_only(program) || !program.grids.empty()) return false;
  if (!found.explained) return true;
  // What a memory gives a slow hand beside a viscosity alone is told as remembered.
  if (std::max(std::abs(found.friction), std::abs(found.friction_across)) < least_force) return false;
  const double whole = found.saturation_speed > 0 ? std::min(1.0, slow_stroke_speed / found.saturation_speed) : 1;
  const std::vector<Stroke> slow = slow_strokes(bank, strokes);
  const std::vector<double> felt = along_strokes(slow, opposed_on(bank, slow, outside));
  for (std::size_t i = 0; i < slow.size(); ++i) {
    const double told = whole * found.frictions().along(slow[i].direction) +
                        slow_stroke_speed * found.dampings().along(slow[i].direction);
    if (std::abs(felt[i] - told) <= std::max(least_force, plainly * std::abs(told))) continue;
    // What holds a hand until it slides holds a slow one again and again.
    return breakaway_of(bank, found.friction) == 0;
  }
  return false;
}

}  // namespace

OpposingForce opposing_force(const Bank& bank, const WallFace* wall) {
  if (!depends_on_motion(bank.program().description())) return {};
  const Outside outside{wall};
  std::vector<Stroke> strokes;
  double settling = 0;
  OpposingForce found = opposing_law(bank, outside, strokes, settling);
  const bool steady = settling == 0 && !found.changes_in_time;
  if (steady && differs_slowly(found, bank, strokes, outside))
    found = opposing_law(bank, outside, strokes, settling, true);
  // A long bristle needs more than a stroke to turn about.
  if (settling > 0) return found;
  const DragByUse use = drag_by_use(bank, strokes, outside);
  found.changes_by_use = use.changes;
  if (use.changes) found.at_first_use = use.first, found.after_use = use.last, found.way_of_use = use.way;
  return found;
}

double OpposingForce::rise() const {
  return saturation_speed >= too_slow_to_matter ? std::abs(friction) / saturation_speed : 0;
}

bool OpposingForce::by_no_figure() const {
  if (limit > 0 || rise() > 0 || one_way() != glm::dvec2(0) || std::abs(uneven()) >= least_force) return true;
  return !explained &&
         std::ranges::any_of(by_speed, [](const DragAt& each) { return std::abs(each.newton) >= least_force; });
}

double OpposingForce::unexplained_at(double speed) const { return explained ? 0 : at(speed); }

double OpposingForce::at(double speed) const { return drag_at(by_speed, speed); }

std::pair<double, double> drags_where_they_differ(const OpposingForce& one, const OpposingForce& other, double speed) {
  std::pair<double, double> found{0, 0};
  for (const std::size_t axis : {0, 1}) {
    const std::pair drags{drag_at(one.along[axis], speed), drag_at(other.along[axis], speed)};
    const double apart = std::abs(drags.first - drags.second), before = std::abs(found.first - found.second);
    constexpr double plainly = 1e-3;  // where they differ alike, x is as good as y
    if (apart > before * (1 + plainly) || axis == 0) found = drags;
  }
  return found;
}

double OpposingForce::creeping() const {
  constexpr double slowly = 0.01;  // m/s
  return by_speed.empty() || by_speed.front().speed > slowly ? 0 : unexplained_at(slowly);
}

}  // namespace wale
