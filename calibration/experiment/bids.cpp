#include "calibration/experiment/bids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "schema/utf8.hpp"

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* missing = "n/a";
constexpr const char* bids_version = "1.9.0";
constexpr const char* own_design = "WaleDesign";
constexpr const char* own_task = "WaleTask";  // of the sidecar: the name before it became a label

/// A cell: no tabs and line ends, and `n/a` for nothing. A text that is "n/a" itself gets a space, which a reader
/// removes.
std::string cell_of(const std::string& value) {
  if (value.empty()) return missing;
  std::string cell;
  for (const char c : value) cell += c == '\t' || c == '\n' || c == '\r' ? ' ' : c;
  return cell == missing ? " n/a" : cell;
}

std::string value_of(std::string_view cell) {
  if (cell == missing) return {};
  return std::string(cell == " n/a" ? missing : cell);
}

/// "sub-S48_task-crossed_run-2", or an error.
Result<std::string> entities(const TrialTable& table, int run, const char* more = "") {
  const std::string participant = bids_label(table.participant), task = bids_label(table.task);
  if (participant.empty() || task.empty())
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("`{}` has no letter and no digit, of which labels of BIDS consist",
                                         participant.empty() ? table.participant : table.task),
                 .mend = "give it another name"};
  std::string name = fmt::format("sub-{}_task-{}{}", participant, task, more);
  if (run > 0) name += fmt::format("_run-{}", run);
  return name;
}

std::string folder(const TrialTable& table, const char* kind) {
  return fmt::format("sub-{}/{}/", bids_label(table.participant), kind);
}

std::string lines_of(const Json& json) { return json.dump(2) + "\n"; }

bool is_text(std::string_view bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const Character each = decode(bytes, at);
    if (!each.valid || each.code == 0) return false;
    at += each.bytes;
  }
  return true;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

Error damaged(const std::string& name, std::size_t line, std::string sentence, std::string mend = {}) {
  return {.code = Code::damaged_file,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = name, .number = line}};
}

std::string text_in(const Json& from, const char* key) {
  const auto found = from.find(key);
  return found != from.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

std::string bids_label(std::string_view text) {
  std::string label;
  for (const char c : text)
    if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) label += c;
  return label;
}

Result<std::vector<BidsFile>> beh_files(const TrialTable& table, int run) {
  const auto name = entities(table, run);
  if (!name) return name.error();
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) text += (i == 0 ? "" : "\t") + table.columns[i].name;
  text += "\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : "\t") + cell_of(row[i]);
    text += "\n";
  }
  Json sidecar = {{"TaskName", bids_label(table.task)}, {"TaskDescription", table.task_description}};
  sidecar[own_task] = table.task;
  if (!table.instructions.empty()) sidecar["Instructions"] = table.instructions;
  sidecar["WaleDevice"] = table.device;
  sidecar["WaleGrade"] = table.grade;
  if (Json design = Json::parse(table.design, nullptr, false); design.is_object()) sidecar[own_design] = std::move(design);
  for (const TrialColumn& each : table.columns) {
    Json column = {{"Description", each.description}};
    if (!each.units.empty()) column["Units"] = each.units;
    if (!each.levels.empty()) {
      column["Levels"] = Json::object();
      for (const auto& [value, means] : each.levels) column["Levels"][value] = means;
    }
    sidecar[each.name] = std::move(column);
  }
  const std::string path = folder(table, "beh") + *name;
  return std::vector<BidsFile>{{path + "_beh.tsv", std::move(text)}, {path + "_beh.json", lines_of(sidecar)}};
}

std::vector<BidsFile> dataset_files(const std::vector<TrialTable>& tables, const std::string& name,
                                    const std::string& version) {
  Json description = {{"Name", name},
                      {"BIDSVersion", bids_version},
                      {"DatasetType", "raw"},
                      {"GeneratedBy", Json::array({{{"Name", "Wale"}, {"Version", version}}})}};
  std::string participants = "participant_id\tgrade\n";
  std::set<std::string> told;
  for (const TrialTable& each : tables)
    if (told.insert(each.participant).second)
      participants += fmt::format("sub-{}\t{}\n", bids_label(each.participant), cell_of(each.grade));
  const Json of_participants = {
      {"grade",
       {{"Description", "what the answers can be evidence of"},
        {"Levels", {{"measured", "people on a plugged, trusted device"}, {"simulated", "anything else, the worst grade"}}}}}};
  const std::string readme =
      fmt::format("{}: experiments on how forces feel, run by Wale {}.\n\nThe columns of each table are described in the JSON "
                  "file beside it. Participants are identifiers.\nAnswers graded `simulated` come from no person on a real "
                  "device and say nothing about people.\n", name, version);
  return {{"dataset_description.json", lines_of(description)},
          {"participants.tsv", participants},
          {"participants.json", lines_of(of_participants)},
          {"README", readme}};
}

Result<std::vector<BidsFile>> motion_files(const TrialTable& table, int run,
                                           const std::vector<PresentedRecording>& recordings) {
  const auto name = entities(table, run, "_tracksys-handle");
  if (!name) return name.error();
  if (recordings.empty()) return std::vector<BidsFile>();
  const double rate = recordings.front().recording.header().device.rate;
  std::string text;
  const auto number = [](double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string(missing); };
  for (const PresentedRecording& each : recordings) {
    const DeviceProfile& device = each.recording.header().device;
    if (device.rate != rate)
      return Error{.code = Code::other_figures,
                   .sentence = fmt::format("the recordings have different rates: {} Hz and {} Hz", rate, device.rate)};
    for (std::size_t i = 0; i < each.recording.ticks(); ++i) {
      const RecordedTick tick = each.recording.tick(i);
      const double time = each.onset + static_cast<double>(tick.period) / rate;
      const bool known = tick.contact == Contact::good;
      const double place[2] = {tick.counts.x * device.position_step(), tick.counts.y * device.position_step()};
      text += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", number(time), known ? number(place[0]) : missing,
                          known ? number(place[1]) : missing, number(tick.velocity.x), number(tick.velocity.y),
                          number(tick.force.x), number(tick.force.y), number(tick.interaction.x),
                          number(tick.interaction.y), each.trial, each.interval);
    }
  }
  struct Channel {
    const char *name, *component, *type, *point, *units, *description;
  };
  static constexpr Channel channels[] = {
      {"time", "n/a", "LATENCY", "n/a", "s", "since the session began"},
      {"position_x", "x", "POS", "handle", "m", "from the centre of the workspace, to the right"},
      {"position_y", "y", "POS", "handle", "m", "from the centre of the workspace, up"},
      {"velocity_x", "x", "VEL", "handle", "m/s", "filtered"},
      {"velocity_y", "y", "VEL", "handle", "m/s", "filtered"},
      {"force_x", "x", "MISC", "handle", "N", "the actuator's, at the handle"},
      {"force_y", "y", "MISC", "handle", "N", "the actuator's, at the handle"},
      {"interaction_x", "x", "MISC", "handle", "N", "from hand to handle, mean over the period before"},
      {"interaction_y", "y", "MISC", "handle", "N", "from hand to handle, mean over the period before"},
      {"trial", "n/a", "MISC", "n/a", "n/a", "number of the trial"},
      {"interval", "n/a", "MISC", "n/a", "n/a", "of the trial, from 1; 0 where there is one"},
  };
  std::string table_of_channels = "name\tcomponent\ttype\ttracked_point\tunits\tdescription\n";
  for (const Channel& each : channels)
    table_of_channels += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\n", each.name, each.component, each.type, each.point,
                                     each.units, each.description);
  const Json sidecar = {{"TaskName", bids_label(table.task)},
                        {"TrackingSystemName", "handle"},
                        {"SamplingFrequency", rate},
                        {"MotionChannelCount", std::size(channels)},
                        {"POSChannelCount", 2},
                        {"VELChannelCount", 2},
                        {"LATENCYChannelCount", 1},
                        {"MISCChannelCount", 6},
                        {"MissingValues", missing},
                        {"RecordingType", "epoched"},
                        {"DeviceSerialNumber", missing},
                        {"ManufacturersModelName", table.device}};
  const std::string path = folder(table, "motion") + *name;
  return std::vector<BidsFile>{{path + "_motion.tsv", std::move(text)},
                               {path + "_motion.json", lines_of(sidecar)},
                               {path + "_channels.tsv", std::move(table_of_channels)}};
}

Result<TrialTable> read_beh(std::string_view text, std::string_view sidecar, const std::string& name) {
  TrialTable table;
  if (!is_text(text)) return damaged(name, 1, "expected text in UTF-8, found other bytes");
  const Json described = Json::parse(sidecar, nullptr, false);
  if (!described.is_object())
    return damaged(name, 0, "its sidecar is no JSON object", "the sidecar has the table's name with .json");
  if (text_in(described, "TaskName").empty()) return damaged(name, 0, "its sidecar has no TaskName");
  table.task = text_in(described, own_task);
  if (table.task.empty()) table.task = text_in(described, "TaskName");
  table.task_description = text_in(described, "TaskDescription");
  table.instructions = text_in(described, "Instructions");
  table.device = text_in(described, "WaleDevice"), table.grade = text_in(described, "WaleGrade");
  if (const auto design = described.find(own_design); design != described.end() && design->is_object())
    table.design = design->dump();
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte-order mark of a spreadsheet
  std::size_t number = 0;
  while (!text.empty()) {
    ++number;
    const auto end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    const auto cells = split(line, '\t');
    if (number == 1) {
      for (const std::string_view each : cells) {
        if (each.empty()) return damaged(name, number, "a column has no name");
        if (table.column(each)) return damaged(name, number, fmt::format("there are two columns `{}`", each));
        TrialColumn column{std::string(each), {}, {}, {}};
        if (const auto about = described.find(column.name); about != described.end() && about->is_object()) {
          column.description = text_in(*about, "Description"), column.units = text_in(*about, "Units");
          if (const auto levels = about->find("Levels"); levels != about->end() && levels->is_object())
            for (const auto& [value, means] : levels->items())
              column.levels.emplace_back(value, means.is_string() ? means.get<std::string>() : std::string());
        }
        table.columns.push_back(std::move(column));
      }
      continue;
    }
    if (line.empty()) continue;
    if (cells.size() != table.columns.size())
      return damaged(name, number, fmt::format("expected {} cells, found {}", table.columns.size(), cells.size()),
                     "cells are parted by tabs, and a cell without a value is n/a");
    auto& row = table.rows.emplace_back();
    for (const std::string_view each : cells) row.push_back(value_of(each));
  }
  if (number == 0) return damaged(name, 1, "the table is empty", "its first line names the columns");
  if (const auto participant = table.column("participant"); participant && !table.rows.empty())
    table.participant = table.rows.front()[*participant];
  return table;
}

}  // namespace wale
