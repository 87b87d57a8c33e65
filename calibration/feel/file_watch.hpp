#pragma once

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace wale {

/// Reports changes of files, whether an editor writes them in place, as a new file of the same name, or deletes them
/// and makes them again. It watches their folders, so a file need not exist yet. One thread at a time.
class FileWatch {
 public:
  FileWatch();
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// Watches these files and the targets of links among them, and no others. True if one of their folders was not
  /// watched before; then a change there may have been missed.
  bool follow(const std::vector<std::string>& files);

  /// Whether one of them was written, renamed or deleted since the last call. Waits for a change for at most `wait`;
  /// after a change it waits until no more changes come for a moment, so that one save is reported once.
  bool changed(std::chrono::milliseconds wait);

 private:
  /// Takes the events that have come or come within `wait`. Returns whether there were any, and any of followed files.
  struct Taken {
    bool any = false, ours = false;
  };
  Taken take(std::chrono::milliseconds wait);

  int events_ = -1;
  std::map<std::string, int> folders_;              // each with its watch
  std::set<std::pair<int, std::string>> followed_;  // a folder's watch and a name in it
};

}  // namespace wale
