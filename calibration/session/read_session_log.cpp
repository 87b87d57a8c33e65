#include <algorithm>
#include <set>
#include <utility>

#include "calibration/session/session_line.hpp"
#include "schema/regular_file.hpp"
#include "wale/session_log.hpp"

namespace wale {
namespace {

constexpr std::size_t largest_log = std::size_t{256} << 20;

/// Puts lines together, and reports what does not fit.
class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  Result<> take(std::string_view line) {
    ++line_;
    auto entry = read_session_line(line);
    if (line_ == 1) {
      if (!entry && entry.error().code == Code::newer_file) return placed(std::move(entry).error());
      if (!entry || !std::holds_alternative<SessionBegin>(entry->event))
        return placed({.code = Code::damaged_file,
                       .sentence = "this is no log of a session: " +
                                   (entry ? std::string("it does not begin with `begin`") : entry.error().sentence)});
    }
    if (!entry) {
      report(entry.error().sentence);
      ++expected_;
    } else if (fits(*entry)) {
      record_.entries.push_back(*std::move(entry));
    }
    return {};
  }

  void report(const std::string& sentence) {
    record_.problems.push_back(placed({.code = Code::damaged_file, .sentence = sentence}));
  }
  void take_cut_line() {
    ++line_;
    report("the last line is cut off: the session was broken off while it was written, and nobody was told that it is kept");
  }

  SessionRecord record() && { return std::move(record_); }

 private:
  Error placed(Error error) const {
    error.place.name = name_;
    error.place.number = line_;
    return error;
  }

  bool fits(const SessionEntry& entry) {
    if (line_ > 1 && std::holds_alternative<SessionBegin>(entry.event)) {
      ++expected_;
      report("a session begins once");
      return false;
    }
    if (entry.number != expected_)
      report(entry.number > expected_ ? "lines " + std::to_string(expected_) + " to " + std::to_string(entry.number - 1) + " are missing before it"
                                      : "line " + std::to_string(entry.number) + " stands here again");
    if (entry.number < expected_) return false;
    expected_ = entry.number + 1;
    if (ended_) report("the session had ended before it");
    ended_ = ended_ || std::holds_alternative<SessionEnd>(entry.event);
    if (std::holds_alternative<SessionAnswer>(entry.event)) standing_.insert(entry.number);
    if (const auto* taken = std::get_if<SessionTakenBack>(&entry.event))
      for (const std::uint64_t each : taken->answers)
        if (standing_.erase(each) == 0) report("line " + std::to_string(each) + " has no answer that could be taken back");
    return true;
  }

  const std::string& name_;
  std::size_t line_ = 0;
  std::uint64_t expected_ = 1;
  bool ended_ = false;
  std::set<std::uint64_t> standing_;
  SessionRecord record_;
};

}  // namespace

bool SessionRecord::ended() const {
  return std::ranges::any_of(entries, [](const SessionEntry& each) { return std::holds_alternative<SessionEnd>(each.event); });
}

std::vector<const SessionEntry*> SessionRecord::standing_answers() const {
  std::set<std::uint64_t> taken;
  for (const SessionEntry& each : entries)
    if (const auto* back = std::get_if<SessionTakenBack>(&each.event)) taken.insert(back->answers.begin(), back->answers.end());
  std::vector<const SessionEntry*> standing;
  for (const SessionEntry& each : entries)
    if (std::holds_alternative<SessionAnswer>(each.event) && !taken.contains(each.number)) standing.push_back(&each);
  return standing;
}

Result<SessionRecord> read_session_log(std::string_view bytes, const std::string& name) {
  Reader reader(name);
  if (bytes.find('\n') == std::string_view::npos)
    return Error{.code = Code::damaged_file,
                 .sentence = bytes.empty() ? "the file is empty" : "this is no log of a session: its first line does not end",
                 .place = {.name = name, .number = 1}};
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    if (end == std::string_view::npos) {
      reader.take_cut_line();
      break;
    }
    if (const auto taken = reader.take(bytes.substr(0, end)); !taken) return taken.error();
    bytes.remove_prefix(end + 1);
  }
  return std::move(reader).record();
}

Result<SessionRecord> open_session_log(const std::string& path) {
  const auto bytes = read_regular_file(path, largest_log);
  if (!bytes) {
    Error error = bytes.error();
    error.sentence = "this file cannot be read: " + error.sentence;
    error.place.name = path;
    return error;
  }
  return read_session_log(*bytes, path);
}

}  // namespace wale
