#include "compiler/build_stage.hpp"

#include <fmt/format.h>

#include "compiler/emit/lower.hpp"
#include "compiler/emit/source_lines.hpp"
#include "compiler/listing/print_checked.hpp"
#include "compiler/listing/print_cpp.hpp"
#include "compiler/listing/print_graph.hpp"
#include "compiler/listing/print_program.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/parse/print_tree.hpp"
#include "compiler/prove/prove.hpp"
#include "compiler/solve/solve.hpp"

namespace wale {

namespace {

/// With what is proved of each result.
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

std::optional<std::string> build_stage(const OpenedFile& opened, const FileRequest& request,
                                       const std::string& material, BuildStage stage, Diagnostics& diagnostics,
                                       std::string& refusal) {
  const bool of_source = stage == BuildStage::tree || stage == BuildStage::checked || stage == BuildStage::ir;
  if (opened.program && of_source) {
    refusal = fmt::format("`{}` is compiled already: of a patch program there are the listing and cpp", request.file);
    return std::nullopt;
  }
  if (stage == BuildStage::tree) {
    Diagnostics known;  // the file has been parsed before, and what is wrong with it has been said
    return print_tree(parse(opened.sources, opened.source, known));
  }
  if (!of_source) {
    const auto program = opened.program ? opened.program : compile_opened(opened, request, material, diagnostics);
    if (!program) return std::nullopt;
    return stage == BuildStage::listing ? listing_of(*program) : print_cpp(program->description());
  }
  const CheckedModule& module = *opened.module;
  const CheckedMaterial* checked = chosen_material(module, material, opened.source, diagnostics);
  if (!checked) return std::nullopt;
  const SourceLines lines(opened.sources, module.modules);
  if (stage == BuildStage::checked) return print_checked(*checked, module.declarations().names(), lines);
  const auto resolver = file_resolver(request.roots);
  const SolvedMaterial solved = solve(*checked, module, request.device, opened.sources, *resolver, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  return print_graph(lower(solved), solved, lines);
}

}  // namespace wale
