#include "wale/session_log.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
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
  return Fnv1a<std::uint64_t>().take_all(write_patch_program(program.description())).hash();
}

}  // namespace wale
