#include "compiler/listing/print_cpp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "compiler/listing/cpp_arithmetic.hpp"
#include "compiler/listing/cpp_code.hpp"
#include "compiler/listing/cpp_names.hpp"
#include "compiler/listing/figures.hpp"
#include "runtime/machine/held_state.hpp"

namespace wale {
namespace {

/// The members of `Hand`, in the order of their registers.
constexpr std::array hand_inputs{
    Input::x,
    Input::y,
    Input::velocity_x,
    Input::velocity_y,
    Input::acceleration_x,
    Input::acceleration_y,
    Input::raw_velocity_x,
    Input::raw_velocity_y,
    Input::raw_acceleration_x,
    Input::raw_acceleration_y,
    Input::workspace_x,
    Input::workspace_y,
    Input::time,
    Input::button,
};

class CppPrinter {
 public:
  explicit CppPrinter(const PatchProgram& program)
      : program_(program), name_space_("wale_patch_" + CppNames::sanitised(program.material)) {
    for (const char* word : {"Parameters",
                             "Patch",
                             "Setup",
                             "Hand",
                             "State",
                             "Cells",
                             "Force",
                             "setup",
                             "enter",
                             "tick",
                             "bank",
                             "hand",
                             "state",
                             "cells",
                             "asked",
                             "placed",
                             "flushed",
                             "patch",
                             "within_envelope",
                             "held_within",
                             "hidden",
                             "values",
                             "i",
                             "lattice_coordinate",
                             "percentile_of",
                             "half_width",
                             "half_height",
                             "rim",
                             "arithmetic",
                             "sample_of",
                             "recall_of",
                             "cell_at",
                             "nearest",
                             "held",
                             "mirrored",
                             "HeightTable",
                             "Spline",
                             "SplineSample",
                             "GridSample",
                             "GridShape",
                             "std",
                             "next",
                             "u",
                             "v"})
      names_.reserve(word);
      // Functions that the column `meaning` calls.
#define INSTRUCTION(number, name, fields, results, cost, meaning, ...) reserve_words(#meaning);
#include "schema/instruction.def"
    // clang-format on
    for (unsigned number = 0; number < first_constant; ++number) names_.reserve(input_name(number));
    for (const Parameter& parameter : program_.parameters) parameters_.push_back(names_.take(parameter.name));
    for (const State& state : program_.states) {
      states_.push_back(names_.take(state.name));
      at_entry_.push_back(names_.take(state.name + "_at_entry"));
    }
    for (const Grid& grid : program_.grids) {
      grids_.push_back(names_.take(grid.name));
      shapes_.push_back(names_.take(grid.name + "_shape"));
    }
  }

  std::string run() {
    // The last part is written first: setup computes only what the others need.
    const std::string tick = print_tick();
    const std::string enter = print_enter();
    const std::string setup = print_setup();
    print_head();
    print_arithmetic();
    add("\nnamespace {} {{\n", name_space_);
    text_ += cpp_helpers(has_peaks_);
    print_tables();
    print_types();
    text_ += setup + enter + tick;
    add("\n}}  // namespace {}\n", name_space_);
    return std::move(text_);
  }

 private:
  template <typename... Parts>
  void add(fmt::format_string<Parts...> format, Parts&&... parts) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Parts>(parts)...);
  }

  void reserve_words(std::string_view meaning) {
    std::string word;
    for (const char c : meaning) {
      if ((c >= 'a' && c <= 'z') || c == '_' || (c >= '0' && c <= '9')) {
        word += c;
      } else {
        if (word.size() > 1) names_.reserve(word);
        word.clear();
      }
    }
  }

  bool is_constant(RegisterNumber number) const {
    return number >= first_constant && number < program_.first_parameter();
  }
  bool is_parameter(RegisterNumber number) const {
    return number >= program_.first_parameter() && number < program_.first_setup();
  }
  bool is_setup(RegisterNumber number) const {
    return number >= program_.first_setup() && number < program_.first_state();
  }
  bool is_state(RegisterNumber number) const {
    return number >= program_.first_state() && number < program_.first_temporary();
  }

  /// The member of `Setup` that holds the result of setup in a register; records that it is needed.
  std::string member_of_setup(RegisterNumber number) {
    if (is_parameter(number)) {
      kept_.insert(number);
      return parameters_[number - program_.first_parameter()];
    }
    kept_.insert(number);
    return fmt::format("v{}", number - program_.first_setup());
  }

  /// A register that is set before enter or tick runs.
  std::string in_run(RegisterNumber number) {
    switch (static_cast<Input>(number)) {
      case Input::patch_half_width: return "bank.patch.half_width";
      case Input::patch_half_height: return "bank.patch.half_height";
      case Input::patch_rim: return "bank.patch.rim";
      case Input::seconds_per_tick: return "seconds_per_tick";
      default: break;
    }
    if (number < first_constant) return "hand." + input_name(number);
    if (is_state(number)) return states_[number - program_.first_state()];
    return "bank." + member_of_setup(number);
  }

  CppCode::Surroundings surroundings_of_run() {
    return {.outside = [this](RegisterNumber number) { return in_run(number); },
            .table =
                [this](std::uint16_t number) {
                  used_tables_.insert(number);
                  return fmt::format("*bank.table{}", number);
                },
            .grid_shape = [this](std::uint16_t number) { return shapes_[number]; },
            .grid_cells = [this](std::uint16_t number) { return "cells." + grids_[number]; }};
  }

  std::string unused(bool used, const std::string& parameter) const {
    return used ? parameter : "[[maybe_unused]] " + parameter;
  }

  std::string print_tick() {
    std::vector<RegisterNumber> roots;
    for (const Output& output : program_.outputs) roots.push_back(output.value);
    for (const State& state : program_.states) roots.push_back(state.next);
    for (const GridWrite& write : program_.writes) roots.insert(roots.end(), {write.u, write.v, write.value});
    CppCode code(program_, CodeSection::tick, 0, "t", roots);
    const auto& outside = code.read_from_outside();
    const std::string lines = code.lines(surroundings_of_run(), 2);

    std::string text = program_.vibrates()
                           ? "\n/// One tick: the shaking under a hand within the envelope. Advances the state.\n"
                           : "\n/// One tick: the force on a hand within the envelope, in N. Advances the state.\n";
    text += fmt::format(
        "inline Force tick([[maybe_unused]] const Setup& bank, [[maybe_unused]] State& state,{}\n"
        "                  [[maybe_unused]] const Hand& hand) {{\n",
        program_.grids.empty() ? "" : " [[maybe_unused]] Cells& cells,");
    for (std::size_t i = 0; i < program_.states.size(); ++i)
      if (std::ranges::binary_search(outside, static_cast<RegisterNumber>(program_.first_state() + i)))
        text += fmt::format("  const float {0} = state.{0};\n", states_[i]);
    text += lines;
    for (std::size_t i = 0; i < program_.states.size(); ++i) {
      const State& state = program_.states[i];
      text += fmt::format("  state.{} = held_within({}, {}, {}, state.{});\n", states_[i], code.result(state.next),
                          cpp_literal(state.low), cpp_literal(state.high), at_entry_[i]);
    }
    for (const GridWrite& write : program_.writes) {
      const Grid& grid = program_.grids[write.grid];
      text += fmt::format(
          "  if (const float u = {}, v = {}, value = {}; u == u && v == v && value == value)\n"
          "    cells.{}[cell_at({}, u, v)] = held_within(value, {}, {}, value);\n",
          code.result(write.u), code.result(write.v), code.result(write.value), grids_[write.grid], shapes_[write.grid],
          cpp_literal(grid.low), cpp_literal(grid.high));
    }
    std::array<std::string, 2> force;
    for (const Output& output : program_.outputs) force[output.component()] = code.result(output.value);
    return text + fmt::format("  return {{{}, {}}};\n}}\n", force[0], force[1]);
  }

  std::string print_enter() {
    std::vector<RegisterNumber> roots;
    for (const State& state : program_.states) roots.push_back(state.initial);
    CppCode code(program_, CodeSection::enter, 0, "t", roots);
    std::string text = "\n/// The state at the moment when a hand within the envelope enters the patch.\n";
    text += "inline State enter([[maybe_unused]] const Setup& bank, [[maybe_unused]] const Hand& hand) {\n";
    text += code.lines(surroundings_of_run(), 2);
    text += "  State state;\n";
    for (std::size_t i = 0; i < program_.states.size(); ++i) {
      const State& state = program_.states[i];
      text += fmt::format("  state.{0} = state.{1} = held_within({2}, {3}, {4}, state.{0});\n", states_[i],
                          at_entry_[i], code.result(state.initial), cpp_literal(state.low), cpp_literal(state.high));
    }
    return text + "  return state;\n}\n";
  }

  /// A register that is set before setup runs.
  std::string in_setup(RegisterNumber number) const {
    switch (static_cast<Input>(number)) {
      case Input::patch_half_width: return "patch.half_width";
      case Input::patch_half_height: return "patch.half_height";
      case Input::patch_rim: return "patch.rim";
      case Input::seconds_per_tick: return "seconds_per_tick";
      default: break;
    }
    if (number < first_constant) return input_name(number);  // of a point of a peak
    return parameters_[number - program_.first_parameter()];
  }

  std::string print_setup() {
    std::vector<RegisterNumber> roots;
    for (const RegisterNumber number : kept_)
      if (is_setup(number)) roots.push_back(number);
    CppCode code(program_, CodeSection::setup, 0, "s", roots);
    CppCode::Surroundings surroundings{.outside = [this](RegisterNumber number) { return in_setup(number); },
                                       .table =
                                           [this](std::uint16_t number) {
                                             used_tables_.insert(number);
                                             return fmt::format("*table{}()", number);
                                           },
                                       .grid_shape = {},
                                       .grid_cells = {}};
    surroundings.peak = [&](const Instruction& instruction, const auto& now, const std::string& name,
                            std::string& lines) { print_peak(instruction.a, surroundings, now, name, lines); };
    const std::string lines = code.lines(surroundings, 2);

    std::string text =
        "\n/// Computes what ticks need from the parameters and the patch. Not for real-time use: it runs the peaks.\n";
    text += "inline Setup setup([[maybe_unused]] const Parameters& asked, const Patch& placed) {\n";
    text +=
        "  using arithmetic::flushed;\n"
        "  const Patch patch{flushed(placed.half_width), flushed(placed.half_height), flushed(placed.rim)};\n";
    std::set<RegisterNumber> needed(kept_.begin(), kept_.end());
    for (const RegisterNumber number : code.read_from_outside()) needed.insert(number);
    for (const RegisterNumber number : needed) {
      if (!is_parameter(number)) continue;
      const Parameter& p = program_.parameters[number - program_.first_parameter()];
      text += fmt::format("  const float {0} = held_within(flushed(asked.{0}), {1}, {2}, {3});\n",
                          parameters_[number - program_.first_parameter()], cpp_literal(p.low), cpp_literal(p.high),
                          cpp_literal(p.value));
    }
    text += lines;
    text += "  Setup bank;\n  bank.patch = patch;\n";
    members_ = "  Patch patch;\n";
    for (const std::uint16_t number : used_tables_) {
      members_ += fmt::format("  const Spline* table{} = nullptr;\n", number);
      text += fmt::format("  bank.table{0} = table{0}();\n", number);
    }
    for (const RegisterNumber number : kept_) {
      const std::string member = member_of_setup(number);
      members_ += fmt::format("  float {} = 0;\n", member);
      text += fmt::format("  bank.{} = {};\n", member, code.result(number));
    }
    return text + "  return bank;\n}\n";
  }

  void print_peak(std::uint16_t index, const CppCode::Surroundings& in_setup,
                  const std::function<std::string(RegisterNumber)>& now, const std::string& name, std::string& lines) {
    has_peaks_ = true;
    const Peak& peak = program_.peaks[index];
    CppCode code(program_, CodeSection::peak, index, "t", {peak.value});
    CppCode::Surroundings surroundings = in_setup;
    surroundings.outside = [&](RegisterNumber number) {
      return number < first_constant ? this->in_setup(number) : now(number);
    };
    std::string body = code.lines(surroundings, 4);
    const std::string value = code.result(peak.value);
    lines += fmt::format("  std::vector<float> peak{}({});\n", index, peak.points);
    lines += fmt::format("  for (std::uint32_t i = 0; i < {}; ++i) {{\n", peak.points);
    const auto& outside = code.read_from_outside();
    const auto reads = [&](Input input) {
      return std::ranges::binary_search(outside, static_cast<RegisterNumber>(input));
    };
    if (reads(Input::x))
      lines += fmt::format("    const float x = lattice_coordinate(i, 3242174889u) * {};\n", now(peak.half_width));
    if (reads(Input::y))
      lines += fmt::format("    const float y = lattice_coordinate(i, 2447445414u) * {};\n", now(peak.half_height));
    lines += body;
    lines += fmt::format("    const float value = {};\n", value);
    lines += fmt::format("    peak{}[i] = absolute(value) < arithmetic::infinity ? value : 0.0f;\n  }}\n", index);
    lines += fmt::format("  const float {} = percentile_of(peak{}, {});\n", name, index, cpp_literal(peak.percentile));
  }

  void print_head() {
    add(R"(// {0}: a patch program of Wale as C++, written by `wale build --emit cpp`. It needs only a C++20 compiler:
//
//   g++ -std=c++20 -O3 -march=x86-64-v3 -ffp-contract=off -c FILE.cpp
//
// Everything is in namespace {1}:
//
//   Parameters                        adjustable, in SI units, with their defaults
//   Patch                             half its width and height, and its rim, m
//   Setup setup(Parameters, Patch)    computes what ticks need; not real-time (peaks, tables)
//   Hand within_envelope(Hand)        within the device's reach and speed, not subnormal, as the runtime does
//   State enter(Setup, Hand)          when the hand enters the patch
//   Force tick(Setup, State&, {2}Hand)
//                                     call it once per period of the device, {3} s
//
// The result has the same bits as Wale's own machine if the caller rounds to nearest and flushes subnormals to zero (on
// x86, bits FTZ 0x8000 and DAZ 0x0040 of MXCSR), and if this file is compiled with -ffp-contract=off and without
// -ffast-math. Functions are inline and change only their arguments; enter and tick do not allocate.
// Pictures and predictions are left out. `t12` is instruction 12 of its section, as in `wale build --emit listing`.
)",
        cpp_comment(program_.material), name_space_, program_.grids.empty() ? "" : "Cells&, ",
        figure(static_cast<float>(1 / program_.device.rate)));
    for (const auto& [key, texts] : program_.layers.representative)
      if (key == "title" && !texts.empty()) add("//\n// {}\n", cpp_comment(texts.front()));
    add(R"(
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

)");
  }

  void print_arithmetic() {
    text_ += cpp_arithmetic("arithmetic.hpp", name_space_);
    if (!program_.grids.empty()) text_ += "\n" + cpp_arithmetic("grid.hpp", name_space_);
    if (used_tables_.empty()) return;
    text_ += "\n" + cpp_height_table(name_space_) + "\n";
    text_ += cpp_arithmetic("spline.hpp", name_space_) + "\n";
    text_ += cpp_arithmetic("spline.cpp", name_space_);
  }

  void print_tables() {
    for (const std::uint16_t number : used_tables_) {
      const HeightTable& table = program_.tables[number];
      add("\ninline constexpr std::uint16_t heights{}[] = {{", number);
      for (std::size_t i = 0; i < table.heights.size(); ++i)
        add("{}{},", i % 16 == 0 ? "\n    " : " ", table.heights[i]);
      add("\n}};\n\n/// Made at its first use.\ninline const Spline* table{}() {{\n", number);
      add("  static const Spline spline(HeightTable{{{0}, {1}, {{std::begin(heights{2}), std::end(heights{2})}}}});\n"
          "  return &spline;\n}}\n",
          table.width, table.height, number);
    }
  }

  void print_types() {
    add("\ninline constexpr float seconds_per_tick = {};\n", cpp_literal(static_cast<float>(1 / program_.device.rate)));
    add("\nstruct Parameters {{\n");
    for (std::size_t i = 0; i < program_.parameters.size(); ++i) {
      const Parameter& p = program_.parameters[i];
      const std::string comment =
          fmt::format("///< {}{}{} .. {}{}{}", cpp_comment(p.si_unit), p.si_unit.empty() ? "" : ", ", figure(p.low),
                      figure(p.high), p.description.empty() ? "" : ": ", cpp_comment(p.description));
      text_ += beside(fmt::format("  float {} = {};", parameters_[i], cpp_literal(p.value)), 40, comment) + '\n';
    }
    add("}};\n\nstruct Patch {{\n  float half_width = {}, half_height = {}, rim = {};  ///< m\n}};\n",
        cpp_literal(0.5f * program_.patch_width), cpp_literal(0.5f * program_.patch_height),
        cpp_literal(program_.patch_rim));
    add("\n/// What a tick needs besides the hand; made by `setup` only.\nstruct Setup {{\n{}}};\n", members_);
    print_hand();
    add("\n/// What is remembered from tick to tick, and its values at the moment when the hand entered.\nstruct State "
        "{{\n");
    for (std::size_t i = 0; i < program_.states.size(); ++i) {
      const State& state = program_.states[i];
      const float begin = initial_state(arithmetic::not_a_number, StateRule(state));
      text_ += beside(fmt::format("  float {} = {}, {} = {};", states_[i], cpp_literal(begin), at_entry_[i],
                                  cpp_literal(begin)),
                      60, fmt::format("///< {} .. {}", figure(state.low), figure(state.high))) +
               '\n';
    }
    add("}};\n");
    if (!program_.grids.empty()) print_cells();
    add("\nstruct Force {{\n  float x = 0, y = 0;  ///< {}\n}};\n",
        program_.vibrates() ? "the device only vibrates: amplitude in m/s^2 and frequency in Hz" : "N");
  }

  void print_hand() {
    add("\n/// In m, m/s and m/s^2 from the patch's centre; `workspace` from the device's centre; `button` is 1 while "
        "it is "
        "pressed.\nstruct Hand {{\n");
    for (const Input input : hand_inputs) add("  float {} = 0;\n", input_name(static_cast<unsigned>(input)));
    add("}};\n\n/// Each component limited to the range of the device; not-a-number and subnormal numbers become 0.\n"
        "inline Hand within_envelope(const Hand& hand) {{\n  using arithmetic::flushed;\n  Hand within;\n");
    const DeviceProfile& device = program_.device;
    for (const Input input : hand_inputs) {
      const std::string name = input_name(static_cast<unsigned>(input));
      float bound = 0;
      switch (input) {
        case Input::x:
        case Input::y:
        case Input::workspace_x:
        case Input::workspace_y: bound = static_cast<float>(device.widest_patch()); break;
        case Input::velocity_x:
        case Input::velocity_y:
        case Input::raw_velocity_x:
        case Input::raw_velocity_y: bound = static_cast<float>(device.speed_limit); break;
        case Input::time:
        case Input::button: break;
        default: bound = static_cast<float>(device.speed_limit * device.rate);
      }
      const std::string low = input == Input::time || input == Input::button ? "0.0f" : cpp_literal(-bound);
      const std::string high = input == Input::time     ? cpp_literal(std::numeric_limits<float>::max())
                               : input == Input::button ? "1.0f"
                                                        : cpp_literal(bound);
      add("  within.{0} = held_within(flushed(hand.{0}), {1}, {2}, 0.0f);\n", name, low, high);
    }
    add("  return within;\n}}\n");
  }

  void print_cells() {
    add("\n");
    for (std::size_t i = 0; i < program_.grids.size(); ++i)
      add("inline constexpr GridShape {}{{0, {}, {}}};\n", shapes_[i], program_.grids[i].columns,
          program_.grids[i].rows);
    add("\n/// The grids, row by row from the lower left, as they are when the program is placed.\nstruct Cells {{\n");
    for (std::size_t i = 0; i < program_.grids.size(); ++i) {
      const Grid& grid = program_.grids[i];
      text_ +=
          beside(fmt::format("  std::array<float, {}> {};", std::size_t{grid.columns} * grid.rows, grids_[i]), 40,
                 fmt::format("///< {} x {}, {} .. {}", grid.columns, grid.rows, figure(grid.low), figure(grid.high))) +
          '\n';
    }
    add("\n  Cells() {{\n");
    for (std::size_t i = 0; i < program_.grids.size(); ++i)
      add("    {}.fill({});\n", grids_[i], cpp_literal(program_.grids[i].initial));
    add("  }}\n}};\n");
  }

  const PatchProgram& program_;
  std::string name_space_;
  CppNames names_;
  std::vector<std::string> parameters_, states_, at_entry_, grids_, shapes_;
  std::set<RegisterNumber> kept_;  ///< parameters and results of setup that enter or tick reads
  std::set<std::uint16_t> used_tables_;
  std::string members_;  ///< of `Setup`
  bool has_peaks_ = false;
  std::string text_;
};

}  // namespace

std::string print_cpp(const PatchProgram& program) { return CppPrinter(program).run(); }

}  // namespace wale
