#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/feel/blind_comparison.hpp"
#include "calibration/feel/felt_report.hpp"
#include "compiler/command/command.hpp"
#include "wale/device.hpp"

/// The verbs that run materials on devices.
namespace wale::command {

struct FeelOptions {
  Choice choice;
  std::vector<std::string> settings;
  std::string device;               ///< empty: `auto`
  std::string built_for;            ///< empty: whatever suits the device
  std::optional<std::string> hand;  ///< the simulated one's motion
  std::string record;
  std::optional<double> seconds;
  bool virtual_time = false, json = false, watch = false;
  std::string max_force;
  std::string against;
  bool blind = false;
  int trials = BlindOptions{}.trials;
  std::optional<std::uint64_t> seed;
};

/// On what it is felt, which is up to those who know the devices.
struct FeltOn {
  bool is_felt = true;  ///< otherwise forces are only shown
  /// What to build, and for what: the device that is to be felt on, where one is named.
  std::function<Choice(Choice)> built;
  /// The device; null when what is wrong has been printed.
  std::function<std::unique_ptr<Device>(const PatchProgram&)> open;
  /// How a run on it was made.
  std::function<RunManner(const Device&)> manner;
};

/// Runs a material and measures it. `stop` is set when the person ends it; so it may last as long as they like when a
/// file is watched.
int feel(const FeelOptions& options, const FeltOn& on, const std::atomic<bool>& stop);

/// Which of two was A?
int feel_blind(const FeelOptions& options, const FeltOn& on, const std::atomic<bool>& stop);

struct ReplayOptions {
  std::string file, csv, wav;
  std::optional<std::size_t> ticks;  ///< no more than so many
  bool json = false;
};

/// Plays a recording again, says whether it comes out the same, and writes it in other forms.
int replay(const ReplayOptions& options);

}  // namespace wale::command
