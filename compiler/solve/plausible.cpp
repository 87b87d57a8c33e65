#include "compiler/solve/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/place_evaluator.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

/// Whether a height has operations that may jump. Sums and products of others cannot.
bool may_jump(const Terms& terms, TermId root) {
  std::vector<char> needed(root + 1);
  needed[root] = 1;
  for (TermId id = root + 1; id-- > 0;) {
    if (!needed[id]) continue;
    const Term& term = terms[id];
    if (term.kind == TermKind::operation && term.dependence.on(Dependence::position) &&
        (term.operation == Operation::floor || term.operation == Operation::less || term.operation == Operation::hash ||
         term.operation == Operation::select || term.operation == Operation::divide ||
         term.operation == Operation::arctangent))
      return true;
    for (const TermId operand : operands(term)) needed[operand] = 1;
  }
  return false;
}

/// A straight way over the patch, as shares of its half sides from -1 to 1.
struct Stroke {
  double from_x, from_y, to_x, to_y;
};
// Askew, so that no line of a pattern lies along one of them.
constexpr Stroke ways[] = {{-0.97, 0.131, 0.93, 0.177}, {0.213, -0.95, 0.171, 0.97}, {-0.91, -0.83, 0.89, 0.94}};

/// Whether two heights differ by no more than the rounding of numbers of a size, or of their own.
bool is_level(double low, double high, double size = 0) {
  constexpr double rounding = 2e-6;
  return !(high - low > rounding * std::max({size, std::abs(low), std::abs(high)}));
}

std::optional<Jump> jump_along(PlaceEvaluator& height, const Stroke& way, std::size_t steps) {
  const auto place = [&](double share) {
    return std::array{(way.from_x + share * (way.to_x - way.from_x)) * height.reach_x(),
                      (way.from_y + share * (way.to_y - way.from_y)) * height.reach_y()};
  };
  const double length =
      std::hypot((way.to_x - way.from_x) * height.reach_x(), (way.to_y - way.from_y) * height.reach_y());
  const auto value = [&](double share) {
    const auto [x, y] = place(share);
    return height.value_at(x, y);
  };
  std::vector<double> values(steps + 1);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i <= steps; ++i) {
    values[i] = value(static_cast<double>(i) / static_cast<double>(steps));
    if (!std::isfinite(values[i])) return std::nullopt;
    low = std::min(low, values[i]);
    high = std::max(high, values[i]);
  }
  if (is_level(low, high)) return std::nullopt;
  constexpr std::size_t most_looked_into = 8;
  constexpr double least_share = 0.02;  // of the height's range: smaller jumps are hardly felt
  std::vector<std::size_t> order(steps);
  for (std::size_t i = 0; i < steps; ++i) order[i] = i;
  const std::size_t looked_into = std::min(most_looked_into, steps);
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(looked_into), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return std::abs(values[a + 1] - values[a]) > std::abs(values[b + 1] - values[b]);
                    });
  for (std::size_t k = 0; k < looked_into; ++k) {
    double from = static_cast<double>(order[k]) / static_cast<double>(steps);
    double to = static_cast<double>(order[k] + 1) / static_cast<double>(steps);
    double before = values[order[k]], after = values[order[k] + 1];
    // What still differs over some nanometres is a jump, and no slope.
    constexpr double narrow = 5e-8;  // m
    while ((to - from) * length > narrow && std::abs(after - before) > least_share * (high - low)) {
      const double middle = (from + to) / 2, between = value(middle);
      if (std::abs(between - before) > std::abs(after - between))
        to = middle, after = between;
      else
        from = middle, before = between;
    }
    const double size = std::abs(after - before);
    if (size <= least_share * (high - low)) continue;
    // Beside a whole number, rounding may give a noise another lattice value for some nanometres.
    const double beside = to - from;
    if (std::abs(value(to + beside) - value(from - beside)) < size / 2) continue;
    const auto [x, y] = place(from);
    Jump found{x, y, size, size / (high - low)};
    bool up = false, down = false;
    for (std::size_t i = 0; i < steps; ++i) {
      const double change = values[i + 1] - values[i];
      if (std::abs(change) <= least_share * (high - low)) continue;
      ++found.changes;
      (change > 0 ? up : down) = true;
    }
    found.one_way = !(up && down);
    return found;
  }
  return std::nullopt;
}

std::string in_numbers(double value, const std::string& unit) {
  return readable("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

/// The largest force that a declared device gives, N.
double largest_device_force(const Declarations& declarations) {
  double most = 0;
  declarations.devices.each([&](const std::string&, const DeviceDeclaration& device) {
    if (!device.profile.shaker) most = std::max(most, static_cast<double>(device.profile.force_newton));
  });
  return most;
}

/// The first fixed size of a carrier that asks for far more than any device gives. A force is too large if it is above
/// the largest; a stiffness or a viscosity asks for its force only far away or at speed, so five times that is allowed.
bool warn_of_huge_carrier(const CheckedMaterial& material, const Declarations& declarations, double most,
                          Diagnostics& diagnostics) {
  const Dimension force = declarations.dimension("force");
  for (const Carrier& carrier : material.carriers) {
    const auto size = carrier.open ? std::nullopt : constant_value(material.terms, carrier.size, &material.parameters);
    if (!size) continue;
    const Percept* percept = nullptr;
    declarations.percepts.each([&](const std::string&, const Percept& each) {
      if (each.carrier == carrier.name) percept = &each;
    });
    if (!percept || !(percept->exerts > 0)) continue;
    const bool is_force = carrier.dimension == force;
    const double allowed = is_force ? most : 5 * most;
    const double exerted = std::abs(*size) * (is_force ? 1 : percept->exerts);
    if (exerted <= allowed) continue;
    const std::string unit = declarations.names().unit(carrier.dimension);
    const std::string argument = percept->argument();
    const std::string text = in_numbers(std::abs(*size), unit);
    const std::string largest = in_numbers(most, "N");
    diagnostics.report(Advice(is_force ? fmt::format("give at most {}; level 1 of {} is {}", largest, percept->name,
                                                     in_numbers(percept->one, unit))
                                       : fmt::format("{} is reached with {} already; level 1 of {} is {}", largest,
                                                     in_numbers(most / percept->exerts, unit), percept->name,
                                                     in_numbers(percept->one, unit)))
                           .fact("size", *size, unit)
                           .fact("most", most, "N")
                           .about(Code::beyond_devices, carrier.size_span,
                                  is_force
                                      ? fmt::format("{} of {} is more than any device gives, {}",
                                                    with_article(argument), text, largest)
                                      : fmt::format("{} of {} asks for {}, and no device gives more than {}",
                                                    with_article(argument), text, in_numbers(exerted, "N"), largest)));
    return true;
  }
  return false;
}

}  // namespace

std::optional<JumpingHeight> find_jump(const CheckedMaterial& material, const DeviceProfile& device) {
  for (const Carrier& carrier : material.carriers) {
    if (!carrier.relief || !may_jump(material.terms, *carrier.relief)) continue;
    PlaceEvaluator height(material, device, {*carrier.relief});
    if (!height.possible()) continue;
    // About a millisecond for the largest heights.
    constexpr std::size_t most_work = 100000, fewest_steps = 48, most_steps = 128;
    const std::size_t steps = std::clamp(most_work / (height.operations() + 1), fewest_steps, most_steps);
    for (const Stroke& way : ways)
      if (const auto jump = jump_along(height, way, steps))
        return JumpingHeight{*jump, carrier.span, carrier.name.substr(0, carrier.name.find(' '))};
  }
  return std::nullopt;
}

std::optional<Span> find_level(const CheckedMaterial& material, const DeviceProfile& device) {
  for (const Carrier& carrier : material.carriers) {
    if (!carrier.relief) continue;
    PlaceEvaluator height(material, device, {*carrier.relief});
    if (!height.possible()) continue;
    // About half a millimetre apart on the patch of a hand, which finds narrow ribs and single hills. Nearly every
    // height shows within a few places that it changes.
    constexpr int places = 65536;
    double low = std::numeric_limits<double>::infinity(), high = -low, size = 0;
    bool level = true;
    for (int i = 0; level && i < places; ++i) {
      // Golden ratios spread the places, so that no pattern is in step with them.
      const double u = std::fmod(0.7548776662466927 * i, 1.0), v = std::fmod(0.5698402909980532 * i, 1.0);
      const double value = height.value_at((2 * u - 1) * height.reach_x(), (2 * v - 1) * height.reach_y());
      if (!std::isfinite(value)) return std::nullopt;
      low = std::min(low, value);
      high = std::max(high, value);
      size = std::max(size, height.size_of_sum());
      level = is_level(low, high, size);
    }
    if (level && (low != 0 || high != 0)) return carrier.span;
  }
  return std::nullopt;
}

void warn_of_huge_forces(const CheckedMaterial& material, const Declarations& declarations, const DeviceProfile& device,
                         Diagnostics& diagnostics) {
  const double most = largest_device_force(declarations);
  if (!(most > 0) || warn_of_huge_carrier(material, declarations, most, diagnostics) || !material.force) return;
  PlaceEvaluator force(material, device, {(*material.force)[0], (*material.force)[1]});
  if (!force.possible()) return;
  constexpr int side = 24;
  constexpr double little = 1e-3, nearly_all = 0.95;  // N; share of the places where it acts
  int acts = 0, beyond = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      force.at(force.reach_x() * (2.0 * i + 1 - side) / side, force.reach_y() * (2.0 * j + 1 - side) / side);
      const double largest = std::max(std::abs(force[0]), std::abs(force[1]));
      if (!(largest > little)) continue;
      ++acts;
      beyond += largest > most ? 1 : 0;
    }
  if (acts == 0 || beyond < nearly_all * acts) return;
  diagnostics.report(Advice("look for a unit that is a thousand times too large, or for a length that is missing")
                         .fact("most", most, "N")
                         .about(Code::beyond_devices, material.force_span,
                                fmt::format("this force is more than any device gives, {}, at {:.0f} % of the places "
                                            "where it pushes",
                                            in_numbers(most, "N"), 100.0 * beyond / acts)));
}

}  // namespace wale
