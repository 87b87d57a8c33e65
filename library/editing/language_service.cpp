#include "wale/language_service.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <tuple>
#include <utility>

#include "calibration/feel/trusted_declarations.hpp"
#include "compiler/compare/compare.hpp"
#include "compiler/compare/compare_files.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/diagnostics/told.hpp"
#include "compiler/format/format.hpp"
#include "compiler/legibility/check_legibility.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/open_file.hpp"
#include "compiler/preview/preview.hpp"
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

/// As `compile_opened`, and `called` is the name of the material, if it is not empty.
std::optional<Program> compile_called(OpenedFile& opened, const FileRequest& request, const std::string& name,
                                      const std::string& called) {
  if (called.empty()) return compile_opened(opened, request, name, opened.diagnostics);
  const CheckedMaterial* found =
      chosen_material(*opened.module, name, opened.sources, opened.source, opened.diagnostics);
  if (!found) return std::nullopt;
  CheckedMaterial material = *found;
  material.name = called;
  const auto resolver = file_resolver(request.roots, nullptr, request.sandbox, request.devices);
  return compile_material(material, *opened.module, request.device, opened.sources, opened.source, *resolver,
                          opened.diagnostics);
}

ToldMaterial told_of(const Bank& bank, const Declarations& declarations) {
  const Description description = describe(bank, declarations);
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
    for (const auto& [argument, text, mend] :
         {std::tuple{"device", &options.device, device_name_mend}, std::tuple{"material", &options.material, usual_name_mend},
          std::tuple{"name", &options.name, "write in one line what errors are to call the text"}})
      if (!text->empty())
        if (auto name = is_name_text(argument, *text, mend); !name) return std::move(name.error());
    return std::nullopt;
  }

  /// The error about a device that nothing declares.
  std::optional<Error> unknown_device_in(const OpenedFile& opened, const CompileOptions& options) const {
    const std::string& device = options.device;
    if (device.empty() || !opened.module || opened.module->declarations().devices.contains(device)) return std::nullopt;
    return unknown(Code::unknown_device, "device", device, opened.module->declarations().devices.spellings());
  }

  /// What is declared where a program is described. Error: `unknown_device` if nothing declares its device.
  Result<CheckedModule> around(const Program& program, SourceSet& sources) const {
    const FileRequest asked = request({.device = program.description().device.name});
    Diagnostics diagnostics;
    const auto resolver = file_resolver(asked.roots, nullptr, asked.sandbox, asked.devices);
    CheckedModule here = check_source(sources, sources.add("here", "wale 1\n"), *resolver, diagnostics);
    if (!here.declarations().devices.contains(asked.device))
      return unknown(Code::unknown_device, "device", asked.device, here.declarations().devices.spellings());
    return here;
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

CompiledText LanguageService::compile(std::string_view text, const CompileOptions& options,
                                      const std::string& called) const {
  if (auto wrong = parts_->wrong(options)) return {.problems = {{.error = *std::move(wrong)}}};
  auto opened = parts_->opened(text, options);
  if (!opened) return {.problems = {{.error = std::move(opened.error())}}};
  if (opened->program) return {.program = std::move(opened->program)};
  CompiledText compiled;
  if (!opened->diagnostics.has_errors())
    compiled.program = compile_called(*opened, parts_->request(options), options.material, called);
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
  SourceSet sources;
  const auto here = parts_->around(program, sources);
  if (!here) return here.error();
  return told_of(Bank(program), here->declarations());
}

Result<ToldMaterial> LanguageService::tell(const Program& program, std::span<const float> parameters,
                                           PatchSize size) const {
  SourceSet sources;
  const auto here = parts_->around(program, sources);
  if (!here) return here.error();
  return told_of(Bank(program, parameters, size), here->declarations());
}

Result<std::string> LanguageService::compare(const PlacedProgram& a, const PlacedProgram& b) const {
  SourceSet sources;
  const auto here = parts_->around(a.program, sources);
  if (!here) return here.error();
  std::vector<ComparedFile> compared;
  for (const PlacedProgram* each : {&a, &b}) {
    ComparedFile& one = compared.emplace_back();
    const std::string name = each->called.empty() ? each->program.description().material : each->called;
    if (each->program.description().vibrates()) {
      one.vibrates = name;
      continue;
    }
    one.cues.push_back(cues_of(Bank(each->program, each->parameters, each->size), here->declarations()));
    one.cues.back().material = name;
  }
  if (const auto can = comparable(compared); !can) return can.error();
  return comparison_text({{compared[0].cues[0], compared[1].cues[0]}, here->declarations()});
}

Result<std::vector<std::byte>> LanguageService::preview(const Program& program, std::span<const float> parameters,
                                                        PatchSize size, const std::string& name) const {
  SourceSet sources;
  const auto here = parts_->around(program, sources);
  if (!here) return here.error();
  const Declarations& declarations = here->declarations();
  const Bank bank(program, parameters, size);
  const auto drawn = draw_preview(bank, preview_text(bank, declarations), declarations);
  if (!drawn) return drawn.error();
  return encode_page(*drawn->page, name);
}

Result<std::vector<PreviewPart>> LanguageService::preview_parts(const Program& program,
                                                                std::span<const float> parameters,
                                                                PatchSize size) const {
  SourceSet sources;
  const auto here = parts_->around(program, sources);
  if (!here) return here.error();
  const Bank bank(program, parameters, size);
  const auto drawn = draw_preview_parts(bank, preview_text(bank, here->declarations()).felt, here->declarations());
  if (!drawn) return drawn.error();
  std::vector<PreviewPart> parts;
  const auto add = [&](const std::string& name, const std::string& title, const Canvas& page) -> Result<> {
    auto bytes = encode_page(page, name + ".png");
    if (!bytes) return bytes.error();
    parts.push_back({name, title, *std::move(bytes)});
    return {};
  };
  if (auto added = add(drawn->surface ? "surface" : "field", "", *drawn->picture); !added) return added.error();
  for (const PlotPage& each : drawn->plots)
    if (auto added = add(each.name, each.title, *each.page); !added) return added.error();
  return parts;
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
