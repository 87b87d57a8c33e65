#include <utility>

#include "wale/stage.hpp"
#include "wale/workspace.hpp"

namespace wale {

Result<std::vector<Patch>> put_on(Stage& stage, const Workspace& workspace) {
  StageEdit edit = stage.edit();
  std::vector<Patch> patches;
  for (const WorkspacePatch& each : workspace.patches) {
    auto added = edit.add(each.program, each.options);
    if (!added) return std::move(added).error();
    patches.push_back(*std::move(added));
  }
  if (auto done = edit.commit(); !done) return std::move(done).error();
  return patches;
}

}  // namespace wale
