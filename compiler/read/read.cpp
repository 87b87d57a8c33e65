#include "compiler/read/read_again.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "compiler/measure/coarseness.hpp"
#include "compiler/prove/later_force.hpp"
#include "compiler/read/breakaway.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/kept_readings.hpp"
#include "compiler/read/room.hpp"
#include "compiler/read/sharp_step.hpp"
#include "compiler/read/slow_sway.hpp"
#include "compiler/read/still_forces.hpp"
#include "compiler/read/strokes.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/unlimited.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

constexpr int places_a_side = 12;      // at which a trend's stiffness is looked at
constexpr double beside_it = 1e-3;     // m: half the step for it
constexpr double alike = 0.15;         // relative difference at which two stiffnesses count as one
constexpr double surely_at_first = 3;  // standard errors
constexpr double mostly = 0.5;         // of the places: a spring's
constexpr double misfit_of_relief = 0.03, misfit_of_spring = 0.01, misfit_of_swing = 0.01, misfit_of_noise = 0.1,
                 misfit_of_parting = 0.08;  // in a constant push beside them

/// The stiffness that draws the hand back, if it is alike at most places.
double even_stiffness(const StaticForce& still, PatchSize patch) {
  if (still.features.empty()) return still.trend.stiffness();
  const auto trend = [&](glm::dvec2 place) {
    glm::dvec2 force = still.trend.at(place);
    for (const Feature& each : still.features)
      if (each.monotone) force += each.at(place);
    return force;
  };
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  std::vector<double> all;
  for (int row = 0; row < places_a_side; ++row)
    for (int column = 0; column < places_a_side; ++column) {
      const glm::dvec2 place = half * ((glm::dvec2(column, row) + 0.5) / (0.5 * places_a_side) - 1.0);
      const glm::dvec2 x(beside_it, 0), y(0, beside_it);
      const double along_x = (trend(place - x) - trend(place + x)).x, along_y = (trend(place - y) - trend(place + y)).y;
      // A wall and a spring that has saturated along one axis are stiff along the other only.
      if (std::abs(along_x - along_y) <= alike * std::abs(along_x + along_y))
        all.push_back((along_x + along_y) / (4 * beside_it));
    }
  if (all.empty()) return 0;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::ranges::nth_element(all, middle);
  const double stiffness = *middle;
  const auto near = std::ranges::count_if(
      all, [&](double each) { return std::abs(each - stiffness) <= alike * std::abs(stiffness); });
  return static_cast<double>(near) >= mostly * places_a_side * places_a_side ? stiffness : 0;
}

/// N: with how much a wall pushes at most beside a part of the force that is limited: infinite if that part is the
/// spring, which then gives less than its law deep in the wall.
double most_of_wall(const Bank& bank, const StaticForce& still, const Wall& wall) {
  if (!(still.cut_at > 0)) return HUGE_VAL;
  if (!still.part_is_cut) return still.cut_at;
  constexpr std::size_t count = 24;
  const WallFace face = wall_face(bank, wall);
  const double depth = deepest(bank, face).depth;
  std::vector<glm::dvec2> places;
  for (std::size_t i = 0; i < count; ++i)
    places.push_back(face.place + depth * (static_cast<double>(i) + 0.5) / count * face.inward);
  const std::vector<glm::dvec2> felt = forces_at(bank, places);
  const auto cut = [&](glm::dvec2 force) {
    const double size = glm::length(force);
    return size > still.cut_at ? still.cut_at / size * force : force;
  };
  const ForceLimit limit = limit_of(bank);
  double off_if_wall = 0, off_if_spring = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 push = still.trend.mean, even = still.trend.at(places[i]) - push, pushed = wall.at(places[i]);
    const glm::dvec2 if_wall = felt[i] - limit.cut(push + even + cut(pushed)),
                     if_spring = felt[i] - limit.cut(push + cut(even) + pushed);
    off_if_wall += glm::dot(if_wall, if_wall), off_if_spring += glm::dot(if_spring, if_spring);
  }
  return off_if_wall < off_if_spring ? still.cut_at : HUGE_VAL;
}

/// The walls and steps that were found in the static force. A face bends that, unless the program has memory and
/// yielded to the hands that were placed behind the face.
void tell_obstacles(const Bank& bank, ForceReading& found) {
  Obstacles& obstacles = found.still.obstacles;
  bool bends = false;  // what is no wall, and its push is a feature
  std::erase_if(obstacles.walls, [&](const Wall& each) {
    const bool is_none = !pushes_back(bank, wall_face(bank, each));
    bends |= is_none && each.power != 1;
    return is_none;
  });
  for (StaticStep& each : obstacles.steps) sharpen(bank, each);
  found.steps = obstacles.steps;
  std::ranges::stable_sort(found.steps, std::greater(),
                           [](const StaticStep& each) { return glm::length(each.change); });
  std::vector<WallFace> walls;
  for (const Wall& each : obstacles.walls)
    walls.push_back(wall_face(bank, each, most_of_wall(bank, found.still, each)));
  std::ranges::stable_sort(walls, std::greater(), &WallFace::stiffness);
  if (!walls.empty()) {
    found.wall = walls.front();
    found.more_walls.assign(walls.begin() + 1, walls.end());
    return;
  }
  const bool remembers = remembers_anything(bank.program().description());
  const auto keep = [&](const std::optional<WallFace>& wall) {
    if (wall && pushes_back(bank, *wall)) found.wall = wall;
  };
  if (remembers) keep(wall_face(bank));
  if (found.wall || found.still.features.empty() || !obstacles.empty() || bends) return;
  keep(wall_face(bank, found.still.features));
  if (!found.wall && !remembers) keep(wall_face(bank));
}

/// N: what a line that is fitted beside a relief has by chance at the patch's edge: four standard errors of the
/// relief's irregular part, whose amplitude is about two standard deviations.
double chance_of_line(const Relief& relief, glm::dvec2 half) {
  const double side = 2 * std::min(half.x, half.y);
  return 2 * relief.amplitude * std::sqrt(1 - relief.in_waves()) * std::min(1.0, relief.period / side);
}

using AtFirst = ReadFirst::AtFirst;

/// What of a push is the same on all sides of the steps: none along an axis along which it turns about.
glm::dvec2 alike_beside(const std::vector<StaticStep>& steps, glm::dvec2 push, glm::dvec2 half) {
  if (steps.empty()) return push;
  glm::dvec2 least{0};
  for (const int axis : {0, 1}) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int row = 0; row < places_a_side; ++row)
      for (int column = 0; column < places_a_side; ++column) {
        const glm::dvec2 place = half * ((glm::dvec2(column, row) + 0.5) / (0.5 * places_a_side) - 1.0);
        double there = push[axis];
        for (const StaticStep& each : steps) there += each.at(place)[axis];
        low = std::min(low, there), high = std::max(high, there);
      }
    least[axis] = low > 0 ? low : high < 0 ? high : 0;
  }
  return least;
}

/// How a trend changes along x and along y as far as a hand can feel it: not in a part that is cut (N) in all of the
/// patch.
std::pair<glm::dvec2, glm::dvec2> felt_slopes(const StaticForce& still, glm::dvec2 half, double most) {
  std::pair slopes{still.trend.by_x, still.trend.by_y};
  for (const int axis : {0, 1}) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const glm::dvec2 corner : {glm::dvec2(1, 1), glm::dvec2(1, -1), glm::dvec2(-1, 1), glm::dvec2(-1, -1)}) {
      const double there = still.trend.at(half * corner)[axis];
      low = std::min(low, there), high = std::max(high, there);
    }
    if (low >= most || high <= -most) slopes.first[axis] = slopes.second[axis] = 0;
  }
  return slopes;
}

/// N: what pushes everywhere in the mean over time, beside a swing that differs from place to place and nothing else
/// but a linear force; nothing if the means are not so. Where a wave travels, no moment has this.
std::optional<glm::dvec2> even_mean(const Bank& bank, const std::vector<glm::dvec2>& means, const LinearForce& trend,
                                    double swing) {
  constexpr double alike_means = 0.02;  // of the swing
  if (means.empty()) return std::nullopt;
  const std::vector<glm::dvec2> places = places_of_rest(bank);
  for (const double share : {0.0, 1.0}) {
    glm::dvec2 mean{0};
    std::vector<glm::dvec2> left;
    for (std::size_t i = 0; i < means.size(); ++i) {
      left.push_back(means[i] - share * (places[i].x * trend.by_x + places[i].y * trend.by_y));
      mean += left.back() / static_cast<double>(means.size());
    }
    if (std::ranges::all_of(left, [&](glm::dvec2 each) {
          return glm::length(each - mean) < std::max(least_force, alike_means * swing);
        }))
      return mean;
  }
  return std::nullopt;
}

/// The linear part: a spring, and a constant push.
void tell_trend(const Bank& bank, ForceReading& found, const AtFirst& at_first) {
  const StaticForce& still = found.still;
  const PatchSize patch = bank.size();
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  if (still.features.empty() || !still.obstacles.empty()) {
    const double chance = chance_of_line(found.relief(), half), nearest = std::min(half.x, half.y);
    const ForceLimit limit = limit_of(bank);
    const auto [by_x, by_y] = felt_slopes(still, half, limit.least());
    Principal spring = principal_of(-by_x, -by_y, std::max(least_stiffness, chance / nearest));
    if (std::abs(spring.greatest) * nearest < chance) spring = {};
    found.stiffness = spring.greatest, found.stiffness_across = spring.across, found.stiffness_axis = spring.axis;
    // Less is what the waves' incomplete periods leave.
    const double certain = std::max(
        {chance, misfit_of_relief * found.relief().amplitude, misfit_of_spring * std::abs(spring.greatest) * nearest,
         misfit_of_swing * std::max(found.sway.amplitude, found.vibration.amplitude),
         found.vibration.noise ? misfit_of_noise * found.vibration.amplitude : 0, at_first.uncertain});
    // Where it is cut, the middle is pushed less than the law asks for.
    const std::optional<glm::dvec2> even = even_mean(bank, at_first.means, still.trend,
                                                     std::max(found.sway.amplitude, found.vibration.amplitude));
    const glm::dvec2 asked = alike_beside(
        still.obstacles.steps, even ? *even : at_first.slow.remaining(still.trend.mean - at_first.force), half);
    const glm::dvec2 push = limit.cut(asked);
    // Means over time at places need no certainty about the first moment's.
    const double sure = even ? misfit_of_swing * std::max(found.sway.amplitude, found.vibration.amplitude) : certain;
    if (glm::length(push) >= std::max(least_force, sure))
      found.constant = push, found.asked_in_middle = asked;
  } else {
    found.stiffness = found.stiffness_across = even_stiffness(still, patch);
  }
  const bool yielding = found.wall && still.obstacles.walls.empty();
  if (yielding &&
      (still.features.empty() || std::abs(found.stiffness - found.wall->stiffness) < alike * found.wall->stiffness))
    found.stiffness = found.stiffness_across = 0, found.stiffness_axis = {0, 0};
}

/// Whether the middle of single features pushes the hand out or draws it in.
double outward_push(const Bank& bank, const ForceReading& found) {
  const Relief& relief = found.relief();
  if (relief.amplitude < least_force || relief.period > 0) return 0;
  constexpr int side = 48;
  constexpr double plainly = 0.5;
  const PatchSize patch = bank.size();
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  std::vector<glm::dvec2> places;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      places.push_back(half * ((glm::dvec2(column, row) + 0.5) / (0.5 * side) - 1.0));
  std::vector<glm::dvec2> forces = forces_at(bank, places);
  glm::dvec2 middle{0};
  double power = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    forces[i] -= found.still.trend.at(places[i]);
    for (const Feature& each : found.still.features)
      if (each.monotone) forces[i] -= each.at(places[i]);
    middle += glm::dot(forces[i], forces[i]) * places[i], power += glm::dot(forces[i], forces[i]);
  }
  if (!(power > 0)) return 0;
  middle /= power;
  double outward = 0, all = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double along = glm::dot(forces[i], places[i] - middle);
    outward += along, all += std::abs(along);
  }
  return std::abs(outward) < plainly * all ? 0 : std::copysign(relief.amplitude, outward);
}

/// What resists a moving hand in a part of the patch only is no law of motion, which strokes through the middle show.
void tell_force_on_moving(const Bank& bank, ForceReading& found) {
  const OpposingForce& opposing = found.opposing;
  const bool unexplained = !opposing.explained && std::ranges::any_of(opposing.by_speed, [](const DragAt& each) {
    return std::abs(each.newton) >= least_force;
  });
  // A force by time scatters too.
  const bool scattered = opposing.scatter >= least_force && !goes_by_time(bank.program().description());
  const bool resisted = std::abs(opposing.damping) >= least_damping || std::abs(opposing.friction) >= least_force ||
                        scattered || opposing.aside >= least_force || unexplained || found.wall;
  if (!resisted) found.other.moving = force_on_moving(bank);
}

/// How much more the force pushes a hand that has just come and rests than it does in the mean over time, and over slow
/// motion to and fro: a sway begins somewhere in its period, and a sign has a value at rest. N.
AtFirst only_at_first(const Bank& bank, const std::vector<std::vector<Force>>& felt, const SlowParts& parts,
                      const ForceReading& found) {
  const SlowChange& slow = parts.change;
  const PatchProgram& program = bank.program().description();
  AtFirst off;
  off.slow = slow;
  if (std::max(found.sway.amplitude, found.vibration.amplitude) >= least_force) {
    const auto places = static_cast<double>(felt.size());
    std::vector<glm::dvec2> all, means;
    // Without a sway of few periods the mean is that of what is left.
    const bool parted = parts.sway && parts.sway->alone;
    for (std::size_t place = 0; place < felt.size(); ++place) {
      const std::vector<Force>& forces = parted ? parts.sway->left[place] : felt[place];
      // Under Hann's window a swing of many periods has no mean.
      glm::dvec2 mean{0};
      const auto count = static_cast<double>(forces.size());
      for (std::size_t i = 0; i < forces.size(); ++i)
        mean += (1 - std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / count)) / count *
                glm::dvec2(forces[i]);
      all.push_back(glm::dvec2(felt[place].front()) - mean), means.push_back(mean);
      off.force += all.back() / places;
    }
    // A wave that travels is elsewhere in its period at each place, and its mean over places is none's.
    double squares = 0;
    for (const glm::dvec2& each : all) squares += glm::dot(each - off.force, each - off.force);
    off.uncertain = surely_at_first * std::sqrt(squares) / places;
    if (off.uncertain >= least_force && glm::length(off.force) < off.uncertain) off.force = {0, 0};
    // Beside what comes or goes, the mean over all of the time is nothing that it ever has.
    if (slow.lower != slow.higher) {
      off.force = -slow.at_first;
      for (const std::vector<Force>& forces : felt) off.force += glm::dvec2(forces.front()) / places;
    } else if (off.uncertain >= least_force) {
      off.means = std::move(means);
    }
  }
  if (remembers_anything(program)) return off;
  constexpr double creeping = 1e-3;  // m/s
  std::array<Hand, 9> hands{};
  std::array<Force, 9> forces{};
  const glm::vec2 place(Room(bank).nearest({}));
  for (Hand& hand : hands) hand.position = hand.workspace = place;
  // Along no axis, so that none of the signs is that of a rest.
  for (std::size_t i = 1; i < hands.size(); ++i) {
    const double angle = (static_cast<double>(i) + 0.5) * std::numbers::pi / 4;
    hands[i].velocity = hands[i].raw_velocity = glm::vec2(creeping * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  tick_all(bank, hands, forces);
  glm::dvec2 mean{0};
  for (std::size_t i = 1; i < forces.size(); ++i) mean += 0.125 * glm::dvec2(forces[i]);
  glm::dvec2 at_rest = glm::dvec2(forces[0]) - mean;
  // What resists on one way only is a drag, and pushes no resting hand.
  const glm::dvec2 one_way = found.opposing.one_way();
  for (const int axis : {0, 1})
    if (one_way[axis] != 0) at_rest[axis] = 0;
  if (glm::length(at_rest) > least_force) off.force += at_rest;
  return off;
}

/// N: all that pushes, on a device that gives so much at most along each axis.
double all_that_pushes(const StaticForce& still, double most) {
  return std::min(still.largest, std::numbers::sqrt2 * most);
}

/// Makes a relief no larger than all that pushes, N, times a tolerance: beside a trend that is fitted awry, or that the
/// device cuts, it may seem so.
void limit_relief(StaticForce& still, double most, double times) {
  Relief& relief = still.relief;
  const double largest = all_that_pushes(still, most);
  if (relief.amplitude <= times * largest) return;
  const double share = largest / relief.amplitude;
  // What fills less than a hundredth of the patch is in none of these, and keeps its maximum.
  for (double* each : {&relief.amplitude, &relief.rms, &relief.mean}) *each *= share;
}

}  // namespace

double ForceReading::more_wall_stiffness() const {
  double sum = 0;
  for (const WallFace& each : more_walls) sum += each.stiffness;
  return sum;
}

double ForceReading::stepped() const {
  double sum = 0;
  for (const StaticStep& each : steps) sum += glm::length(each.change);
  return sum;
}

double ForceReading::cut_spring() const {
  // Beside a wall, either is what is cut.
  const bool wall_is_cut = wall && !(still.part_is_cut && wall->most == HUGE_VAL);
  return !wall_is_cut && stiffness >= least_stiffness ? still.cut_at : 0;
}

double ForceReading::held_drag(double speed) const {
  if (!held) return 0;
  const auto [with, without] = drags_where_they_differ(held->opposing, opposing, speed);
  return with - without;
}

double ForceReading::held_mass() const {
  if (!held) return 0;
  const auto [with, without] = where_they_differ(held->inertia, inertia, least_mass);
  return with - without;
}

double ForceReading::held_swing() const {
  if (!held) return 0;
  const auto of = [](const Swing& a, const Swing& b) { return std::max(a.amplitude, b.amplitude); };
  return of(held->sway, held->vibration) - of(sway, vibration);
}

double ForceReading::uneven_swing() const {
  const Swing& swing = sway.least ? sway : vibration;
  return swing.least ? swing.amplitude - *swing.least : 0;
}

namespace {

/// What the button does in motion and in time. What comes late while it is held is the button's, if it does not come
/// without it.
void tell_held_button(const Bank& bank, ForceReading& found) {
  constexpr double plainly_later = 1.2;
  const bool damped_wall = found.wall && std::max(found.wall->damping, found.wall->release) >= least_damping;
  found.held = held_button(bank, damped_wall ? &*found.wall : nullptr);
  if (!found.held) return;
  const SlowChange& slow = found.held->slow;
  if (slow.newton > plainly_later * std::max(found.other.slowly, found.other.button))
    found.other.button = slow.newton, found.other.button_push = slow.push;
}

}  // namespace

ForceReading read(const Bank& bank, const Declarations& declarations, ReadParts wanted) {
  ReadFirst none;
  return read_again(bank, declarations, wanted, none);
}

ForceReading read_again(const Bank& bank, const Declarations&, ReadParts wanted, ReadFirst& first) {
  if (bank.program().description().vibrates()) return {};  // such a program has no force
  const bool has_all = (first.still || !wanted.still) && (first.moving || !wanted.moving);
  const std::string key = first.kept && !has_all ? KeptReadings::key_of(bank) : std::string();
  if (!key.empty()) first.kept->complete(key, first);
  ForceReading found;
  const bool remembers = remembers_anything(bank.program().description());
  AtFirst at_first;
  if (first.moving && wanted.moving) found = *first.moving, at_first = first.at_first;
  if (first.still && wanted.still) found.still = *first.still;
  const bool reads_still = wanted.still && !first.still, reads_moving = wanted.moving && !first.moving;
  const auto read_still = [&] { found.still = static_force(bank); };
  const auto read_moving = [&] {
    found.opposing = opposing_force(bank);
    found.breakaway = breakaway_of(bank, found.opposing.friction);
    found.inertia = inertia(bank);
    const std::vector<std::vector<Force>> felt = felt_at_rest(bank);
    tell_swings(bank, felt, found.sway, found.vibration);
    const SlowParts parts = slow_parts(bank, felt, found.sway, found.vibration);
    const std::optional<PartedSway>& parted = parts.sway;
    const SlowChange& slow = parts.change;
    at_first = only_at_first(bank, felt, parts, found);
    if (parted && !parted->alone) at_first.uncertain = std::max(at_first.uncertain, misfit_of_parting * parted->amplitude);
    found.other = other_force(bank, felt, slow, found.sway.amplitude + found.vibration.amplitude,
                              std::max(found.opposing.friction, found.breakaway));
    // What swings in a part of the patch was felt there.
    found.other.rehearsed = std::max({found.other.rehearsed, found.sway.amplitude, found.vibration.amplitude});
    found.other.later = later_force(bank, still_seconds, remembers_time_only(bank.program().description()));
    const bool swings = std::max(found.sway.amplitude, found.vibration.amplitude) >= least_force;
    const std::vector<std::vector<Force>> unmoved;
    look_all_over(bank, swings ? unmoved : felt, found.other);
    found.coming = coming_force(bank, parted ? parted->left : swings ? unmoved : felt, found.other);
    found.directions = directions_of_motion(bank, found.opposing, found.sway, found.vibration, found.other);
  };
  const auto part = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i == 0 && reads_still) read_still();
      if (i == 1 && reads_moving) read_moving();
    }
  };
  // Strokes that run tick by tick take as long as all static measurements together.
  const std::size_t parts = leaves_out_motion(bank.program().description()) ? 1 : 2;
  if (remembers && reads_still && reads_moving)
    in_parallel(parts, part);
  else
    part(0, parts);
  if (reads_still) first.still = found.still;
  if (reads_moving && parts == 2) {
    first.moving = found, first.at_first = at_first;
    first.moving->still = {};
  }
  if (!key.empty() && (reads_still || reads_moving)) first.kept->keep(key, first);
  if (!wanted.still) {
    tell_held_button(bank, found);
    return found;
  }
  // A relief may be a little larger than itself and a push against it together.
  constexpr double beside_a_trend = 1.06;
  const double most = bank.program().description().device.most();
  limit_relief(found.still, most, beside_a_trend);
  found.at_first = glm::length(at_first.force);
  tell_obstacles(bank, found);
  if (found.wall) found.wall_push = deepest(bank, *found.wall).newton;
  tell_trend(bank, found, at_first);
  const bool alone = found.still.features.empty() && found.constant == glm::dvec2(0) && found.stiffness == 0;
  if (alone) limit_relief(found.still, most, 1);
  LinearForce even = found.still.trend;
  even.mean -= at_first.force;
  const glm::dvec2 half = half_of(bank);
  tell_still_directions(found.directions, found.steps, even, half);
  if (std::abs(found.directions.swirl) * std::min(half.x, half.y) < chance_of_line(found.relief(), half))
    found.directions.swirl = 0;
  found.outward = outward_push(bank, found);
  // What damps the hand in a wall is the wall's.
  if (wanted.moving && found.wall && std::max(found.wall->damping, found.wall->release) >= least_damping) {
    found.opposing = opposing_force(bank, &*found.wall);
    tell_directions_of_drag(found.directions, bank, found.opposing, &*found.wall);
  }
  if (wanted.moving) tell_force_on_moving(bank, found), tell_held_button(bank, found);
  return found;
}

std::optional<ForceReading> read_relief(const Bank& bank, ReadFirst& first, StaticTranscript& transcript) {
  ForceReading found;
  if (bank.program().description().vibrates()) return found;
  const std::string key = first.kept && !first.still ? KeptReadings::key_of(bank) : std::string();
  if (!key.empty()) first.kept->complete(key, first);
  if (!first.still) {
    first.still = static_force(bank, &transcript);
    if (!key.empty()) first.kept->keep(key, first);
  }
  found.still = *first.still;
  // Of a relief that is larger it depends on all other forces how much counts.
  if (found.relief().amplitude > all_that_pushes(found.still, bank.program().description().device.most()))
    return std::nullopt;
  return found;
}

}  // namespace wale
