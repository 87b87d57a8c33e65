#include "compiler/command/workspace_choice.hpp"

#include <fmt/format.h>

#include "compiler/command/print.hpp"
#include "compiler/modules/load_modules.hpp"

namespace wale::command {

Result<const CheckedWorkspace*> workspace_in(const OpenedFile& opened, const std::string& name) {
  if (opened.module) return find_workspace(*opened.module, name, opened.name);
  return Error{.code = Code::malformed_value,
               .sentence = fmt::format("expected a Wale file, found `{}`, a patch program", opened.name),
               .mend = "name the Wale file that declares the workspace",
               .place = {.name = "--workspace"}};
}

std::optional<std::vector<LaidPatch>> laid_in(const OpenedFile& opened, const CheckedWorkspace& workspace,
                                              const Choice& choice, Diagnostics& diagnostics) {
  const FileRequest request = choice.recording_request();
  const auto resolver = file_resolver(request.roots, request.looked_for, request.sandbox, request.devices);
  return compile_workspace(workspace, *opened.module, request.device, opened.sources, opened.source, *resolver,
                           diagnostics);
}

OrStatus<ChosenWorkspace> compiled_workspace(const OpenedFile& opened, const std::string& name, const Choice& choice) {
  const auto found = workspace_in(opened, name);
  if (!found) return refuse(found.error());
  Diagnostics diagnostics = opened.diagnostics;
  auto laid = laid_in(opened, **found, choice, diagnostics);
  print_diagnostics(stderr, diagnostics, opened.sources);
  if (!laid) return refused;
  return ChosenWorkspace{*found, *std::move(laid)};
}

}  // namespace wale::command
