#include "compiler/cpp/header_frame.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/cpp/shared_arithmetic.hpp"
#include "compiler/listing/figures.hpp"
#include "schema/fnv1a.hpp"

namespace wale {
namespace {

std::string guard_of(const HeaderFrame& frame) {
  return fmt::format("WALE_PATCH_{}_HPP", CppNames::sanitised(frame.program.material));
}

std::string title_of(const PatchProgram& program) {
  for (const auto& [key, texts] : program.layers.representative)
    if (key == "title" && !texts.empty()) return fmt::format(", \"{}\"", cpp_comment(texts.front()));
  return "";
}

/// What the header needs besides its code, whose size depends on the compiler.
std::string memory_table(const HeaderFrame& frame) {
  const PatchProgram& program = frame.program;
  std::string text = "// Memory, in bytes, without the code:\n//\n";
  const auto row = [&](std::size_t bytes, std::string_view what) {
    text += fmt::format("//   {:>8}  {}\n", bytes, what);
  };
  row(frame.table_bytes, "flash: tables of heights");
  row(std::max<std::size_t>(1, 8 * program.states.size()),
      fmt::format("RAM: State, {}", counted(program.states.size(), "state")));
  std::size_t cells = 0;
  for (const Grid& grid : program.grids) cells += std::size_t{grid.columns} * grid.rows;
  if (cells > 0) row(4 * cells, fmt::format("RAM: Cells, {}", counted(program.grids.size(), "grid")));
  if (frame.live) row(frame.setup_bytes, "RAM: Setup");
  if (frame.live && frame.peaks > 0) row(1024, "stack while setup runs: a histogram for one peak at a time");
  return text;
}

std::string interface_of(const HeaderFrame& frame) {
  const char* bank = frame.live ? "Setup, " : "";
  const char* cells = frame.program.grids.empty() ? "" : "Cells&, ";
  std::string text = fmt::format("// Everything is in namespace {}:\n//\n", frame.name_space);
  const auto row = [&](const std::string& what, std::string_view meaning) {
    text += beside("//   " + what, 45, std::string(meaning)) + '\n';
  };
  if (frame.live) {
    row("Parameters", frame.live_parameters.empty() ? "none" : "adjustable, in SI units, with their defaults");
    if (frame.live_size) row("Patch", "its width, height and rim, m");
    row(fmt::format("Setup setup(Parameters{})", frame.live_size ? ", Patch" : ""),
        frame.peaks > 0 ? "computes what ticks need; not real-time" : "computes what ticks need");
  }
  row(fmt::format("bool on_patch({}Hand)", bank), "whether the hand is on the patch");
  row("Hand within_envelope(Hand)", "within the device's reach and speed");
  row(fmt::format("State enter({}Hand)", bank), "when the hand enters the patch");
  row(fmt::format("Force tick({}State&, {}Hand)", bank, cells),
      fmt::format("once per period of the device, {} s", figure(static_cast<float>(1 / frame.program.device.rate))));
  return text;
}

std::string example_of(const HeaderFrame& frame) {
  const bool grids = !frame.program.grids.empty();
  std::string text = "// Example: a function to call once per period, with the hand as it was measured.\n//\n";
  text += fmt::format("//   namespace patch = {};\n", frame.name_space);
  if (frame.live)
    text += fmt::format("//   patch::Setup bank = patch::setup({{}}{});\n", frame.live_size ? ", {}" : "");
  text += "//   patch::State state;\n";
  if (grids) text += "//   patch::Cells cells;\n";
  text += "//   bool inside = false;\n//\n//   patch::Force step(const patch::Hand& measured) {\n";
  const char* bank = frame.live ? "bank, " : "";
  text += "//     const patch::Hand hand = patch::within_envelope(measured);\n";
  text += fmt::format("//     if (!patch::on_patch({}hand)) return inside = false, patch::Force{{}};\n", bank);
  text += fmt::format("//     if (!inside) inside = true, state = patch::enter({}hand);\n", bank);
  text += fmt::format("//     return patch::tick({}state, {}hand);\n//   }}\n", bank, grids ? "cells, " : "");
  return text;
}

std::string comment_of(const HeaderFrame& frame) {
  return fmt::format(
      R"(// {0}{1}: a patch program of Wale for {2}, as a C++17 header that `wale build --emit cpp` wrote.
//
{3}//
{4}//
{5}//
// Forces, states and grids have the same bits as in Wale's own machine, on every processor with IEEE floats and whatever it
// does with subnormal numbers, if it rounds to nearest. A thread that sets FTZ and DAZ of MXCSR (x86) may define
// WALE_MACHINE_MODE and be compiled with -ffp-contract=off: then the processor flushes, which is faster.
// Functions are inline, change only their arguments, and use no heap, no exceptions and no library.
// Pictures and predictions are left out. `t12` is instruction 12 of its section, as in `wale build --emit listing`.
)",
      cpp_comment(frame.program.material), title_of(frame.program), cpp_comment(frame.program.device.name),
      interface_of(frame), memory_table(frame), example_of(frame));
}

constexpr std::string_view checks = R"(
#if __cplusplus < 201703L
#error "this header needs C++17"
#endif
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "this header needs IEEE floats: compile without -ffast-math and -ffinite-math-only"
#endif
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0 && __FLT_EVAL_METHOD__ != 16
#error "this header needs floats that are rounded after each operation, such as those of -mfpmath=sse"
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

// Products and sums are rounded one by one, although the processor may have an instruction for both.
#if defined(__clang__)
#pragma float_control(push)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__) && !defined(WALE_MACHINE_MODE) && (defined(__FP_FAST_FMAF) || defined(__ARM_FEATURE_FMA))
#define WALE_OWN_OPTIONS
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off")
#endif

)";

constexpr std::string_view end_of_checks = R"(
#if defined(__clang__)
#pragma float_control(pop)
#elif defined(WALE_OWN_OPTIONS)
#undef WALE_OWN_OPTIONS
#pragma GCC pop_options
#endif
)";

}  // namespace

std::string framed(const HeaderFrame& frame, const std::string& code) {
  const SharedArithmetic& shared = shared_arithmetic();
  const std::string hash = fmt::format("{:08x}", Fnv1a<std::uint32_t>().take_all(code).hash());
  const std::string guard = guard_of(frame), build = guard + "_" + hash;
  // Two files of a program may hold different materials of one name. Their functions then have different names, since a
  // linker keeps one of each name.
  const std::string own_name = shared.name + "_" + hash;
  std::string text = comment_of(frame);
  text += fmt::format(
      "\n#if defined({0})\n#if !defined({1})\n#error \"another build of this material is included: its device, its "
      "live "
      "parts or its source differ\"\n#endif\n#else\n#define {0}\n#define {1}\n",
      guard, build);
  text += std::string(checks) + shared.text;
  text +=
      fmt::format("\nnamespace {0} {{\ninline namespace {1} {{\n\n{2}{3}\n}}  // namespace {1}\n}}  // namespace {0}\n",
                  frame.name_space, own_name, using_arithmetic(), code);
  text += end_of_checks;
  return text + fmt::format("\n#endif  // {}\n", guard);
}

void reserve_cpp_words(CppNames& names) {
  for (const char* word :
       {"Parameters",  "Patch",       "Setup",       "Hand",         "State",       "Cells",     "Force",
        "setup",       "enter",       "tick",        "bank",         "hand",        "state",     "cells",
        "asked",       "placed",      "flushed",     "patch",        "extent",      "on_patch",  "within_envelope",
        "held_within", "values",      "i",           "half_width",   "half_height", "rim",       "arithmetic",
        "sample_of",   "recall_of",   "cell_at",     "std",          "next",        "u",         "v",
        "value",       "each",        "sum",         "difference",   "product",     "quotient",  "ranked_value",
        "extent_of",   "PatchExtent", "SplineTable", "SplineSample", "GridSample",  "GridShape", "lattice_coordinate"})
    names.reserve(word);
  // Functions that the column `meaning` calls.
  const auto reserve_words = [&](std::string_view meaning) {
    std::string word;
    for (const char c : meaning) {
      if ((c >= 'a' && c <= 'z') || c == '_' || (c >= '0' && c <= '9')) {
        word += c;
      } else {
        if (word.size() > 1) names.reserve(word);
        word.clear();
      }
    }
  };
#define INSTRUCTION(number, name, fields, results, cost, meaning, ...) reserve_words(#meaning);
#include "wale/instruction.def"
  for (unsigned number = 0; number < first_constant; ++number) names.reserve(input_name(number));
  names.reserve(shared_arithmetic().name);
}

}  // namespace wale
