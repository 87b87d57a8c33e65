#include "runtime/c/stage.hpp"

#include <cmath>
#include <utility>

#include "runtime/c/profile.hpp"
#include "runtime/c/run.hpp"
#include "runtime/c/shape.hpp"
#include "runtime/c/sized.hpp"
#include "runtime/stage/stage_state.hpp"

WaleStage::~WaleStage() {
  { const wale::Stage ended(std::move(stage)); }
  if (device) device->has_stage = false;
}

namespace wale::c {
namespace {

static_assert(sizeof(WaleGuards) == 11 * sizeof(int64_t));

Result<StageOptions> read_stage_options(const WaleStageOptions* options) {
  const auto given = read_sized("options", options);
  if (!given) return given.error();
  if (!(given->max_force >= 0 && given->max_force < HUGE_VAL))
    return about_argument("max_force", "expected a finite number that is not negative", "0 sets no limit");
  if (given->priority < 0 || given->priority > 99)
    return about_argument("priority", "expected 0 to 99, found " + std::to_string(given->priority),
                          "the usual one is 80");
  const auto lock_memory = read_flag("lock_memory", given->lock_memory);
  if (!lock_memory) return lock_memory.error();
  const auto low_latency = read_flag("low_latency", given->low_latency);
  if (!low_latency) return low_latency.error();
  StageOptions read{.lock_memory = *lock_memory, .low_latency = *low_latency};
  if (given->priority != 0) read.priority = given->priority;
  if (given->max_force != 0) read.max_force = given->max_force;
  auto file = read_path("record", given->record);
  if (!file) return std::move(file).error();
  auto hand = read_text("record_hand", given->record_hand);
  if (hand && !hand->empty()) hand = read_name("record_hand", given->record_hand, record_hand_mend);
  if (!hand) return std::move(hand).error();
  if (!file->empty()) read.record = {.file = *std::move(file), .hand = *std::move(hand)};
  return read;
}

}  // namespace

Result<PatchOptions> read_options(const WalePatchOptions* options) {
  const auto given = read_sized("options", options);
  if (!given) return given.error();
  if (!(given->rim >= 0 && std::isfinite(given->rim)))
    return about_argument("rim", "expected a finite number that is not negative", "0 is no rim");
  PatchOptions read{.at = {given->x, given->y}, .layer = given->layer};
  if (given->width != 0 || given->height != 0) read.size = PatchSize{given->width, given->height, given->rim};
  if (given->shape != nullptr) read.shape = given->shape->shape;
  return read;
}

Result<const Program*> read_program(const WaleProgram* program) {
  if (auto given = is_given("program", program); !given) return std::move(given).error();
  return &program->program;
}

Result<> is_stage_here(const WaleStage* stage) {
  if (auto given = is_stage(stage); !given) return given;
  if (stage->home.is_here()) return {};
  return about_argument("stage", "it is the parent process's, and this is a child of its fork",
                        "make a stage and a device of the child's own", Code::wrong_moment);
}

}  // namespace wale::c

using namespace wale::c;

WaleCode wale_stage_create(WaleDevice* device, const WaleStageOptions* options, WaleStage** stage, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("stage", stage); !clear) return clear;
    if (auto given = is_given("device", device); !given) return given;
    auto read = read_stage_options(options);
    if (!read) return std::move(read).error();
    const std::shared_ptr<SharedDevice> shared = device->shared;
    if (!shared->home.is_here())
      return about_argument("device", "it is the parent process's, and this is a child of its fork",
                            "open it again in the child", wale::Code::wrong_moment);
    if (shared->has_stage.exchange(true))
      return about_argument("device", "another stage has the device", "free that stage first",
                            wale::Code::wrong_moment);
    try {
      hand_out(std::make_unique<WaleStage>(shared, shared->device->profile(), *read), stage);
    } catch (...) {
      shared->has_stage = false;
      throw;
    }
    return {};
  });
}

WaleCode wale_stage_create_for(const WaleProfile* profile, const WaleStageOptions* options, WaleStage** stage,
                               WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("stage", stage); !clear) return clear;
    const auto figures = read_profile(profile);
    if (!figures) return figures.error();
    auto read = read_stage_options(options);
    if (!read) return std::move(read).error();
    hand_out(std::make_unique<WaleStage>(nullptr, *figures, *read), stage);
    return {};
  });
}

void wale_stage_free(WaleStage* stage) { free_handle(stage); }

WaleCode wale_stage_add(WaleStage* stage, const WaleProgram* program, const WalePatchOptions* options,
                        WalePatch** patch, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (patch != nullptr) *patch = nullptr;
    if (auto given = is_stage(stage); !given) return given;
    const auto known = read_program(program);
    if (!known) return known.error();
    const auto read = read_options(options);
    if (!read) return read.error();
    HandleToBe<WalePatch> handle(patch);
    auto added = stage->stage.add(**known, *read);
    if (!added) return std::move(added).error();
    if (handle) handle->patch = *std::move(added);
    handle.give();
    return {};
  });
}

size_t wale_stage_size(const WaleStage* stage) { return stage == nullptr ? 0 : stage->stage.size(); }

WaleCode wale_stage_run(WaleStage* stage, const WaleRunOptions* options, WaleRun** run, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (run != nullptr) *run = nullptr;
    if (auto given = is_stage(stage); !given) return given;
    if (auto given = is_given("options", options); !given) return given;
    const auto given = read_sized("options", options);
    if (!given) return given.error();
    const auto virtual_time = read_flag("virtual_time", given->virtual_time);
    if (!virtual_time) return virtual_time.error();
    wale::RunOptions read{.seconds = given->seconds, .virtual_time = *virtual_time};
    if (given->kept_seconds != 0) read.kept_seconds = given->kept_seconds;
    read.stop = &stage->interrupted;
    stage->interrupted = false;
    HandleToBe<WaleRun> handle(run);
    auto done = stage->stage.run(read);  // `stage` may be gone now
    if (!done) return std::move(done).error();
    give_run(*std::move(done), handle);
    return {};
  });
}

void wale_stage_interrupt(WaleStage* stage) {
  if (stage != nullptr) stage->interrupted = true;
}

WaleCode wale_stage_start(WaleStage* stage, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_stage(stage); !given) return given;
    return stage->stage.start();
  });
}

WaleCode wale_stage_stop(WaleStage* stage, WaleRun** run, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (run != nullptr) *run = nullptr;
    if (auto given = is_stage(stage); !given) return given;
    // The force ends first, whether or not there is memory to tell of it.
    auto done = stage->stage.stop();
    if (!done) return std::move(done).error();
    HandleToBe<WaleRun> handle(run);
    give_run(*std::move(done), handle);
    return {};
  });
}

int32_t wale_stage_is_running(const WaleStage* stage) { return stage != nullptr && stage->stage.is_running(); }

WaleCode wale_stage_now(const WaleStage* stage, WaleNow* now) {
  if (stage == nullptr || !has_size(now)) return WALE_CODE_malformed_value;
  const wale::Now known = stage->stage.now();
  write_sized(now, {.time = known.time,
                    .lateness = known.lateness,
                    .ticks_run = known.ticks_run,
                    .ticks_missed = known.ticks_missed,
                    .revision = known.revision,
                    .patch = known.patch ? known.patch->id() : 0,
                    .position = vector_of(known.position),
                    .velocity = vector_of(known.velocity),
                    .force = vector_of(known.force),
                    .inside = known.inside,
                    .guards = guards_of(known.guards)});
  return 0;
}

WaleCode wale_stage_on_contact(WaleStage* stage, WaleReceiveContact receive, void* user, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_stage_here(stage); !given) return given;
    if (receive == nullptr) {
      stage->stage.on_contact({});
      return {};
    }
    stage->stage.on_contact([receive, user](const wale::ContactEvent& event) {
      const WaleContact contact{.size = sizeof(WaleContact),
                                .patch = event.patch.id(),
                                .time = event.time,
                                .position = vector_of(event.position),
                                .velocity = vector_of(event.velocity),
                                .force = vector_of(event.force),
                                .kind = static_cast<int32_t>(event.kind)};
      receive(&contact, user);
    });
    return {};
  });
}

WaleCode wale_stage_poll(WaleStage* stage, size_t* dropped, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (dropped != nullptr) *dropped = 0;
    if (auto given = is_stage_here(stage); !given) return given;
    const std::size_t lost = stage->stage.poll();
    if (dropped != nullptr) *dropped = lost;
    return {};
  });
}
