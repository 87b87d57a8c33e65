#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "wale/program.hpp"
#include "wale/result.hpp"

namespace wale {

/// The first line of each log: who feels what, on which device, by which software.
struct SessionBegin {
  std::string participant;                      ///< an identifier, not a name
  std::uint32_t seed = 0;                       ///< of all that is random in the session
  std::string device;                           ///< the name of its profile
  std::string file;                             ///< what is presented; may be empty
  std::map<std::string, std::string> versions;  ///< of the programs that take part: {"wale", "0.1.0"}
  std::string experiment{};                       ///< the design that is run; empty for a free session
  /// What the answers can be evidence of: "measured", by people on a plugged, trusted device; "simulated", the worst,
  /// by anyone else. Empty where nobody says.
  std::string grade{};
  friend bool operator==(const SessionBegin&, const SessionBegin&) = default;
};

/// A program that can be felt from here on.
struct SessionProgram {
  /// The patch's name, or those of several of one material with ", " between; and the material as written.
  std::string patch, material;
  std::uint64_t hash = 0;       ///< `program_hash`
  friend bool operator==(const SessionProgram&, const SessionProgram&) = default;
};

/// One thing in a realised order.
struct SessionItem {
  std::string name;
  std::string label;             ///< what the participant sees instead of its name; may be empty
  std::optional<glm::dvec2> at;  ///< m from the workspace's centre
  friend bool operator==(const SessionItem&, const SessionItem&) = default;
};

/// An order, or places, that a seed gave.
struct SessionOrder {
  std::string what;  ///< "frames", "places", "keys", "numbers"
  std::string of;    ///< the movie, the workspace or the keys
  std::uint32_t seed = 0;
  std::vector<SessionItem> items;
  friend bool operator==(const SessionOrder&, const SessionOrder&) = default;
};

/// Where one thing lies, and what of that can be felt.
struct SessionPlace {
  std::string name;
  glm::dvec2 at{0};                ///< m from the workspace's centre
  std::optional<glm::dvec2> size;  ///< m; of a patch that has not its material's own
  std::string shape;               ///< as written; empty for a rectangle
  std::optional<double> rim;       ///< m; of a patch that has not the usual one
  std::uint32_t layer = 0;         ///< of a patch, from 1 for the one behind all others; 0 where nothing lies in front
  friend bool operator==(const SessionPlace&, const SessionPlace&) = default;
};

/// Things lie elsewhere from here on, by whatever hand; the first of a workspace or of keys has all of them.
struct SessionPlaced {
  std::string what;                 ///< "patches", "keys"
  std::string of;                   ///< the workspace or the keys
  std::vector<SessionPlace> items;  ///< those that are new, or lie otherwise than the log said before
  std::vector<std::string> gone;    ///< names of those that are there no more
  friend bool operator==(const SessionPlaced&, const SessionPlaced&) = default;
};

/// Something is presented.
struct SessionShown {
  std::string what;          ///< "frame", "key"
  std::string name;          ///< of the workspace or the patch
  std::string label;         ///< what the participant sees instead; may be empty
  std::uint32_t number = 0;  ///< its place in the order, from 1; 0 where there is none
  std::uint32_t interval = 0;  ///< of a trial with several presentations, from 1; 0 where there is one
  std::string recording;       ///< the file beside the log that keeps what was felt; may be empty
  friend bool operator==(const SessionShown&, const SessionShown&) = default;
};

/// An answer of the participant. Its line's number is its name.
struct SessionAnswer {
  std::string question, about, answer;  ///< "pile", "board", "2": the key `board` was put into pile 2
  friend bool operator==(const SessionAnswer&, const SessionAnswer&) = default;
};

/// Answers that do not count any more. They stay in the log.
struct SessionTakenBack {
  std::vector<std::uint64_t> answers;  ///< the numbers of their lines
  friend bool operator==(const SessionTakenBack&, const SessionTakenBack&) = default;
};

/// How the participant sorted the patches of a workspace in the end.
struct SessionGroups {
  struct Group {
    std::vector<std::string> patches;
    std::string says;  ///< may be empty
    friend bool operator==(const Group&, const Group&) = default;
  };
  std::string name, workspace;
  std::vector<Group> groups;
  friend bool operator==(const SessionGroups&, const SessionGroups&) = default;
};

/// A session that was broken off goes on.
struct SessionResumed {
  double gap = 0;   ///< s since the line before, by the computer's clock
  std::string how;  ///< "resume", "practice" (which is repeated first), "restart" (of the block)
  friend bool operator==(const SessionResumed&, const SessionResumed&) = default;
};

/// Anything else that is worth a line: "the force was taken away".
struct SessionNote {
  std::string text;
  friend bool operator==(const SessionNote&, const SessionNote&) = default;
};

/// The last line of a session that ended properly.
struct SessionEnd {
  std::string why;  ///< "done", "stopped"
  friend bool operator==(const SessionEnd&, const SessionEnd&) = default;
};

/// An event that this version does not know. Programs with events of their own write them so.
struct SessionOther {
  std::string event;   ///< its name: "estimate"
  std::string fields;  ///< a JSON object with what else its line holds
  friend bool operator==(const SessionOther&, const SessionOther&) = default;
};

using SessionEvent =
    std::variant<SessionBegin, SessionProgram, SessionOrder, SessionPlaced, SessionShown, SessionAnswer,
                 SessionTakenBack, SessionGroups, SessionResumed, SessionNote, SessionEnd, SessionOther>;

/// A line of a log.
struct SessionEntry {
  std::uint64_t number = 1;  ///< of its line, from 1
  std::string time;          ///< of the computer's clock, UTC: "2026-11-24T20:31:00.123Z"
  double seconds = 0;        ///< since the session began, by a clock that nobody sets
  SessionEvent event;
  friend bool operator==(const SessionEntry&, const SessionEntry&) = default;
};

/// The log of a session while it runs: a text file to which lines are appended, calibration/session/SESSION_LOG.md. One
/// thread at a time; not for a real-time thread, since each call waits for the disk.
class SessionLog {
 public:
  /// Makes a new file and its first line. Error: `unwritable_file`, also if there is such a file: a log is never
  /// overwritten; and as `append`.
  static Result<SessionLog> create(const std::string& path, const SessionBegin& begin);
  struct Resumed;
  /// Opens the log of a session that was broken off, to go on in it. A last line that was cut off is removed: nobody
  /// was told that it is kept. `seconds` of later lines count on by the computer's clock. Errors: those of
  /// `open_session_log`; `damaged_file` if any other line is wrong; `wrong_moment` if the session has ended, or another
  /// process goes on in it; `unwritable_file`.
  static Result<Resumed> resume(const std::string& path);
  SessionLog(SessionLog&& other) noexcept;
  SessionLog& operator=(SessionLog&& other) noexcept;
  /// Leaves the file as it is: without a `SessionEnd` it is that of a session that was broken off.
  ~SessionLog();

  /// Writes an event and returns the number of its line when it is on the disk, so that nothing is lost whatever
  /// happens to the process next. What is to be logged is logged before it is presented. Errors: `unwritable_file` if
  /// the disk does not take it, then the file ends with the line before; `malformed_value` for text that is not UTF-8,
  /// a number that is not finite, a line longer than 1 MiB, a second `SessionBegin`, a `SessionOther` whose fields are
  /// no JSON object or contain a field of every line, or whose event has a known name.
  Result<std::uint64_t> append(const SessionEvent& event);

  const std::string& path() const { return path_; }

 private:
  SessionLog(std::string path, int file) : path_(std::move(path)), file_(file) {}
  Result<> write(const std::string& line);

  std::string path_;
  int file_ = -1;
  std::uint64_t lines_ = 0;
  std::int64_t size_ = 0;   // bytes
  double begun_ = 0;        // s, of the steady clock
};

/// A log as it was read.
struct SessionRecord {
  std::vector<SessionEntry> entries;
  /// What is wrong, with file and line: lines that are malformed or missing, a last one that was cut off when the
  /// process or the computer died, answers taken back that nobody gave. All other lines are kept. Code: `damaged_file`.
  std::vector<Error> problems;

  /// Whether the session came to its end; otherwise it was broken off.
  bool ended() const;
  /// The entries with answers that were not taken back, in the order given.
  std::vector<const SessionEntry*> standing_answers() const;
};

/// A log to go on in, what it holds so far, and how long ago it was broken off, s.
struct SessionLog::Resumed {
  SessionLog log;
  SessionRecord record;
  double gap = 0;
};

/// Reads a log; `name` is the file's, for errors. Errors: `damaged_file` for bytes that do not begin as a log does;
/// `newer_file`.
Result<SessionRecord> read_session_log(std::string_view bytes, const std::string& name);
/// The same of a file of at most 256 MiB. Error besides: `unreadable_file`.
Result<SessionRecord> open_session_log(const std::string& path);

/// One line of a log without the newline. Error: `malformed_value`, as for `SessionLog::append`.
Result<std::string> session_line(const SessionEntry& entry);

/// FNV-1a, 64 bits, of a program's bytes as a `.wpp` file has them, without the lines of the source that its code comes
/// from: the same while the file is changed elsewhere. A recording's hashes count these lines, too.
std::uint64_t program_hash(const Program& program);

}  // namespace wale
