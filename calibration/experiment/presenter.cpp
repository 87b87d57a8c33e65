#include "calibration/experiment/presenter.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "wale/session_log.hpp"

namespace wale {

std::string DevicePresenter::recording_of(const Program& program, const std::string& wanted) {
  if (options_.recordings.empty()) return {};
  std::string name = wanted;
  if (options_.virtual_time) {
    const std::uint64_t hash = program_hash(program);
    if (const auto known = known_.find(hash); known != known_.end()) return known->second.recording;
    name = fmt::format("{:016x}", hash);
  }
  // A presentation that was broken off may have left a file of this name.
  const auto path_of = [&](const std::string& each) { return options_.recordings + "/" + each + ".wrec"; };
  std::string free = name;
  std::error_code ignored;
  for (int number = 2; std::filesystem::exists(std::filesystem::path(options_.folder) / path_of(free), ignored); ++number)
    free = fmt::format("{}-{}", name, number);
  return path_of(free);
}

Result<FeltSize> DevicePresenter::present(const Program& program, const std::string& recording) {
  const std::uint64_t hash = options_.virtual_time ? program_hash(program) : 0;
  if (options_.virtual_time)
    if (const auto known = known_.find(hash); known != known_.end()) return known->second.felt;
  if (!device_) {
    auto opened = open_(program);
    if (!opened) return opened.error();
    device_ = *std::move(opened);
  }
  StageOptions how = felt_stage_options(options_.most_newton);
  if (options_.virtual_time) how.priority.reset(), how.lock_memory = how.low_latency = false;
  if (!recording.empty()) {
    const std::filesystem::path file = std::filesystem::path(options_.folder) / recording;
    std::error_code failed;
    std::filesystem::create_directories(file.parent_path(), failed);
    how.record = RecordTo{file.string(), device_->name + ", " + device_->hand};
  }
  Result<FeltSize> felt = [&]() -> Result<FeltSize> {
    Stage stage(*device_->device, how);
    if (const auto patch = stage.add(program); !patch) return patch.error();
    const auto run = stage.run({.seconds = options_.seconds, .virtual_time = options_.virtual_time, .stop = options_.stop});
    if (!run) return run.error();
    if (options_.stop && *options_.stop) return Error{.code = Code::stopped, .sentence = "interrupted"};
    if (run->record_problem) return *run->record_problem;
    const double seconds = static_cast<double>(run->ticks_run + run->ticks_missed) * run->record.seconds_per_tick;
    constexpr double enough = 0.5;  // share: a shorter presentation counts as a lost device
    if (seconds < enough * options_.seconds)
      return Error{.code = Code::lost_device, .sentence = fmt::format("the device stopped after {:.1f} s", seconds)};
    return felt_size(run->record);
  }();
  if (device_->plugged == nullptr) device_.reset();
  if (felt && options_.virtual_time) known_[hash] = {*felt, recording};
  return felt;
}

}  // namespace wale
