#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "wale/workspace.hpp"

namespace wale {

/// A patch of a workspace with its finished program. Patches of the same material and size share one.
struct LaidPatch {
  const CheckedPatch* patch;
  std::shared_ptr<const Program> program;
  PatchSize size;  ///< m: as the workspace, the material or the device gives it, and no wider than the device reaches
  Shape shape;
};

/// Compiles the patches of a workspace for a device, in the order written. Warns of those that the device does not
/// reach, and of areas of keys (W0427). Empty after errors, which are reported (W0314: a mask with more cells than a stage
/// takes).
std::optional<std::vector<LaidPatch>> compile_workspace(const CheckedWorkspace& workspace, const CheckedModule& module,
                                                        const std::string& device, const SourceSet& sources,
                                                        SourceId source, Resolver& resolver, Diagnostics& diagnostics);

/// The outline of a patch as a shape; a mask's is stretched to the size. Errors: those of `Shape`.
Result<Shape> shape_of(const Outline& outline, const PatchSize& size);

/// What is written into a workspace file, and put on a stage.
Workspace workspace_of(const CheckedWorkspace& workspace, const std::vector<LaidPatch>& laid);

/// The workspace that the option `--workspace` names; W0609 if there is none, whose mend has the nearest name or all of
/// them. `file` is the file's name in the error.
Result<const CheckedWorkspace*> find_workspace(const CheckedModule& module, const std::string& name,
                                               const std::string& file);

}  // namespace wale
