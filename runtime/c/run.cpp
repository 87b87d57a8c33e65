#include "runtime/c/run.hpp"

#include <limits>

#include "runtime/c/program.hpp"
#include "runtime/c/sized.hpp"
#include "runtime/c/stage.hpp"
#include "wale/felt.hpp"

struct WaleFelt {
  wale::Felt felt;
  std::vector<wale::LevelBack> levels;
  std::vector<std::unique_ptr<WaleError>> problems;  // null where there is a level
};

namespace wale::c {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

double or_unknown(const std::optional<float>& figure) { return figure ? *figure : not_measured; }

}  // namespace

WaleGuards guards_of(const GuardCounts& counts) noexcept {
  return {.not_a_number = counts.not_a_number,
          .device_limit = counts.device_limit,
          .user_limit = counts.user_limit,
          .heat = counts.heat,
          .energy = counts.energy,
          .passivity = counts.passivity,
          .slew = counts.slew,
          .overrun = counts.overrun,
          .stale = counts.stale,
          .lost = counts.lost,
          .restored = counts.restored};
}

void give_run(RunResult result, HandleToBe<WaleRun>& handle) {
  if (!handle) return;
  if (result.record_problem) handle->problem = handle_of(*result.record_problem);
  handle->result = std::move(result);
  handle.give();
}

}  // namespace wale::c

using namespace wale::c;

void wale_run_free(WaleRun* run) { free_handle(run); }

WaleCode wale_run_figures(const WaleRun* run, WaleRunFigures* figures, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("run", run); !given) return given;
    if (auto sized = is_sized("figures", figures); !sized) return sized;
    const wale::RunResult& known = run->result;
    const wale::Times costs = known.costs ? known.costs->whole : wale::Times{};
    write_sized(figures, {.ticks_run = known.ticks_run,
                          .ticks_missed = known.ticks_missed,
                          .lateness_p50 = known.lateness.p50,
                          .lateness_p99 = known.lateness.p99,
                          .lateness_maximum = known.lateness.maximum,
                          .cost_p50 = costs.p50,
                          .cost_p99 = costs.p99,
                          .cost_maximum = costs.maximum,
                          .seconds_per_tick = known.record.seconds_per_tick,
                          .recorded = known.record.ticks.size(),
                          .problem = run->problem.get(),
                          .scheduling = text_of(known.scheduling),
                          .guards = guards_of(known.guards)});
    return {};
  });
}

WaleCode wale_run_ticks(const WaleRun* run, size_t first, size_t count, size_t each, WaleTick* ticks,
                        WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("run", run); !given) return given;
    const auto& all = run->result.record.ticks;
    if (auto there = are_there(first, count, all.size()); !there) return there;
    return write_elements(count, each, ticks, [&](std::size_t i) {
      const wale::TickRecord& tick = all[first + i];
      return WaleTick{.time = tick.time,
                      .position = vector_of(tick.position),
                      .velocity = vector_of(tick.velocity),
                      .force = vector_of(tick.force),
                      .interaction = vector_of(tick.interaction),
                      .lateness = tick.lateness,
                      .skipped = tick.skipped,
                      .inside = tick.inside,
                      .patch = tick.patch,
                      .change = tick.change};
    });
  });
}

WaleCode wale_felt_measure(const WaleRun* run, const WalePatch* patch, const WaleMeasureOptions* options,
                           WaleFelt** felt, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("felt", felt); !clear) return clear;
    if (auto given = is_given("run", run); !given) return given;
    if (auto given = is_given("patch", patch); !given) return given;
    const auto given = read_sized("options", options);
    if (!given) return given.error();
    wale::MeasureOptions measured{.settling = given->settling};
    if (given->stuck_seconds != 0) measured.stuck_seconds = given->stuck_seconds;
    if (given->stuck_counts != 0) measured.stuck_counts = given->stuck_counts;
    auto known = wale::measure(run->result, patch->patch, measured,
                               given->least_crossings != 0 ? given->least_crossings : 50);
    if (!known) return std::move(known).error();
    auto made = std::make_unique<WaleFelt>();
    made->felt = std::move(known->felt);
    made->levels = std::move(known->levels);
    for (const wale::LevelBack& each : made->levels)
      made->problems.push_back(each.back ? nullptr : handle_of(each.back.error()));
    hand_out(std::move(made), felt);
    return {};
  });
}

void wale_felt_free(WaleFelt* felt) { free_handle(felt); }

WaleCode wale_felt_figures(const WaleFelt* felt, WaleFeltFigures* figures, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("felt", felt); !given) return given;
    if (auto sized = is_sized("figures", figures); !sized) return sized;
    const wale::Felt& known = felt->felt;
    const auto& shaken = known.vibration;
    const wale::ForceSize all = shaken ? shaken->acceleration : known.force;
    const wale::ForceSize rubbing = shaken ? shaken->acceleration : known.force_rubbing;
    WaleFeltFigures made{.ticks = known.ticks,
                         .ticks_rubbing = shaken ? shaken->ticks : known.ticks_rubbing,
                         .crossings = known.crossings,
                         .stuck = known.stuck,
                         .force_p99 = all.p99,
                         .force_maximum = all.maximum,
                         .force_rms = all.rms,
                         .rubbing_p99 = rubbing.p99,
                         .rubbing_maximum = rubbing.maximum,
                         .rubbing_rms = rubbing.rms,
                         .interaction_p99 = not_measured,
                         .interaction_maximum = not_measured,
                         .interaction_rms = not_measured,
                         .drag = or_unknown(known.response.drag),
                         .viscosity = or_unknown(known.response.viscosity),
                         .stiffness = or_unknown(known.response.stiffness),
                         .wall_stiffness = or_unknown(known.response.wall_stiffness),
                         .wall_damping = or_unknown(known.response.wall_damping),
                         .mass = or_unknown(known.response.mass),
                         .shaking = or_unknown(known.response.shaking),
                         .levels = felt->levels.size()};
    if (const auto& hand = known.interaction_rubbing)
      made.interaction_p99 = hand->p99, made.interaction_maximum = hand->maximum, made.interaction_rms = hand->rms;
    write_sized(figures, made);
    return {};
  });
}

WaleCode wale_felt_level(const WaleFelt* felt, size_t index, WaleFeltLevel* level, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("felt", felt); !given) return given;
    if (auto sized = is_sized("level", level); !sized) return sized;
    if (auto there = is_there(index, felt->levels.size()); !there) return there;
    const wale::LevelBack& known = felt->levels[index];
    write_sized(level, {.name = text_of(known.name),
                        .predicted = known.predicted_amplitude,
                        .measured = known.size,
                        .level = known.back ? known.back->level : not_measured,
                        .problem = felt->problems[index].get()});
    return {};
  });
}
