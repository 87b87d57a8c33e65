#pragma once

#include <string>
#include <vector>

#include "calibration/feel/felt_report.hpp"
#include "wale/stage.hpp"
#include "wale/workspace.hpp"

namespace wale {

/// A patch during a run.
struct PatchVisits {
  std::string name;
  long entries = 0;    ///< times that the hand came onto it
  double seconds = 0;  ///< that the hand was on it
  double largest = 0;  ///< N, the actuator's largest force meanwhile; of a pad m/s^2
  double typical = 0;  ///< N, its root mean square
};

/// A run on a workspace.
struct WorkspaceReport {
  std::string workspace;
  RunManner manner;
  double seconds = 0, outside = 0;  ///< s: of the run, and of it beside all patches
  long ticks_run = 0, ticks_missed = 0;
  std::vector<PatchVisits> patches;  ///< in their order
};

/// Notes the contacts of a stage during a run and tells each tick which patch the hand was on. It must outlive the run.
class VisitedPatches {
 public:
  VisitedPatches(Stage& stage, std::vector<Patch> patches);
  /// Takes the contacts so far; called often enough that none is dropped, and after the run.
  void poll() { dropped_ += stage_.poll(); }
  WorkspaceReport report(const Workspace& workspace, const RunResult& run, RunManner manner) const;

 private:
  Stage& stage_;
  std::vector<Patch> patches_;
  std::vector<ContactEvent> contacts_;  ///< that begin or end
  std::size_t dropped_ = 0;
};

std::string workspace_report_text(const WorkspaceReport& report);
std::string workspace_report_json(const WorkspaceReport& report);

}  // namespace wale
