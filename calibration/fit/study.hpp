#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "calibration/analysis/table.hpp"
#include "wale/result.hpp"

namespace wale {

/// A file of trials as it was read.
struct StudyFile {
  std::string path;
  const char* form = "";   ///< "log", "BIDS table", "table"
  std::uint64_t hash = 0;  ///< FNV-1a, 64 bits, of its bytes
};

/// The trials of a study and what their files say about themselves. Texts that no file says are empty.
struct Study {
  std::vector<StudyFile> files;
  std::vector<analysis::Table> tables;  ///< one for each file
  std::string experiment, task;         ///< "crossed", "magnitude_estimation"
  std::string design;                   ///< as written, with the materials of its file
  std::string design_file;              ///< the file that was presented
  std::string device;
  std::string first_day, last_day;           ///< of the data, UTC: "2026-11-24"
  std::set<std::string> versions;            ///< "wale 0.1.0"
  std::set<std::uint64_t> programs;          ///< hashes of all that was felt
  std::vector<std::string> varied;           ///< columns of numbers that were varied, in their order
  std::vector<std::string> words;            ///< columns of words that were varied
  std::map<std::string, std::string> units;  ///< of columns, SI
  bool simulated = false;                    ///< what describes a table says so, whatever its rows say
  std::vector<std::string> notes;            ///< what a reader of the results should know
};

/// Reads logs of `wale experiment run`, tables of BIDS with the description beside them, and any other tables.
/// `stimuli` names a table with the sizes of stimuli that are named in a column `stimulus`; empty for none.
///
/// Errors: W0501 and W0502 for files that cannot be read, those of `open_session_log`, `trial_table` and `read_table`;
/// W0801 for a file that is there twice, files of two experiments, and stimuli that the table of stimuli lacks.
Result<Study> read_study(const std::vector<std::string>& paths, const std::string& stimuli);

/// What the design of a file adds where its trials do not say it: task, units, columns that were varied.
struct DesignFacts {
  std::string experiment, task;
  std::vector<std::string> varied, words;
  std::map<std::string, std::string> units;
};
void add_design(Study& study, const DesignFacts& design);

}  // namespace wale
