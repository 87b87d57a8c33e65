#include "compiler/legibility/check_legibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/compare/compare.hpp"
#include "compiler/declarations/discrimination.hpp"
#include "compiler/diagnostics/advice.hpp"
#include "compiler/layout/ground.hpp"
#include "compiler/legibility/border.hpp"
#include "compiler/legibility/check_count.hpp"
#include "compiler/legibility/check_sizes.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

void warn_of_hidden(const LaidPatch& patch, Diagnostics& diagnostics) {
  diagnostics.report(
      Advice("move it, or write it behind the others, which then lie behind it")
          .about(Code::hidden_patch, patch.patch->span,
                 fmt::format("`{}` is never felt: it lies behind later patches", patch.patch->name)));
}

/// Whether the box of a patch lies in that of another, so that no gap can be between them.
bool lies_within(const LaidPatch& inner, const LaidPatch& outer) {
  const auto &at = inner.patch->at, &of = outer.patch->at;
  return std::abs(at[0] - of[0]) + 0.5 * inner.size.width <= 0.5 * outer.size.width &&
         std::abs(at[1] - of[1]) + 0.5 * inner.size.height <= 0.5 * outer.size.height;
}

void check_neighbours(const std::vector<LaidPatch>& laid, const Ground& ground, const Comparer& comparer,
                      const Discrimination& of_force, ReadCues& cues, Diagnostics& diagnostics) {
  for (const auto& [both, crossings] : ground.neighbours()) {
    const LaidPatch &one = laid[static_cast<std::size_t>(both.first)],
                    &other = laid[static_cast<std::size_t>(both.second)];
    if (one.patch->made_of == other.patch->made_of) continue;  // one surface of several parts
    const Distance distance = comparer.distance(cues.of(one), cues.of(other));
    if (distance.verdict != Verdict::alike) continue;
    const double step = border_step(one, cues.of(one), other, cues.of(other), crossings);
    if (of_force.distance(step, 0).value_or(0) >= 1) continue;  // the border itself is felt
    const bool is_inside = lies_within(one, other) || lies_within(other, one);
    diagnostics.report(
        Advice("give one of them another level or material" +
               (is_inside ? std::string()
                          : readable(", or leave {:.2g} mm between them", 1e3 * (one.size.rim + other.size.rim) + 1)))
            .about(
                Code::indistinct_neighbours, other.patch->span,
                readable("people would not tell `{}` from `{}` beside it: they differ by {:.2g} of a just noticeable "
                         "difference",
                         other.patch->name, one.patch->name, std::floor(100 * distance.noticeable) / 100)));
  }
}

}  // namespace

const Cues& ReadCues::read(std::map<const Program*, Cues>& known, const Program& program, PatchSize size) {
  const auto found = known.find(&program);
  if (found != known.end()) return found->second;
  const Bank bank(program, program.default_parameters(), size);
  return known.emplace(&program, cues_of(bank, declarations_)).first->second;
}

const Cues& ReadCues::of(const LaidPatch& patch) { return read(read_, *patch.program, patch.program->default_size()); }

const Cues& ReadCues::of_material(const LaidPatch& patch) {
  constexpr float small = 0.25f;  // of the usual size: a texture has some periods in more
  const DeviceProfile& device = patch.program->description().device;
  const PatchSize size{static_cast<float>(device.patch_width), static_cast<float>(device.patch_height),
                       static_cast<float>(device.patch_rim)};
  const bool is_small = std::min(patch.size.width, patch.size.height) < small * std::min(size.width, size.height);
  return is_small ? read(of_materials_, *patch.program, size) : of(patch);
}

void check_legibility(const CheckedWorkspace& workspace, const std::vector<LaidPatch>& laid,
                      const Declarations& declarations, const std::string& device, Diagnostics& diagnostics) {
  const DeviceDeclaration* declared = declarations.devices.find(device);
  if (laid.empty() || declared == nullptr || !declared->profile.has_position()) return;
  const Ground ground(laid, 0.5 * declared->profile.workspace_diameter);
  for (std::size_t i = 0; i < laid.size(); ++i)
    if (ground.is_hidden(i)) warn_of_hidden(laid[i], diagnostics);
  if (declared->profile.shaker) return;  // cues are forces
  ReadCues cues(declarations);
  const Comparer comparer(declarations, device);
  check_neighbours(laid, ground, comparer, Discrimination(declarations, "amplitude", device, 1), cues, diagnostics);
  check_sizes(laid, ground, declarations, declared->profile, cues, diagnostics);
  check_count(workspace, laid, comparer, declarations, device, cues, diagnostics);
}

}  // namespace wale
