// A libFuzzer target for the parts that read Wale. Any bytes are parsed, printed, reported on, formatted, checked and
// compiled without a crash. Formatting keeps the meaning, and a second formatting changes nothing.

#include <cstdio>
#include <cstdlib>
#include <string>

#include "compiler/compile.hpp"
#include "compiler/compile_workspace.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/format/format.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/parse/print_tree.hpp"

namespace {

/// Larger inputs find the same faults as smaller ones, but later.
constexpr std::size_t largest_input = 4096;
/// Each patch of a workspace takes as long as a material.
constexpr std::size_t most_patches = 3;

/// Finds no imports and no images.
class NoFiles final : public wale::Resolver {
 public:
  wale::Result<wale::ResolvedFile> module(const std::string&, const std::string&) override {
    return wale::Error{wale::Code::unreadable_file, "no such file"};
  }
  wale::Result<wale::ResolvedFile> file(const std::string&, const std::string&) override {
    return wale::Error{wale::Code::unreadable_file, "no such file"};
  }
};

void require(bool held, const char* what, const std::string& text) {
  if (held) return;
  std::fprintf(stderr, "%s:\n%s\n", what, text.c_str());
  std::abort();
}

std::string tree_of(const std::string& text) {
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  return print_tree(parse(sources, sources.add("fuzz.wale", text), diagnostics));
}

std::optional<std::string> formatted(const std::string& text) {
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  return format(sources, sources.add("fuzz.wale", text), diagnostics);
}

/// Reading takes microseconds, checking the language's own files milliseconds, measuring a program a tenth of a second
/// to five seconds under the sanitizers: of every 16 inputs all are read, 4 checked and 3 compiled, each for another
/// device. Which, the input alone decides.
unsigned turn_of(const std::string& text) {
  unsigned hash = 2166136261u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return (hash >> 8) % 16;
}

void check_and_compile(const std::string& text) {
  const unsigned turn = turn_of(text);
  if (turn >= 4) return;
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  NoFiles resolver;
  const wale::SourceId source = sources.add("fuzz.wale", text);
  const wale::CheckedModule module = check_source(sources, source, resolver, diagnostics);
  const char* devices[] = {wale::default_device, "touch_pad", "gamepad"};
  if (turn < 3 && !diagnostics.has_errors() && !module.materials.empty())
    compile_material(module, module.materials.front().name, devices[turn], sources, source, resolver, diagnostics);
  if (turn < 3 && !diagnostics.has_errors() && !module.workspaces.empty()) {
    wale::CheckedWorkspace workspace = module.workspaces.front();
    if (workspace.patches.size() > most_patches) workspace.patches.resize(most_patches);
    compile_workspace(workspace, module, devices[turn], sources, source, resolver, diagnostics);
  }
  render_json(diagnostics, sources);
  for (const wale::Diagnostic& each : diagnostics.all()) render_text(each, sources, true);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size) {
  if (size > largest_input) return 0;
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  const std::string tree = print_tree(parse(sources, sources.add("fuzz.wale", text), diagnostics));
  if (!diagnostics.has_errors()) {
    const auto once = formatted(text);
    require(once.has_value(), "not formatted", text);
    require(tree_of(*once) == tree, "another meaning", *once);
    require(formatted(*once) == once, "formatted twice", *once);
  }
  render_json(diagnostics, sources);
  for (const wale::Diagnostic& each : diagnostics.all()) render_text(each, sources, true);
  check_and_compile(text);
  return 0;
}
