#include "compiler/prove/range_machine.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/machine/decoded_program.hpp"

namespace wale {

const Interval& Quantity::in(const Domain& domain) const {
  switch (kind) {
    case Kind::input: return domain.inputs[index];
    case Kind::parameter: return domain.parameters[index];
    case Kind::state: break;
  }
  return domain.states[index];
}

Interval& Quantity::in(Domain& domain) const { return const_cast<Interval&>(in(std::as_const(domain))); }

RangeMachine::RangeMachine(const Program& program)
    : program_(program), description_(program_.description()), registers_(description_.register_count()) {
  tables_.reserve(description_.tables.size());
  for (const Spline& spline : program_.decoded().splines) tables_.emplace_back(spline);
  grids_ = description_.grids;
  for (const Peak& peak : description_.peaks) peaks_.push_back(peak.code);
}

void RangeMachine::start(const Domain& domain, std::span<const Quantity> quantities) {
  const auto set = [this](std::size_t first, std::span<const Interval> ranges) {
    for (std::size_t i = 0; i < ranges.size(); ++i) registers_[first + i] = Enclosure::of(ranges[i]);
  };
  set(0, domain.inputs);
  for (std::size_t i = 0; i < description_.constants.size(); ++i) {
    registers_[first_constant + i] = Enclosure::of(Interval::of(description_.constants[i]));
  }
  set(description_.first_parameter(), domain.parameters);
  set(description_.first_state(), domain.states);
  for (std::size_t i = 0; i < domain.cells.size(); ++i) {
    grids_[i].low = domain.cells[i].low;
    grids_[i].high = domain.cells[i].high;
  }
  for (std::size_t i = 0; i < std::min(quantities.size(), quantities_limit); ++i) {
    const Quantity& quantity = quantities[i];
    const std::size_t first = quantity.kind == Quantity::Kind::input       ? 0
                              : quantity.kind == Quantity::Kind::parameter ? description_.first_parameter()
                                                                           : description_.first_state();
    registers_[first + quantity.index] = Enclosure::quantity(quantity.in(domain), i);
  }
}

void RangeMachine::run(std::span<const Instruction> code, std::span<ResultRanges> results) {
  run(code, nullptr, 0, results);
}

void RangeMachine::run(std::span<const Instruction> code, const Relations& relations, std::size_t first,
                       std::span<ResultRanges> results) {
  if (first == 0) known_.assign(3 * relations.instructions(), {});
  run(code, &relations, first, results);
}

double RangeMachine::length(const Relations& relations, RegisterNumber x, RegisterNumber y) const {
  return relations.length(relations.last(x), relations.last(y), known());
}

Enclosure RangeMachine::related(const Instruction& i, std::size_t number, const Relations& relations) const {
  const auto operation = static_cast<Operation>(i.operation);
  const Enclosure& a = registers_[i.a];
  if (operation == Operation::select) {
    if (const auto guarded = relations.guarded(number, known())) {
      // The form of an unbounded choice says nothing; the range under its guard does.
      const Enclosure& choice = registers_[guarded->operand == 1 ? i.b : i.c];
      Enclosure narrowed = choice.range.is_finite() ? choice : Enclosure::of(guarded->range);
      narrowed.range = intersection(choice.range, guarded->range);
      return guarded->operand == 1 ? enclose(operation, a, narrowed, registers_[i.c], false)
                                   : enclose(operation, a, registers_[i.b], narrowed, false);
    }
  }
  Enclosure result = enclose(operation, a, registers_[i.b], registers_[i.c], i.a == i.b);
  const std::optional<Interval> more = relations.bound(number, known());
  if (!more) return result;
  const Interval range = intersection(result.range, *more);
  if (!result.range.is_finite()) return Enclosure::of(range);
  result.range = range;
  return result;
}

void RangeMachine::run(std::span<const Instruction> code, const Relations* relations, std::size_t first,
                       std::span<ResultRanges> results) {
  const auto note = [&](std::size_t number, std::size_t result, const Interval& range) {
    if (relations != nullptr) known_[3 * (first + number) + result] = range;
    if (!results.empty()) results[number][result] = range;
  };
  for (std::size_t number = 0; number < code.size(); ++number) {
    const Instruction& i = code[number];
    const auto operation = static_cast<Operation>(i.operation);
    ResultRanges found{};
    switch (operation) {
      case Operation::sample: found = tables_[i.c].at(range(i.a), range(i.b)); break;
      case Operation::recall: found = recall_ranges(grids_[i.c]); break;
      case Operation::cell: found[0] = cell_range(grids_[i.c]); break;
      case Operation::peak: found[0] = peak_range(i.a); break;
      default: {
        Enclosure result = relations != nullptr
                               ? related(i, first + number, *relations)
                               : enclose(operation, registers_[i.a], registers_[i.b], registers_[i.c], i.a == i.b);
        note(number, 0, result.range);
        registers_[i.destination] = result;
        continue;
      }
    }
    for (std::size_t result = 0; result < static_cast<std::size_t>(facts(operation).results); ++result) {
      registers_[i.destination + result] = Enclosure::of(found[result]);
      note(number, result, found[result]);
    }
  }
}

void RangeMachine::run_peak(std::size_t index, std::span<const Instruction> code, std::span<ResultRanges> results) {
  const Peak& peak = description_.peaks[index];
  // A coordinate of the lattice is 2 u - 1 in [-1, 1], times the extent.
  const Interval share = Interval::between(-1, 1);
  constexpr auto x = static_cast<std::size_t>(Input::x), y = static_cast<std::size_t>(Input::y);
  const Enclosure hand_x = registers_[x], hand_y = registers_[y];
  registers_[x] = Enclosure::of(range_of(Operation::multiply, share, range(peak.half_width), {}));
  registers_[y] = Enclosure::of(range_of(Operation::multiply, share, range(peak.half_height), {}));
  run(code, results);
  registers_[x] = hand_x;
  registers_[y] = hand_y;
}

/// A percentile lies between the least and the greatest of its values; values that are not finite count as 0.
Interval RangeMachine::peak_range(std::size_t index) {
  run_peak(index, peaks_[index]);
  const Interval value = range(description_.peaks[index].value);
  if (value.is_finite() && !value.maybe_nan) return value;
  constexpr float most = std::numeric_limits<float>::max();
  const Interval finite{std::clamp(value.low, -most, most), std::clamp(value.high, -most, most), false};
  return hull(finite, Interval{});
}

}  // namespace wale
