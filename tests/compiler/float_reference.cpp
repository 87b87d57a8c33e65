// The machine, in one lane and in blocks, against the slow evaluator of terms in 32-bit floats: every bit of forces,
// states and memories, for all shipped materials and for random ones.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "compiler/solve/solve.hpp"
#include "tests/compiler/compiling.hpp"
#include "tests/compiler/random_material.hpp"
#include "tests/reference/float_evaluator.hpp"
#include "wale/memory.hpp"

namespace wale::compiling::float_reference_test {
namespace {

constexpr int ticks_each = 6;

/// All materials of a text, each solved and compiled.
class Solved {
 public:
  Solved(const std::string& name, std::string text, Resolver& resolver) {
    Diagnostics diagnostics;
    const SourceId source = sources_.add(name, std::move(text));
    const CheckedModule module = check_source(sources_, source, resolver, diagnostics);
    for (const auto& material : module.materials) {
      if (diagnostics.has_errors()) break;
      SolvedMaterial solved = solve_as_read(material, module, default_device, sources_, resolver, diagnostics);
      auto program = compile_material(module, material.name, default_device, sources_, source, resolver, diagnostics);
      if (program) materials.push_back({std::move(solved), *program});
    }
    if (!diagnostics.has_errors()) return;
    std::string reasons = sources_[source].text + "\n";
    for (const auto& diagnostic : diagnostics.all()) reasons += render_text(diagnostic, sources_, false);
    throw std::runtime_error(reasons);
  }

  struct Material {
    SolvedMaterial solved;
    Program program;
  };
  std::vector<Material> materials;

 private:
  SourceSet sources_;
};

std::vector<Hand> random_hands(std::mt19937& random) {
  const auto in = [&](double size) { return static_cast<float>(size * (random() / 2147483648.0 - 1)); };
  std::vector<Hand> hands;
  for (int i = 0; i < ticks_each; ++i) {
    Hand hand;
    hand.position = {in(0.07), in(0.07)};
    hand.velocity = {in(0.5), in(0.5)};
    hand.acceleration = {in(8), in(8)};
    hand.raw_velocity = {in(0.5), in(0.5)};
    hand.raw_acceleration = {in(8), in(8)};
    hand.workspace = {in(0.1), in(0.1)};
    hand.time = 5 + in(5);
    hand.button = in(1) > 0;
    if (i % 3 == 2) {  // subnormal, or nearly
      hand.position = {in(1e-38), in(4e-44)};
      hand.velocity = hand.workspace = {in(2e-38), in(1e-37)};
      hand.time = 1e-39;
    }
    hands.push_back(hand);
  }
  return hands;
}

/// All inputs of a tick, in the order of `Input`.
reference::FloatInputs inputs_of(const Hand& hand, const PatchProgram& program) {
  reference::FloatInputs inputs{};
  const float all[] = {hand.position.x,
                       hand.position.y,
                       hand.velocity.x,
                       hand.velocity.y,
                       0.5f * program.patch_width,
                       0.5f * program.patch_height,
                       program.patch_rim,
                       0,
                       hand.acceleration.x,
                       hand.acceleration.y,
                       hand.raw_velocity.x,
                       hand.raw_velocity.y,
                       hand.raw_acceleration.x,
                       hand.raw_acceleration.y,
                       hand.workspace.x,
                       hand.workspace.y,
                       static_cast<float>(hand.time),
                       hand.button ? 1.0f : 0.0f,
                       static_cast<float>(1 / program.device.rate)};
  std::ranges::copy(all, inputs.begin());
  return inputs;
}

std::vector<std::uint32_t> bits(std::span<const float> values) {
  std::vector<std::uint32_t> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}

std::vector<std::uint32_t> bits(const Force& force) { return bits(std::array{force.x, force.y}); }

/// Expects the same bits of the machine and the evaluator. `what` names the material in failures.
void compare(const Solved::Material& material, std::mt19937& random, const std::string& what) {
  const PatchProgram& program = material.program.description();
  std::vector<float> parameters = material.program.default_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto& declared = program.parameters[i];
    parameters[i] *= static_cast<float>(1 + 0.2 * (random() / 2147483648.0 - 1));
    parameters[i] = std::clamp(parameters[i], declared.low, declared.high);
  }
  Bank bank(material.program, parameters, material.program.default_size());
  reference::FloatSimulation simulation(material.solved, parameters, inputs_of({}, program));
  const std::vector<Hand> hands = random_hands(random);

  // One hand after the other, with one memory.
  Memory memory(material.program);
  memory.enter(bank, hands[0]);
  simulation.enter(inputs_of(hands[0], program));
  for (const Hand& hand : hands) {
    const Force force = tick(bank, memory, hand);
    ASSERT_EQ(bits(force), bits(simulation.tick(inputs_of(hand, program)))) << what;
    ASSERT_EQ(bits(memory.states()), bits(simulation.states())) << what;
  }
  ASSERT_EQ(bits(memory.cells()), bits(simulation.cells())) << what;

  // Side by side, each just having entered.
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const auto inputs = inputs_of(hands[i], program);
    simulation.place();
    simulation.enter(inputs);
    ASSERT_EQ(bits(forces[i]), bits(simulation.tick(inputs))) << what;
    ASSERT_EQ(bits(tick(bank, hands[i])), bits(forces[i])) << what;
  }
}

/// The patches of 1995, the parts of `std` and one in five of the other files; with WALE_ALL_MATERIALS in the environment,
/// all.
std::vector<std::string> library_files() {
  std::vector<std::string> files;
  const std::filesystem::path library = std::filesystem::path(WALE_SOURCE_DIR) / "library";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(library))
    if (entry.path().extension() == ".wale") files.push_back(entry.path().string());
  std::ranges::sort(files);
  std::size_t kinds = 0;
  if (!std::getenv("WALE_ALL_MATERIALS"))
    std::erase_if(files, [&](const std::string& path) {
      return path.find("/std/") == std::string::npos && path.find("/sandpaper/") == std::string::npos && kinds++ % 5 != 0;
    });
  return files;
}

TEST(FloatReference, AgreesWithTheMachineOnWhatIsShipped) {
  std::mt19937 random(1995);
  std::size_t compared = 0;
  const auto resolver = file_resolver({});
  for (const auto& path : library_files()) {
    const Solved solved(path, read_file(path)->bytes, *resolver);
    // The stimuli of library/sandpaper differ only in their figures, and the evaluator needs half a second for each
    // peak, so only every twentieth is compared. With WALE_ALL_MATERIALS in the environment, all are.
    const bool stimuli = solved.materials.size() > 25 && !std::getenv("WALE_ALL_MATERIALS");
    for (std::size_t i = 0; i < solved.materials.size(); i += stimuli ? 20 : 1) {
      const auto& material = solved.materials[i];
      compare(material, random, path + " " + material.solved.name);
      if (HasFatalFailure()) return;
      ++compared;
    }
  }
  RecordProperty("materials", std::to_string(compared));
  EXPECT_GT(compared, 60u);
}

TEST(FloatReference, AgreesWithTheMachineOnRandomMaterials) {
  std::mt19937 random(1996);
  Files none;
  for (std::uint32_t seed = 0; seed < 1000; ++seed) {
    RandomMaterial material(seed);
    if (seed % 2 == 0)
      material.write();
    else
      material.write_with_states();
    const Solved solved("test.wale", material.text(false), none);
    compare(solved.materials.front(), random, "seed " + std::to_string(seed) + "\n" + material.text(false));
    if (HasFatalFailure()) return;
  }
}

// Random materials have no heights; these have peaks and slopes of heights.
TEST(FloatReference, AgreesWithTheMachineOnHeights) {
  std::mt19937 random(1997);
  Files none;
  const std::vector<std::string> heights = {
      "grating(x + 0.3 * y, period: 3 mm, duty: 0.4, smooth: 0.1)",
      "grating(x, period: 3 mm) * grating(y, period: wale)",
      "gradient_noise(x / wale, y / wale) + noise(x / wale)",
      "sqrt(abs(x * y) / (1 mm^2)) + sin(x / (1 mm)) * exp(-abs(y) / (10 mm))",
      "if x < y then normal(x / wale) else atan2(y, x) + tanh(x / (2 mm))",
      "min(x / wale, fract(y / (2 mm))) ^ 2",
  };
  for (const auto& height : heights) {
    for (const std::string force :
         {"lateral(h, amplitude: 1.3 N)", "-(2 N mm) * grad(h) / (1 + 0.01 * length(grad(h)) * (1 mm))"}) {
      const std::string text =
          "wale 1\nmaterial m {\n  physical {\n    param wale = 2 mm in 1 mm .. 5 mm\n    height h = " + height +
          "\n    force = " + force + "\n  }\n}\n";
      SCOPED_TRACE(text);
      const Solved solved("test.wale", text, none);
      compare(solved.materials.front(), random, text);
      if (HasFatalFailure()) return;
    }
  }
}

// Operations that choose among their operands, with subnormal operands. The quotient depends on the sign of a zero.
TEST(FloatReference, AgreesWithTheMachineOnSubnormalNumbers) {
  std::mt19937 random(1999);
  Files none;
  for (const std::string length :
       {"min(x, 1e-40 m)", "max(x, -1e-40 m)", "clamp(x, -1e-41 m, 1e-42 m)", "if x < y then tiny else -tiny",
        "min(tiny, max(x, -tiny))", "if tiny > 0 m then x else y", "s", "abs(min(s, tiny))",
        "track(vector(y, x)) + min(x, y)"}) {
    const std::string text =
        "wale 1\nmaterial m {\n  physical {\n    param tiny = 1e-40 m in -1e-39 m .. 1 mm\n"
        "    state s : length = x in -1e-40 m .. 1e-39 m\n    next s = min(x, tiny)\n"
        "    memory track : length = -1e-41 m in -1e-40 m .. 1e-40 m, cell 20 mm\n    next track = x\n"
        "    let a = " +
        length + "\n    force = vector((1e-3 N m) / a, a * 1e38 N/m)\n  }\n}\n";
    SCOPED_TRACE(text);
    const Solved solved("test.wale", text, none);
    for (int i = 0; i < 5; ++i) compare(solved.materials.front(), random, text);
    if (HasFatalFailure()) return;
  }
}

TEST(FloatReference, AgreesWithTheMachineOnTables) {
  std::mt19937 random(1998);
  Files files;
  files.contents["push.csv"] = "place (mm),push (N)\n0,0\n1,1\n2,3\n3,2\n";
  const std::string text =
      "wale 1\nmaterial m {\n  physical {\n    param at = 2 mm in 0 mm .. 3 mm\n    let push = table(\"push.csv\")\n"
      "    force = vector(push(1 mm) * push(at) / (1 N), push(x * 0.1) + push(at + y) - push(3 mm))\n  }\n}\n";
  const Solved solved("test.wale", text, files);
  for (int i = 0; i < 10; ++i) compare(solved.materials.front(), random, text);
}

}  // namespace
}  // namespace wale::compiling::float_reference_test
