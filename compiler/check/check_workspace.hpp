#pragma once

#include "compiler/expression/check_expression.hpp"
#include "compiler/expression/checked.hpp"

namespace wale {

/// Checks a workspace: the material of each patch, and where it lies. Errors are reported; patches with errors are left
/// out. `whole` says that the file has no other errors, so that names that seem unused are.
CheckedWorkspace check_workspace(const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings, bool whole);

/// Checks the shape of a patch, `ellipse`, `polygon(…)` or `mask(…)`, and gives it to the patch: its outline, and the
/// size that a polygon or a mask has. False after an error, which is reported.
bool check_shape(const SettingItem& item, const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings,
                 CheckedPatch& patch);

/// Checks a mark of a slider: `mark roughness, low 0.2, high 0.45, "still denim"`. Empty after an error, which is
/// reported.
std::optional<SliderMark> check_mark(const Setting& setting, const CheckedPatch& patch,
                                     const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings);

}  // namespace wale
