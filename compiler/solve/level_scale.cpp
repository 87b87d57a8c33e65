#include "compiler/solve/level_scale.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/solve/choose_map.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

LevelScale::LevelScale(const Percept& percept, const Map& map, const Declarations& declarations,
                       const DeviceDeclaration& device)
    : percept_(percept),
      map_(map),
      law_(map, percept),
      people_(declarations, percept.cue, device.profile.name, percept.exerts),
      most_size_(percept.exerts > 0 ? device.profile.force_newton / percept.exerts
                                    : std::numeric_limits<double>::infinity()) {}

double LevelScale::size_of(double level) const { return level > 0 ? std::min(law_.carrier_of(level), most_size_) : 0; }

std::optional<double> LevelScale::step(double size, double towards, double apart) const {
  const auto far_enough = [&](double other) { return people_.distance(size, other).value_or(0) >= apart; };
  if (!far_enough(towards)) return std::nullopt;
  double near = size, far = towards;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (near + far);
    (far_enough(middle) ? far : near) = middle;
  }
  return far;
}

namespace {

/// Checks two neighbouring levels of one percept, the lower first.
void check_neighbours(const LevelScale& scale, const Levels::Level& lower, const Levels::Level& higher,
                      const std::string& device, Diagnostics& diagnostics) {
  constexpr double rounding = 1e-6;  // since levels are written with few digits
  const double low = scale.size_of(lower.value), high = scale.size_of(higher.value);
  const Threshold* threshold = scale.people().threshold(low, high);
  const auto apart = scale.people().distance(low, high);
  if (!threshold || !apart || std::isnan(*apart) || *apart >= 1 - rounding) return;
  const std::string& percept = scale.percept().name;
  const auto enough = scale.step(low, std::min(scale.size_of(1), scale.most_size()), 1);
  // Rounded up, so that the proposed level is far enough.
  const double written = enough ? std::ceil(scale.level_of(*enough) * 1000) / 1000 : HUGE_VAL;
  Advice advice =
      written <= 1
          ? Advice(typeable("`{} {:.3g}` is one just noticeable difference from it; `wale levels {}` proposes more",
                            higher.name, written, percept))
                .fact("enough", written)
          : Advice(fmt::format("no higher level is far enough from it; lower `{}`, as `wale levels {}` proposes",
                               lower.name, percept));
  advice = std::move(advice).see(lower.span, typeable("{} {:.3g}", percept, lower.value)).fact("apart", *apart);
  Diagnostic found = std::move(advice).about(
      Code::close_levels, higher.span,
      readable("`{}` and `{}` are hard to tell apart on `{}`: {:.2g} of a just noticeable difference of {}",
               higher.name, lower.name, device, *apart, percept));
  const std::vector<std::string> outside = threshold->unmet(low, high, {}, {});
  found.cause = readable("at these sizes, a relative difference of {:.2g} is noticed at d' = 1 ({}{}{})",
                         threshold->weber, threshold->source, outside.empty() ? "" : ", extrapolated from ",
                         fmt::format("{}", fmt::join(outside, ", ")));
  diagnostics.report(std::move(found));
}

}  // namespace

void check_levels(const Declarations& declarations, SourceId source, const std::string& device,
                  Diagnostics& diagnostics) {
  const DeviceDeclaration* on = declarations.devices.find(device);
  if (!on) return;
  for (const Levels* levels : declarations.levels()) {
    const Percept* declared = declarations.percepts.find(levels->percept);
    if (levels->span.source != source || !declared || !declared->has_reference) continue;
    if (on->profile.shaker && !on->realise.contains(declared->name)) continue;  // it renders no level of this percept
    const Percept percept = carried_on(*on, *declared, declarations);
    const Map* map = choose_map(percept, *on, declarations).map;
    if (!map) continue;
    const LevelScale scale(percept, *map, declarations, *on);
    std::vector<Levels::Level> sorted = levels->levels;
    std::ranges::stable_sort(sorted, {}, &Levels::Level::value);
    const Threshold* recalled = nullptr;
    for (auto higher = sorted.begin(); higher != sorted.end(); ++higher) {
      const auto same = std::ranges::lower_bound(sorted, higher->value, {}, &Levels::Level::value);
      if (same == sorted.begin()) continue;
      constexpr std::size_t operations_of_a_level = 256;
      if (!diagnostics.charge(operations_of_a_level * (1 + map->terms.size()), levels->span, Work::solving)) return;
      const Levels::Level& lower = *std::prev(same);
      check_neighbours(scale, lower, *higher, device, diagnostics);
      const Threshold* threshold = scale.people().threshold(scale.size_of(lower.value), scale.size_of(higher->value));
      if (threshold && threshold->recalled()) recalled = threshold;
    }
    if (!recalled) continue;
    diagnostics.report(
        Advice("treat it as a guess until somebody has checked the source")
            .see(recalled->span, "the threshold")
            .about(Code::unverified_basis, levels->span,
                   fmt::format(
                       "the distance between levels of {} rests on a figure that was recalled and not looked up ({})",
                       levels->percept, recalled->source)));
  }
}

}  // namespace wale
