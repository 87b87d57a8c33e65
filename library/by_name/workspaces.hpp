#pragma once

#include "compiler/open_file.hpp"
#include "wale/compiled_workspace.hpp"

namespace wale {

/// The workspace of that name, or the first if it is empty. Error: `unknown_workspace`.
Result<const CheckedWorkspace*> asked_workspace(const OpenedFile& opened, const std::string& name);

/// Reads a Wale file or a workspace file. Errors: `unreadable_file`, and `damaged_file` for other files.
Result<NamedFile> read_workspace(const std::string& path);

/// A workspace of a file that was read: of a text, or a workspace file. Errors: those of `Library::workspace`.
Result<CompiledWorkspace> workspace_of_file(NamedFile named, const FileRequest& request,
                                            const WorkspaceOptions& options);

/// What a text declares for people to explore. Error: the first one in the text.
Result<Presentation> presentation_of(NamedFile named, const FileRequest& request);

}  // namespace wale
