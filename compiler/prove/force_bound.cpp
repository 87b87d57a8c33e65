#include "compiler/prove/force_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "compiler/prove/range_machine.hpp"
#include "compiler/prove/reachable.hpp"

namespace wale {
namespace {

/// A bound this close to the found force counts as exact.
constexpr double close_enough = 1.001;
/// The search stops after this share of the effort without an improvement by a thousandth.
constexpr long patience = 16;
/// The fixed cost of an evaluation, in instructions.
constexpr long evaluation_overhead = 40;

/// A part of the domain with its proved bound.
struct Part {
  Domain domain;
  Interval x, y;  ///< force, N
  double bound;   ///< N
  long number;    ///< of its evaluation; parts with equal bounds are split in this order
};

struct Lower {
  bool operator()(const Part& a, const Part& b) const {
    return a.bound != b.bound ? a.bound < b.bound : a.number > b.number;
  }
};

class Splitting {
 public:
  Splitting(const Program& program, const ForceSlice& slice)
      : machine_(program), slice_(slice), relations_(program.description(), slice.setup, slice.tick) {
    machine_.replace_peaks(slice.peaks);
    for (const Output& output : program.description().outputs) values_[output.component()] = output.value;
  }

  Part evaluated(const Domain& domain) {
    machine_.start(domain, slice_.quantities);
    machine_.run(slice_.setup, relations_, 0);
    machine_.run(slice_.tick, relations_, slice_.setup.size());
    const Interval x = machine_.range(values_[0]), y = machine_.range(values_[1]);
    return {domain, x, y, std::min(length_bound(x, y), machine_.length(relations_, values_[0], values_[1])),
            evaluations_++};
  }

  /// The quantity to split `part` by: the one whose spread raises the bound most. None if there is nothing to split.
  const Quantity* widest(const Part& part) {
    const Quantity* best = nullptr;
    double lowest = std::numeric_limits<double>::infinity(), widest = 0;
    for (const Quantity& quantity : slice_.quantities) {
      const Interval& range = quantity.in(part.domain);
      const float at = middle(range);
      if (at <= range.low || at >= range.high) continue;
      Domain narrowed = part.domain;
      quantity.in(narrowed) = Interval::between(at, at);
      const double bound = evaluated(narrowed).bound;
      // If no single quantity matters most, the one that was split least.
      const double share = (static_cast<double>(range.high) - range.low) / whole_width(quantity);
      if (bound < lowest || (bound == lowest && share > widest)) best = &quantity, lowest = bound, widest = share;
    }
    return best;
  }

  std::array<Part, 2> halves(const Part& part, const Quantity& quantity) {
    const Interval range = quantity.in(part.domain);
    const float at = middle(range);
    Domain low = part.domain, high = part.domain;
    quantity.in(low) = Interval::between(range.low, at, range.maybe_nan);
    quantity.in(high) = Interval::between(at, range.high, range.maybe_nan);
    std::array<Part, 2> both = {evaluated(low), evaluated(high)};
    // The bound of the whole holds for its halves.
    for (Part& half : both) half.bound = std::min(half.bound, part.bound);
    return both;
  }

  void measure(const Domain& whole) { whole_ = whole; }
  long evaluations() const { return evaluations_; }

 private:
  static float middle(const Interval& range) {
    return static_cast<float>(0.5 * (static_cast<double>(range.low) + range.high));
  }
  double whole_width(const Quantity& quantity) const {
    const Interval& range = quantity.in(whole_);
    return std::max(static_cast<double>(range.high) - range.low, 1e-300);
  }

  RangeMachine machine_;
  const ForceSlice& slice_;
  Relations relations_;
  std::array<RegisterNumber, 2> values_{};
  Domain whole_;
  long evaluations_ = 0;
};

}  // namespace

double ForceBound::ratio() const {
  if (found.newton > 0) return newton / found.newton;
  return newton > 0 ? std::numeric_limits<double>::infinity() : 1;
}

ForceBound force_bound(const Program& program, const Domain& domain, long effort) {
  const ForceSlice slice = force_slice(program.description());
  ForceBound result;
  Splitting splitting(program, slice);
  splitting.measure(domain);
  const Part whole = splitting.evaluated(domain);
  result.found = largest_force(program, slice, domain, whole.bound / close_enough);
  const double good = result.found.newton * close_enough;

  const long most = std::max(effort / (slice.instructions() + evaluation_overhead), 1L);
  std::priority_queue<Part, std::vector<Part>, Lower> open;
  const auto settle = [&](const Part& part) {
    result.newton = std::max(result.newton, part.bound);
    result.axis_newton[0] = std::max<double>(result.axis_newton[0], part.x.largest());
    result.axis_newton[1] = std::max<double>(result.axis_newton[1], part.y.largest());
  };
  const auto add = [&](Part part) {
    if (part.bound <= good)
      settle(part);
    else
      open.push(std::move(part));
  };
  add(whole);
  double lowest = whole.bound;
  long gained = splitting.evaluations();
  while (!open.empty() && splitting.evaluations() < std::min(most, gained + most / patience + 1)) {
    const Part part = open.top();
    if (part.bound * close_enough < lowest) lowest = part.bound, gained = splitting.evaluations();
    open.pop();
    if (const Quantity* quantity = splitting.widest(part)) {
      for (Part& half : splitting.halves(part, *quantity)) add(std::move(half));
    } else {
      settle(part);
    }
  }
  for (; !open.empty(); open.pop()) settle(open.top());
  result.evaluations = splitting.evaluations();
  return result;
}

ForceBound force_bound(const Program& program) { return force_bound(program, reachable_domain(program)); }

}  // namespace wale
