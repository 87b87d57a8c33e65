#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/stage/patches_in_run.hpp"
#include "runtime/stage/stage_state.hpp"
#include "schema/sentence.hpp"
#include "wale/felt.hpp"

namespace wale {
namespace {

Error nothing_measured(std::string sentence, std::string mend) {
  return {.code = Code::not_measured,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = "patch"}};
}

bool is_same(const std::weak_ptr<const StageState>& one, const std::weak_ptr<StageState>& other) {
  return !one.owner_before(other) && !other.owner_before(one);
}

/// The number of the last change of the patch in the run, whose ticks count.
Result<std::uint32_t> last_change(const RunResult& run, const Patch& patch) {
  const auto& ticks = run.record.ticks;
  if (run.patches && !is_same(run.patches->stage, StageState::of(patch)))
    return wrong_moment("run", "the run was one of another stage than the patch's", "measure a run of the patch's stage");
  if (ticks.empty() || !run.patches)
    return nothing_measured("the run kept no record", "measure a run of `run`, since one that is started keeps none");
  if (std::ranges::none_of(ticks, [&](const TickRecord& tick) { return tick.patch == patch.id(); }))
    return nothing_measured("the hand was never on the patch", "put the patch where the hand goes, or the hand on the patch");
  const auto state = StageState::of(patch).lock();
  const PatchName name = StageState::name_of(patch);
  const std::lock_guard lock(state->mutex);
  const auto& known = run.patches->all;
  const auto as_felt = std::ranges::find(known, name, &PatchTable::Published::name);
  if (as_felt == known.end())
    return nothing_measured("the hand was not on the patch after its last change in the run",
                        "leave it as it is for a while, or measure a run of its own for each change");
  const WantedPatch* const wanted = state->table.wanted(name);
  if (wanted == nullptr) return patch_is_gone();
  if (!(wanted->key() == as_felt->key))
    return wrong_moment("patch", "the patch's program, parameters or size have changed since the run",
                        "measure before the change, or run again");
  return static_cast<std::uint32_t>(as_felt->change);
}

/// Error: an option that is not finite, or negative.
Result<> can_be_measured(const MeasureOptions& options, long least_crossings) {
  for (const auto& [name, value] : {std::pair{"settling", options.settling},
                                    std::pair{"stuck_seconds", options.stuck_seconds},
                                    std::pair{"stuck_counts", options.stuck_counts}})
    if (!(std::isfinite(value) && value >= 0))
      return malformed(name, "expected a finite number that is not negative", "leave it out for the usual one",
                       "a finite number that is not negative", sentence(value));
  if (least_crossings < 0)
    return malformed("least_crossings", "expected a number that is not negative", "leave it out for the usual one, 50",
                     "a number that is not negative", sentence(least_crossings));
  return {};
}

/// Whether the force that `predicted_amplitude` tells is that which comes to the handle: a factor or a limit leaves
/// another one.
bool is_as_predicted(const Bank& bank) {
  const auto& percepts = bank.program().description().percepts;
  const auto texture = std::ranges::find(percepts, Extractor::lateral_force, &PerceptRecord::extractor);
  return texture == percepts.end() || texture->basis.summand;
}

}  // namespace

Result<FeltPatch> measure(const RunResult& run, const Patch& patch, const MeasureOptions& options,
                          long least_crossings) {
  if (auto good = can_be_measured(options, least_crossings); !good) return std::move(good).error();
  const Result<Bank> bank = patch.bank();  // its errors are those of the patch
  if (!bank) return bank.error();
  const auto state = StageState::of(patch).lock();
  if (!state) return stage_is_gone();
  const Result<std::uint32_t> change = last_change(run, patch);
  if (!change) return change.error();
  const double most = std::min(state->options.max_force, state->profile.most());
  MeasureOptions all = options;
  all.position_step = state->profile.position_step();
  all.predicted_amplitude = is_as_predicted(*bank) ? std::min(predicted_amplitude(*bank), static_cast<float>(most)) : 0;
  all.vibrates = run.record.vibrates;
  all.bandwidth = {state->profile.bandwidth_x, state->profile.bandwidth_y};
  all.change = *change;
  FeltPatch felt{measure(run.record, all), {}};
  if (felt.felt.ticks == 0)
    return run.record.ticks.back().time < options.settling
               ? nothing_measured("the run ended before its `settling`, so nothing is left to measure",
                              "run for longer, or leave out less")
               : nothing_measured("the hand was not on the patch after `settling`", "run for longer, or leave out less");
  felt.levels = levels_back(*bank, felt.felt, least_crossings);
  return felt;
}

}  // namespace wale
