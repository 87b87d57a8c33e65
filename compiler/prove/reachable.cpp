#include "compiler/prove/reachable.hpp"

#include <algorithm>

#include "compiler/prove/range_machine.hpp"
#include "compiler/prove/slice.hpp"

namespace wale {
namespace {

/// After `patient_ticks` ticks, moving ends of ranges jump to their bounds. After `most_ticks` ticks all other ranges
/// do too. Then the ranges are shrunk at most `most_shrinkings` times.
constexpr int patient_ticks = 4, most_ticks = 16, most_shrinkings = 24;
/// Instructions of all those ticks, about two seconds of work. Only a program far larger than any shipped one meets it,
/// and its ranges are then those that it declares, or less shrunk ones; both hold.
constexpr double most_instructions = 0x1p21;

/// The memory of a program: ranges of states, then of memories' cells.
using Remembered = std::vector<Interval>;

bool contains(const Interval& outer, const Interval& inner) {
  return outer.low <= inner.low && inner.high <= outer.high;
}

class Reaching {
 public:
  explicit Reaching(const Program& program)
      : description_(program.description()),
        whole_(whole_domain(description_)),
        quantities_(force_slice(description_).quantities),
        relations_(description_, description_.setup, description_.tick),
        machine_(program) {}

  Domain run() {
    bounds_ = whole_.states;
    bounds_.insert(bounds_.end(), whole_.cells.begin(), whole_.cells.end());
    begin_ = begin();
    Remembered now = begin_;
    for (int tick = 0;; ++tick) {
      if (tick == most_ticks || left_ <= 0) return whole_;
      Remembered next = after(now);
      if (std::ranges::equal(now, next, contains)) break;
      for (std::size_t i = 0; i < next.size(); ++i) next[i] = grown(now[i], next[i], bounds_[i], tick >= patient_ticks);
      now = std::move(next);
    }
    // If a tick does not leave a set of ranges, the image of these ranges is also such a set, provided that a tick does
    // not leave it either.
    Remembered next = after(now);
    for (int i = 0; i < most_shrinkings && left_ > 0 && next != now; ++i) {
      Remembered beyond = after(next);
      if (!std::ranges::equal(next, beyond, contains)) break;
      now = std::move(next);
      next = std::move(beyond);
    }
    return domain(now);
  }

 private:
  Domain domain(const Remembered& remembered) const {
    Domain result = whole_;
    const auto states = static_cast<std::ptrdiff_t>(result.states.size());
    std::copy(remembered.begin(), remembered.begin() + states, result.states.begin());
    std::copy(remembered.begin() + states, remembered.end(), result.cells.begin());
    return result;
  }

  static Interval grown(const Interval& now, const Interval& next, const Interval& bounds, bool at_once) {
    Interval result = hull(now, next);
    if (at_once && next.low < now.low) result.low = bounds.low;
    if (at_once && next.high > now.high) result.high = bounds.high;
    return result;
  }

  /// A value as it is stored; not-a-number is not stored.
  static Interval held(const Interval& value, const Interval& bounds) {
    return Interval::between(std::clamp(value.low, bounds.low, bounds.high),
                             std::clamp(value.high, bounds.low, bounds.high));
  }

  /// The initial values of states and cells.
  Remembered begin() {
    machine_.start(whole_, quantities_);
    machine_.run(description_.setup, relations_, 0);
    machine_.run(description_.enter);
    Remembered result;
    for (std::size_t i = 0; i < description_.states.size(); ++i) {
      const Interval value = machine_.range(description_.states[i].initial);
      Interval held_value = held(value, bounds_[i]);
      if (value.maybe_nan) held_value = hull(held_value, held(Interval{}, bounds_[i]));
      result.push_back(held_value);
    }
    for (const Grid& grid : description_.grids) result.push_back(Interval::of(grid.initial));
    return result;
  }

  /// Their values after any tick from `remembered` on, or after starting again.
  Remembered after(const Remembered& remembered) {
    left_ -= static_cast<double>(description_.setup.size() + description_.tick.size());
    machine_.start(domain(remembered), quantities_);
    machine_.run(description_.setup, relations_, 0);
    machine_.run(description_.tick, relations_, description_.setup.size());
    Remembered result = begin_;
    const std::size_t states = description_.states.size();
    for (std::size_t i = 0; i < states; ++i)
      result[i] = hull(result[i], held(machine_.range(description_.states[i].next), bounds_[i]));
    for (const GridWrite& write : description_.writes) {
      // The other cells stay as they are.
      Interval& cells = result[states + write.grid];
      cells = hull(cells, held(machine_.range(write.value), bounds_[states + write.grid]));
    }
    return result;
  }

  const PatchProgram& description_;
  const Domain whole_;
  const std::vector<Quantity> quantities_;
  const Relations relations_;
  RangeMachine machine_;
  Remembered bounds_, begin_;
  double left_ = most_instructions;
};

}  // namespace

Domain reachable_domain(const Program& program) {
  const PatchProgram& description = program.description();
  if (description.states.empty() && description.grids.empty()) return whole_domain(description);
  return Reaching(program).run();
}

}  // namespace wale
