#include "runtime/c/stage.hpp"

#include <utility>

#include "runtime/c/run.hpp"
#include "runtime/c/sized.hpp"
#include "runtime/device/shipped_devices.hpp"

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
  StageOptions read;
  if (given->priority != 0) read.priority = given->priority;
  read.lock_memory = given->lock_memory != 0;
  read.low_latency = given->low_latency != 0;
  if (given->max_force != 0) read.max_force = given->max_force;
  auto file = read_path("record", given->record);
  if (!file) return std::move(file).error();
  auto hand = read_text("record_hand", given->record_hand);
  if (!hand) return std::move(hand).error();
  if (!file->empty()) read.record = {.file = *std::move(file), .hand = *std::move(hand)};
  return read;
}

/// The shipped pad of that name: what shakes it is in no struct.
Result<Shaker> shaker_of(const std::string& name) {
  const auto& shipped = shipped_devices();
  if (shipped)
    for (const DeclaredDevice& each : *shipped)
      if (each.profile.name == name && each.profile.shaker) return *each.profile.shaker;
  return about_argument("profile", "expected the profile of a shipped pad, since no other one's shaker is known");
}

Result<DeviceProfile> read_profile(const WaleProfile* profile) {
  if (auto given = is_given("profile", profile); !given) return std::move(given).error();
  const auto given = read_sized("profile", profile);
  if (!given) return given.error();
  auto name = read_text("name", given->name);
  if (!name) return std::move(name).error();
  DeviceProfile read{.name = *std::move(name),
                     .workspace_diameter = given->workspace_diameter,
                     .position_counts = given->position_counts,
                     .force_newton = given->force,
                     .force_counts = given->force_counts,
                     .rate = given->rate,
                     .speed_limit = given->speed_limit,
                     .slew = given->slew,
                     .continuous_newton = given->continuous_force,
                     .heating_seconds = given->heating_seconds,
                     .active_watt = given->active_power,
                     .velocity_window = given->velocity_window,
                     .velocity_noise_counts = given->velocity_noise_counts,
                     .patch_width = given->patch_width,
                     .patch_height = given->patch_height,
                     .patch_rim = given->patch_rim,
                     .mass = given->mass,
                     .damping = given->damping,
                     .friction = given->friction,
                     .delay_x = given->delay_x,
                     .delay_y = given->delay_y,
                     .bandwidth_x = given->bandwidth_x,
                     .bandwidth_y = given->bandwidth_y};
  for (const double each : {read.workspace_diameter,
                            read.position_counts,
                            read.force_newton,
                            read.force_counts,
                            read.rate,
                            read.speed_limit,
                            read.slew,
                            read.continuous_newton,
                            read.heating_seconds,
                            read.active_watt,
                            read.velocity_window,
                            read.velocity_noise_counts,
                            read.patch_width,
                            read.patch_height,
                            read.patch_rim,
                            read.mass,
                            read.damping,
                            read.friction,
                            read.delay_x,
                            read.delay_y,
                            read.bandwidth_x,
                            read.bandwidth_y})
    if (!(each >= 0 && each < HUGE_VAL))
      return about_argument("profile", "expected finite figures that are not negative");
  if (!(read.rate >= DeviceProfile::least_rate && read.rate <= DeviceProfile::most_rate))
    return about_argument("rate", "expected 100 to 10000 ticks per second");
  if (given->vibrates != 0) {
    auto shaker = shaker_of(read.name);
    if (!shaker) return std::move(shaker).error();
    read.shaker = *std::move(shaker);
  }
  return read;
}

}  // namespace

Result<PatchOptions> read_options(const WalePatchOptions* options) {
  const auto given = read_sized("options", options);
  if (!given) return given.error();
  PatchOptions read{.at = {given->x, given->y}, .layer = given->layer};
  if (given->width != 0 || given->height != 0) read.size = PatchSize{given->width, given->height, given->rim};
  return read;
}

Result<const Program*> read_program(const WaleProgram* program) {
  if (auto given = is_given("program", program); !given) return std::move(given).error();
  return &program->program;
}

void hand_out_patch(Patch patch, WalePatch** to) {
  if (to != nullptr) hand_out(std::make_unique<WalePatch>(WalePatch{std::move(patch)}), to);
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
    if (shared->has_stage.exchange(true))
      return about_argument("device", "another stage has the device", wale::Code::wrong_moment);
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
    auto added = stage->stage.add(**known, *read);
    if (!added) return std::move(added).error();
    hand_out_patch(*std::move(added), patch);
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
    wale::RunOptions read{.seconds = given->seconds, .virtual_time = given->virtual_time != 0};
    if (given->kept_seconds != 0) read.kept_seconds = given->kept_seconds;
    read.stop = &stage->interrupted;
    const wale::DeviceProfile profile = stage->profile;
    stage->interrupted = false;
    auto done = stage->stage.run(read);  // `stage` may be gone now
    if (!done) return std::move(done).error();
    hand_out_run(*std::move(done), profile, run);
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
    auto done = stage->stage.stop();
    if (!done) return std::move(done).error();
    hand_out_run(*std::move(done), stage->profile, run);
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
    if (auto given = is_stage(stage); !given) return given;
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
    if (auto given = is_stage(stage); !given) return given;
    const std::size_t lost = stage->stage.poll();
    if (dropped != nullptr) *dropped = lost;
    return {};
  });
}
