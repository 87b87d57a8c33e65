#pragma once

#include <fmt/format.h>

#include <array>
#include <random>
#include <string>
#include <vector>

namespace wale::compiling {

/// Writes random materials with consistent dimensions, which use every sort of expression. The same seed writes the
/// same text on every platform.
class RandomMaterial {
 public:
  explicit RandomMaterial(std::uint32_t seed) : random_(seed) {}

  /// A parameter with its default.
  struct Param {
    std::string name, value, unit;
  };

  /// A file with one material. Where `inlined`, its parameters are constants.
  std::string text(bool inlined) const {
    std::string params;
    for (const auto& param : params_)
      params += inlined ? fmt::format("    let {} = {} {}\n", param.name, param.value, param.unit)
                        : fmt::format("    param {0} = {1} {2} in 0.01 {2} .. 100 {2}\n", param.name, param.value,
                                      param.unit);
    return fmt::format("wale 1\n\n{}\nmaterial m {{\n  physical {{\n{}{}  }}\n}}\n", declarations_, params, body_);
  }

  /// Everything but states.
  void write() { write(false); }
  /// With states, scalar and vector, whose bounds are reached now and then.
  void write_with_states() { write(true); }

 private:
  void write(bool with_states) {
    for (int i = below(3); i >= 0; --i) {
      const std::string name = fmt::format("c{}", names_.size());
      const Dimension dimension = small_dimension();
      declarations_ += fmt::format("let {} = {}\n", name, literal(dimension));
      names_.push_back({name, dimension, false});
    }
    for (int i = below(3); i >= 0; --i) {
      hand_ = one_in(2);  // functions may use inputs, but no names of the material
      write_function();
    }
    hand_ = false;
    for (int i = below(3); i >= 0; --i) {
      const Dimension dimension = small_dimension();
      params_.push_back({fmt::format("p{}", names_.size()), figure(), unit(dimension)});
      names_.push_back({params_.back().name, dimension, false});
    }
    hand_ = true;
    if (with_states) write_states();
    for (int i = below(4); i >= 0; --i) write_let();
    // The sum of all layers stays below the device's limit.
    const int layers = 1 + below(3);
    for (int i = 0; i < layers; ++i) {
      if (one_in(3)) write_update();
      body_ += fmt::format("    let push{} = {}\n", i, vector_of(force, 4));
      const bool last = i == layers - 1;
      const std::string layer = last && one_in(2) ? "" : fmt::format(" layer{}", i), push = fmt::format("push{}", i);
      if (one_in(3))
        body_ += fmt::format("    force{} = {} limit {} N\n", layer, push, 4.5 / layers);
      else
        body_ += fmt::format("    force{0} = {1} * ({2} N / (1 N + length({1})))\n", layer, push, 4.5 / layers);
      if (!last && one_in(2)) names_.push_back({fmt::format("layer{}", i), force, true});
    }
    while (!unmoved_.empty()) write_update();
  }

  using Dimension = std::array<int, 3>;  // m, kg, s
  static constexpr Dimension force{1, 1, -2}, length{1, 0, 0}, plain{0, 0, 0};

  struct Name {
    std::string text;
    Dimension dimension;
    bool vector;
  };

  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }
  bool one_in(int n) { return below(n) == 0; }

  void write_let() {
    const std::string name = fmt::format("l{}", names_.size() + conditions_.size());
    if (one_in(4)) {
      body_ += fmt::format("    let {} = {}\n", name, condition(3));
      conditions_.push_back(name);
      return;
    }
    const bool vector = one_in(3);
    const Dimension dimension = small_dimension();
    body_ += fmt::format("    let {} = {}\n", name, vector ? vector_of(dimension, 3) : number_of(dimension, 3));
    names_.push_back({name, dimension, vector});
  }

  /// Initial values may not name states, so states become known only after all are declared.
  void write_states() {
    for (int i = 0, count = 1 + below(4); i < count; ++i) {
      const Name state{fmt::format("s{}", i), small_dimension(), one_in(3)};
      const std::string in = unit(state.dimension), zero = in.empty() ? "0" : "0 " + in;
      const std::string nought = state.vector ? fmt::format("vector({0}, {0})", zero) : zero;
      // Bounds of about the size of typical values. An initial value that the compiler knows must lie within them.
      const std::string begin = one_in(2) ? nought : named_input(state.dimension, state.vector);
      body_ += fmt::format("    state {} = {} in -{} .. {}\n", state.text, begin.empty() ? nought : begin,
                           literal(state.dimension), literal(state.dimension));
      unmoved_.push_back(state);
    }
    names_.insert(names_.end(), unmoved_.begin(), unmoved_.end());
  }

  /// Writes the update of a state that has none so far; sometimes leaves the state without one.
  void write_update() {
    if (unmoved_.empty()) return;
    const auto which = unmoved_.begin() + below(static_cast<int>(unmoved_.size()));
    const Name state = *which;
    unmoved_.erase(which);
    if (one_in(6)) return;
    const bool rate = one_in(2);
    Dimension dimension = state.dimension;
    if (rate) --dimension[2];
    // A tick is 1/900 s, so some rates are made fast enough to reach the bounds.
    const std::string faster = rate && one_in(2) ? "300 * " : "";
    body_ += fmt::format("    {}{}{} = {}{}\n", rate ? "" : "next ", state.text, rate ? "'" : "", faster,
                         state.vector ? vector_of(dimension, 3) : number_of(dimension, 3));
  }

  Dimension small_dimension() {
    static const std::vector<Dimension> common{plain,     plain,      length,     force,      {1, 0, -1},
                                               {0, 1, 0}, {0, 1, -2}, {0, 1, -1}, {2, 1, -2}, {0, 0, 1},
                                               {2, 0, 0}, {-1, 0, 0}, {1, 0, -2}};
    return common[static_cast<std::size_t>(below(static_cast<int>(common.size())))];
  }

  /// Such as "2.75". Most of these are not exact as floats.
  std::string figure() { return fmt::format("{}.{:02}", below(9) + (one_in(3) ? 1 : 0), 1 + below(99)); }

  /// A unit of that dimension, such as "mm", "N s/m" or "kg m^2/s".
  std::string unit(const Dimension& dimension) {
    static const std::vector<std::pair<Dimension, std::vector<std::string>>> known{
        {length, {"m", "cm", "inch", "mm"}}, {{0, 1, 0}, {"kg", "g"}},        {{0, 0, 1}, {"s", "ms"}},
        {force, {"N", "gf", "ozf", "pu"}},   {{0, 0, -1}, {"Hz", "kHz"}},     {{2, 1, -2}, {"J", "N m"}},
        {{0, 1, -2}, {"N/m", "N/cm"}},       {{0, 1, -1}, {"N s/m", "kg/s"}}, {{1, 0, -1}, {"m/s", "cm/s"}},
        {plain, {"", "", "%", "deg"}}};
    for (const auto& [which, units] : known)
      if (which == dimension) return units[static_cast<std::size_t>(below(static_cast<int>(units.size())))];
    std::string text;
    const std::array<const char*, 3> base{"m", "kg", "s"};
    for (int i = 0; i < 3; ++i) {
      if (dimension[i] == 0) continue;
      text += fmt::format("{}{}", text.empty() && dimension[i] > 0 ? "" : dimension[i] > 0 ? " " : "/", base[i]);
      if (std::abs(dimension[i]) > 1) text += fmt::format("^{}", std::abs(dimension[i]));
    }
    return text;
  }

  std::string literal(const Dimension& dimension) {
    const std::string in = unit(dimension);
    return figure() + (in.empty() ? "" : " " + in);
  }

  void write_function() {
    const std::string name = fmt::format("f{}", functions_.size());
    Function function{name, small_dimension(), {}};
    std::vector<Name> outside;
    std::swap(outside, names_);
    for (const auto& each : outside)
      if (each.text[0] == 'c') names_.push_back(each);
    std::string formals;
    for (int i = below(2); i >= 0; --i) {
      const Dimension dimension = small_dimension();
      formals += fmt::format("{}a{}", formals.empty() ? "" : ", ", i);
      function.formals.push_back(dimension);
      names_.push_back({fmt::format("a{}", i), dimension, false});
    }
    declarations_ += fmt::format("function {}({}) = {}\n", name, formals, number_of(function.result, 3));
    std::swap(outside, names_);
    functions_.push_back(function);
  }

  /// A known name of that dimension, or an empty text.
  std::string named(const Dimension& dimension, bool vector) {
    std::vector<std::string> fitting;
    for (const auto& name : names_)
      if (name.dimension == dimension && name.vector == vector) fitting.push_back(name.text);
    if (!vector)  // parts of vectors that have a name
      for (const auto& name : names_)
        if (name.dimension == dimension && name.vector) fitting.push_back(name.text + (one_in(2) ? ".x" : ".y"));
    if (const std::string input = named_input(dimension, vector); !input.empty()) fitting.push_back(input);
    if (!vector && dimension == plain) fitting.push_back("pi");
    return fitting.empty() ? "" : fitting[static_cast<std::size_t>(below(static_cast<int>(fitting.size())))];
  }

  /// An input of that dimension, or an empty text.
  std::string named_input(const Dimension& dimension, bool vector) {
    if (!hand_) return "";
    std::vector<std::string> fitting;
    const std::array<std::pair<const char*, Dimension>, 3> motion{
        {{"hand", length}, {"velocity", {1, 0, -1}}, {"acceleration", {1, 0, -2}}}};
    for (const auto& [name, of] : motion) {
      if (of != dimension) continue;
      if (vector)
        fitting.emplace_back(name);
      else
        fitting.insert(fitting.end(), {std::string(name) + ".x", std::string(name) + ".y"});
    }
    if (!vector && dimension == length) fitting.insert(fitting.end(), {"x", "y"});
    if (!vector && dimension == Dimension{0, 0, 1}) fitting.insert(fitting.end(), {"time", "dt"});
    return fitting.empty() ? "" : fitting[static_cast<std::size_t>(below(static_cast<int>(fitting.size())))];
  }

  std::string number_of(const Dimension& d, int depth) {
    if (depth == 0 || one_in(6)) {
      const std::string name = named(d, false);
      return name.empty() || one_in(4) ? literal(d) : name;
    }
    const auto n = [&](const Dimension& dimension) { return number_of(dimension, depth - 1); };
    switch (below(d == plain ? 24 : 14)) {
      case 0: return fmt::format("({} + {})", n(d), n(d));
      case 1: return fmt::format("({} - {})", n(d), n(d));
      case 2: return product(d, depth);
      case 3: return quotient(d, depth);
      case 4: return fmt::format("-{}", n(d));
      case 5: return fmt::format("{}({}, {})", one_in(2) ? "min" : "max", n(d), n(d));
      case 6: return fmt::format("(if {} then {} else {})", condition(depth - 1), n(d), n(d));
      case 7: return one_in(2) ? fmt::format("abs({})", n(d)) : fmt::format("length({})", vector_of(d, depth - 1));
      case 8: return d[0] % 2 == 0 && d[1] % 2 == 0 && d[2] % 2 == 0 ? power(d, depth) : product(d, depth);
      case 9: return fmt::format("clamp({}, {}, {})", n(d), literal(d), n(d));
      case 10: return call(d, depth);
      case 11: {
        const Dimension a = small_dimension(), b{d[0] - a[0], d[1] - a[1], d[2] - a[2]};
        return fmt::format("dot({}, {})", vector_of(a, depth - 1), vector_of(b, depth - 1));
      }
      case 12: return fmt::format("({}).{}", vector_of(d, depth - 1), one_in(2) ? "x" : "y");
      case 13: return fmt::format("mix({}, {}, {})", n(d), n(d), n(plain));
      case 14: return fmt::format("{}({})", one_in(2) ? "sin" : "cos", n(plain));
      case 15: return fmt::format("exp(-abs({}))", n(plain));
      case 16:
        return fmt::format("{}(0.2 + abs({}))", std::array{"log", "log2", "log10"}[static_cast<std::size_t>(below(3))],
                           n(plain));
      case 17: return fmt::format("{}({})", one_in(2) ? "normal" : "smoothstep", n(plain));
      case 18:
        return fmt::format("{}({})", std::array{"floor", "ceil", "round", "fract"}[static_cast<std::size_t>(below(4))],
                           n(plain));
      case 19: {
        const Dimension of = small_dimension();
        return fmt::format("atan2({}, {})", n(of), n(of));
      }
      case 20: return fmt::format("sign({})", n(small_dimension()));
      case 21:
      case 22: return fmt::format("tanh({})", n(plain));
      default: return fmt::format("modulo({}, {})", n(plain), literal(plain));
    }
  }

  std::string product(const Dimension& d, int depth) {
    const Dimension a = small_dimension(), b{d[0] - a[0], d[1] - a[1], d[2] - a[2]};
    return fmt::format("{} * {}", number_of(a, depth - 1), number_of(b, depth - 1));
  }
  std::string quotient(const Dimension& d, int depth) {
    const Dimension b = small_dimension(), a{d[0] + b[0], d[1] + b[1], d[2] + b[2]};
    return fmt::format("({} / ({}))", number_of(a, depth - 1), number_of(b, depth - 1));
  }
  /// Whole powers and roots, and any power of plain numbers.
  std::string power(const Dimension& d, int depth) {
    const Dimension half{d[0] / 2, d[1] / 2, d[2] / 2}, twice{2 * d[0], 2 * d[1], 2 * d[2]},
        inverse{-d[0], -d[1], -d[2]};
    if (d == plain && one_in(3))
      return fmt::format("(0.1 + abs({}))^{}.{}", number_of(plain, depth - 1), below(2), 1 + below(9));
    switch (below(3)) {
      case 0: return fmt::format("({})^2", number_of(half, depth - 1));
      case 1: return fmt::format("sqrt(abs({}))", number_of(twice, depth - 1));
      default: return fmt::format("({})^-1", number_of(inverse, depth - 1));
    }
  }
  std::string call(const Dimension& d, int depth) {
    for (const auto& function : functions_) {
      if (function.result != d) continue;
      std::string arguments;
      for (const auto& formal : function.formals)
        arguments += (arguments.empty() ? "" : ", ") + number_of(formal, depth - 1);
      return fmt::format("{}({})", function.name, arguments);
    }
    return product(d, depth);
  }

  std::string condition(int depth) {
    if (depth > 0 && one_in(3)) {
      const auto c = [&] { return condition(depth - 1); };
      switch (below(4)) {
        case 0: return fmt::format("({} and {})", c(), c());
        case 1: return fmt::format("({} or {})", c(), c());
        case 2: return fmt::format("(not ({}))", c());
        default: return fmt::format("(if {} then {} else {})", c(), c(), c());
      }
    }
    if (one_in(8)) {
      std::vector<std::string> known{"true", "false"};
      if (hand_) known.insert(known.end(), {"button", "button"});
      known.insert(known.end(), conditions_.begin(), conditions_.end());
      return known[static_cast<std::size_t>(below(static_cast<int>(known.size())))];
    }
    const Dimension d = small_dimension();
    return fmt::format("{} {} {}", number_of(d, depth),
                       std::array{"<", "<=", ">", ">="}[static_cast<std::size_t>(below(4))], number_of(d, depth));
  }

  std::string vector_of(const Dimension& d, int depth) {
    if (depth == 0 || one_in(6)) {
      const std::string name = named(d, true);
      if (!name.empty()) return name;
      return fmt::format("vector({}, {})", number_of(d, 0), number_of(d, 0));
    }
    const auto v = [&](const Dimension& dimension) { return vector_of(dimension, depth - 1); };
    switch (below(hand_ && d == force ? 12 : 10)) {
      case 0: return fmt::format("({} + {})", v(d), v(d));
      case 1: return fmt::format("({} - {})", v(d), v(d));
      case 2: {
        const Dimension a = small_dimension(), b{d[0] - a[0], d[1] - a[1], d[2] - a[2]};
        return one_in(2) ? fmt::format("{} * {}", number_of(a, depth - 1), v(b))
                         : fmt::format("{} * {}", v(b), number_of(a, depth - 1));
      }
      case 3: {
        const Dimension b = small_dimension(), a{d[0] + b[0], d[1] + b[1], d[2] + b[2]};
        return fmt::format("({} / ({}))", v(a), number_of(b, depth - 1));
      }
      case 4: return fmt::format("-{}", v(d));
      case 5: return fmt::format("(if {} then {} else {})", condition(depth - 1), v(d), v(d));
      case 6: return fmt::format("rotate({}, {})", v(d), number_of(plain, depth - 1));
      case 7:
        return d == plain ? fmt::format("normalise({})", v(small_dimension()))
                          : fmt::format("{} * normalise({})", number_of(d, depth - 1), v(small_dimension()));
      case 8: return fmt::format("mix({}, {}, {})", v(d), v(d), number_of(plain, depth - 1));
      case 10: return fmt::format("viscous({})", number_of({0, 1, -1}, depth - 1));
      case 11: return fmt::format("spring({})", number_of({0, 1, -2}, depth - 1));
      default: return fmt::format("vector({}, {})", number_of(d, depth - 1), number_of(d, depth - 1));
    }
  }

  struct Function {
    std::string name;
    Dimension result;
    std::vector<Dimension> formals;
  };

  std::mt19937 random_;  // unlike distributions, it gives the same numbers on every platform
  std::vector<Name> names_;
  std::vector<std::string> conditions_;
  std::vector<Name> unmoved_;  ///< states without an update so far
  std::vector<Function> functions_;
  std::vector<Param> params_;
  std::string declarations_, body_;
  bool hand_ = false;

 public:
  const std::vector<Param>& params() const { return params_; }
};

}  // namespace wale::compiling
