// Programs that are printed as C++ headers and compiled give the bits of the machine: forces, states and grids, tick by
// tick, whether the processor flushes subnormal numbers or not, with everything live and with everything folded.

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>

#include "compiler/cpp/print_header.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "tests/listing/subjects.hpp"
#include "tests/temporary_folder.hpp"
#include "wale/memory.hpp"

namespace wale::listing::cpp_test {
namespace {

namespace fs = std::filesystem;

constexpr int ticks_each = 200;
constexpr std::size_t hand_members = 14;

/// Whether the processor flushes subnormal numbers while the C++ runs.
enum class Mode { of_the_machine, of_ieee };

/// The C++ function that converts rows of floats to the program's structures, runs it, and converts back.
std::string driver(const std::string& name, const PatchProgram& program, bool live) {
  std::ostringstream text;
  const std::size_t parameters = program.parameters.size(), states = program.states.size();
  const char* bank = live ? "bank, " : "";
  text << "extern \"C\" void run_" << name
       << "(const float* parameters, const float* hands, int ticks, float* forces, float* states, float* cells) {\n"
       << "  using namespace wale_patch_" << name << ";\n";
  if (live) text << "  Parameters asked;\n";
  if (live && parameters > 0) text << "  std::memcpy(static_cast<void*>(&asked), parameters, sizeof asked);\n";
  if (live) text << "  const Setup bank = setup(asked, Patch{});\n";
  text << "  const auto hand = [&](int i) {\n"
       << "    Hand hand;\n"
       << "    std::memcpy(static_cast<void*>(&hand), hands + " << hand_members << " * i, sizeof hand);\n"
       << "    return within_envelope(hand);\n"
       << "  };\n"
       << "  State state = enter(" << bank << "hand(0));\n";
  if (!program.grids.empty()) text << "  const auto grids = std::make_unique<Cells>();\n";
  text << "  for (int i = 0; i < ticks; ++i) {\n"
       << "    const Force force = tick(" << bank << "state, " << (program.grids.empty() ? "" : "*grids, ")
       << "hand(i));\n"
       << "    forces[2 * i] = force.x, forces[2 * i + 1] = force.y;\n"
       << "    float all[" << 2 * states + 1 << "];\n"
       << "    std::memcpy(all, &state, " << 2 * states << " * sizeof(float));\n"
       << "    for (int k = 0; k < " << states << "; ++k) *states++ = all[2 * k];\n"
       << "  }\n";
  if (!program.grids.empty()) text << "  std::memcpy(cells, grids.get(), sizeof *grids);\n";
  text << "  (void)parameters, (void)cells, (void)states;\n}\n\n";
  return text.str();
}

using RunProgram = void (*)(const float*, const float*, int, float*, float*, float*);

[[gnu::noinline]] void run_in_mode(Mode mode, RunProgram run, const float* parameters, const float* hands,
                                   float* forces, float* states, float* cells) {
  std::optional<FloatingPointMode> flushing;
  if (mode == Mode::of_the_machine) flushing.emplace();
  run(parameters, hands, ticks_each, forces, states, cells);
}

/// The first number whose bits differ, in words; empty when all are the same.
std::string first_difference(std::span<const float> found, std::span<const float> expected) {
  std::ostringstream text;
  for (std::size_t i = 0; i < expected.size() && text.str().empty(); ++i)
    if (std::bit_cast<std::uint32_t>(found[i]) != std::bit_cast<std::uint32_t>(expected[i]))
      text << "number " << i << " is " << std::hexfloat << found[i] << " and not " << expected[i];
  return text.str();
}

/// A walk with jumps, including places beyond the device's reach, not-a-number and subnormal numbers.
std::vector<Hand> walk(std::mt19937& random) {
  const auto in = [&](double size) { return static_cast<float>(size * (random() / 2147483648.0 - 1)); };
  std::vector<Hand> hands;
  Hand hand;
  for (int i = 0; i < ticks_each; ++i) {
    if (i % 20 == 0) hand.position = {in(0.06), in(0.06)};
    hand.velocity = {in(0.5), in(0.5)};
    hand.position += hand.velocity * (1 / 900.0f);
    hand.acceleration = {in(9), in(9)};
    hand.raw_velocity = {in(0.6), in(0.6)};
    hand.raw_acceleration = {in(20), in(20)};
    hand.workspace = hand.position + glm::vec2(0.01f, -0.02f);
    hand.time = 3 + i / 900.0;
    hand.button = random() % 3 == 0;
    hands.push_back(hand);
    Hand& last = hands.back();
    if (i % 37 == 11) last.position.x = in(1e9);
    if (i % 41 == 12) last.velocity.y = std::nanf("");
    if (i % 43 == 13) last.position.y = -INFINITY;
    if (i % 17 == 3) last.position = {in(1e-38), in(1e-44)};
    if (i % 19 == 4) last.velocity = last.raw_acceleration = {in(1e-40), in(1e-37)};
    if (i % 23 == 5) last.time = 1e-39;
  }
  return hands;
}

std::vector<float> rows_of(const std::vector<Hand>& hands) {
  std::vector<float> rows;
  for (const Hand& h : hands)
    rows.insert(rows.end(), {h.position.x, h.position.y, h.velocity.x, h.velocity.y, h.acceleration.x, h.acceleration.y,
                             h.raw_velocity.x, h.raw_velocity.y, h.raw_acceleration.x, h.raw_acceleration.y,
                             h.workspace.x, h.workspace.y, static_cast<float>(h.time), h.button ? 1.0f : 0.0f});
  return rows;
}

void compare(const Subject& subject, RunProgram run, bool live, Mode mode, std::mt19937& random) {
  const PatchProgram& description = subject.program.description();
  std::vector<float> parameters = subject.program.default_parameters();
  for (int variant = 0; variant < (live ? 2 : 1); ++variant) {
    const std::vector<Hand> hands = walk(random);
    Bank bank(subject.program, parameters, subject.program.default_size());
    Memory memory(subject.program);
    memory.enter(bank, hands[0]);
    std::vector<float> forces, states;
    for (const Hand& hand : hands) {
      const Force force = tick(bank, memory, hand);
      forces.insert(forces.end(), {force.x, force.y});
      states.insert(states.end(), memory.states().begin(), memory.states().end());
    }
    std::vector<float> cpp_forces(forces.size()), cpp_states(states.size() + 1), cpp_cells(memory.cells().size() + 1);
    const std::vector<float> rows = rows_of(hands);
    run_in_mode(mode, run, parameters.data(), rows.data(), cpp_forces.data(), cpp_states.data(), cpp_cells.data());
    cpp_states.pop_back();
    cpp_cells.pop_back();
    ASSERT_EQ(first_difference(cpp_forces, forces), "") << subject.what << ", forces";
    ASSERT_EQ(first_difference(cpp_states, states), "") << subject.what << ", states";
    ASSERT_EQ(first_difference(cpp_cells, memory.cells()), "") << subject.what << ", cells";
    // The second run has other parameters, some of them outside of their ranges.
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const Parameter& p = description.parameters[i];
      parameters[i] = p.low + (p.high - p.low) * static_cast<float>(random() / 4294967296.0);
      if (random() % 8 == 0) parameters[i] = 2 * p.high + 1;
      if (random() % 8 == 0) parameters[i] = std::nanf("");
      if (random() % 8 == 0) parameters[i] = random() % 2 == 0 ? 1e-40f : -1e-40f;
    }
  }
}

/// The header of a subject; a folded one has another name, so that it can stand beside the live one.
std::string header_of(const Subject& subject, bool live) {
  if (live) {
    LiveParts all;
    all.parameters.assign(subject.program.description().parameters.size(), true);
    all.size = true;
    return print_header(subject.program, all);
  }
  PatchProgram folded = subject.program.description();
  folded.material = "f" + folded.material;
  return print_header(*Program::load(std::move(folded)), {});
}

/// The option for instructions that multiply and add at once, if this processor has them.
std::string fused() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("fma")) return " -mfma";
#endif
  return "";
}

/// All subjects, compiled by one call of `compiler`, against the machine.
void compare_all(const std::string& compiler) {
  const TemporaryFolder folder;
  static const auto all = subjects();
  const std::string source = folder / "programs.cpp", object = folder / "programs.so";
  {
    std::ofstream file(source);
    std::string drivers;
    for (const Subject& subject : all)
      for (const bool live : {true, false}) {
        const PatchProgram& description = subject.program.description();
        file << header_of(subject, live) << "\n";
        drivers += driver((live ? "" : "f") + description.material, description, live);
      }
    file << "#include <cstring>\n#include <memory>\n\n" << drivers;
  }
  if (const char* kept = std::getenv("WALE_KEEP_CPP"))
    fs::copy_file(source, kept, fs::copy_options::overwrite_existing);
  // The compiler gets no include path of this project, and may use instructions that multiply and add at once.
  // WALE_CPP_FLAGS="-O3" in the environment shows in a few minutes that optimisation changes no bit.
  const char* flags = std::getenv("WALE_CPP_FLAGS");
  const std::string command = compiler + " -std=c++17 " + (flags ? flags : "-O1") + fused() +
                              " -fno-exceptions -fno-rtti -Wall -Wextra -Werror -fPIC -shared -o " + object + " " +
                              source + " 2>" + (folder / "errors");
  const int status = std::system(command.c_str());
  std::ifstream errors(folder / "errors");
  ASSERT_EQ(status, 0) << std::string{std::istreambuf_iterator<char>(errors), {}}.substr(0, 4000);
  void* library = dlopen(object.c_str(), RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(library, nullptr) << dlerror();
  std::mt19937 random(1995);
  for (const Subject& subject : all)
    for (const bool live : {true, false})
      for (const Mode mode : {Mode::of_the_machine, Mode::of_ieee}) {
        const std::string name = (live ? "run_" : "run_f") + subject.program.description().material;
        const auto run = reinterpret_cast<RunProgram>(dlsym(library, name.c_str()));
        ASSERT_NE(run, nullptr);
        compare(subject, run, live, mode, random);
        if (testing::Test::HasFatalFailure()) {
          ADD_FAILURE() << name << (mode == Mode::of_ieee ? " with" : " without") << " subnormal numbers";
          return;
        }
      }
  dlclose(library);
  testing::Test::RecordProperty("programs", std::to_string(all.size()));
}

TEST(Cpp, CompiledGivesTheBitsOfTheMachine) { compare_all(WALE_CXX_COMPILER); }

TEST(Cpp, CompiledByClangGivesTheBitsOfTheMachine) {
  const std::string clang = WALE_CLANG;
  if (clang.empty()) GTEST_SKIP() << "there is no clang++ (Debian: clang)";
  if (clang == WALE_CXX_COMPILER) GTEST_SKIP() << "it is the compiler of the other test";
  compare_all(clang);
}

}  // namespace
}  // namespace wale::listing::cpp_test
