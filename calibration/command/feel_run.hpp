#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibration/feel/blind_comparison.hpp"
#include "calibration/feel/felt_device.hpp"
#include "calibration/feel/felt_workspace.hpp"
#include "compiler/command/command.hpp"

/// What the kinds of runs of `wale feel` share: the device, the material and the options of a run.
namespace wale::command {

struct FeelOptions {
  Choice choice;
  std::vector<std::string> settings;
  std::vector<std::string> trusted;  ///< files whose declarations may scale a real device
  std::string workspace;             ///< to feel instead of a material; empty for none
  std::string device;                ///< empty: `auto`
  std::string built_for;             ///< empty: the device that is felt on
  std::optional<std::string> hand;   ///< how a simulated person moves
  std::string transport;             ///< of a real device; empty: its driver chooses
  std::string record;
  std::optional<double> seconds, max_force;
  bool virtual_time = false, json = false, watch = false;
  std::string against;
  bool blind = false;
  std::optional<std::uint64_t> trials, seed;
};

/// Tells the person something on standard error.
void say(const std::string& what);

/// A material to feel, with its parameters as set. Errors: those of `chosen_parameters`.
Result<BlindMaterial> material_to_feel(const Program& program, const std::vector<std::string>& settings);

/// A material or a workspace, and the device that it is built for and felt on.
struct PreparedRun {
  DeviceToFeel device;
  Choice built;               ///< of the material, with that device
  BlindMaterial material;     ///< of a workspace, that of its first patch
  Workspace workspace;  ///< without patches if a material is felt
};

/// Opens and checks the file, chooses the device among those that the file knows, and compiles the material or the
/// workspace for it.
OrStatus<PreparedRun> prepared(const FeelOptions& options, const std::atomic<bool>& stop);

/// Opens the device of a prepared run.
OrStatus<FeltDevice> open_prepared(const FeelOptions& options, const PreparedRun& run, const std::atomic<bool>& stop);

/// s; of a run whose length is not given.
inline constexpr double usual_seconds = 5;
/// s; of a watched or recorded run, which may be long, only the last part is measured.
inline constexpr double measured_seconds = 600;

/// How the stage runs, and what it records.
StageOptions stage_options(const FeelOptions& options, const RunManner& manner);
/// How long the run takes, and what is kept of it.
RunOptions run_options(const FeelOptions& options, const std::atomic<bool>& stop);

/// Opens the table of a run before it, so that no run is lost to a table that cannot be written. Nothing if the person
/// asked for none.
Result<std::optional<OutputFile>> table_of(const FeelOptions& options);

/// Whether the file to feel is a workspace file (.wws).
bool is_workspace_file(const FeelOptions& options);

/// Feels a workspace and reports which of its patches the hand was on. Returns the exit status.
int feel_workspace(const FeelOptions& options, const std::atomic<bool>& stop);

}  // namespace wale::command
