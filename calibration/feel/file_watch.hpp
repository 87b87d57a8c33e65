#pragma once

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace wale {

/// Tells when files change, however an editor writes them: in place, as a new file of the same name, or deleted and
/// made again. It watches the folders that they are in, so a file need not be there yet.
class FileWatch {
 public:
  FileWatch();
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// Watches these files, and what they are links to, and no others. True if it had not watched one of their folders
  /// before: then something may have changed there unseen.
  bool follow(const std::vector<std::string>& files);

  /// Whether one of them was written, renamed or deleted since it was asked last; waits for it up to `wait`, and when
  /// something happened until nothing more does for a moment, so that one save is told once.
  bool changed(std::chrono::milliseconds wait);

 private:
  /// Takes the events that are there, or come within `wait`. Whether there were any, and any of ours.
  struct Taken {
    bool any = false, ours = false;
  };
  Taken take(std::chrono::milliseconds wait);

  int events_ = -1;
  std::map<std::string, int> folders_;              // each with its watch
  std::set<std::pair<int, std::string>> followed_;  // a folder's watch and a name in it
};

}  // namespace wale
