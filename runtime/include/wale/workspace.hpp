#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wale/patch.hpp"

namespace wale {

class Stage;

/// A range of a slider that a person has marked: from here to here it still felt like `says`.
struct WorkspaceMark {
  std::string slider;              ///< a parameter or a percept of the patch's program
  bool is_percept = false;         ///< then the range is one of levels, 0 .. 1
  std::optional<float> low, high;  ///< SI; at least one of them
  std::string says;                ///< may be empty

  friend bool operator==(const WorkspaceMark&, const WorkspaceMark&) = default;
};

/// A patch of a workspace.
struct WorkspacePatch {
  std::string name;     ///< that no other patch of the workspace has
  std::string made_of;  ///< its material as the author wrote it: "denim(roughness: 0.3)"
  Program program;
  PatchOptions options;  ///< its size is given
  std::vector<WorkspaceMark> marks = {};
};

/// Materials that are laid out side by side, compiled for one device: what `wale build --workspace` makes. Patches of
/// the same material may share a program. The format is runtime/workspace/WORKSPACE_FILE.md.
struct Workspace {
  std::string name, documentation;
  std::vector<WorkspacePatch> patches;  ///< the last in front

  /// Reads a workspace file. Errors: `damaged_file`, with the byte; `newer_file`; those of `Program::load` for its
  /// programs.
  static Result<Workspace> load(std::span<const std::byte> bytes);
};

/// The bytes of a workspace file. The same workspace gives the same bytes.
std::vector<std::byte> write_workspace(const Workspace& workspace);

/// Puts all patches on a stage at once, the last in front, and gives them in their order. Errors: those of `Stage::add`;
/// then none is there.
Result<std::vector<Patch>> put_on(Stage& stage, const Workspace& workspace);

}  // namespace wale
