#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calibration/experiment/trial_table.hpp"
#include "wale/recording.hpp"

namespace wale {

/// A file of a BIDS data set (Brain Imaging Data Structure, behavioural and motion data).
struct BidsFile {
  std::string path;  ///< in the data set: "sub-S48/beh/sub-S48_task-crossed_beh.tsv"
  std::string text;
};

/// A BIDS label: the letters and digits of a text. Empty if it has none.
std::string bids_label(std::string_view text);

/// The `_beh.tsv` of a session and its sidecar, which describes all columns. `run` numbers the sessions of a participant
/// in one task, from 1; 0 where there is only one. Error: `malformed_value` for a participant or a task without a letter
/// or digit.
Result<std::vector<BidsFile>> beh_files(const TrialTable& table, int run);

/// What the data set as a whole needs: `dataset_description.json`, `participants.tsv` with its sidecar, and `README`.
std::vector<BidsFile> dataset_files(const std::vector<TrialTable>& tables, const std::string& name,
                                    const std::string& version);

/// A recording, and the place of its presentation in the session.
struct PresentedRecording {
  std::uint32_t trial = 0, interval = 0;
  double onset = 0;  ///< s since the session began
  Recording recording;
};

/// The hand's motion and the forces of a session as `_motion.tsv` without a header, its `_channels.tsv` and its sidecar:
/// time, place, velocity, the actuator's force, that between hand and handle, trial and interval. Errors: as above;
/// `other_figures` if the recordings have different rates.
Result<std::vector<BidsFile>> motion_files(const TrialTable& table, int run,
                                           const std::vector<PresentedRecording>& recordings);

/// Reads a `_beh.tsv` and its sidecar back. `name` is the table's file, for errors. Errors: `damaged_file` with file and
/// line: no header, a column without a name or there twice, a row with more or fewer cells, bytes that are no UTF-8; a
/// sidecar that is no JSON object or lacks `TaskName`.
Result<TrialTable> read_beh(std::string_view table, std::string_view sidecar, const std::string& name);

}  // namespace wale
