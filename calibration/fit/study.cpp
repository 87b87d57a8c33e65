#include "calibration/fit/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <unordered_map>

#include "calibration/analysis/trials.hpp"
#include "calibration/experiment/bids.hpp"
#include "calibration/experiment/trial_table.hpp"
#include "compiler/text/resolver.hpp"
#include "schema/visible_text.hpp"
#include "wale/session_log.hpp"

namespace wale {
namespace {

using analysis::Table;

constexpr std::size_t most_bytes = std::size_t{1} << 30;

std::uint64_t hash_of(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

Result<std::string> bytes_in(const std::string& path) {
  auto file = read_file(path, most_bytes);
  if (!file) return std::move(file).error();
  return std::move(file->bytes);
}

/// A cell of a table that is parted by tabs.
std::string cell_of(std::string_view value) {
  if (value.empty()) return "n/a";
  if (value.find_first_of("\t\n\r\"") == std::string_view::npos) return std::string(value);
  std::string cell = "\"";
  for (const char c : value) {
    if (c == '"') cell += '"';
    cell += c == '\t' || c == '\n' || c == '\r' ? ' ' : c;
  }
  return cell + '"';
}

bool is_all_numbers(const Table& table, std::size_t column) {
  std::size_t numbers = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string_view cell = table.cell(row, column);
    if (analysis::is_missing(cell)) continue;
    if (!analysis::number_in(cell)) return false;
    ++numbers;
  }
  return numbers > 0;
}

/// Reads the files of one study, one after the other.
class StudyReader {
 public:
  explicit StudyReader(const std::string& stimuli) : stimuli_path_(stimuli) {}

  Result<Study> read(const std::vector<std::string>& paths) {
    if (!stimuli_path_.empty()) {
      auto bytes = bytes_in(stimuli_path_);
      if (!bytes) return std::move(bytes).error();
      auto table = analysis::read_table(stimuli_path_, *std::move(bytes));
      if (!table) return table.error();
      stimuli_ = *std::move(table);
      const auto names = stimuli_->column("stimulus");
      if (!names)
        return analysis::table_error(*stimuli_, 0, "the table of stimuli has no column `stimulus`",
                                     "name the stimuli there as the design does");
      for (std::size_t row = 0; row < stimuli_->rows(); ++row)
        if (!stimulus_rows_.try_emplace(std::string(stimuli_->cell(row, *names)), row).second)
          return analysis::table_error(*stimuli_, row, "this stimulus is there twice", "keep one of them");
    }
    for (const std::string& path : paths)
      if (const auto done = add(path); !done) return done.error();
    study_.versions = std::move(versions_);
    return std::move(study_);
  }

 private:
  Result<> add(const std::string& path) {
    auto bytes = bytes_in(path);
    if (!bytes) return bytes.error();
    const std::uint64_t hash = hash_of(*bytes);
    for (const StudyFile& each : study_.files)
      if (each.hash == hash)
        return Error{.code = Code::malformed_value,
                     .sentence = fmt::format("this file has the same trials as `{}`", visible_text(each.path)),
                     .mend = "name each file once",
                     .place = {.name = path}};
    const std::filesystem::path sidecar = std::filesystem::path(path).replace_extension(".json");
    std::error_code ignored;
    if (bytes->starts_with("{\"line\":")) {
      study_.files.push_back({path, "log", hash});
      return add_log(path, *bytes);
    }
    if (is_of_bids(path) && std::filesystem::exists(sidecar, ignored) && sidecar != path) {
      study_.files.push_back({path, "BIDS table", hash});
      return add_described(path, *std::move(bytes), sidecar.string());
    }
    study_.files.push_back({path, "table", hash});
    return add_table(path, *std::move(bytes));
  }

  /// Whether a file's name is one of BIDS, so that the .json beside it describes it: sub-S1_task-crossed_beh.tsv.
  static bool is_of_bids(const std::string& path) {
    const std::string name = std::filesystem::path(path).filename().string();
    return name.ends_with("_beh.tsv") || name.ends_with("_events.tsv");
  }

  Result<> add_log(const std::string& path, const std::string& bytes) {
    const auto record = read_session_log(bytes, path);
    if (!record) return record.error();
    const auto table = trial_table(*record, path);
    if (!table) return table.error();
    if (const auto same = is_of(path, table->task, table->task_description); !same) return same;
    for (const Error& each : record->problems)
      study_.notes.push_back(
          fmt::format("{}:{}: {}", visible_text(path), each.place.number.value_or(0), each.sentence));
    if (!record->ended())
      study_.notes.push_back(visible_text(path) + ": the session was broken off, and is not finished");
    std::size_t resumed = 0;
    for (const SessionEntry& entry : record->entries) {
      const std::string day = entry.time.substr(0, std::min<std::size_t>(10, entry.time.size()));
      note_day(day);
      if (const auto* begin = std::get_if<SessionBegin>(&entry.event)) {
        for (const auto& [name, version] : begin->versions) versions_.insert(visible_text(name + " " + version));
        if (study_.design_file.empty()) study_.design_file = begin->file;
      } else if (const auto* program = std::get_if<SessionProgram>(&entry.event)) {
        study_.programs.insert(program->hash);
        note_felt(path, *program);
      } else if (std::holds_alternative<SessionResumed>(entry.event)) {
        ++resumed;
      } else if (const auto* other = std::get_if<SessionOther>(&entry.event); other && other->event == "design") {
        const auto fields = nlohmann::json::parse(other->fields, nullptr, false);
        if (const auto same = is_designed_alike(path, fields); !same) return same;
      }
    }
    if (resumed > 0)
      study_.notes.push_back(fmt::format("{}: the session was interrupted {}, and went on", visible_text(path),
                                         resumed == 1 ? "once" : fmt::format("{} times", resumed)));
    study_.device = table->device;
    std::string text;
    for (std::size_t i = 0; i < table->columns.size(); ++i) text += (i == 0 ? "" : "\t") + table->columns[i].name;
    text += '\n';
    for (const auto& row : table->rows) {
      for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : "\t") + cell_of(row[i]);
      text += '\n';
    }
    if (table->rows.empty())
      return Error{.code = Code::malformed_value,
                   .sentence = "no trial of this session has begun",
                   .mend = "leave the file out",
                   .place = {.name = path}};
    if (const auto same = is_asked_alike(path, *table); !same) return same;
    if (const auto units = take_units(table->columns, path); !units) return units;
    return add_table(path, std::move(text));
  }

  Result<> add_described(const std::string& path, std::string bytes, const std::string& sidecar) {
    const auto described = bytes_in(sidecar);
    if (!described) return described.error();
    const auto table = read_beh(bytes, *described, path);
    if (!table) return table.error();
    if (const auto same = is_of(path, table->task, table->task_description); !same) return same;
    if (!table->device.empty()) study_.device = table->device;
    const auto grade = analysis::grade_in(table->grade);
    if (!grade)
      return Error{.code = Code::malformed_value,
                   .sentence = fmt::format("expected measured or simulated for WaleGrade, found `{}`", visible_text(table->grade)),
                   .mend = "write one of the two, or leave it out",
                   .place = {.name = sidecar}};
    study_.simulated |= *grade == analysis::GradeWord::simulated || analysis::is_unfelt_device(table->device);
    if (!table->design.empty())
      if (const auto same = is_designed_alike(path, nlohmann::json::parse(table->design, nullptr, false)); !same) return same;
    if (const auto same = is_asked_alike(path, *table); !same) return same;
    if (const auto units = take_units(table->columns, path); !units) return units;
    return add_table(path, std::move(bytes));
  }

  Result<> take_units(const std::vector<TrialColumn>& columns, const std::string& path) {
    for (const TrialColumn& each : columns) {
      if (each.units.empty() || each.units == "s") continue;
      const auto [known, is_new] = study_.units.try_emplace(each.name, each.units);
      if (!is_new && known->second != each.units)
        return Error{
            .code = Code::malformed_value,
            .sentence = fmt::format("the unit of `{}` is {} here and {} in the files before", visible_text(each.name),
                                    visible_text(each.units), visible_text(known->second)),
            .mend = "analyse files with one unit",
            .place = {.name = path}};
    }
    return {};
  }

  /// Files of one study are of one experiment.
  Result<> is_of(const std::string& path, const std::string& experiment, const std::string& task) {
    if (study_.experiment.empty()) study_.experiment = experiment, study_.task = task;
    if (study_.experiment == experiment && study_.task == task) return {};
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("this file is of the experiment `{}`, and the files before are of `{}`",
                                         visible_text(experiment), visible_text(study_.experiment)),
                 .mend = "analyse each experiment alone",
                 .place = {.name = path}};
  }

  /// Sessions of one study ask the same about the same for as long. Other changes of the design are noted.
  Result<> is_designed_alike(const std::string& path, const nlohmann::json& fields) {
    if (!fields.is_object()) return {};
    if (design_.empty()) {
      design_ = fields, design_path_ = path;
      if (const auto text = fields.find("text"); text != fields.end() && text->is_string())
        study_.design = text->get<std::string>();
      return {};
    }
    static const std::pair<const char*, const char*> parts[] = {
        {"task", "task"},       {"method", "method"}, {"questions", "questions"}, {"presentation_seconds", "time of a presentation"},
        {"modulus", "modulus"}, {"over", "factor that is sought"}, {"motion", "motion of the hand"}, {"grip", "grip"}};
    for (const auto& [key, words] : parts) {
      const auto here = fields.find(key);
      const auto before = std::as_const(design_).find(key);
      const bool has = here != fields.end(), had = before != std::as_const(design_).end();
      if (has == had && (!has || *here == *before)) continue;
      return other_design(path, fmt::format("this session differs from `{}` in its {}", visible_text(design_path_), words));
    }
    const auto text_of = [](const nlohmann::json& design) { return design.value("text", std::string()); };
    if (!text_of(fields).empty() && !text_of(design_).empty() && text_of(fields) != text_of(design_))
      study_.notes.push_back(fmt::format("{}: the text of the design is not that of {}; task, questions, method and "
                                         "presentation are the same",
                                         visible_text(path), visible_text(design_path_)));
    if (fields.value("practice", 0) != design_.value("practice", 0))
      study_.notes.push_back(fmt::format("{}: there was another number of practice trials than in {}",
                                         visible_text(path), visible_text(design_path_)));
    return {};
  }

  /// The same of what every table says: its question, and what was varied. Tables of other programs say no more.
  Result<> is_asked_alike(const std::string& path, const TrialTable& table) {
    std::vector<std::string> varied;
    const auto stimulus = table.column("stimulus");
    for (std::size_t i = stimulus ? *stimulus + 1 : table.columns.size(); i < table.columns.size(); ++i) {
      if (ends_varied(table.columns[i].name)) break;
      varied.push_back(table.columns[i].name);
    }
    if (!asked_) {
      asked_ = AskedIn{path, table.instructions, std::move(varied)};
      return {};
    }
    if (!table.instructions.empty() && !asked_->question.empty() && table.instructions != asked_->question)
      return other_design(path, fmt::format("the question was \"{}\" here and \"{}\" in `{}`",
                                            visible_text(table.instructions), visible_text(asked_->question),
                                            visible_text(asked_->path)));
    if (asked_->question.empty()) asked_->question = table.instructions;
    if (varied == asked_->varied) return {};
    const auto list = [](const std::vector<std::string>& names) {
      std::string text;
      for (const std::string& each : names) text += (text.empty() ? "`" : ", `") + visible_text(each) + "`";
      return text.empty() ? std::string("nothing") : text;
    };
    return other_design(path, fmt::format("{} was varied here, and {} in `{}`", list(varied), list(asked_->varied),
                                          visible_text(asked_->path)));
  }

  static bool ends_varied(std::string_view name) {
    return name == "standard" || name == "target" || name == "response" || name == "groups";
  }

  /// Tables that nothing describes: PsychoPy's name the experiment in each row, and all have columns.
  Result<> is_of_one_kind(const Table& table) {
    if (const auto column = table.column("expName"))
      for (std::size_t row = 0; row < table.rows(); ++row) {
        const std::string name(table.cell(row, *column));
        if (analysis::is_missing(name)) continue;
        if (psychopy_name_.empty()) psychopy_name_ = name;
        if (name != psychopy_name_)
          return analysis::table_error(table, row,
                                       fmt::format("this row is of the experiment `{}`, and those before are of `{}`",
                                                   visible_text(name), visible_text(psychopy_name_)),
                                       "analyse each experiment alone, in files of its own");
      }
    if (study_.tables.empty()) return {};
    const Table& first = study_.tables.front();
    std::string only;
    std::size_t count = 0;
    const auto add_missing = [&](const Table& has, const Table& lacks) {
      for (const std::string& name : has.columns())
        if (!lacks.column(name) && ++count <= 5) only += (only.empty() ? "`" : ", `") + visible_text(name) + "`";
    };
    add_missing(table, first), add_missing(first, table);
    if (count > 0)
      study_.notes.push_back(fmt::format("{}: its columns are not those of {}: {}{} {} in one of them only",
                                         visible_text(table.file()), visible_text(first.file()), only,
                                         count > 5 ? fmt::format(" and {} more", count - 5) : std::string(),
                                         count == 1 ? "is" : "are"));
    return {};
  }

  /// Notes stimuli of one name that were other programs, which a change of the design's text makes too.
  void note_felt(const std::string& path, const SessionProgram& program) {
    const auto [known, is_new] = felt_.try_emplace(program.patch, program.hash, path);
    if (is_new || known->second.first == program.hash || known->second.second == path || noted_ == path) return;
    noted_ = path;
    study_.notes.push_back(fmt::format("{}: `{}` was another program than in {}: look whether both felt alike",
                                       visible_text(path), visible_text(program.patch),
                                       visible_text(known->second.second)));
  }

  Error other_design(const std::string& path, std::string sentence) const {
    return {.code = Code::malformed_value,
            .sentence = std::move(sentence),
            .mend = "analyse each design alone: what was asked and felt otherwise is another experiment",
            .place = {.name = path}};
  }

  void note_day(const std::string& day) {
    if (day.size() != 10 || !analysis::number_in(day.substr(0, 4)) || day[4] != '-' || day[7] != '-') return;
    if (study_.first_day.empty() || day < study_.first_day) study_.first_day = day;
    study_.last_day = std::max(study_.last_day, day);
  }

  Result<> add_table(const std::string& path, std::string text) {
    auto table = analysis::read_table(path, std::move(text));
    if (!table) return table.error();
    if (stimuli_) {
      auto joined = with_stimuli(*table);
      if (!joined) return joined.error();
      table = std::move(joined);
    }
    if (study_.files.back().form == std::string_view("table"))
      if (const auto same = is_of_one_kind(*table); !same) return same;
    if (const auto date = table->column("date"))  // as PsychoPy writes it: 2026-11-24_14h03.11.123
      for (std::size_t row = 0; row < table->rows(); ++row)
        note_day(std::string(table->cell(row, *date).substr(0, 10)));
    if (study_.varied.empty() && study_.words.empty()) find_varied(*table);
    study_.tables.push_back(*std::move(table));
    return {};
  }

  /// Columns between `stimulus` and the answer are what a design varies.
  void find_varied(const Table& table) {
    const auto stimulus = table.column("stimulus");
    for (std::size_t i = stimulus ? *stimulus + 1 : table.columns().size(); i < table.columns().size(); ++i) {
      const std::string& name = table.columns()[i];
      if (ends_varied(name)) break;
      (is_all_numbers(table, i) ? study_.varied : study_.words).push_back(name);
    }
    if (stimuli_)
      for (std::size_t i = 0; i < stimuli_->columns().size(); ++i)
        if (stimuli_->columns()[i] != "stimulus")
          (is_all_numbers(*stimuli_, i) ? study_.varied : study_.words).push_back(stimuli_->columns()[i]);
  }

  /// The same table with the columns of the table of stimuli at its end.
  Result<Table> with_stimuli(const Table& table) const {
    const auto column = table.column("stimulus");
    if (!column)
      return analysis::table_error(table, 0, "this table has no column `stimulus`, by which sizes could be found",
                                   "leave --stimuli out");
    std::string text;
    for (const std::string& name : table.columns()) text += cell_of(name) + "\t";
    std::vector<std::size_t> added;
    for (std::size_t i = 0; i < stimuli_->columns().size(); ++i)
      if (stimuli_->columns()[i] != "stimulus") {
        if (table.column(stimuli_->columns()[i]))
          return analysis::table_error(
              *stimuli_, 0, fmt::format("the trials have a column `{}` too", visible_text(stimuli_->columns()[i])),
              "leave it out, or call it otherwise");
        text += (added.empty() ? "" : "\t") + cell_of(stimuli_->columns()[i]);
        added.push_back(i);
      }
    text += '\n';
    std::size_t line = table.line(0) - 1;  // rows keep their lines, so that errors name those of the file
    if (line > 1) text.insert(0, std::string(line - 1, '\n'));
    for (std::size_t row = 0; row < table.rows(); ++row) {
      for (++line; line < table.line(row); ++line) text += '\n';
      const auto found = stimulus_rows_.find(std::string(table.cell(row, *column)));
      if (found == stimulus_rows_.end())
        return analysis::table_error(
            table, row,
            fmt::format("the table of stimuli has no stimulus `{}`", visible_text(table.cell(row, *column))),
            "add it to " + visible_text(stimuli_path_));
      for (std::size_t i = 0; i < table.columns().size(); ++i) text += cell_of(table.cell(row, i)) + "\t";
      for (std::size_t i = 0; i < added.size(); ++i)
        text += (i == 0 ? "" : "\t") + cell_of(stimuli_->cell(found->second, added[i]));
      text += '\n';
    }
    return analysis::read_table(table.file(), std::move(text));
  }

  std::string stimuli_path_;
  std::optional<Table> stimuli_;
  std::unordered_map<std::string, std::size_t> stimulus_rows_;
  std::set<std::string> versions_;
  nlohmann::json design_;                                             ///< of the first log
  std::string design_path_, noted_, psychopy_name_;
  struct AskedIn {
    std::string path, question;
    std::vector<std::string> varied;
  };
  std::optional<AskedIn> asked_;  ///< in the first table that says it
  std::map<std::string, std::pair<std::uint64_t, std::string>> felt_;  ///< by stimulus: its program, and where first
  Study study_;
};

}  // namespace

Result<Study> read_study(const std::vector<std::string>& paths, const std::string& stimuli) {
  return StudyReader(stimuli).read(paths);
}

void add_design(Study& study, const DesignFacts& design) {
  if (study.experiment.empty()) study.experiment = design.experiment;
  if (study.task.empty() || study.files.front().form == std::string_view("table")) study.task = design.task;
  for (const auto& [name, unit] : design.units) study.units.try_emplace(name, unit);
  const auto has = [&](const std::string& name) {
    return std::ranges::all_of(study.tables, [&](const Table& each) { return each.column(name).has_value(); });
  };
  if (study.varied.empty() && study.words.empty()) {
    for (const std::string& name : design.varied)
      if (has(name)) study.varied.push_back(name);
    for (const std::string& name : design.words)
      if (has(name)) study.words.push_back(name);
  }
}

}  // namespace wale
