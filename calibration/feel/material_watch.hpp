#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "calibration/feel/file_watch.hpp"
#include "compiler/command/command.hpp"
#include "wale/stage.hpp"

namespace wale {

/// Keeps patch 0 of a stage up to date with a file. Whenever the file, or one that it imports or shows, is saved, it is
/// compiled again and replaces the active program (`Patch::replace`). With errors the previous version stays active.
class MaterialWatch {
 public:
  /// `felt` is the program of the patch. `settings` (NAME=VALUE) hold for every version that has such a parameter;
  /// where one cannot, the person is told. `say` gets messages of whole lines. The stage outlives the watch.
  MaterialWatch(command::Choice choice, Patch patch, const Program& felt, std::vector<std::string> settings,
                std::function<void(const std::string&)> say);

  enum class Outcome {
    nothing,   ///< no file changed, or the program did not
    replaced,  ///< the new program is felt, or is from a run's first tick on
    refused    ///< it has errors, which were shown, and the previous version stays active
  };
  /// Waits for a change, at most `wait`. The first call does not wait, since the file may have changed after it was
  /// read.
  Outcome attend(std::chrono::milliseconds wait);

  /// How many versions were on the stage, the first among them. Call it when nobody attends.
  long versions() const { return versions_; }

 private:
  Outcome look();
  Outcome refuse(std::string why);
  /// Returns as soon as the stage's run has the newest version, at once without a run, and after some hundred ticks at
  /// the latest.
  void wait_until_felt() const;
  std::string apply_settings(const PatchProgram& now);

  command::Choice choice_;
  Patch patch_;
  std::vector<std::string> settings_;
  std::map<std::string, std::string> said_of_settings_;  // the last message about each
  std::function<void(const std::string&)> say_;
  FileWatch files_;
  bool begun_ = false;
  long versions_ = 1;
  std::vector<std::byte> felt_;  // the program's bytes
  DeviceProfile device_;         // that the program is built for
  std::string refused_;          // the last message about it; empty while it is active
};

}  // namespace wale
