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
  for (const Grid& grid : description_.grids) grids_.push_back(recall_ranges(grid));
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
  for (std::size_t i = 0; i < std::min(quantities.size(), quantities_limit); ++i) {
    const Quantity& quantity = quantities[i];
    const std::size_t first = quantity.kind == Quantity::Kind::input       ? 0
                              : quantity.kind == Quantity::Kind::parameter ? description_.first_parameter()
                                                                           : description_.first_state();
    registers_[first + quantity.index] = Enclosure::quantity(quantity.in(domain), i);
  }
}

void RangeMachine::run(std::span<const Instruction> code, std::span<ResultRanges> results) {
  for (std::size_t number = 0; number < code.size(); ++number) {
    const Instruction& i = code[number];
    const auto operation = static_cast<Operation>(i.operation);
    ResultRanges found{};
    switch (operation) {
      case Operation::sample: found = tables_[i.c].at(range(i.a), range(i.b)); break;
      case Operation::recall: found = grids_[i.c]; break;
      case Operation::cell: found[0] = cell_range(description_.grids[i.c]); break;
      case Operation::peak: found[0] = peak_range(i.a); break;
      default: {
        const bool same = i.a == i.b;
        registers_[i.destination] = enclose(operation, registers_[i.a], registers_[i.b], registers_[i.c], same);
        if (!results.empty()) results[number] = {range(i.destination)};
        continue;
      }
    }
    for (int result = 0; result < facts(operation).results; ++result) {
      registers_[i.destination + result] = Enclosure::of(found[static_cast<std::size_t>(result)]);
    }
    if (!results.empty()) results[number] = found;
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

/// A percentile lies between the least and the greatest of its values, of which those that are not finite count as 0.
Interval RangeMachine::peak_range(std::size_t index) {
  run_peak(index, peaks_[index]);
  const Interval value = range(description_.peaks[index].value);
  if (value.is_finite() && !value.maybe_nan) return value;
  constexpr float most = std::numeric_limits<float>::max();
  const Interval finite{std::clamp(value.low, -most, most), std::clamp(value.high, -most, most), false};
  return hull(finite, Interval{});
}

}  // namespace wale
