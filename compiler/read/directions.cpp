#include "compiler/read/directions.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/room.hpp"
#include "compiler/read/strokes.hpp"
#include "compiler/read/tolerances.hpp"
#include "wale/batch.hpp"

namespace wale {
namespace {

constexpr double turning_speed = 0.2;  // m/s
constexpr double nearly_turned = 1e-3;

/// In [0, whole).
double turned_into(double angle, double whole) {
  const double turned = std::fmod(angle + 2 * whole, whole);
  return whole - turned < nearly_turned ? 0 : turned;
}

/// What turns with a hand, and the axis of what resists it, from strokes along both axes.
void tell_strokes(const Bank& bank, const Outside& outside, Directions& found) {
  const std::vector<Stroke> strokes = strokes_over(bank, {1, 0}, outside, Room(bank), 0);
  const std::vector<glm::dvec2> opposed = opposed_on(bank, strokes, outside);
  const std::size_t half = strokes.size() / 2;
  glm::dvec2 along{0}, across{0};
  double count = 0;
  for (std::size_t i = 0; i < half; ++i) {
    if (strokes[i].speed != turning_speed) continue;
    along += opposed[i], across += opposed[half + i], count += 1;
  }
  if (count == 0) return;
  along /= count, across /= count;
  // Turned about for a hand that goes forth: to its left is against y on the way along x, and along x on that along y.
  if (along.y * across.x < 0) found.aside = std::copysign(std::min(std::abs(along.y), std::abs(across.x)), across.x);
  found.drag = principal_of(along, across, least_force);
}

constexpr std::size_t places_of_travel = 32, hands_a_place = 5;
constexpr double seconds_of_travel = 2, seconds_of_slow_travel = 8, usual_step = 1e-4, longest_between = 0.02,
                 part_of_a_swing = 0.125;
constexpr std::size_t ticks_between = 5;
constexpr double travels = 0.5;     // of the power of what time changes
constexpr double along_one = 0.05;  // of the greater power of the gradient, or less, lies across it

/// What each hand feels, for each tick.
std::vector<std::vector<Force>> felt_in_time(const Bank& bank, std::vector<Hand>& hands, std::size_t ticks) {
  const PatchProgram& program = bank.program().description();
  const double rate = program.device.rate;
  std::vector<std::vector<Force>> felt(ticks, std::vector<Force>(hands.size()));
  if (program.states.empty()) {
    for (std::size_t tick = 0; tick < ticks; ++tick) {
      for (Hand& hand : hands) hand.time = static_cast<double>(tick) / rate;
      tick_all(bank, hands, felt[tick]);
    }
    return felt;
  }
  Batch batch(bank, hands.size());
  batch.enter(hands);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    for (Hand& hand : hands) hand.time = static_cast<double>(tick) / rate;
    batch.tick(hands, felt[tick]);
  }
  return felt;
}

/// A velocity, whose size is in parts of what lies beside a place in what comes after, and how much it explains.
struct Travel {
  glm::dvec2 way{0};
  double explained = 0;  ///< 0 .. 1: of what time changes
};

/// By least squares: what comes after so many ticks is what lies against the way.
Travel travel_over(const std::vector<std::vector<Force>>& felt, std::size_t apart) {
  glm::dmat2 gradients(0.0);
  glm::dvec2 both{0};
  double changes = 0;
  for (std::size_t place = 0; place < felt.front().size(); place += hands_a_place)
    for (const int axis : {0, 1}) {
      std::vector<glm::dvec2> slopes;
      std::vector<double> rises;
      glm::dvec2 mean{0};
      for (std::size_t tick = apart; tick + apart < felt.size(); tick += ticks_between) {
        const Force* const now = &felt[tick][place];
        slopes.emplace_back(double{now[1][axis]} - now[2][axis], double{now[3][axis]} - now[4][axis]);
        rises.push_back(double{felt[tick + apart][place][axis]} - felt[tick - apart][place][axis]);
        mean += slopes.back();
      }
      mean /= static_cast<double>(std::max<std::size_t>(slopes.size(), 1));
      for (std::size_t i = 0; i < slopes.size(); ++i) {
        const glm::dvec2 slope = slopes[i] - mean;
        gradients += glm::outerProduct(slope, slope), both += slope * rises[i], changes += rises[i] * rises[i];
      }
    }
  const double xx = gradients[0][0], yy = gradients[1][1], xy = gradients[0][1];
  const double apart_by = std::hypot(0.5 * (xx - yy), xy), most = 0.5 * (xx + yy) + apart_by,
               least = 0.5 * (xx + yy) - apart_by;
  if (!(most > 0) || !(changes > 0)) return {};
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
  Travel found{-glm::dot(both, along) / most * along, glm::dot(both, along) * glm::dot(both, along) / most / changes};
  if (least > along_one * most) {
    found.way -= glm::dot(both, across) / least * across;
    found.explained += glm::dot(both, across) * glm::dot(both, across) / least / changes;
  }
  return found;
}

/// Towards where a pattern goes that time changes: what a place feels next is what lies beside it now. A swing that is
/// the same everywhere and a wave that stands go nowhere.
std::optional<double> travel_of(const Bank& bank, double frequency) {
  const PatchProgram& program = bank.program().description();
  if (!program.grids.empty() || (!program.states.empty() && !remembers_time_only(program))) return std::nullopt;
  if (!reads(program, {Input::x, Input::y, Input::workspace_x, Input::workspace_y})) return std::nullopt;
  const glm::dvec2 half = half_of(bank);
  std::vector<Hand> hands;
  for (const Hand& still : hands_at_rest(places_of_travel, glm::vec2(half)))
    for (const glm::dvec2 beside :
         {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
      Hand& hand = hands.emplace_back(still);
      hand.position = hand.workspace = glm::vec2(glm::dvec2(still.position) + usual_step * beside);
    }
  const double rate = program.device.rate;
  const auto ticks = static_cast<std::size_t>((frequency > 0 ? seconds_of_travel : seconds_of_slow_travel) * rate);
  const std::vector<std::vector<Force>> felt = felt_in_time(bank, hands, ticks);
  const double longest = frequency > 0 ? std::min(longest_between, part_of_a_swing / frequency) : longest_between;
  // What jumps is seen where it goes as far in the time as lies between the places.
  Travel best;
  for (std::size_t apart = 1; apart == 1 || static_cast<double>(apart) <= longest * rate; apart *= 2) {
    const Travel found = travel_over(felt, apart);
    if (found.explained > best.explained) best = found;
  }
  if (best.explained < travels) return std::nullopt;
  return turned_into(std::atan2(best.way.y, best.way.x), 2 * std::numbers::pi);
}

}  // namespace

void tell_directions_of_drag(Directions& found, const Bank& bank, const OpposingForce& opposing, const WallFace* wall) {
  found.drag = {}, found.aside = 0;
  const bool by_itself = !opposing.explained && std::abs(opposing.unexplained_at(turning_speed)) >= least_force;
  if (opposing.aside < least_force && !by_itself) return;
  tell_strokes(bank, Outside{wall}, found);
  if (!by_itself) found.drag = {};
  if (opposing.aside < least_force) found.aside = 0;
}

Directions directions_of_motion(const Bank& bank, const OpposingForce& opposing, const Swing& sway,
                                const Swing& vibration, const OtherForce& other) {
  Directions found;
  tell_directions_of_drag(found, bank, opposing, nullptr);
  const bool swings = sway.amplitude >= least_force || (vibration.amplitude >= least_force && !vibration.noise);
  if (swings || other.slowly >= least_force)
    found.travel = travel_of(bank, vibration.amplitude > sway.amplitude ? vibration.frequency : sway.frequency);
  return found;
}

void tell_still_directions(Directions& found, const std::vector<StaticStep>& steps, const LinearForce& trend,
                           glm::dvec2 half) {
  found.swirl = 0.5 * (trend.by_x.y - trend.by_y.x);
  if (steps.empty()) return;
  const glm::dvec2 way = steps.front().way;
  found.step_axis = turned_into(std::atan2(way.y, way.x) + std::numbers::pi, std::numbers::pi);
  // Each on the way up or to the right, from where it has not come yet.
  std::vector<StaticStep> up = steps;
  glm::dvec2 before = trend.mean, on{0};
  for (StaticStep& each : up) {
    const double angle = turned_into(std::atan2(each.way.y, each.way.x), 2 * std::numbers::pi);
    if (angle >= std::numbers::pi - nearly_turned) {
      before += each.change;
      each.way = -each.way, each.offset = -each.offset, each.change = -each.change;
    }
    on += each.way;
  }
  constexpr int side = 48;
  constexpr double plainly_more = 1.02;
  std::vector<glm::dvec2> places;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      places.push_back(half * ((glm::dvec2(column, row) + 0.5) / (0.5 * side) - 1.0));
  std::ranges::stable_sort(places, {}, [&](glm::dvec2 place) { return glm::dot(place, on); });
  for (const glm::dvec2 place : places) {
    glm::dvec2 changed{0};
    for (const StaticStep& each : up) changed += each.at(place);
    for (const int axis : {0, 1}) {
      // The first of those that are as large.
      if (std::abs(changed[axis]) > plainly_more * std::abs(found.steps[axis])) found.steps[axis] = changed[axis];
      const double pushed = before[axis] + changed[axis];
      if (std::abs(pushed) > plainly_more * std::abs(found.step_push[axis])) found.step_push[axis] = pushed;
    }
  }
}

}  // namespace wale
