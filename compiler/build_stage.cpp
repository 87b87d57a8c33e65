#include "compiler/build_stage.hpp"

#include <fmt/format.h>

#include "compiler/cpp/print_header.hpp"
#include "compiler/emit/lower.hpp"
#include "compiler/emit/source_lines.hpp"
#include "compiler/listing/print_checked.hpp"
#include "compiler/listing/print_graph.hpp"
#include "compiler/listing/print_program.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/parse/print_tree.hpp"
#include "compiler/prove/prove.hpp"
#include "compiler/solve/solve.hpp"

namespace wale {

namespace {

/// The listing, with the proved range of each result.
std::string listing_of(const Program& program) {
  const Proof proof = prove(program);
  const auto ranges_of = [&](CodeSection section, std::size_t index) -> const Proof::Ranges& {
    switch (section) {
      case CodeSection::setup: return proof.setup;
      case CodeSection::peak: return proof.peaks[index];
      case CodeSection::enter: return proof.enter;
      case CodeSection::tick: return proof.tick;
      case CodeSection::picture: return proof.picture;
      case CodeSection::frame: return proof.frame;
      case CodeSection::prediction: break;
    }
    return proof.predictions[index];
  };
  return print_program(program.description(),
                       [&](CodeSection section, std::size_t index, std::size_t number) -> std::optional<std::string> {
                         return shown(ranges_of(section, index)[number][0]);
                       });
}

}  // namespace

Result<std::optional<std::string>> build_stage(const OpenedFile& opened, const FileRequest& request,
                                               const std::string& material, BuildStage stage, Diagnostics& diagnostics,
                                               const std::vector<std::string>& live) {
  using Text = std::optional<std::string>;
  const bool of_source = stage == BuildStage::tree || stage == BuildStage::checked || stage == BuildStage::ir;
  if (opened.program && of_source)
    return Error{.code = Code::malformed_value,
                 .sentence = "a patch program has only the stages listing and cpp",
                 .mend = "show one of these, or name the Wale file that it was built from",
                 .place = {.name = "--emit"}};
  if (stage == BuildStage::tree) {
    Diagnostics known;  // discarded: the file has been parsed before, and its errors have been reported
    return Text(print_tree(parse(opened.sources, opened.source, known)));
  }
  if (!of_source) {
    const auto program = opened.program ? opened.program : compile_opened(opened, request, material, diagnostics);
    if (!program) return Text();
    if (stage == BuildStage::listing) return Text(listing_of(*program));
    const auto parts = live_parts(program->description(), live);
    if (!parts) return parts.error();
    return Text(print_header(*program, *parts));
  }
  const CheckedModule& module = *opened.module;
  const CheckedMaterial* checked = chosen_material(module, material.empty() ? opened.material : material,
                                                   opened.sources, opened.source, diagnostics);
  if (!checked) return Text();
  const SourceLines lines(opened.sources, module.modules);
  if (stage == BuildStage::checked) return Text(print_checked(*checked, module.declarations().names(), lines));
  const auto resolver = file_resolver(request.roots, nullptr, request.sandbox, request.devices);
  const SolvedMaterial solved = solve_as_read(*checked, module, request.device, opened.sources, *resolver, diagnostics);
  if (diagnostics.has_errors()) return Text();
  const LoweredMaterial lowered = lower(solved, diagnostics);
  return diagnostics.has_errors() ? Text() : Text(print_graph(lowered, solved, lines));
}

}  // namespace wale
