#include "wale/language_service.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <utility>

#include "calibration/feel/trusted_declarations.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/diagnostics/told.hpp"
#include "compiler/format/format.hpp"
#include "compiler/legibility/check_legibility.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/open_file.hpp"
#include "library/by_name/missing_folder.hpp"
#include "library/by_name/told.hpp"
#include "library/by_name/workspaces.hpp"
#include "library/editing/layout.hpp"
#include "library/editing/proposals.hpp"
#include "schema/name_text.hpp"
#include "schema/owners_devices_file.hpp"

namespace wale {
namespace {

/// The problems of the text that is source `source`, and those of other files.
std::vector<Problem> problems_of(Diagnostics& diagnostics, const SourceSet& sources, SourceId source) {
  diagnostics.sort();
  std::vector<Problem> problems;
  for (const Diagnostic& each : diagnostics.all()) {
    Problem problem{.error = told(each, sources)};
    if (each.span.source == source) {
      problem.begin = each.span.begin, problem.end = each.span.end;
      for (const Fix& fix : each.fixes) {
        TextFix told{.title = fix.title, .safe = fix.safe};
        for (const Edit& edit : fix.edits)
          if (edit.span.source == source) told.edits.push_back({edit.span.begin, edit.span.end, edit.replacement});
        if (told.edits.size() == fix.edits.size()) problem.fixes.push_back(std::move(told));
      }
    }
    problems.push_back(std::move(problem));
  }
  return problems;
}

/// Why a percept's level is unknown, or is no measured one.
std::string why_not_measured(const DescribedPercept& percept) {
  std::string why = percept.domain_why;
  for (const OutsideRange& each : percept.outside) why += (why.empty() ? "" : "; ") + outside_in_words(each);
  return why;
}

}  // namespace

bool CheckedText::has_errors() const {
  return std::ranges::any_of(problems,
                             [](const Problem& each) { return severity_of(each.error.code) == Severity::error; });
}

struct LanguageService::Parts {
  std::shared_ptr<const CommonModules> common = common_modules();
  std::vector<std::string> roots;
  std::optional<Error> missing;  ///< about the first of the given folders that is none
  Sandbox sandbox = Sandbox::required;
  std::vector<ResolvedFile> devices;  ///< what the owner declares; nothing if that has an error

  explicit Parts(const LibraryOptions& options)
      : roots(library_folders(options.folders, std::getenv("WALE_LIBRARY"))),
        missing(missing_folder(options.folders)),
        sandbox(options.unsandboxed_pictures ? Sandbox::if_possible : Sandbox::required) {
    auto trusted = trusted_declarations({}, owners_devices_file(std::getenv("XDG_CONFIG_HOME"), std::getenv("HOME")));
    if (trusted) devices = std::move(trusted->files);
  }

  FileRequest request(const CompileOptions& options) const {
    FileRequest request{.device = options.device.empty() ? default_device : options.device, .roots = roots};
    request.sandbox = sandbox;
    if (!common->declarations.devices.contains(request.device)) request.devices = devices;
    return request;
  }

  /// The first error of the service or of options that cannot be names.
  std::optional<Error> wrong(const CompileOptions& options) const {
    if (missing) return missing;
    for (const auto& [argument, text] : {std::pair{"device", &options.device}, std::pair{"material", &options.material},
                                         std::pair{"name", &options.name}})
      if (!text->empty())
        if (auto name = is_name_text(argument, *text); !name) return std::move(name.error());
    return std::nullopt;
  }

  /// The error about a device that nothing declares.
  std::optional<Error> unknown_device_in(const OpenedFile& opened, const CompileOptions& options) const {
    const std::string& device = options.device;
    if (device.empty() || !opened.module || opened.module->declarations().devices.contains(device)) return std::nullopt;
    return unknown(Code::unknown_device, "device", device, opened.module->declarations().devices.spellings());
  }

  Result<OpenedFile> opened(std::string_view text, const CompileOptions& options) const {
    return open_named({.name = options.name, .bytes = std::string(text)}, request(options));
  }
};

LanguageService::LanguageService(const LibraryOptions& options) : parts_(std::make_unique<Parts>(options)) {}
LanguageService::~LanguageService() = default;

Result<> LanguageService::folders_exist() const {
  if (parts_->missing) return *parts_->missing;
  return {};
}

CheckedText LanguageService::check(std::string_view text, const CompileOptions& options) const {
  auto wrong = parts_->wrong(options);
  if (wrong && wrong->code != Code::unreadable_file) return {.problems = {{.error = *std::move(wrong)}}};
  auto opened = parts_->opened(text, options);
  if (!opened) return {.problems = {{.error = std::move(opened.error())}}};
  if (!wrong) wrong = parts_->unknown_device_in(*opened, options);
  CheckedText checked{.problems = problems_of(opened->diagnostics, opened->sources, opened->source)};
  if (wrong) checked.problems.insert(checked.problems.begin(), Problem{.error = *std::move(wrong)});
  if (!opened->module) return checked;  // a patch program
  checked.materials = materials_of(*opened);
  if (const auto& modules = opened->module->modules.modules; !modules.empty())
    checked.layouts = layouts_in(modules.back()->tree, *opened->module, text);
  return checked;
}

CompiledText LanguageService::compile(std::string_view text, const CompileOptions& options) const {
  if (auto wrong = parts_->wrong(options)) return {.problems = {{.error = *std::move(wrong)}}};
  auto opened = parts_->opened(text, options);
  if (!opened) return {.problems = {{.error = std::move(opened.error())}}};
  if (opened->program) return {.program = std::move(opened->program)};
  CompiledText compiled;
  if (!opened->diagnostics.has_errors())
    compiled.program = compile_opened(*opened, parts_->request(options), options.material, opened->diagnostics);
  compiled.problems = problems_of(opened->diagnostics, opened->sources, opened->source);
  return compiled;
}

std::vector<Problem> LanguageService::legibility(std::string_view text, const WorkspaceOptions& options) const {
  const CompileOptions choice{.device = options.device, .name = options.name};
  if (auto wrong = parts_->wrong(choice)) return {{.error = *std::move(wrong)}};
  auto opened = parts_->opened(text, choice);
  if (!opened) return {{.error = std::move(opened.error())}};
  if (auto wrong = parts_->unknown_device_in(*opened, choice)) return {{.error = *std::move(wrong)}};
  if (!opened->module || opened->diagnostics.has_errors())
    return problems_of(opened->diagnostics, opened->sources, opened->source);
  const FileRequest request = parts_->request(choice);
  const auto resolver = file_resolver(request.roots, nullptr, request.sandbox, request.devices);
  const auto asked = asked_workspace(*opened, options.workspace);
  if (!asked) return {{.error = asked.error()}};
  const CheckedWorkspace* const found = *asked;
  Diagnostics diagnostics;
  const auto laid = compile_workspace(*found, *opened->module, request.device, opened->sources, opened->source,
                                      *resolver, diagnostics);
  if (laid) check_legibility(*found, *laid, opened->module->declarations(), request.device, diagnostics);
  return problems_of(diagnostics, opened->sources, opened->source);
}

Result<ToldMaterial> LanguageService::tell(const Program& program) const {
  const FileRequest request = parts_->request({.device = program.description().device.name});
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver(request.roots, nullptr, request.sandbox, request.devices);
  const CheckedModule here = check_source(sources, sources.add("here", "wale 1\n"), *resolver, diagnostics);
  if (!here.declarations().devices.contains(request.device))
    return unknown(Code::unknown_device, "device", request.device, here.declarations().devices.spellings());
  const Description description = describe(Bank(program), here.declarations());
  ToldMaterial told{.text = description_text(description)};
  for (const DescribedPercept& each : description.percepts) {
    ToldPercept percept{.name = each.name,
                        .asked = each.asked,
                        .evidence = evidence_word(each.evidence()),
                        .why = why_not_measured(each)};
    if (!each.unknown) percept.reads = each.level;
    told.percepts.push_back(std::move(percept));
  }
  return told;
}

Result<std::string> LanguageService::format(std::string_view text) const {
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add("text", std::string(text));
  auto formatted = wale::format(sources, source, diagnostics);
  if (!formatted) return first_error(diagnostics, sources);
  return *std::move(formatted);
}

Proposals LanguageService::proposals(std::string_view text, std::size_t at, const CompileOptions& options) const {
  const std::size_t place = std::min(at, text.size());
  const auto opened = parts_->opened(text, options);
  const Declarations& known = opened && opened->module ? opened->module->declarations() : parts_->common->declarations;
  const auto resolver = file_resolver(parts_->roots, nullptr, parts_->sandbox, parts_->devices);
  return proposals_at(text, place, known, *library_index(*resolver, options.name));
}

}  // namespace wale
