#include "library/by_name/workspaces.hpp"

#include <algorithm>
#include <span>

#include "compiler/compile_workspace.hpp"
#include "compiler/legibility/check_legibility.hpp"
#include "compiler/modules/load_modules.hpp"
#include "library/by_name/told.hpp"
#include "schema/regular_file.hpp"

namespace wale {
namespace {

TextPart part_of(const Span& span) { return {span.begin, span.end}; }

std::vector<std::string> names_of(const std::vector<NamedThing>& things) {
  std::vector<std::string> names;
  for (const NamedThing& each : things) names.push_back(each.name);
  return names;
}

PatchInText in_text_of(const CheckedPatch& patch) {
  PatchInText in_text{part_of(patch.statement), part_of(patch.name_span), part_of(patch.made_of_span), {}, {}};
  for (const auto& [key, span] : patch.settings) in_text.settings.emplace_back(key, part_of(span));
  if (const auto* mask = std::get_if<MaskOutline>(&patch.outline)) in_text.colour = mask->colour;
  return in_text;
}

/// The checked text of a file. Errors: the first one in it; `damaged_file` for a file that is no text.
Result<OpenedFile> checked_text(NamedFile named, const FileRequest& request) {
  auto opened = open_named(std::move(named), request);
  if (!opened) return opened;
  if (opened->program)
    return Error{.code = Code::damaged_file,
                 .sentence = "expected a Wale file, found a patch program",
                 .mend = "name the Wale file that it was built from",
                 .place = {.name = opened->name}};
  if (opened->diagnostics.has_errors()) return first_error(opened->diagnostics, opened->sources);
  return opened;
}

/// How a workspace file begins.
constexpr std::string_view workspace_magic = "\x89WWS";
/// Bytes; 4096 programs of 4 MB would be more than any stage needs.
constexpr std::size_t largest_workspace_file = std::size_t{1} << 30;

}  // namespace

Result<const CheckedWorkspace*> asked_workspace(const OpenedFile& opened, const std::string& name) {
  const auto& all = opened.module->workspaces;
  if (name.empty() && !all.empty()) return &all.front();
  std::vector<std::string> known;
  for (const CheckedWorkspace& each : all) known.push_back(each.name);
  if (name.empty())
    return Error{.code = Code::unknown_workspace,
                 .sentence = "it has no workspace",
                 .mend = "add one, as in `workspace desk { patch board = oak }`",
                 .place = {.name = opened.name}};
  if (const CheckedWorkspace* found = opened.module->workspace(name)) return found;
  return unknown(Code::unknown_workspace, "workspace", name, known);
}

Result<NamedFile> read_workspace(const std::string& path) {
  if (path.ends_with(".wws")) {
    auto bytes = read_regular_file(path, largest_workspace_file);
    if (!bytes) {
      Error error = std::move(bytes).error();
      error.sentence = "this file cannot be read: " + error.sentence;
      if (error.mend.empty()) error.mend = "name a workspace file, which `wale build --workspace` makes, or a Wale file";
      error.place.name = path;
      return error;
    }
    if (bytes->starts_with(workspace_magic)) return NamedFile{.name = path, .bytes = *std::move(bytes)};
    Error error = Workspace::load(std::as_bytes(std::span(*bytes))).error();
    error.place.name = path;
    return error;
  }
  auto named = read_named_file(path);
  if (!named && named.error().code == Code::unreadable_file)
    named.error().mend = "name a Wale file with a workspace, or a workspace file (.wws)";
  return named;
}

Result<CompiledWorkspace> workspace_of_file(NamedFile named, const FileRequest& request,
                                            const WorkspaceOptions& options) {
  if (named.bytes.starts_with(workspace_magic)) {
    auto loaded = Workspace::load(std::as_bytes(std::span(named.bytes)));
    if (!loaded && loaded.error().place.name.empty()) loaded.error().place.name = named.name;
    if (!loaded) return std::move(loaded).error();
    if (!options.workspace.empty() && options.workspace != loaded->name)
      return unknown(Code::unknown_workspace, "workspace", options.workspace, {loaded->name});
    if (!options.device.empty())
      for (const WorkspacePatch& each : loaded->patches)
        if (const std::string& device = each.program.description().device.name; device != options.device)
          return Error{.code = Code::other_device,
                       .sentence = "this workspace is built for `" + device + "`",
                       .mend = "ask for it without a device, or compile its Wale file for that device",
                       .place = {.name = "device", .text = options.device}};
    return CompiledWorkspace{*std::move(loaded), {}, {}, {}};
  }
  auto opened = checked_text(std::move(named), request);
  if (!opened) return std::move(opened).error();
  if (!opened->module->declarations().devices.contains(request.device))
    return unknown(Code::unknown_device, "device", request.device, opened->module->declarations().devices.spellings());
  const auto found = asked_workspace(*opened, options.workspace);
  if (!found) return found.error();
  const auto resolver = file_resolver(request.roots, request.looked_for, request.sandbox, request.devices);
  const auto laid = compile_workspace(**found, *opened->module, request.device, opened->sources, opened->source,
                                      *resolver, opened->diagnostics);
  if (!laid) return first_error(opened->diagnostics, opened->sources);
  if (options.legibility)
    check_legibility(**found, *laid, opened->module->declarations(), request.device, opened->diagnostics);
  CompiledWorkspace compiled{workspace_of(**found, *laid), {}, part_of((*found)->statement), part_of((*found)->span)};
  for (const LaidPatch& each : *laid) compiled.in_text.push_back(in_text_of(*each.patch));
  compiled.warnings = warnings_in(opened->diagnostics, opened->sources);
  return compiled;
}

Result<Presentation> presentation_of(NamedFile named, const FileRequest& request) {
  auto opened = checked_text(std::move(named), request);
  if (!opened) return std::move(opened).error();
  Presentation shown;
  for (const CheckedWorkspace& each : opened->module->workspaces) shown.workspaces.push_back(each.name);
  for (const CheckedMovie& each : opened->module->movies)
    shown.movies.push_back({each.named.name, each.documentation, names_of(each.frames), part_of(each.statement)});
  for (const CheckedKeys& each : opened->module->keys)
    shown.keys.push_back({each.named.name, each.documentation, each.workspace.name, each.area, each.at, each.key,
                          each.numbered_at_random, part_of(each.statement)});
  for (const CheckedGroups& each : opened->module->groups) {
    SortedGroups& groups = shown.groups.emplace_back(
        SortedGroups{each.named.name, each.documentation, each.workspace.name, {}, part_of(each.statement)});
    for (const auto& group : each.groups) groups.groups.push_back({names_of(group.patches), group.says});
  }
  return shown;
}

}  // namespace wale
