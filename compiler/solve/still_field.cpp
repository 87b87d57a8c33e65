#include "compiler/solve/still_field.hpp"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <numbers>
#include <vector>

#include "compiler/solve/place_evaluator.hpp"

namespace wale {

bool may_turn(const CheckedMaterial& material, TermId x, TermId y) {
  const Terms& terms = material.terms;
  std::vector<char> needed(std::max(x, y) + 1);
  needed[x] = needed[y] = 1;
  for (TermId id = std::max(x, y) + 1; id-- > 0;) {
    if (!needed[id]) continue;
    const Term& term = terms[id];
    if (term.kind == TermKind::parameter && term.index < material.parameters.size() &&
        material.parameters[term.index].low < 0)
      return true;
    for (const TermId operand : operands(term)) needed[operand] = 1;
  }
  return false;
}

namespace {

/// What one component of a force does along its own axis.
enum class Along { nothing, away, other };

/// `values` are samples of the component from one edge of the patch to the other.
Along along(const std::vector<double>& values) {
  constexpr double little = 0.1;      // N: hardly felt
  constexpr double rounding = 1e-4;   // of the range of values
  constexpr double gradually = 0.25;  // of the rise: a larger part at one place is a step
  constexpr std::size_t fewest = 8;   // samples over which it rises
  const auto [low, high] = std::ranges::minmax(values);
  if (!std::isfinite(low) || !std::isfinite(high)) return Along::other;
  const double range = high - low;
  if (range < little) return range < rounding * little ? Along::nothing : Along::other;
  // A force that pushes one way everywhere has no place where a hand rests.
  if (values.front() > rounding * range || values.back() < -rounding * range) return Along::other;
  std::size_t rises = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double rise = values[i] - values[i - 1];
    if (rise < -rounding * range || rise > gradually * range) return Along::other;
    rises += rise > rounding * range ? 1 : 0;
  }
  return rises >= fewest ? Along::away : Along::other;
}

bool drives_away(const CheckedMaterial& material, const DeviceProfile& device, std::array<TermId, 2> of_force) {
  if (may_turn(material, of_force[0], of_force[1])) return false;
  PlaceEvaluator force(material, device, {of_force[0], of_force[1]});
  if (!force.possible()) return false;
  constexpr int lines = 7, samples = 257;
  std::vector<double> values(samples);
  for (const std::size_t axis : {0, 1}) {
    int away = 0, other = 0;
    for (int line = 0; line < lines; ++line) {
      const double aside = (2.0 * line + 1.1) / lines - 1;
      for (int i = 0; i < samples; ++i) {
        const double forward = 2.0 * i / (samples - 1) - 1;
        force.at(force.reach_x() * (axis == 0 ? forward : aside), force.reach_y() * (axis == 0 ? aside : forward));
        values[i] = force[axis];
      }
      const Along found = along(values);
      away += found == Along::away ? 1 : 0, other += found == Along::other ? 1 : 0;
    }
    if (away > 0 && other == 0) return true;
  }
  return false;
}

}  // namespace

std::optional<Span> driving_away(const CheckedMaterial& material, const DeviceProfile& device) {
  if (!material.force || material.relief) return std::nullopt;
  if (std::ranges::any_of(material.carriers, [](const Carrier& each) { return each.relief.has_value(); }))
    return std::nullopt;
  // Beside a stronger force that draws back, one that drives away is a part of its law.
  if (!drives_away(material, device, *material.force)) return std::nullopt;
  for (const WrittenForce& each : material.forces)
    if (drives_away(material, device, each.force))
      return each.signed_by_author ? std::nullopt : std::optional(each.span);
  return std::nullopt;
}

namespace {

/// The mean power that what a motion adds to a force gives to the hand, in the motion's unit; nothing if it cannot be
/// evaluated.
std::optional<double> power_along(const CheckedMaterial& material, const DeviceProfile& device,
                                  const WrittenForce& written, GivenBy what, double most) {
  constexpr int directions = 8, side = 9;
  const std::vector<TermId> roots{written.force[0], written.force[1]};
  PlaceEvaluator still(material, device, roots, true);
  if (!still.possible()) return std::nullopt;
  double power = 0;
  for (int turn = 0; turn < directions; ++turn) {
    const double angle = 2 * std::numbers::pi * (turn + 0.3) / directions;
    const glm::dvec2 along = most * glm::dvec2(std::cos(angle), std::sin(angle));
    const EvenMotion motion = what == GivenBy::velocity ? EvenMotion{.velocity = along}
                                                        : EvenMotion{.acceleration = along};
    PlaceEvaluator moving(material, device, roots, true, motion);
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const double x = still.reach_x() * (2.0 * i + 0.9 - side) / side,
                     y = still.reach_y() * (2.0 * j + 1.1 - side) / side;
        still.at(x, y), moving.at(x, y);
        power += (moving[0] - still[0]) * along.x + (moving[1] - still[1]) * along.y;
      }
  }
  return power / (directions * side * side);
}

/// The largest work that a force does around a circle, either way round, J; nothing if it cannot be evaluated.
std::optional<double> work_around(const CheckedMaterial& material, const DeviceProfile& device,
                                  const WrittenForce& written) {
  constexpr int side = 4, steps = 128;
  PlaceEvaluator force(material, device, {written.force[0], written.force[1]}, true);
  if (!force.possible()) return std::nullopt;
  double most = 0;
  const glm::dvec2 reach(force.reach_x(), force.reach_y());
  for (const double share : {0.2, 0.05}) {
    const double radius = share * std::min(reach.x, reach.y);
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const glm::dvec2 centre = (reach - radius) * glm::dvec2(2.0 * i + 0.9 - side, 2.0 * j + 1.1 - side) /
                                  static_cast<double>(side);
        double work = 0;
        for (int step = 0; step < steps; ++step) {
          const double angle = 2 * std::numbers::pi * step / steps;
          force.at(centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle));
          work += (force[1] * std::cos(angle) - force[0] * std::sin(angle)) * radius * 2 * std::numbers::pi / steps;
        }
        most = std::max(most, std::abs(work));
      }
  }
  return most;
}

}  // namespace

const WrittenForce* giving_energy(const CheckedMaterial& material, const DeviceProfile& device, GivenBy what,
                                  double most) {
  constexpr double rounding = 1e-6;  // W, J
  const WrittenForce* found = nullptr;
  double given = rounding;
  for (const WrittenForce& each : material.forces) {
    const auto here = what == GivenBy::place ? work_around(material, device, each)
                                             : power_along(material, device, each, what, most);
    if (here && *here > given) given = *here, found = &each;
  }
  return found;
}

bool has_no_curl(const CheckedMaterial& material, const DeviceProfile& device, double limit) {
  if (!material.force) return false;
  PlaceEvaluator force(material, device, {(*material.force)[0], (*material.force)[1]}, true);
  if (!force.possible()) return false;
  constexpr int side = 40;
  constexpr double beside = 1e-5;       // m: half the step of a difference
  constexpr double counts = 0.01;       // of the slope there
  constexpr double at_kinks = 0.02;     // of the places that have a slope: the difference reaches over a kink
  constexpr double least_slope = 1e-3;  // N/m
  int sloping = 0, turning = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double x = force.reach_x() * (2.0 * i + 0.9 - side) / side,
                   y = force.reach_y() * (2.0 * j + 1.1 - side) / side;
      const auto limited = [&](double at_x, double at_y, std::size_t axis) {
        force.at(at_x, at_y);
        const double size = std::hypot(force[0], force[1]);
        return size > limit ? force[axis] * (limit / size) : force[axis];
      };
      const auto slope = [&](double dx, double dy, std::size_t axis) {
        return (limited(x + dx, y + dy, axis) - limited(x - dx, y - dy, axis)) / (2 * beside);
      };
      const double xx = slope(beside, 0, 0), yx = slope(beside, 0, 1), xy = slope(0, beside, 0),
                   yy = slope(0, beside, 1);
      const double size = std::max({std::abs(xx), std::abs(xy), std::abs(yx), std::abs(yy)});
      if (!std::isfinite(xx + xy + yx + yy)) return false;
      if (size < least_slope) continue;
      ++sloping;
      turning += std::abs(yx - xy) > counts * size ? 1 : 0;
    }
  return sloping > 0 && turning <= at_kinks * sloping;
}

}  // namespace wale
