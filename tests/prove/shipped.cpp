// For every material of the library and its standard modules, the force bound holds and is close to the largest force
// that is found.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/prove/force_bound.hpp"
#include "compiler/prove/prove.hpp"
#include "compiler/prove/reachable.hpp"
#include "wale/memory.hpp"

namespace wale::shipped_test {
namespace {

struct Material {
  std::string name;
  Program program;
};

/// All materials except those of library/sandpaper, of which there are hundreds.
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
    const SourceId source = sources.add(file, read->bytes);
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

/// Strokes the program while its parameters change over their ranges. Returns the first force above `newton` or the
/// first state outside of `domain`, in words; empty when there is none.
std::string strayed(const Program& program, const Domain& domain, double newton) {
  const PatchProgram& description = program.description();
  std::mt19937 random(3);
  const auto within = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  std::vector<Bank> banks;
  for (int i = 0; i < 3; ++i) {
    std::vector<float> parameters;
    for (const Parameter& parameter : description.parameters)
      parameters.push_back(i == 0 ? parameter.value : within(parameter.low, parameter.high));
    banks.emplace_back(program, parameters, Bank(program).size());
  }
  Memory memory(program);
  Hand hand;
  const float reach = 0.5f * description.patch_width;
  memory.enter(banks[0], hand);
  for (int tick_number = 0; tick_number < 400; ++tick_number) {
    Bank& bank = banks[static_cast<std::size_t>(tick_number / 37 % 3)];
    const glm::vec2 before = hand.position;
    if (tick_number % 90 == 0) hand.position = {within(-reach, reach), within(-reach, reach)};
    hand.position += glm::vec2(within(-1e-3f, 1e-3f), within(-1e-3f, 1e-3f));
    hand.workspace = hand.position;
    hand.velocity = hand.raw_velocity = (hand.position - before) * static_cast<float>(description.device.rate);
    hand.time = tick_number / description.device.rate;
    hand.button = tick_number % 50 > 30;
    const Force force = tick(bank, memory, hand);
    if (std::hypot(force.x, force.y) > newton) return "a force above the bound";
    for (std::size_t i = 0; i < description.states.size(); ++i)
      if (!domain.states[i].contains(memory.states()[i]))
        return description.states[i].name + " becomes " + std::to_string(memory.states()[i]);
  }
  return {};
}

/// How many times what the search finds a bound may be. It presses the button once at most, waits no second, and tries no
/// long stroke beside other forces, so it misses much of what creatures, late drags and wells beside friction can push. A
/// lock that holds with 4 N only after two presses, beside a friction of 1 N, pushes with the 5 N that are proved.
double farthest_from_found(const std::string& name) { return name == "lock_key" ? 5.1 : 4; }

TEST(Shipped, MaterialsHaveBoundsThatHoldAndAreClose) {
  const std::vector<Material> materials = shipped_materials();
  ASSERT_GT(materials.size(), 50u);
  std::size_t close = 0, near = 0;
  std::string far;
  for (const auto& [name, program] : materials) {
    const ForceBound bound = force_bound(program);
    const Proof proof = prove(program);
    EXPECT_LE(bound.found.newton, bound.newton) << name;
    EXPECT_LE(bound.newton, proof.bound_newton) << name;
    for (const std::size_t axis : {0u, 1u}) {
      EXPECT_LE(bound.axis_newton[axis], program.description().device.force_newton) << name;
    }
    EXPECT_EQ(strayed(program, reachable_domain(program), bound.newton), "") << name;
    // The largest force is reproduced at the hand, parameters and size that the search reports.
    if (!bound.found.after_a_stroke) {
      Bank bank(program, bound.found.parameters, bound.found.size);
      const Force force = tick(bank, bound.found.hand);
      EXPECT_NEAR(std::hypot(force.x, force.y), bound.found.newton, 1e-6) << name;
    }
    near += bound.ratio() <= 1.5;
    if (bound.ratio() <= 1.05) {
      ++close;
    } else {
      far += name + " " + std::to_string(bound.ratio()) + "\n";
    }
    EXPECT_LT(bound.ratio(), farthest_from_found(name)) << name;
  }
  EXPECT_GE(near, materials.size() * 95 / 100) << far;
  EXPECT_GE(close, materials.size() * 85 / 100) << "ratios of the bound to the largest force found:\n" << far;
}

}  // namespace
}  // namespace wale::shipped_test
