#include "wale/session_log.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

#include "calibration/session/session_line.hpp"
#include "schema/fnv1a.hpp"
#include "wale/patch_program.hpp"

namespace wale {
namespace {

Error unwritable(const std::string& path, int error) {
  if (error == EEXIST)
    return {.code = Code::unwritable_file,
            .sentence = "the file exists already, and a log is never overwritten",
            .mend = "choose another name",
            .place = {.name = path}};
  return {.code = Code::unwritable_file,
          .sentence = "the log cannot be written: " + std::generic_category().message(error),
          .mend = error == ENOSPC || error == EDQUOT ? "make room on the disk" : "choose another place for it",
          .place = {.name = path}};
}

std::string utc_now() {
  using namespace std::chrono;
  const auto now = time_point_cast<milliseconds>(system_clock::now());
  const std::time_t seconds = system_clock::to_time_t(floor<std::chrono::seconds>(now));
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S.", &parts);
  const std::string fraction = std::to_string(1000 + now.time_since_epoch().count() % 1000).substr(1);
  return std::string(text, length) + fraction + "Z";
}

double steady_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

int again(auto call) {
  int result;
  do result = static_cast<int>(call());
  while (result < 0 && errno == EINTR);
  return result;
}

/// Keeps other processes from going on in the same log.
bool lock(int file) { return again([&] { return flock(file, LOCK_EX | LOCK_NB); }) == 0; }

/// Makes sure that a new file's name is on the disk too. Some file systems cannot, and keep it all the same.
void sync_folder_of(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  const int opened = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return;
  [[maybe_unused]] const int synced = again([&] { return fsync(opened); });
  close(opened);
}

}  // namespace

Result<SessionLog> SessionLog::create(const std::string& path, const SessionBegin& begin) {
  const int file = again([&] { return open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644); });
  if (file < 0) return unwritable(path, errno);
  SessionLog log(path, file);
  (void)lock(file);  // nobody else knows the new file yet
  log.begun_ = steady_now();
  const auto line = session_line({.number = 1, .time = utc_now(), .seconds = 0, .event = begin});
  const Result<> written = line ? log.write(*line) : Result<>(line.error());
  if (!written) {
    unlink(path.c_str());
    return written.error();
  }
  sync_folder_of(path);
  return log;
}

namespace {

/// Seconds from `time`, "2026-11-24T20:31:00.123Z", until now; 0 for another text and for a clock that was set back.
double seconds_since(const std::string& time) {
  std::tm parts{};
  const char* end = strptime(time.c_str(), "%Y-%m-%dT%H:%M:%S", &parts);
  if (end == nullptr) return 0;
  const double then = static_cast<double>(timegm(&parts)) + (*end == '.' ? std::atof(end) : 0.0);
  const double now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  return std::max(0.0, now - then);
}

}  // namespace

Result<SessionLog::Resumed> SessionLog::resume(const std::string& path) {
  const auto at_path = [&](Error error) {
    error.place.name = path;
    return error;
  };
  const int file = again([&] { return open(path.c_str(), O_RDWR | O_APPEND | O_CLOEXEC); });
  if (file < 0)
    return at_path({.code = Code::unreadable_file,
                    .sentence = "the log cannot be opened: " + std::generic_category().message(errno)});
  SessionLog log(path, file);
  if (!lock(file))
    return at_path({.code = Code::wrong_moment,
                    .sentence = "another process goes on in this log",
                    .mend = "end it first"});
  auto record = open_session_log(path);
  if (!record) return record.error();
  struct stat status {};
  if (fstat(file, &status) != 0) return unwritable(path, errno);
  log.size_ = status.st_size;
  char last = '\n';
  if (pread(file, &last, 1, log.size_ - 1) != 1) return unwritable(path, errno);
  const bool is_cut = last != '\n';
  if (record->problems.size() > (is_cut ? 1u : 0u)) return record->problems.front();
  if (record->ended())
    return at_path({.code = Code::wrong_moment,
                    .sentence = "this session has ended",
                    .mend = "begin another one with a new log"});
  if (is_cut) {
    std::int64_t whole = log.size_;
    while (whole > 0 && pread(file, &last, 1, whole - 1) == 1 && last != '\n') --whole;
    if (again([&] { return ftruncate(file, whole); }) != 0) return unwritable(path, errno);
    log.size_ = whole;
    record->problems.clear();
  }
  const SessionEntry& before = record->entries.back();
  const double gap = seconds_since(before.time);
  log.lines_ = before.number;
  log.begun_ = steady_now() - before.seconds - gap;
  return Resumed{std::move(log), *std::move(record), gap};
}

SessionLog::SessionLog(SessionLog&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      lines_(other.lines_),
      size_(other.size_),
      begun_(other.begun_) {}

SessionLog& SessionLog::operator=(SessionLog&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  std::swap(lines_, other.lines_);
  std::swap(size_, other.size_);
  std::swap(begun_, other.begun_);
  return *this;
}

SessionLog::~SessionLog() {
  if (file_ >= 0) close(file_);
}

Result<> SessionLog::write(const std::string& line) {
  const std::string bytes = line + "\n";
  std::size_t done = 0;
  int error = 0;
  while (done < bytes.size() && error == 0) {
    const ssize_t written = ::write(file_, bytes.data() + done, bytes.size() - done);
    if (written >= 0) done += static_cast<std::size_t>(written);
    else if (errno != EINTR) error = errno;
  }
  if (error == 0 && again([&] { return fsync(file_); }) != 0) error = errno;
  if (error != 0) {
    // What nobody was told of must not stand in front of the next line.
    [[maybe_unused]] const int cut = ftruncate(file_, size_);
    return unwritable(path_, error);
  }
  size_ += static_cast<std::int64_t>(bytes.size());
  ++lines_;
  return {};
}

Result<std::uint64_t> SessionLog::append(const SessionEvent& event) {
  if (std::holds_alternative<SessionBegin>(event))
    return Error{.code = Code::malformed_value, .sentence = "a session begins once", .place = {.name = path_}};
  const double seconds = std::round((steady_now() - begun_) * 1000) / 1000;
  const auto line = session_line({.number = lines_ + 1, .time = utc_now(), .seconds = seconds, .event = event});
  if (!line) {
    Error error = line.error();
    error.place.name = path_;
    return error;
  }
  if (const auto written = write(*line); !written) return written.error();
  return lines_;
}

std::uint64_t program_hash(const Program& program) {
  PatchProgram felt = program.description();
  felt.places = {};
  return Fnv1a<std::uint64_t>().take_all(write_patch_program(felt)).hash();
}

}  // namespace wale
