#include "tests/reference/float_evaluator.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <stdexcept>

#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/grid.hpp"
#include "runtime/machine/meaning.hpp"
#include "runtime/machine/spline.hpp"

namespace wale::reference {

namespace {

/// How often a value changes, as in the language reference: never, with parameters, with the hand.
enum class Changes { never, with_parameters, with_hand };

/// A computed value and its operands, for derivatives. Derivatives know the value of a step that never changes, and so
/// whether it is zero.
struct Step {
  enum class Kind { value, input, operation, lookup, component };
  Kind kind = Kind::value;
  float value = 0;
  Changes changes = Changes::never;
  Operation operation = Operation::add;
  std::uint32_t index = 0;  ///< input, or component
  std::array<const Step*, 3> of{};
  std::array<float, 3> results{};  ///< of a lookup
  mutable std::array<const Step*, 2> derivatives{};

  bool constant() const { return changes == Changes::never && kind == Kind::value; }
  bool is(float other) const {
    return constant() && std::bit_cast<std::uint32_t>(value) == std::bit_cast<std::uint32_t>(other);
  }
  bool zero() const { return is(0.0f) || is(-0.0f); }
};

/// Converts an input as the machine does: a subnormal number becomes the zero of its sign.
float entering(double number) {
  const auto value = static_cast<float>(number);
  return std::fpclassify(value) == FP_SUBNORMAL ? std::copysign(0.0f, value) : value;
}

[[gnu::noinline]] float applied(Operation operation, float a, float b, float c) {
  // clang-format off
  switch (operation) {
#define INSTRUCTION(number, name, ...) \
  case Operation::name: return Meaning<Operation::name>::of(a, b, c);
#define SPECIAL(number, name, ...) \
  case Operation::name: break;
#include "wale/instruction.def"
  }
  // clang-format on
  return 0;
}

}  // namespace

/// Evaluates the terms at one state of the hand, or at one point of a peak's lattice.
class FloatEvaluation {
 public:
  FloatEvaluation(FloatSimulation& simulation, const FloatInputs& inputs)
      : simulation_(simulation),
        material_(simulation.material_),
        inputs_(&inputs),
        known_(simulation.material_.terms.size(), nullptr) {}

  /// Starts again, for other inputs.
  void begin(const FloatInputs& inputs) {
    inputs_ = &inputs;
    for (const TermId id : reached_) known_[id] = nullptr;
    reached_.clear();
    used_ = 0;
  }

  float value(TermId id) { return step(id)->value; }

  const Step* constant(float value) { return keep({.value = value}); }

  /// Performs an operation. An operation that is exact for all operands makes no step.
  const Step* apply(Operation operation, const Step* a, const Step* b = nullptr, const Step* c = nullptr) {
    if (operation == Operation::multiply && b->is(1)) return a;
    if (operation == Operation::multiply && a->is(1)) return b;
    if (operation == Operation::divide && b->is(1)) return a;
    if (operation == Operation::subtract && b->is(0)) return a;
    if (operation == Operation::select && a->constant()) return a->value != 0 ? b : c;
    if (operation == Operation::negate && a->kind == Step::Kind::operation && a->operation == Operation::negate)
      return a->of[0];
    Step step{.kind = Step::Kind::operation, .operation = operation, .of = {a, b, c}};
    bool known = true;
    for (const Step* operand : step.of) {
      if (!operand) continue;
      known = known && operand->constant();
      step.changes = std::max(step.changes, operand->changes);
    }
    step.value = applied(operation, a->value, b ? b->value : 0, c ? c->value : 0);
    return known ? constant(step.value) : keep(step);
  }

  /// Along x (axis 0) or y.
  const Step* derivative(const Step* of, int axis);

 private:
  const Step* keep(const Step& step) {
    if (used_ == steps_.size()) steps_.emplace_back();
    return &(steps_[used_++] = step);
  }

  const Step* step(TermId id) {
    if (!known_[id]) {
      known_[id] = work_out(material_.terms[id]);
      reached_.push_back(id);
    }
    return known_[id];
  }

  const Step* work_out(const Term& term) {
    switch (term.kind) {
      case TermKind::literal: return constant(entering(term.value));
      case TermKind::input: {
        const Input input = term.input();
        const bool patch = input == Input::patch_half_width || input == Input::patch_half_height ||
                           input == Input::patch_rim || input == Input::seconds_per_tick;
        return keep({.kind = Step::Kind::input,
                     .value = entering((*inputs_)[term.index]),
                     .changes = patch ? Changes::with_parameters : Changes::with_hand,
                     .index = term.index});
      }
      case TermKind::parameter:
        return keep({.kind = Step::Kind::input,
                     .value = entering(simulation_.parameters_[term.index]),
                     .changes = Changes::with_parameters,
                     .index = 32});
      case TermKind::state:
        return keep({.kind = Step::Kind::input,
                     .value = simulation_.states_[term.index],
                     .changes = Changes::with_hand,
                     .index = 32});
      case TermKind::settled: return step(term.a);
      case TermKind::component: return component(step(term.a), term.index);
      case TermKind::gradient: return derivative(step(term.a), static_cast<int>(term.index));
      case TermKind::peak: return peak(term.a);
      case TermKind::operation: break;
      default: throw std::runtime_error("a term that is not solved");
    }
    switch (term.operation) {
      case Operation::sample: {
        const Step *a = step(term.a), *b = step(term.b);
        const SplineSample found = sample_of(simulation_.splines_[term.index], a->value, b->value);
        return keep({.kind = Step::Kind::lookup,
                     .changes = std::max(a->changes, b->changes),
                     .of = {a, b, nullptr},
                     .results = {found.value, found.along_a, found.along_b}});
      }
      case Operation::recall: {
        const Step *a = step(term.a), *b = step(term.b);
        const GridSample found = recall_of(shape(term.index), simulation_.cells_.data(), a->value, b->value);
        return keep({.kind = Step::Kind::lookup,
                     .changes = Changes::with_hand,
                     .of = {a, b, nullptr},
                     .results = {found.value, found.along_a, found.along_b}});
      }
      case Operation::cell: {
        const std::size_t cell = cell_at(shape(term.index), step(term.a)->value, step(term.b)->value);
        return keep(
            {.kind = Step::Kind::input, .value = simulation_.cells_[cell], .changes = Changes::with_hand, .index = 32});
      }
      default: break;
    }
    const auto count = operands(term).size();
    const Step* a = step(term.a);
    const Step* b = count > 1 ? step(term.b) : nullptr;
    return apply(term.operation, a, b, count > 2 ? step(term.c) : nullptr);
  }

  const Step* component(const Step* lookup, std::uint32_t index) {
    return keep({.kind = Step::Kind::component,
                 .value = lookup->results[index],
                 .changes = lookup->changes,
                 .index = index,
                 .of = {lookup, nullptr, nullptr}});
  }

  GridShape shape(std::uint32_t memory) const {
    const Grid& grid = material_.memories[memory];
    return {simulation_.first_cells_[memory], grid.columns, grid.rows};
  }

  /// The 99th percentile over the patch without its rim, by a simple loop over the lattice of PATCH_PROGRAM.md.
  const Step* peak(TermId of) {
    const Step* here = step(of);
    if (here->changes != Changes::with_hand) return here;
    const auto [known, is_new] = simulation_.peaks_.try_emplace(of, 0.0f);
    if (is_new) {
      constexpr std::uint32_t points = 16384;
      const auto extent = [&](Input half) {
        return applied(Operation::subtract, (*inputs_)[static_cast<std::size_t>(half)],
                       (*inputs_)[static_cast<std::size_t>(Input::patch_rim)], 0);
      };
      const float half_width = extent(Input::patch_half_width), half_height = extent(Input::patch_half_height);
      std::vector<float> values;
      FloatInputs at = simulation_.patch_;
      FloatEvaluation there(simulation_, at);
      for (std::uint32_t i = 0; i < points; ++i) {
        const auto coordinate = [&](std::uint64_t step) {
          const double u = static_cast<double>(i * step % (std::uint64_t{1} << 32)) / 4294967296.0;
          return static_cast<float>(2 * u - 1);
        };
        at[static_cast<std::size_t>(Input::x)] = applied(Operation::multiply, coordinate(3242174889u), half_width, 0);
        at[static_cast<std::size_t>(Input::y)] = applied(Operation::multiply, coordinate(2447445414u), half_height, 0);
        there.begin(at);
        const float value = there.value(of);
        values.push_back(std::isfinite(value) ? value : 0.0f);
      }
      std::ranges::sort(values);
      known->second = values[static_cast<std::size_t>(std::ceil(0.99f * static_cast<float>(points))) - 1];
    }
    return keep({.kind = Step::Kind::input, .value = known->second, .changes = Changes::with_parameters, .index = 32});
  }

  FloatSimulation& simulation_;
  const SolvedMaterial& material_;
  const FloatInputs* inputs_;
  std::vector<const Step*> known_;  ///< by term
  std::vector<TermId> reached_;     ///< the terms with an entry in `known_`
  std::deque<Step> steps_;          ///< steps point to each other; those after `used_` are outdated
  std::size_t used_ = 0;
};

namespace {

/// A step with arithmetic operators, so that the derivative column of the instruction table reads as mathematics. A
/// known zero stays zero and vanishes from sums.
struct Derived {
  FloatEvaluation* evaluation;
  const Step* step;

  bool zero() const { return step->zero(); }
};

Derived apply(Operation operation, Derived a) { return {a.evaluation, a.evaluation->apply(operation, a.step)}; }
Derived apply(Operation operation, Derived a, Derived b) {
  return {a.evaluation, a.evaluation->apply(operation, a.step, b.step)};
}

Derived operator+(Derived a, Derived b) {
  if (a.zero()) return b;
  return b.zero() ? a : apply(Operation::add, a, b);
}
Derived operator-(Derived a) { return a.zero() ? a : apply(Operation::negate, a); }
Derived operator-(Derived a, Derived b) {
  if (b.zero()) return a;
  return a.zero() ? -b : apply(Operation::subtract, a, b);
}
Derived operator*(Derived a, Derived b) {
  if (a.zero()) return a;
  return b.zero() ? b : apply(Operation::multiply, a, b);
}
Derived operator/(Derived a, Derived b) { return a.zero() ? a : apply(Operation::divide, a, b); }

[[maybe_unused]] Derived sine(Derived a) { return apply(Operation::sine, a); }
[[maybe_unused]] Derived cosine(Derived a) { return apply(Operation::cosine, a); }
[[maybe_unused]] Derived exp2(Derived a) { return apply(Operation::exp2, a); }
[[maybe_unused]] Derived absolute(Derived a) { return apply(Operation::absolute, a); }
[[maybe_unused]] Derived less(Derived a, Derived b) { return apply(Operation::less, a, b); }
/// Selects `b` or `c`. If both are the same number, it records no choice.
[[maybe_unused]] Derived select(Derived a, Derived b, Derived c) {
  if (b.step == c.step || (b.step->constant() && c.step->is(b.step->value))) return b;
  return {a.evaluation, a.evaluation->apply(Operation::select, a.step, b.step, c.step)};
}

Derived rule(Operation operation, FloatEvaluation* evaluation, Derived r, Derived a, Derived b, Derived c, Derived da,
             Derived db, Derived dc) {
  [[maybe_unused]] const auto number = [&](double value) {
    return Derived{evaluation, evaluation->constant(static_cast<float>(value))};
  };
  // clang-format off
  switch (operation) {
#define INSTRUCTION(number_, name, fields, results, cost, meaning, range, derivative) \
  case Operation::name: return derivative;
#define SPECIAL(number_, name, ...) \
  case Operation::name: break;
#include "wale/instruction.def"
  }
  // clang-format on
  (void)r, (void)a, (void)b, (void)c, (void)da, (void)db, (void)dc;
  return number(0);
}

}  // namespace

const Step* FloatEvaluation::derivative(const Step* of, int axis) {
  const Step*& known = of->derivatives[static_cast<std::size_t>(axis)];
  if (known) return known;
  known = constant(0);
  if (of->changes != Changes::with_hand) return known;
  switch (of->kind) {
    case Step::Kind::value:
    case Step::Kind::lookup: break;
    case Step::Kind::input: {
      const auto place = static_cast<std::uint32_t>(axis == 0 ? Input::x : Input::y);
      const auto on_workspace = static_cast<std::uint32_t>(axis == 0 ? Input::workspace_x : Input::workspace_y);
      if (of->index == place || of->index == on_workspace) known = constant(1);
      const auto slope = static_cast<std::uint32_t>(axis == 0 ? Input::shape_edge_x : Input::shape_edge_y);
      if (of->index == static_cast<std::uint32_t>(Input::shape_edge))
        known = keep({.kind = Step::Kind::input,
                      .value = entering((*inputs_)[slope]),
                      .changes = Changes::with_hand,
                      .index = slope});
      break;
    }
    case Step::Kind::component: {
      if (of->index != 0) break;
      const Step* lookup = of->of[0];
      const Derived du{this, component(lookup, 1)}, dv{this, component(lookup, 2)};
      const Derived da{this, derivative(lookup->of[0], axis)}, db{this, derivative(lookup->of[1], axis)};
      known = (du * da + dv * db).step;
      break;
    }
    case Step::Kind::operation: {
      const auto derived = [&](const Step* operand) {
        return Derived{this, operand ? derivative(operand, axis) : constant(0)};
      };
      const auto itself = [&](const Step* operand) { return Derived{this, operand ? operand : constant(0)}; };
      known = rule(of->operation, this, itself(of), itself(of->of[0]), itself(of->of[1]), itself(of->of[2]),
                   derived(of->of[0]), derived(of->of[1]), derived(of->of[2]))
                  .step;
      break;
    }
  }
  return known;
}

namespace {

/// Within low .. high; `otherwise` for not-a-number.
float held_within(float value, double low, double high, float otherwise) {
  if (std::isnan(value)) return otherwise;
  return std::min(std::max(value, entering(low)), entering(high));
}

}  // namespace

FloatSimulation::FloatSimulation(const SolvedMaterial& material, std::vector<float> parameters,
                                 const FloatInputs& inputs)
    : material_(material), parameters_(std::move(parameters)), patch_(inputs) {
  for (const HeightTable& table : material.tables) splines_.emplace_back(table);
  place();
}

void FloatSimulation::place() {
  first_cells_.clear();
  cells_.clear();
  for (const Grid& memory : material_.memories) {
    first_cells_.push_back(cells_.size());
    cells_.insert(cells_.end(), std::size_t{memory.columns} * memory.rows, entering(memory.initial));
  }
  states_.assign(material_.states.size(), 0.0f);
  initial_states_ = states_;
}

void FloatSimulation::enter(const FloatInputs& hand) {
  const FloatingPointMode mode;
  FloatEvaluation evaluation(*this, hand);
  std::vector<float> begun;
  for (const auto& state : material_.states) {
    const float nearest_to_zero = held_within(0, state.low, state.high, 0);
    begun.push_back(held_within(evaluation.value(state.initial), state.low, state.high, nearest_to_zero));
  }
  states_ = initial_states_ = begun;
}

std::array<float, 2> FloatSimulation::tick(const FloatInputs& hand) {
  const FloatingPointMode mode;
  FloatEvaluation evaluation(*this, hand);
  const DeviceProfile& device = material_.device;
  std::array<float, 2> ceiling{static_cast<float>(device.most()), static_cast<float>(device.most())};
  if (device.shaker) ceiling[1] = static_cast<float>(device.shaker->frequency_high);
  std::array<float, 2> force{};
  for (std::size_t axis = 0; axis < 2; ++axis)
    force[axis] = applied(Operation::limit, evaluation.value(material_.force[axis]), ceiling[axis], 0);
  std::vector<float> next;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const auto& state = material_.states[i];
    next.push_back(held_within(evaluation.value(state.next), state.low, state.high, initial_states_[i]));
  }
  struct Written {
    std::size_t cell;
    float value;
  };
  std::vector<Written> written;
  for (const auto& write : material_.writes) {
    const float u = evaluation.value(write.u), v = evaluation.value(write.v), value = evaluation.value(write.value);
    if (std::isnan(u) || std::isnan(v) || std::isnan(value)) continue;
    const Grid& memory = material_.memories[write.memory];
    const GridShape shape{first_cells_[write.memory], memory.columns, memory.rows};
    written.push_back({cell_at(shape, u, v), held_within(value, memory.low, memory.high, 0)});
  }
  states_ = next;
  for (const auto& [cell, value] : written) cells_[cell] = value;
  return force;
}

}  // namespace wale::reference
