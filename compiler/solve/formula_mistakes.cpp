#include "compiler/solve/formula_mistakes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "compiler/solve/place_evaluator.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// The change over a metre of what is proportional to the place, apart from a constant; nothing of anything else.
std::optional<double> slope_of(PlaceEvaluator& value) {
  const double x = value.reach_x(), y = value.reach_y(), middle = value.value_at(0, 0);
  const double by_x = (value.value_at(x, 0) - middle) / x, by_y = (value.value_at(0, y) - middle) / y;
  if (!std::isfinite(by_x) || !std::isfinite(by_y)) return std::nullopt;
  // Askew and at different distances, where only a line has what the slopes foretell.
  constexpr double shares[][2] = {{0.31, 0.47}, {-0.83, 0.19}, {-0.43, -0.91}, {0.67, -0.59}};
  const double most = std::abs(by_x) * x + std::abs(by_y) * y;
  for (const auto& [u, v] : shares) {
    const double foretold = middle + u * x * by_x + v * y * by_y;
    if (!(std::abs(value.value_at(u * x, v * y) - foretold) <= 1e-6 * (most + std::abs(middle)))) return std::nullopt;
  }
  return std::hypot(by_x, by_y);
}

}  // namespace

bool warn_of_cycles(const CheckedMaterial& material, const DeviceProfile& device, Diagnostics& diagnostics) {
  constexpr double patches = 4;  // even half a period of it is not felt any more
  constexpr std::size_t most_looked_at = 64;
  const double widest = std::min(device.widest_patch(), material.patch
                                                            ? std::max((*material.patch)[0], (*material.patch)[1])
                                                            : std::max(device.patch_width, device.patch_height));
  std::set<TermId> seen;
  for (const CheckedCycle& cycle : material.cycles) {
    if (!seen.insert(cycle.value).second) continue;
    if (seen.size() > most_looked_at) break;
    PlaceEvaluator value(material, device, {cycle.value});
    if (!value.possible() || value.operations() == 0) continue;
    const auto slope = slope_of(value);
    if (!slope || !(*slope > 0)) continue;
    const double length = (cycle.turns ? 2 * std::numbers::pi : 1) / *slope;
    const double least = 2 * device.position_step();
    if (cycle.turns && length < least) {
      diagnostics.report(
          Advice(readable("make it {:.2g} mm or more", std::ceil(1e4 * least) / 10))
              .fact("period", 1e3 * length, "mm")
              .fact("least", 1e3 * least, "mm")
              .about(Code::under_resolution, cycle.span,
                     readable("a period of {:.3g} mm is less than two counts of the encoder of `{}` ({:.3g} mm each)",
                              1e3 * length, device.name, 500 * least)));
      return true;
    }
    if (length <= patches * widest) continue;
    diagnostics.report(
        Advice(typeable("for millimetres write `{:.4g} mm`", length))
            .fact("period", 1e3 * length, "mm")
            .fact("most", 1e3 * patches * widest, "mm")
            .about(Code::beyond_soft_range, cycle.span,
                   readable("a {} of {:.4g} m is {:.0f} times as long as the patch ({:.0f} mm), so hardly a part of it "
                            "is felt",
                            cycle.turns ? "period" : "grain", length, length / widest, 1e3 * widest)));
    return true;
  }
  return false;
}

bool warn_of_no_number(const CheckedMaterial& material, const DeviceProfile& device, Diagnostics& diagnostics) {
  if (material.operands.empty()) return false;
  constexpr int side = 24;
  constexpr double many = 0.05;  // of the places
  std::vector<TermId> wholes;
  if (material.force) wholes = {(*material.force)[0], (*material.force)[1]};
  for (const Carrier& carrier : material.carriers)
    if (carrier.relief) wholes.push_back(*carrier.relief);
  // Each by itself: one that cannot be evaluated hides no other.
  std::vector<PlaceEvaluator> evaluators;
  for (const TermId whole : wholes)
    if (PlaceEvaluator each(material, device, {whole}); each.possible()) evaluators.push_back(std::move(each));
  std::vector<PlaceEvaluator> operands;
  for (const CheckedOperand& each : material.operands) operands.emplace_back(material, device, std::vector{each.value});
  std::vector<int> negative(operands.size(), 0);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double u = (2.0 * i + 1 - side) / side, v = (2.0 * j + 1 - side) / side;
      const bool without = std::ranges::any_of(evaluators, [&](PlaceEvaluator& each) {
        return std::isnan(each.value_at(u * each.reach_x(), v * each.reach_y()));
      });
      if (!without) continue;
      for (std::size_t k = 0; k < operands.size(); ++k)
        if (operands[k].possible() && operands[k].value_at(u * operands[k].reach_x(), v * operands[k].reach_y()) < 0)
          ++negative[k];
    }
  const auto most = std::ranges::max_element(negative);
  const double share = static_cast<double>(*most) / (side * side);
  if (share < many) return false;
  const CheckedOperand& found = material.operands[static_cast<std::size_t>(most - negative.begin())];
  diagnostics.report(
      Advice("keep it at 0 or above, as `max(0, …)` does")
          .fact("share", share)
          .about(Code::beyond_soft_range, found.span,
                 readable("{} of a negative number is no number, at {:.0f} % of the places; there the force is 0",
                          found.words, 100 * share)));
  return true;
}

}  // namespace wale
