#include "compiler/legibility/check_count.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/layout/layout_rules.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// More textures are compared with no others: no publication has so many.
constexpr std::size_t most_compared = 64;

/// One patch of each texture that is told from the others side by side, as far as the thresholds say.
std::vector<const LaidPatch*> different_textures(const std::vector<LaidPatch>& laid, const Comparer& comparer,
                                                 ReadCues& cues) {
  std::vector<const LaidPatch*> different;
  for (const LaidPatch& patch : laid) {
    const auto is_alike = [&](const LaidPatch* each) {
      return each->patch->made_of == patch.patch->made_of ||
             comparer.distance(cues.of(*each), cues.of(patch)).verdict == Verdict::alike;
    };
    if (different.size() < most_compared && std::ranges::none_of(different, is_alike)) different.push_back(&patch);
  }
  return different;
}

/// What people recognise of the cues in which the textures differ.
struct Capacity {
  double recognised = 1;
  std::map<std::string, const Threshold*> by_cue;  ///< the publications, by their cue
  double nearest = 0;  ///< distance of the two nearest textures, just noticeable differences
  const LaidPatch *one = nullptr, *other = nullptr;  ///< which are these
};

/// Empty if the textures differ in a cue of which nobody knows how many sizes people recognise.
std::optional<Capacity> capacity_of(const std::vector<const LaidPatch*>& textures, const Comparer& comparer,
                                    const Declarations& declarations, const std::string& device, ReadCues& cues) {
  Capacity capacity;
  for (std::size_t i = 0; i < textures.size(); ++i)
    for (std::size_t j = i + 1; j < textures.size(); ++j) {
      const Comparison comparison = comparer.compare(cues.of(*textures[i]), cues.of(*textures[j]));
      double plainest = 0;
      for (const CueDifference& each : comparison.cues) {
        if (!each.noticeable) return std::nullopt;
        plainest = std::max(plainest, *each.noticeable);
        if (*each.noticeable < 1) continue;
        const char* cue = cue_table()[static_cast<std::size_t>(each.kind)].threshold;
        const auto [known, is_new] = capacity.by_cue.try_emplace(cue, nullptr);
        if (is_new) known->second = recognition(declarations, cue, device);
        if (!known->second) return std::nullopt;
      }
      if (!capacity.one || plainest < capacity.nearest)
        capacity.nearest = plainest, capacity.one = textures[i], capacity.other = textures[j];
    }
  for (const auto& [cue, publication] : capacity.by_cue) capacity.recognised *= publication->recognised;
  return capacity;
}

}  // namespace

void check_count(const CheckedWorkspace& workspace, const std::vector<LaidPatch>& laid, const Comparer& comparer,
                 const Declarations& declarations, const std::string& device, ReadCues& cues,
                 Diagnostics& diagnostics) {
  const auto textures = different_textures(laid, comparer, cues);
  if (textures.size() < 2) return;
  const auto capacity = capacity_of(textures, comparer, declarations, device, cues);
  if (!capacity || static_cast<double>(textures.size()) <= capacity->recognised) return;
  std::vector<std::string> differ, sources;
  for (const auto& [cue, publication] : capacity->by_cue) {
    differ.push_back(cue);
    if (std::ranges::find(sources, publication->source) == sources.end()) sources.push_back(publication->source);
  }
  for (std::string& each : differ) std::ranges::replace(each, '_', ' ');
  const std::string in_what = fmt::format("{}", fmt::join(differ, " and "));
  const std::string said_by = fmt::format("{}", fmt::join(sources, "; "));
  diagnostics.report(
      Advice(
          readable("leave some out, or let them differ in another cue too, such as the period; the nearest two, `{}` "
                   "and `{}`, are {:.2g} just noticeable differences apart",
                   capacity->one->patch->name, capacity->other->patch->name, capacity->nearest))
          .fact("textures", static_cast<double>(textures.size()))
          .fact("recognised", capacity->recognised)
          .because(layout_rule("textures", static_cast<double>(textures.size()), declarations))
          .about(Code::many_textures, workspace.span,
                 readable(
                     "`{}` has {} textures that differ only in {}, of which people who feel one alone recognise {:.2g} "
                     "({})",
                     workspace.name, textures.size(), in_what, capacity->recognised, said_by)));
}

}  // namespace wale
