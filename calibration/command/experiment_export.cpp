#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "calibration/experiment/bids.hpp"
#include "compiler/command/command.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/text/resolver.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct ExperimentExportOptions {
  std::vector<std::string> logs;
  std::string out;
  bool without_motion = false;
};

/// Whether a folder may get the files of a data set: it is new or empty, or holds one that Wale has written. Other files
/// of these names, such as a README, are somebody's work.
Result<> is_for_data_set(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code failed;
  if (!fs::exists(folder, failed) || (fs::is_directory(folder, failed) && fs::is_empty(folder, failed))) return {};
  if (const auto described = read_file((fs::path(folder) / "dataset_description.json").string())) {
    const auto description = nlohmann::json::parse(described->bytes, nullptr, false);
    if (description.is_object() && description.contains("GeneratedBy") && description["GeneratedBy"].is_array())
      for (const auto& each : description["GeneratedBy"])
        if (each.is_object() && each.value("Name", nlohmann::json()) == "Wale") return {};
  }
  return Error{.code = Code::unwritable_file,
               .sentence = "the folder holds other files than those of a data set of Wale's",
               .mend = "name a new or an empty folder",
               .place = {.name = folder}};
}

/// The recordings of a session that lie beside its log, in the order of the presentations. Those that are missing are
/// told: a study may have been copied without them.
std::vector<PresentedRecording> recordings_of(const SessionRecord& record, const std::string& log) {
  std::vector<PresentedRecording> all;
  std::map<std::string, Result<Recording>> known;
  std::size_t lost = 0;
  for (const SessionEntry& entry : record.entries) {
    const auto* shown = std::get_if<SessionShown>(&entry.event);
    if (shown == nullptr || shown->recording.empty()) continue;
    const auto path = std::filesystem::path(log).parent_path() / shown->recording;
    const auto [found, is_new] = known.try_emplace(shown->recording, Error{});
    if (is_new) found->second = Recording::open(path.string());
    if (found->second) all.push_back({shown->number, shown->interval, entry.seconds, *found->second});
    else ++lost;
  }
  if (lost > 0)
    print_error(readable("wale: {} presentations of {} have no readable recording, and no motion\n", lost, visible_text(log)));
  return all;
}

int experiment_export(const ExperimentExportOptions& options) {
  std::vector<TrialTable> tables;
  std::vector<BidsFile> files;
  std::vector<SessionRecord> records;
  std::map<std::pair<std::string, std::string>, int> sessions, numbers;
  std::set<std::string> seen;
  for (const std::string& log : options.logs) {
    std::error_code ignored;
    if (!seen.insert(std::filesystem::weakly_canonical(log, ignored).string()).second)
      return refuse(Error{.code = Code::malformed_value, .sentence = "the log is named twice", .place = {.name = log}});
    auto record = open_session_log(log);
    if (!record) return refuse(record.error());
    for (const Error& each : record->problems) warn(each);
    auto table = trial_table(*record, log);
    if (!table) return refuse(table.error());
    // The recordings are no files of the data set; the motion of the handle is.
    if (const auto column = table->column("stim_file")) {
      const auto at = static_cast<std::ptrdiff_t>(*column);
      table->columns.erase(table->columns.begin() + at);
      for (auto& row : table->rows) row.erase(row.begin() + at);
    }
    ++sessions[{bids_label(table->participant), bids_label(table->task)}];
    tables.push_back(*std::move(table)), records.push_back(*std::move(record));
  }
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::pair key{bids_label(tables[i].participant), bids_label(tables[i].task)};
    const int run = sessions[key] > 1 ? ++numbers[key] : 0;
    auto made = beh_files(tables[i], run);
    if (!made) return refuse(made.error());
    files.insert(files.end(), std::make_move_iterator(made->begin()), std::make_move_iterator(made->end()));
    if (options.without_motion) continue;
    auto motion = motion_files(tables[i], run, recordings_of(records[i], options.logs[i]));
    if (!motion) return refuse(motion.error());
    files.insert(files.end(), std::make_move_iterator(motion->begin()), std::make_move_iterator(motion->end()));
  }
  const auto common = dataset_files(tables, tables.front().task, WALE_VERSION);
  files.insert(files.begin(), common.begin(), common.end());  // first, so that an export cut short may be made again
  if (const auto done = is_for_data_set(options.out); !done) return refuse(done.error());
  for (const BidsFile& each : files) {
    const std::filesystem::path path = std::filesystem::path(options.out) / each.path;
    std::error_code failed;
    // A README is there for people to go on with.
    if (each.path == "README" && std::filesystem::exists(path, failed)) continue;
    std::filesystem::create_directories(path.parent_path(), failed);
    if (failed)
      return refuse(Error{.code = Code::unwritable_file,
                          .sentence = "the folder cannot be made: " + failed.message(),
                          .place = {.name = path.parent_path().string()}});
    if (const auto written = write_file(path.string(), each.text, options.logs); !written) return refuse(written.error());
  }
  std::size_t trials = 0;
  for (const TrialTable& each : tables) trials += each.rows.size();
  print_out("{}\n", readable("{} session{}, {} rows, {} files in {}", tables.size(), tables.size() == 1 ? "" : "s", trials,
                             files.size(), visible_text(options.out)));
  return done;
}

Run declare_experiment_export(CLI::App& verb) {
  const auto options = std::make_shared<ExperimentExportOptions>();
  must_say(verb.add_option("LOG", options->logs, "logs of `wale experiment run`"), "the path of a log")->required();
  must_say(verb.add_option("-o,--output", options->out, "the folder of the data set, which is made if it is not there")
               ->type_name("FOLDER"),
           "the path of a folder")
      ->required();
  verb.add_flag("--without-motion", options->without_motion, "leaves the hand's motion and the forces out");
  verb.footer(
      "Writes a data set in the Brain Imaging Data Structure: for each session a table of trials (_beh.tsv) with a\n"
      "description of its columns, and the motion of the handle (_tracksys-handle_motion.tsv) from the recordings.\n"
      "for example: wale experiment export crossed-*.trials -o study");
  return [options] { return experiment_export(*options); };
}

}  // namespace

extern const Verb experiment_export_verb{"experiment-export", "makes tables of trials, in the form of BIDS, from logs",
                                         declare_experiment_export};

}  // namespace wale::command
