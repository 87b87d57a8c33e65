// Every material of the library and its standard modules: no force found is above its bound, and the bounds are close.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/prove/force_bound.hpp"
#include "compiler/prove/prove.hpp"

namespace wale::shipped_test {
namespace {

struct Material {
  std::string name;
  Program program;
};

/// All but the thesis's own, of which there are hundreds.
std::vector<Material> shipped_materials() {
  const std::filesystem::path library = std::filesystem::path(WALE_SOURCE_DIR) / "library";
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(library)) {
    if (entry.path().extension() == ".wale" && entry.path().parent_path().filename() != "sandpaper") {
      files.push_back(entry.path().string());
    }
  }
  std::ranges::sort(files);
  std::vector<Material> materials;
  for (const std::string& file : files) {
    SourceSet sources;
    Diagnostics diagnostics;
    const auto resolver = file_resolver({library.string()});
    auto read = read_file(file);
    const SourceId source = sources.add(file, std::get<ResolvedFile>(read).bytes);
    const CheckedModule module = check_source(sources, source, *resolver, diagnostics);
    for (const CheckedMaterial& material : module.materials) {
      if (auto program =
              compile_material(module, material.name, default_device, sources, source, *resolver, diagnostics)) {
        materials.push_back({material.name, *program});
      }
    }
  }
  return materials;
}

TEST(Shipped, MaterialsHaveBoundsThatHoldAndAreClose) {
  const std::vector<Material> materials = shipped_materials();
  ASSERT_GT(materials.size(), 50u);
  std::size_t close = 0;
  std::string far;
  for (const auto& [name, program] : materials) {
    const ForceBound bound = force_bound(program);
    const Proof proof = prove(program);
    EXPECT_LE(bound.found.newton, bound.newton) << name;
    EXPECT_LE(bound.newton, proof.bound_newton) << name;
    for (const std::size_t axis : {0u, 1u}) {
      EXPECT_LE(bound.axis_newton[axis], program.description().device.force_newton) << name;
    }
    // What is found is found again where it was found.
    if (!bound.found.after_a_stroke) {
      Bank bank(program, bound.found.parameters, bound.found.size);
      const Force force = tick(bank, bound.found.hand);
      EXPECT_NEAR(std::hypot(force.x, force.y), bound.found.newton, 1e-6) << name;
    }
    if (bound.ratio() <= 1.05) {
      ++close;
    } else {
      far += name + " " + std::to_string(bound.ratio()) + "\n";
    }
    EXPECT_LT(bound.ratio(), 5) << name;
  }
  EXPECT_GE(close, materials.size() * 3 / 4) << "ratios of the bound to the largest force found:\n" << far;
}

}  // namespace
}  // namespace wale::shipped_test
