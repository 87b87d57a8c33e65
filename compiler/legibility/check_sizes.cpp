#include "compiler/legibility/check_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/layout/layout_rules.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// m; a proposed width or gap is a multiple of it.
constexpr double proposed_step = 0.1e-3;

double rounded_up(double metres) { return proposed_step * std::ceil(metres / proposed_step - 1e-6); }

NarrowestFelt::Reason stronger(NarrowestFelt::Reason a, NarrowestFelt::Reason b) {
  return b.needed > a.needed ? std::move(b) : std::move(a);
}

}  // namespace

NarrowestFelt::NarrowestFelt(const Declarations& declarations, const DeviceProfile& device)
    : device_(device), speed_(speed_of_strokes(declarations).value_or(0)) {
  if (const HandDeclaration* hand = declarations.hands.find("normal")) counts_ = hand->faithful_counts;
}

NarrowestFelt::Reason NarrowestFelt::for_hand(double newton) const {
  Reason reason{counts_ * device_.position_step(),
                readable("the encoder has {:.2g} mm for a count, and {:.3g} of them show a form",
                         1e3 * device_.position_step(), counts_)};
  if (device_.slew > 0)
    reason = stronger(std::move(reason), {speed_ * newton / device_.slew,
                                          readable("a hand that strokes at {:.3g} mm/s is across before the force of "
                                                   "{:.2g} N has come, in {:.2g} ms",
                                                   1e3 * speed_, newton, 1e3 * newton / device_.slew)});
  return reason;
}

NarrowestFelt::Reason NarrowestFelt::for_patch(const Cues& cues, double rim) const {
  Reason reason = for_hand(cues[CueKind::amplitude].value_or(0));
  if (const auto& period = cues[CueKind::period])
    reason =
        stronger(std::move(reason),
                 {*period + 2 * rim, readable("between its rims, of {:.2g} mm each, there is less than one period of its "
                                              "texture, {:.3g} mm",
                                              1e3 * rim, 1e3 * *period)});
  return reason;
}

NarrowestFelt::Reason NarrowestFelt::for_gap(const Cues& one, const Cues& other) const {
  Reason reason = for_hand(std::max(one[CueKind::amplitude].value_or(0), other[CueKind::amplitude].value_or(0)));
  const double period = std::min(one[CueKind::period].value_or(0), other[CueKind::period].value_or(0));
  return stronger(
      std::move(reason),
      {period,
       readable("the textures beside it have valleys as wide: one has a period of {:.3g} mm, the other no shorter one",
                1e3 * period)});
}

void check_sizes(const std::vector<LaidPatch>& laid, const Ground& ground, const Declarations& declarations,
                 const DeviceProfile& device, ReadCues& cues, Diagnostics& diagnostics) {
  const NarrowestFelt narrowest(declarations, device);
  const auto widths = ground.widths();
  for (std::size_t i = 0; i < laid.size(); ++i) {
    const LaidPatch& patch = laid[i];
    if (!(widths[i] > 0) && !ground.is_slit(i)) continue;  // hidden, or beyond reach
    const double shorter = std::min<double>(patch.size.width, patch.size.height);
    const double width = std::min(widths[i] + ground.square(), shorter);
    const auto reason = narrowest.for_patch(cues.of_material(patch), patch.size.rim);
    if (width >= reason.needed) continue;
    diagnostics.report(
        Advice(typeable("make it at least {:.4g} mm wide{}", 1e3 * rounded_up(reason.needed),
                        cues.of_material(patch)[CueKind::period] ? ", or take a material with a shorter period" : ""))
            .fact("width", 1e3 * width, "mm")
            .fact("low", 1e3 * reason.needed, "mm")
            .because(layout_rule("element", width, declarations))
            .about(Code::too_small_for_hand, patch.patch->span,
                   readable("what is felt of `{}` is {:.2g} mm wide at most: {}", patch.patch->name,
                            1e3 * width, reason.why)));
  }
  for (const auto& [both, between] : ground.gaps()) {
    const LaidPatch &one = laid[static_cast<std::size_t>(both.first)],
                    &other = laid[static_cast<std::size_t>(both.second)];
    const auto reason = narrowest.for_gap(cues.of_material(one), cues.of_material(other));
    if (between >= reason.needed) continue;
    diagnostics.report(
        Advice(typeable("leave {:.4g} mm between them, or lay them edge to edge", 1e3 * rounded_up(reason.needed)))
            .fact("width", 1e3 * between, "mm")
            .fact("low", 1e3 * reason.needed, "mm")
            .because(layout_rule("gap", between, declarations))
            .about(Code::too_small_for_hand, other.patch->span,
                   readable("the gap of {:.2g} mm between `{}` and `{}` is not felt as one: {}", 1e3 * between,
                            one.patch->name, other.patch->name, reason.why)));
  }
}

}  // namespace wale
