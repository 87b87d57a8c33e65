#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
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
  double most = HUGE_VAL;                ///< N, on a pad m/s^2: what the person lets through
};

/// A percept that the program has no record of, as `describe` reads it of the force.
struct ReadLevel {
  std::string name;
  double level = 0;
  bool at_least = false;  ///< its carrier is greater than could be read
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
  // For each of `levels`:
  std::vector<double> asked;       ///< the level asked for; negative if none was
  std::vector<float> aimed;        ///< the carrier's size that the program aims at, as far as the device gives it
  std::vector<float> let_through;  ///< of that, what the person's limit lets through
  std::vector<bool> at_least;      ///< the carrier is greater than could be read
  std::vector<std::string> units;  ///< the carrier's unit
  /// the carrier's size that the program itself shows on the hand's way, whatever the device gave; 0 if that is unknown
  std::vector<float> shown;
  /// Percepts that `describe` reads of the force besides those of `levels`, and their levels.
  std::vector<ReadLevel> read;
  double largest = 0, largest_at = 0;  ///< N: the largest force that the device was told, and when, s
  double settling = 0;                 ///< s at the beginning that the measured figures leave out
  /// s: about how long such a run must be for the hand to cross the texture often enough, if it did not; infinite if it
  /// crossed nothing.
  std::optional<double> needed_seconds;
  /// The motion of a hand that crosses the texture more often, "lateral along y"; empty if that of the run does as
  /// well.
  std::string crossing_motion;
  /// Whether the program has a relief at all: of another force, such as a vibration, the crossings are no texture's.
  bool has_relief = true;
  /// Whether that relief is the whole force, so that the swings of the force are its flanks. Beside other forces they
  /// are not, and the number of crossings is not told.
  bool crossings_counted = true;
};

/// The least number of crossings that a texture needs to be read back.
inline constexpr long least_crossings = 50;

/// Of a run whose hand moves over the texture, the seconds after which it is long enough. Longer runs are not proposed.
inline constexpr double longest_proposed_run = 60;

/// Measures a run, without its first part, in which forces slew in and the hand comes up to speed.
FeltReport felt_report(const Bank& bank, const RunResult& run, const DeviceProfile& device, RunManner manner);

/// Reads the run as `describe` reads the program. The level of a percept is that of the size which `describe` reads,
/// times the share of it that came to the handle: of what the program shows on the hand's way, if that is known. What
/// `describe` does not tell has no level, and what it tells besides is added; and the motion that crosses the texture.
void tell_read_percepts(FeltReport& report, const Bank& bank, const Declarations& declarations);

std::string felt_text(const FeltReport& report);
std::string felt_json(const FeltReport& report);

/// The live line of a run: time, place, speed and force, or a pad's amplitude and frequency.
std::string progress_line(const Now& now, bool vibrates = false);

}  // namespace wale
