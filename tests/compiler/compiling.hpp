#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"
#include "wale/program.hpp"

namespace wale::compiling {

/// Files in memory, by name.
class Files final : public Resolver {
 public:
  std::map<std::string, std::string> contents;

  Result<ResolvedFile> module(const std::string& path, const std::string&) override { return file(path, ""); }
  Result<ResolvedFile> file(const std::string& name, const std::string&) override {
    const auto found = contents.find(name);
    if (found == contents.end()) return Error{Code::unreadable_file, "no such file"};
    return ResolvedFile{name, found->second};
  }
};

/// A text and the programs of all its materials. Throws std::runtime_error with the diagnostics when there are errors.
struct Compiled {
  std::map<std::string, Program> programs;

  explicit Compiled(std::string text, Files files = {}) {
    SourceSet sources;
    Diagnostics diagnostics;
    const SourceId source = sources.add("test.wale", std::move(text));
    const CheckedModule module = check_source(sources, source, files, diagnostics);
    for (const auto& material : module.materials)
      if (!diagnostics.has_errors())
        if (const auto program =
                compile_material(module, material.name, default_device, sources, source, files, diagnostics))
          programs.emplace(material.name, *program);
    if (!diagnostics.has_errors()) return;
    std::string reasons = sources[source].text + "\n";
    for (const auto& diagnostic : diagnostics.all()) reasons += render_text(diagnostic, sources, false);
    throw std::runtime_error(reasons);
  }

  const Program& only() const { return programs.begin()->second; }
};

/// The program of a material with the block `physical`, beside other declarations, and with the block `perceptual`
/// unless that is empty.
inline Program compiled(const std::string& physical, const std::string& declarations = "",
                        const std::string& perceptual = "", Files files = {}) {
  const std::string percept = perceptual.empty() ? "" : "  perceptual { " + perceptual + " }\n";
  return Compiled("wale 1\n" + declarations + "\nmaterial m {\n" + percept + "  physical {\n" + physical + "\n  }\n}\n",
                  std::move(files))
      .only();
}

}  // namespace wale::compiling
