#pragma once

#include <map>

#include "compiler/compile_workspace.hpp"
#include "compiler/read/cues.hpp"

namespace wale {

/// The cues of the patches of a workspace: those of each program are read once, when they are first asked for.
class ReadCues {
 public:
  /// The declarations must outlive it.
  explicit ReadCues(const Declarations& declarations) : declarations_(declarations) {}

  const Cues& of(const LaidPatch& patch);

 private:
  const Declarations& declarations_;
  std::map<const Program*, Cues> read_;
};

}  // namespace wale
