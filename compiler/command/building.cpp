#include <fmt/format.h>

#include <algorithm>

#include "compiler/build_all.hpp"
#include "compiler/build_stage.hpp"
#include "compiler/command/verbs.hpp"

// What becomes of a material.

namespace wale::command {

int build(const Choice& choice, const std::string& out) {
  const auto programs = load_programs(choice, false);
  if (programs.empty()) return refused;
  const auto bytes = write_patch_program(programs.front().description());
  if (const auto problem = write_file(out, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}))
    return refuse(*problem);
  return 0;
}

int show_stage(const Choice& choice, const std::string& name, const std::string& out) {
  const auto known = std::ranges::find(stage_names, name, &StageName::name);
  auto opened = open(choice);
  if (!opened) return refused;
  std::string refusal;
  const auto text = build_stage(*opened, choice.request(), choice.material, known->stage, opened->diagnostics, refusal);
  print_diagnostics(stderr, opened->diagnostics, opened->sources);
  if (!refusal.empty()) return refuse(refusal);
  if (!text) return refused;
  if (const auto problem = write_file(out, *text)) return refuse(*problem);
  return 0;
}

int build_collection(const Choice& choice, const std::string& folder) {
  const auto opened = open(choice);
  if (!opened) return refused;
  if (opened->program) return refuse("--all builds the materials of a Wale file, and this is a program already");
  print_diagnostics(stderr, opened->diagnostics, opened->sources);
  const BuiltCollection collection = build_all(*opened, choice.request(), folder);
  if (!collection.refusal.empty()) return refuse(collection.refusal);
  for (const auto& built : collection.materials) {
    print_diagnostics(stderr, built.diagnostics, opened->sources);
    if (!built.problem.empty()) refuse(built.problem);
    if (built.path.empty())
      refuse(fmt::format("`{}` is not built", built.material));
    else
      fmt::print("{}  {} bytes\n", built.path, built.bytes);
  }
  const std::size_t all = collection.materials.size(), built = collection.built();
  fmt::print("{} of {} material{} built\n", built, all, all == 1 ? "" : "s");
  return built == all ? 0 : refused;
}

}  // namespace wale::command
