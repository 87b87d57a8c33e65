#pragma once

#include <string>
#include <vector>

#include "compiler/compile_workspace.hpp"
#include "compiler/layout/layout_rules.hpp"

namespace wale {

/// A marked range of a slider, with its unit in SI.
struct DescribedMark {
  SliderMark mark;
  double unit_in_si = 1;
};

/// A patch of a workspace, in words and figures.
struct DescribedPatch {
  std::string name, made_of;   ///< "cloth", "denim(roughness: 0.3)"
  std::array<double, 2> at{};  ///< m, of its centre from the workspace's
  PatchSize size;              ///< m
  std::string shape;           ///< "rectangle", "ellipse", "polygon, 5 corners", "mask river.png"
  std::string feels;           ///< what its program reads, in a line: "roughness 0.35, viscosity 0.2"
  std::vector<DescribedMark> marks;
};

/// A workspace on a device.
struct WorkspaceDescription {
  std::string name, documentation, device;
  std::vector<DescribedPatch> patches;  ///< the last lies in front
  LayoutFigures layout;
  std::vector<std::string> rules;  ///< those that the layout does not keep, with what they are made for
};

/// Describes a workspace by its finished programs, each of which is read once.
WorkspaceDescription describe_workspace(const CheckedWorkspace& workspace, const std::vector<LaidPatch>& laid,
                                        const std::string& device, const Declarations& declarations);

/// The description as text for people.
std::string workspace_text(const WorkspaceDescription& description);
/// JSON: an object for one description, an array for several.
std::string workspaces_json(const std::vector<WorkspaceDescription>& descriptions);

/// "rectangle", "ellipse", "polygon, 5 corners", "mask river.png", "colour #c04020 of map.png".
std::string outline_text(const Outline& outline);

}  // namespace wale
