#include "compiler/report_heights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/measure/small_feature.hpp"
#include "compiler/solve/plausible.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// The heights of a material by whose slopes a force is scaled.
struct ScaledHeights {
  std::size_t count = 0;
  Span span;             ///< of the only one, else of the force
  std::string function;  ///< `lateral`, or `bumps`: of the first one
};

ScaledHeights scaled_heights(const SolvedMaterial& solved, const CheckedMaterial& material) {
  ScaledHeights found{.span = solved.force_span, .function = "lateral"};
  for (const Carrier& carrier : material.carriers) {
    if (!carrier.relief) continue;
    if (found.count++ > 0) continue;
    found.span = carrier.span;
    found.function = carrier.name.substr(0, carrier.name.find(' '));
  }
  if (found.count > 1) found.span = solved.force_span;
  return found;
}

/// The share of the height of a material that is sloped least; nothing if the author scales forces in other ways too.
std::optional<SlopedShare> share_of_heights(const Bank& bank, const ScaledHeights& heights) {
  if (bank.program().description().peaks.size() > heights.count) return std::nullopt;
  return sloped_share(bank);
}

/// "make the patch smaller: `patch 60 mm, 60 mm`; or repeat the feature".
std::string mend_of_small_feature(const std::optional<PatchSize>& patch) {
  if (!patch) return "move the feature to the middle and make the patch smaller, or repeat it all over the patch";
  return typeable("make the patch smaller: `patch {:.0f} mm, {:.0f} mm`; or repeat the feature all over the patch",
                  1e3 * patch->width, 1e3 * patch->height);
}

/// "0.9 %", "less than 0.01 %" of the patch.
std::string percent_of(double share) {
  constexpr double least_told = 1e-4;
  return share < least_told ? readable("less than {:.2f} %", 100 * least_told) : readable("{:.2g} %", 100 * share);
}

std::string size_of(const SolvedMaterial& solved) {
  return readable("{:.0f} mm by {:.0f} mm", 1e3 * solved.patch_width, 1e3 * solved.patch_height);
}

/// Reports a height that changes, but on so little of the patch that the percentile of its slope is 0. Whether it did.
bool report_small_feature(const Bank& bank, const SolvedMaterial& solved, const CheckedMaterial& material,
                          Diagnostics& diagnostics) {
  const ScaledHeights heights = scaled_heights(solved, material);
  const auto share = share_of_heights(bank, heights);
  if (!share || (share->steeper > 0 && std::isfinite(share->steeper))) return false;
  const auto patch = patch_for_feature(bank);
  if (share->covered == 0 && !patch) return false;
  diagnostics.report(
      Advice(mend_of_small_feature(patch))
          .fact("covered", share->covered)
          .about(Code::flat_height, heights.span,
                 fmt::format("this height slopes on {} of the patch only ({}), so the 99th percentile of its slope, by "
                             "which `{}` scales the force, is 0",
                             percent_of(share->covered), size_of(solved), heights.function)));
  return true;
}

/// What to write for a height that only jumps.
std::string mend_of_jump(const Jump& jump, const SolvedMaterial& solved) {
  // A flank across the patch covers as many hundredths of it as it is wide in hundredths of the patch.
  constexpr double share_of_patch = 0.05;
  if (jump.changes <= 2)
    return typeable("let it rise over a distance, as `smoothstep(x / {:.0f} mm)` does",
                    std::ceil(1e3 * share_of_patch * std::max(solved.patch_width, solved.patch_height)));
  return jump.one_way ? "let each step rise over a distance, as those of `smoothed_steps(x / 3 mm, 0.1)` do"
                      : "let its flanks rise over a distance, as those of `grating(x, period: 3 mm)` do";
}

}  // namespace

void report_flat_height(const SolvedMaterial& solved, const CheckedMaterial& material, const Bank* bank,
                        Diagnostics& diagnostics) {
  if (!material.doubts.empty()) {
    Diagnostic doubt = material.doubts.front();
    doubt.code = Code::flat_height;
    doubt.message = "this height is flat inside the patch, and a flat height gives no force: " + doubt.message;
    return diagnostics.report(std::move(doubt));
  }
  const bool level = find_level(material, solved.device).has_value();
  if (!level && bank && report_small_feature(*bank, solved, material, diagnostics)) return;
  const auto jump = level ? std::nullopt : find_jump(material, solved.device);
  diagnostics.report(
      {.code = Code::flat_height,
       .span = jump ? jump->span : solved.force_span,
       .message = jump ? "this height has no slope: it is level, and jumps from level to level"
                       : "this height is flat inside the patch, and a flat height gives no force",
       .help = jump ? mend_of_jump(jump->jump, solved)
                    : "let it change with `x` or `y` inside the patch, as in `grating(x, period: 2.5 mm)`"});
}

void warn_of_jumps(const SolvedMaterial& solved, const CheckedMaterial& material, Diagnostics& diagnostics) {
  const auto found = find_jump(material, solved.device);
  if (!found) return;
  diagnostics.report(
      {.code = Code::jumping_height,
       .span = found->span,
       .message = fmt::format(
           "this height jumps by {:.0f} % of its range at ({:.1f}, {:.1f}) mm, where the force would "
           "be infinite; `{}` leaves the jump out",
           100 * std::min(found->jump.share, 1.0), 1e3 * found->jump.x, 1e3 * found->jump.y, found->function),
       .help = "let it rise over a distance, as `smoothstep(x / 1 mm)` does, or begin and end at the same height"});
}

void warn_of_held_feature(const Bank& bank, const SolvedMaterial& solved, const CheckedMaterial& material,
                          Diagnostics& diagnostics) {
  const ScaledHeights heights = scaled_heights(solved, material);
  if (heights.count == 0) return;
  const auto share = share_of_heights(bank, heights);
  if (!share || !share->is_mostly_held()) return;
  constexpr double most_told = 1000;
  const std::string ratio =
      share->steeper > most_told ? readable("more than {:.0f}", most_told) : readable("{:.2g}", share->steeper);
  diagnostics.report(
      Advice(mend_of_small_feature(patch_for_feature(bank)))
          .fact("covered", share->covered)
          .fact("held", share->held)
          .fact("steeper", std::min(share->steeper, most_told))
          .about(Code::held_feature, heights.span,
                 fmt::format("this height slopes on {} of the patch only ({}): of the places where `{}` pushes, it "
                             "holds {:.0f} % at the amplitude, though the greatest slope there is {} times the least, "
                             "so the shape is lost",
                             percent_of(share->covered), size_of(solved), heights.function, 100 * share->held, ratio)));
}

}  // namespace wale
