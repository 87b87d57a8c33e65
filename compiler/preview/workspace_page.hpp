#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "compiler/drawing/canvas.hpp"
#include "wale/workspace.hpp"

namespace wale {

/// The words about a patch of a workspace.
struct PatchWords {
  std::string feels;           ///< "roughness 0.30"
  std::optional<double> felt;  ///< the level of the texture, by which its relief is drawn; empty if there is none
};

/// A picture of a workspace from above, 1600 x 1240 pixels: the device's workspace as a disc, each patch as the relief
/// of its material in its shape, the last in front, with a scale bar; what lies beyond the device's reach is pale.
/// Beside it, the patches by number, with `words`, one for each. Surfaces are those of memories that nobody has
/// touched. The same workspace and words give the same pixels.
///
/// Error: `Code::missing_library`.
Result<std::unique_ptr<Canvas>> draw_workspace(const Workspace& workspace, const DeviceProfile& device,
                                               std::span<const PatchWords> words);

}  // namespace wale
