#pragma once

#include <string>
#include <vector>

#include "compiler/command/command.hpp"
#include "compiler/compile_workspace.hpp"

namespace wale::command {

/// The workspace of an opened file that an option names. Errors: W0609; W0801 for a patch program.
Result<const CheckedWorkspace*> workspace_in(const OpenedFile& opened, const std::string& name);

/// Compiles a workspace of the file for the device of `choice`, whose inputs receive the pictures that were read.
/// Empty after errors, which are reported to `diagnostics`.
std::optional<std::vector<LaidPatch>> laid_in(const OpenedFile& opened, const CheckedWorkspace& workspace,
                                              const Choice& choice, Diagnostics& diagnostics);

/// A workspace of an opened file, which must outlive it, compiled.
struct ChosenWorkspace {
  const CheckedWorkspace* checked;
  std::vector<LaidPatch> laid;

  Workspace made() const { return workspace_of(*checked, laid); }
};

/// Finds and compiles the workspace of that name. All diagnostics of the file, and errors, are printed.
OrStatus<ChosenWorkspace> compiled_workspace(const OpenedFile& opened, const std::string& name, const Choice& choice);

}  // namespace wale::command
