#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "calibration/feel/file_watch.hpp"
#include "compiler/command/command.hpp"
#include "wale/stage.hpp"

namespace wale {

/// Keeps a stage's patch 0 to what a file says: whenever the file, or one that it imports or shows, is saved, it is
/// compiled again and takes the place of what is felt (`Stage::replace`). With errors the old one stays.
class MaterialWatch {
 public:
  /// `felt` is what lies on the stage. `say` gets what is to be told, whole lines. The stage outlives the watch.
  MaterialWatch(command::Choice choice, Stage& stage, const Program& felt, std::function<void(const std::string&)> say);

  enum class Outcome {
    nothing,   ///< no file changed, or nothing that is felt did
    replaced,  ///< another program is felt from the next tick on
    refused    ///< what is wrong was said, and the old one stays
  };
  /// Waits for a change up to `wait`. The first time it looks without waiting, since the file may have changed after it
  /// was read.
  Outcome attend(std::chrono::milliseconds wait);

 private:
  Outcome look();
  Outcome refuse(std::string why);

  command::Choice choice_;
  Stage& stage_;
  std::function<void(const std::string&)> say_;
  FileWatch files_;
  bool begun_ = false;
  std::vector<std::byte> felt_;  // the program's bytes
  bool vibrates_;
  std::string device_;
  std::string refused_;  // what was said of it last; empty when it is felt
};

}  // namespace wale
