#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/device/hot_plugged_device.hpp"
#include "wale/felt.hpp"
#include "wale/stage.hpp"

namespace wale {

/// The conditions of a run, for the report.
struct RunManner {
  std::string device;  ///< "simulated"
  std::string hand;    ///< "lateral", or the trace's file
  bool virtual_time = false;
  std::optional<HotPlugReport> plugged;  ///< of a real device
  long versions = 1;                     ///< of a watched file, that were felt one after the other
};

/// The measured force at the handle, and the force that the program aims at.
struct FeltReport {
  std::string material;
  RunManner manner;
  DeviceProfile device;
  double seconds = 0;
  long ticks_run = 0, ticks_missed = 0;
  Lateness lateness;
  std::optional<TickCosts> costs;  ///< nothing in virtual time
  GuardCounts guards;
  std::string scheduling;
  Felt felt;
  float predicted_amplitude = 0;  ///< N, of a pad m/s^2; 0 when no percept of the program predicts one
  std::vector<LevelBack> levels;
  std::vector<double> asked;  ///< for each of `levels` the level asked for; negative if none was
};

/// The least number of crossings that a texture needs to be read back.
inline constexpr long least_crossings = 50;

/// Measures a run, without its first part, in which forces slew in and the hand comes up to speed.
FeltReport felt_report(const Bank& bank, const RunResult& run, const DeviceProfile& device, RunManner manner);

std::string felt_text(const FeltReport& report);
std::string felt_json(const FeltReport& report);

/// The live line of a run: time, place, speed and force, or a pad's amplitude and frequency.
std::string progress_line(const Progress& now, bool vibrates = false);

}  // namespace wale
