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
  /// The cues of the material itself: as those of the patch, but where it is so small that its own texture may not be
  /// read in it, as on a patch of the device's usual size.
  const Cues& of_material(const LaidPatch& patch);

 private:
  const Cues& read(std::map<const Program*, Cues>& known, const Program& program, PatchSize size);

  const Declarations& declarations_;
  std::map<const Program*, Cues> read_, of_materials_;
};

}  // namespace wale
