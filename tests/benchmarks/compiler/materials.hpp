#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/emit/emit.hpp"
#include "compiler/emit/lower.hpp"
#include "compiler/solve/solve.hpp"
#include "runtime/machine/verify.hpp"

namespace wale::benchmarks {

/// A material as a designer writes one: 40 lines.
inline const std::string material_of_40_lines = R"(wale 1

/// Ribs across rings in a slow fluid, worn smooth at the middle.
material worn_cord {
  representative {
    title  "Worn cord"
    called "worn cord", "old corduroy", "cord in oil"
    kind   fabric.woven
  }
  perceptual {
    roughness 0.6
  }
  physical {
    patch 120 mm, 100 mm
    param wale   = 2.5 mm in 1 mm .. 5 mm         "distance between ribs"
    param duty   = 0.5 in 0.2 .. 0.8              "part of it which is rib"
    param spread = 8 mm in 4 mm .. 20 mm          "from ring to ring"
    param wear   = 30 % in 0 % .. 100 %           "how much of the middle is gone"
    param drag   = 2 N s/m in 0 N s/m .. 8 N s/m  "of the oil"
    param pull   = 12 N/m in 0 N/m .. 40 N/m      "towards the middle"

    // Where the hand is, in several ways.
    let radius = length(hand)
    let along  = x * cos(10 deg) + y * sin(10 deg)
    let across = y * cos(10 deg) - x * sin(10 deg)
    let middle = exp(-(radius / 25 mm)^2)
    let left   = 1 - wear * middle
    let reach  = if x < 0 m then 1 else 1 - smoothstep(x / 50 mm)

    // What is there.
    height ribs  = grating(along, period: wale, duty: duty)
    height rings = 0.3 * grating(radius, period: spread, smooth: 0.1)
    height weave = 0.1 * sin(2 pi * across / 1 mm) * reach
    height face  = left * (ribs + rings) + weave

    force =
      lateral(face) +
      viscous(drag) + spring(pull)
  }
}
)";

/// What a device has to realise by itself, with a map to solve for each percept.
inline const std::string material_of_five_percepts = R"(wale 1

material wet_felt {
  perceptual {
    roughness 0.3
    stickiness 0.5
    hardness 0.3
    springiness 0.2
    viscosity 0.3
  }
}
)";

/// No imports and no images.
class NoFiles final : public Resolver {
 public:
  Result<ResolvedFile> module(const std::string&, const std::string&) override {
    return Error{Code::unreadable_file, "no such file"};
  }
  Result<ResolvedFile> file(const std::string&, const std::string&) override {
    return Error{Code::unreadable_file, "no such file"};
  }
};

/// What compiling needs beside the text.
struct Desk {
  SourceSet sources;
  Diagnostics diagnostics;
  NoFiles resolver;

  SourceId add(const std::string& text) { return sources.add("benchmark.wale", text); }

  /// Throws what is wrong: a benchmark of an error would be one of something else.
  void expect_no_errors() const {
    if (!diagnostics.has_errors()) return;
    throw std::runtime_error(render_text(diagnostics.all().front(), sources, false));
  }
};

/// From a checked material to its patch program, which is still to be verified.
inline PatchProgram emitted(const CheckedMaterial& material, const CheckedModule& module, Desk& desk) {
  const SolvedMaterial solved = solve(material, module, default_device, desk.sources, desk.resolver, desk.diagnostics);
  auto program = emit(lower(solved, desk.diagnostics), solved, desk.diagnostics);
  desk.expect_no_errors();
  return std::move(*program);
}

inline PatchProgram emitted(const std::string& text) {
  Desk desk;
  const CheckedModule module = check_source(desk.sources, desk.add(text), desk.resolver, desk.diagnostics);
  desk.expect_no_errors();
  return emitted(module.materials.front(), module, desk);
}

/// Text to patch program. That the machine takes it belongs to this: the compiler gives away no other, and tells the
/// author what is refused. Making it ready to run does not: see `loaded`.
inline PatchProgram compiled(const std::string& text) {
  PatchProgram program = emitted(text);
  if (const auto verified = verify(program); !verified) throw std::runtime_error(in_words(verified.error()));
  return program;
}

/// Verified and decoded: what measuring begins with, and the runtime.
inline Program loaded(PatchProgram program) {
  auto loaded = Program::load(std::move(program));
  if (!loaded) throw std::runtime_error(in_words(loaded.error()));
  return *std::move(loaded);
}

/// Every Wale file that the project ships: path and text.
inline std::vector<std::pair<std::string, std::string>> shipped_files() {
  namespace fs = std::filesystem;
  std::vector<std::pair<std::string, std::string>> files;
  for (const char* folder : {"schema", "calibration", "library"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(WALE_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".wale") {
        std::ifstream file(entry.path(), std::ios::binary);
        files.emplace_back(entry.path().string(), std::string(std::istreambuf_iterator<char>(file), {}));
      }
  std::ranges::sort(files);
  return files;
}

/// A file of about so many lines: constants, each of which uses one from the upper half, and materials of ten lines.
inline std::string large_file(long lines) {
  std::string text = "wale 1\nlet c0 = 1\nlet c1 = 0.5\n";
  for (long i = 2; i < lines / 2; ++i) text += fmt::format("let c{} = 0.5 * c{} + 1 / 2\n", i, i / 2);
  for (long i = 0; i < lines / 20; ++i)
    text += fmt::format(
        "material m{0} {{\n  perceptual {{ roughness 0.5 }}\n  physical {{\n"
        "    param wale = 2.5 mm in 1 mm .. 5 mm\n    let a = c{1} * x\n    let b = a + y\n"
        "    height ribs = grating(b, period: wale)\n    force = lateral(ribs)\n  }}\n}}\n",
        i, i % std::max(1L, lines / 2));
  return text;
}

/// A material with a chain of values, each of which uses the one before it twice.
inline std::string chain_of_lets(long links) {
  std::string text = "wale 1\nmaterial m {\n  physical {\n    let a0 = x / 1 m\n";
  for (long i = 1; i <= links; ++i) text += fmt::format("    let a{} = 0.25 * a{} + a{} / 4\n", i, i - 1, i - 1);
  return text + fmt::format("    force = vector(a{} * 1 N, 0 N)\n  }}\n}}\n", links);
}

}  // namespace wale::benchmarks
