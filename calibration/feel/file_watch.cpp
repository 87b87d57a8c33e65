#include "calibration/feel/file_watch.hpp"

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

namespace wale {

namespace fs = std::filesystem;

namespace {

/// Closing a file after writing counts as a change; creating or opening it does not.
constexpr std::uint32_t telling = IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE;

/// The longest time between events of one save: an editor writes, renames and deletes within it.
constexpr std::chrono::milliseconds moment{30};
/// A file that is written without a pause is reported after this many moments.
constexpr int most_moments = 30;

}  // namespace

FileWatch::FileWatch() : events_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {}

FileWatch::~FileWatch() {
  if (events_ >= 0) close(events_);
}

bool FileWatch::follow(const std::vector<std::string>& files) {
  std::set<fs::path> paths;
  for (const std::string& file : files) {
    std::error_code ignored;
    paths.insert(fs::absolute(file, ignored).lexically_normal());
    paths.insert(fs::weakly_canonical(file, ignored));
  }
  bool fresh = false;
  followed_.clear();
  std::map<std::string, int> folders;
  for (const fs::path& path : paths) {
    const std::string folder = path.parent_path().string();
    // The system returns the same watch for a folder that is already watched, and a new one for a folder made again.
    const int watch = inotify_add_watch(events_, folder.c_str(), telling | IN_ONLYDIR);
    if (watch < 0) continue;  // there is no such folder
    const auto known = folders_.find(folder);
    fresh |= known == folders_.end() || known->second != watch;
    folders[folder] = watch;
    followed_.emplace(watch, path.filename().string());
  }
  for (const auto& old : folders_)
    if (std::ranges::none_of(folders, [&](const auto& each) { return each.second == old.second; }))
      inotify_rm_watch(events_, old.second);
  folders_ = std::move(folders);
  return fresh;
}

bool FileWatch::changed(std::chrono::milliseconds wait) {
  bool ours = take(wait).ours;
  for (int moments = 0; ours && moments < most_moments && take(moment).any; ++moments) {
  }
  return ours;
}

FileWatch::Taken FileWatch::take(std::chrono::milliseconds wait) {
  pollfd readable{events_, POLLIN, 0};
  Taken taken;
  if (poll(&readable, 1, static_cast<int>(wait.count())) <= 0) return taken;
  alignas(inotify_event) char buffer[16 * 1024];
  for (ssize_t size = 0; (size = ::read(events_, buffer, sizeof buffer)) > 0;) {
    for (const char* at = buffer; at < buffer + size;) {
      inotify_event event;
      std::memcpy(&event, at, sizeof event);
      const char* name = at + sizeof event;
      taken.any = true;
      taken.ours |=
          (event.mask & IN_Q_OVERFLOW) != 0 || (event.len > 0 && followed_.contains({event.wd, std::string(name)}));
      at += sizeof event + event.len;
    }
  }
  return taken;
}

}  // namespace wale
