#include "compiler/cpp/print_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "compiler/cpp/cpp_code.hpp"
#include "compiler/cpp/cpp_names.hpp"
#include "compiler/cpp/header_frame.hpp"
#include "compiler/cpp/shared_arithmetic.hpp"
#include "compiler/listing/figures.hpp"
#include "compiler/prove/prove.hpp"
#include "runtime/machine/decoded_program.hpp"
#include "schema/spelling.hpp"

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

constexpr std::array size_inputs{Input::patch_half_width, Input::patch_half_height, Input::patch_rim};

RegisterNumber register_of(Input input) { return static_cast<RegisterNumber>(input); }

/// What the runtime allows, with everything that is not live at its default.
Domain domain_of(const PatchProgram& program, const LiveParts& live) {
  Domain domain = whole_domain(program);
  const Domain at_defaults = domain_at_defaults(program);
  if (!live.size)
    for (const Input input : size_inputs) domain[input] = at_defaults[input];
  for (std::size_t i = 0; i < program.parameters.size(); ++i)
    if (!live.parameters[i]) domain.parameters[i] = at_defaults.parameters[i];
  return domain;
}

/// What is known before setup runs.
RegisterFacts facts_before_setup(const Program& program, const LiveParts& live, const Domain& domain) {
  const PatchProgram& description = program.description();
  const Bank bank(program);
  RegisterFacts facts{std::vector<std::optional<float>>(description.register_count()),
                      std::vector<Smallest>(description.register_count()),
                      std::vector<Interval>(description.register_count(), Interval::everything(true))};
  const auto know = [&](std::size_t number) {
    facts.values[number] = bank.registers()[number];
    facts.smallest[number] = Smallest::of(bank.registers()[number]);
  };
  const auto bound = [&](std::size_t number, const Interval& interval) {
    facts.intervals[number] = interval;
    facts.smallest[number] = Smallest{}.within(interval);
  };
  for (std::size_t number = 0; number < first_constant; ++number) bound(number, domain.inputs[number]);
  facts.smallest[register_of(Input::button)] = {.size = 1};
  know(register_of(Input::seconds_per_tick));
  // A header's patch is a rectangle.
  for (const Input input : {Input::shape_edge, Input::shape_edge_x, Input::shape_edge_y}) know(register_of(input));
  if (!live.size)
    for (const Input input : size_inputs) know(register_of(input));
  for (std::size_t number = first_constant; number < description.first_parameter(); ++number) know(number);
  for (std::size_t i = 0; i < description.parameters.size(); ++i) {
    const std::size_t number = description.first_parameter() + i;
    bound(number, domain.parameters[i]);
    if (!live.parameters[i]) know(number);
  }
  for (std::size_t i = 0; i < description.states.size(); ++i) bound(description.first_state() + i, domain.states[i]);
  return facts;
}

class HeaderPrinter {
 public:
  HeaderPrinter(const Program& program, const LiveParts& live)
      : machine_(program),
        program_(program.description()),
        live_(live),
        name_space_("wale_patch_" + CppNames::sanitised(program_.material)),
        proof_(prove(program, domain_of(program_, live))),
        before_setup_(facts_before_setup(program, live, domain_of(program_, live))),
        after_setup_(CppCode(proved(CodeSection::setup), before_setup_, "s", {}).facts_at_end()) {
    for (std::size_t number = program_.first_temporary(); number < program_.register_count(); ++number)
      after_setup_.values[number].reset();
    reserve_cpp_words(names_);
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
    // Ticks are written first: setup computes only what they need.
    if (live_.size)
      for (const Input input : size_inputs) kept_.insert(register_of(input));
    const std::string tick = print_tick(), enter = print_enter();
    const std::string setup = live_.any() ? print_setup() : "";
    print_types();
    const std::string types = std::move(text_);
    text_.clear();
    print_tables();
    const std::string code = std::move(text_) + types + setup + enter + tick;
    HeaderFrame frame{.program = program_, .name_space = name_space_};
    frame.live = live_.any();
    frame.live_size = live_.size;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      if (live_.parameters[i]) frame.live_parameters.push_back(parameters_[i]);
    for (const std::uint16_t number : used_tables_) {
      const Spline& spline = machine_.decoded().splines[number];
      frame.table_bytes += 4 * spline.coefficients.size();
    }
    frame.setup_bytes = 4 * kept_.size();
    frame.peaks = peaks_;
    return framed(frame, code);
  }

 private:
  template <typename... Parts>
  void add(fmt::format_string<Parts...> format, Parts&&... parts) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Parts>(parts)...);
  }

  ProvedSection proved(CodeSection section, std::size_t index = 0) const { return {machine_, proof_, section, index}; }
  bool is_parameter(RegisterNumber number) const {
    return number >= program_.first_parameter() && number < program_.first_setup();
  }
  bool is_setup(RegisterNumber number) const {
    return number >= program_.first_setup() && number < program_.first_state();
  }

  /// The name of a register that setup makes or passes on.
  std::string name_in_setup(RegisterNumber number) const {
    if (is_parameter(number)) return parameters_[number - program_.first_parameter()];
    if (is_setup(number)) return fmt::format("v{}", number - program_.first_setup());
    return input_name(number);
  }

  /// A register that is set before enter or tick runs.
  std::string in_run(RegisterNumber number) {
    const bool of_size = std::ranges::any_of(size_inputs, [&](Input input) { return number == register_of(input); });
    if (number < first_constant && !of_size) return "hand." + input_name(number);
    if (number >= program_.first_state()) return states_[number - program_.first_state()];
    kept_.insert(number);
    return "bank." + name_in_setup(number);
  }

  std::string use_table(std::uint16_t number) {
    used_tables_.insert(number);
    return fmt::format("table{}", number);
  }

  CppCode::Surroundings surroundings_of_run() {
    return {.outside = [this](RegisterNumber number) { return in_run(number); },
            .table = [this](std::uint16_t number) { return use_table(number); },
            .grid_shape = [this](std::uint16_t number) { return shapes_[number]; },
            .grid_cells = [this](std::uint16_t number) { return "cells." + grids_[number]; }};
  }

  std::string print_tick() {
    std::vector<RegisterNumber> roots;
    for (const Output& output : program_.outputs) roots.push_back(output.value);
    for (const State& state : program_.states) roots.push_back(state.next);
    for (const GridWrite& write : program_.writes) roots.insert(roots.end(), {write.u, write.v, write.value});
    CppCode code(proved(CodeSection::tick), after_setup_, "t", roots);
    const auto& outside = code.read_from_outside();
    const std::string lines = code.lines(surroundings_of_run(), 2);

    std::string text = program_.vibrates()
                           ? "\n/// One tick: the shaking under a hand within the envelope. Advances the state.\n"
                           : "\n/// One tick: the force on a hand within the envelope, in N. Advances the state.\n";
    text += fmt::format("inline Force tick({}[[maybe_unused]] State& state,{} [[maybe_unused]] const Hand& hand) {{\n",
                        live_.any() ? "[[maybe_unused]] const Setup& bank, " : "",
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
    CppCode code(proved(CodeSection::enter), after_setup_, "t", roots);
    std::string text = "\n/// The state at the moment when a hand within the envelope enters the patch.\n";
    text += fmt::format("inline State enter({}[[maybe_unused]] const Hand& hand) {{\n",
                        live_.any() ? "[[maybe_unused]] const Setup& bank, " : "");
    text += code.lines(surroundings_of_run(), 2);
    text += "  State state;\n";
    for (std::size_t i = 0; i < program_.states.size(); ++i) {
      const State& state = program_.states[i];
      text += fmt::format("  state.{0} = state.{1} = held_within({2}, {3}, {4}, state.{0});\n", states_[i],
                          at_entry_[i], code.result(state.initial), cpp_literal(state.low), cpp_literal(state.high));
    }
    return text + "  return state;\n}\n";
  }

  std::string print_setup() {
    std::vector<RegisterNumber> roots;
    for (const RegisterNumber number : kept_)
      if (is_setup(number)) roots.push_back(number);
    CppCode code(proved(CodeSection::setup), before_setup_, "s", roots);
    CppCode::Surroundings surroundings{.outside = [this](RegisterNumber number) { return name_in_setup(number); },
                                       .table = [this](std::uint16_t number) { return use_table(number); },
                                       .grid_shape = {},
                                       .grid_cells = {}};
    surroundings.peak = [&](const Instruction& instruction, const RegisterFacts& facts, const auto& now,
                            const std::string& name,
                            std::string& lines) { print_peak(instruction.a, facts, surroundings, now, name, lines); };
    const std::string lines = code.lines(surroundings, 2);
    std::string text =
        "\n/// Computes what ticks need from the live parts. Not for real-time use if it has peaks, which take long.\n";
    text += fmt::format("inline Setup setup([[maybe_unused]] const Parameters& asked{}) {{\n",
                        live_.size ? ", [[maybe_unused]] const Patch& placed" : "");
    std::set<RegisterNumber> needed(kept_.begin(), kept_.end());
    for (const RegisterNumber number : code.read_from_outside()) needed.insert(number);
    const bool needs_size =
        std::ranges::any_of(size_inputs, [&](Input input) { return needed.contains(register_of(input)); });
    if (needs_size)
      text += fmt::format(
          "  const PatchExtent extent = extent_of(placed.width, placed.height, placed.rim, {{{}, {}, {}}}, {});\n",
          cpp_literal(0.5f * program_.patch_width), cpp_literal(0.5f * program_.patch_height),
          cpp_literal(program_.patch_rim), cpp_literal(static_cast<float>(program_.device.widest_patch())));
    for (const RegisterNumber number : needed) {
      if (is_parameter(number)) {
        const Parameter& p = program_.parameters[number - program_.first_parameter()];
        text += fmt::format("  const float {0} = held_within(arithmetic::flushed(asked.{0}), {1}, {2}, {3});\n",
                            name_in_setup(number), cpp_literal(p.low), cpp_literal(p.high), cpp_literal(p.value));
      } else if (number < first_constant) {
        text += fmt::format("  const float {0} = extent.{1};\n", input_name(number), input_name(number).substr(6));
      }
    }
    text += lines + "  Setup bank;\n";
    for (const RegisterNumber number : kept_)
      text += fmt::format("  bank.{} = {};\n", name_in_setup(number), code.result(number));
    return text + "  return bank;\n}\n";
  }

  void print_peak(std::uint16_t index, const RegisterFacts& facts, const CppCode::Surroundings& in_setup,
                  const std::function<std::string(RegisterNumber)>& now, const std::string& name, std::string& lines) {
    ++peaks_;
    const Peak& peak = program_.peaks[index];
    RegisterFacts before = facts;
    for (std::size_t number = program_.first_temporary(); number < program_.register_count(); ++number)
      before.values[number].reset();
    CppCode code(proved(CodeSection::peak, index), before, "t", {peak.value});
    CppCode::Surroundings surroundings = in_setup;
    surroundings.outside = [&](RegisterNumber number) {
      return number < first_constant ? name_in_setup(number) : now(number);
    };
    const std::string body = code.lines(surroundings, 4), value = code.result(peak.value);
    const auto rank = static_cast<std::uint32_t>(std::ceil(peak.percentile * static_cast<float>(peak.points)));
    lines += fmt::format("  const float {} = ranked_value({}u, {}u, [&]([[maybe_unused]] std::uint32_t i) {{\n", name,
                         peak.points, std::clamp(rank, 1u, peak.points));
    const auto& outside = code.read_from_outside();
    const auto place = [&](Input input, const char* step, RegisterNumber extent) {
      if (!std::ranges::binary_search(outside, register_of(input))) return;
      lines += fmt::format("    const float {} = product(lattice_coordinate(i, {}u), {});\n",
                           input_name(register_of(input)), step, now(extent));
    };
    place(Input::x, "3242174889", peak.half_width);
    place(Input::y, "2447445414", peak.half_height);
    lines += body + fmt::format("    return {};\n  }});\n", value);
  }

  void print_tables() {
    for (const std::uint16_t number : used_tables_) {
      const Spline& spline = machine_.decoded().splines[number];
      add("\n/// {} x {} heights as the coefficients of their spline.\ninline constexpr float coefficients{}[] = {{",
          spline.width, spline.height, number);
      for (std::size_t i = 0; i < spline.coefficients.size(); ++i)
        add("{}{},", i % 8 == 0 ? "\n    " : " ", cpp_literal(spline.coefficients[i]));
      add("\n}};\ninline constexpr SplineTable table{0}{{coefficients{0}, {1}, {2}, {3}}};\n", number, spline.stride,
          cpp_literal(spline.last_column), cpp_literal(spline.last_row));
    }
  }

  void print_types() {
    add("\ninline constexpr float seconds_per_tick = {};\n", cpp_literal(static_cast<float>(1 / program_.device.rate)));
    if (live_.any()) print_live_types();
    if (!live_.size)
      add("\n/// Of the patch, m.\n"
          "inline constexpr float half_width = {}, half_height = {};\n",
          cpp_literal(0.5f * program_.patch_width), cpp_literal(0.5f * program_.patch_height));
    print_hand();
    const char* bank = live_.size ? "bank.patch_" : "";
    add("\n/// Whether the hand is on the patch.\ninline bool on_patch({0}const Hand& hand) {{\n"
        "  return absolute(hand.x) <= {1}half_width && absolute(hand.y) <= {1}half_height;\n}}\n",
        live_.any() ? "[[maybe_unused]] const Setup& bank, " : "", bank);
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

  void print_live_types() {
    add("\nstruct Parameters {{\n");
    for (std::size_t i = 0; i < program_.parameters.size(); ++i) {
      if (!live_.parameters[i]) continue;
      const Parameter& p = program_.parameters[i];
      const std::string comment =
          fmt::format("///< {}{}{} .. {}{}{}", cpp_comment(p.si_unit), p.si_unit.empty() ? "" : ", ", figure(p.low),
                      figure(p.high), p.description.empty() ? "" : ": ", cpp_comment(p.description));
      text_ += beside(fmt::format("  float {} = {};", parameters_[i], cpp_literal(p.value)), 40, comment) + '\n';
    }
    add("}};\n");
    if (live_.size)
      add("\nstruct Patch {{\n  float width = {}, height = {}, rim = {};  ///< m\n}};\n",
          cpp_literal(program_.patch_width), cpp_literal(program_.patch_height), cpp_literal(program_.patch_rim));
    add("\n/// What a tick needs besides the hand; made by `setup` only.\nstruct Setup {{\n");
    for (const RegisterNumber number : kept_) add("  float {} = 0;\n", name_in_setup(number));
    add("}};\n");
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
          beside(fmt::format("  float {}[{}];", grids_[i], std::size_t{grid.columns} * grid.rows), 40,
                 fmt::format("///< {} x {}, {} .. {}", grid.columns, grid.rows, figure(grid.low), figure(grid.high))) +
          '\n';
    }
    add("\n  Cells() {{\n");
    for (std::size_t i = 0; i < program_.grids.size(); ++i)
      add("    for (float& each : {}) each = {};\n", grids_[i], cpp_literal(program_.grids[i].initial));
    add("  }}\n}};\n");
  }

  const Program& machine_;
  const PatchProgram& program_;
  const LiveParts& live_;
  std::string name_space_;
  Proof proof_;
  RegisterFacts before_setup_, after_setup_;
  CppNames names_;
  std::vector<std::string> parameters_, states_, at_entry_, grids_, shapes_;
  std::set<RegisterNumber> kept_;  ///< what enter or tick reads of setup's results, live parameters and the size
  std::set<std::uint16_t> used_tables_;
  std::size_t peaks_ = 0;  ///< in setup
  std::string text_;
};

}  // namespace

bool LiveParts::any() const { return size || std::ranges::find(parameters, true) != parameters.end(); }

Result<LiveParts> live_parts(const PatchProgram& program, const std::vector<std::string>& names) {
  LiveParts live{.parameters = std::vector<bool>(program.parameters.size())};
  for (const std::string& name : names) {
    const auto found = std::ranges::find(program.parameters, name, &Parameter::name);
    if (found != program.parameters.end()) {
      live.parameters[static_cast<std::size_t>(found - program.parameters.begin())] = true;
    } else if (name == "size") {
      live.size = true;
    } else if (name == "all") {
      live.parameters.assign(program.parameters.size(), true);
      live.size = true;
    } else {
      std::vector<std::string> known{"size", "all"};
      for (const Parameter& parameter : program.parameters) known.push_back(parameter.name);
      const auto nearest = nearest_spelling(name, known);
      return Error{.code = Code::malformed_value,
                   .sentence = fmt::format("`{}` has no parameter `{}`", program.material, name),
                   .mend = nearest ? fmt::format("did you mean `{}`?", *nearest)
                                   : fmt::format("expected one of {}", fmt::join(known, ", ")),
                   .place = {.name = "--live", .text = name}};
    }
  }
  return live;
}

std::string print_header(const Program& program, const LiveParts& live) {
  LiveParts whole = live;
  whole.parameters.resize(program.description().parameters.size());
  return HeaderPrinter(program, whole).run();
}

}  // namespace wale
