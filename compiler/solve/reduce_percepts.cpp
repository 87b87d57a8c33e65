#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/solve_percepts.hpp"
#include "compiler/text/readable.hpp"

// Divides the device's force among the percepts, or gives it all to a single one that needs more. Sizes that the author
// fixed come first, then the percepts in the order of their priority. If a law depends on the size of another percept's
// carrier, it uses the reduced size.
//
// A percept whose law depends on a percept of lower priority can be solved neither before nor after it. Therefore one
// number describes how far the percepts are served in the order of priority: 2.3 means that two are rendered fully, the
// third with 0.3 of the size that its level needs then, and the others not at all. Given this number, all sizes follow,
// coupled percepts first. The number is found such that the sum of the forces equals the device's force.

namespace wale {
namespace {

constexpr int steps_as_number = 60;  // steps of bisection
/// Steps of bisection in the program, followed by linear interpolation between the two ends. Each end is known to
/// 1/4096, so the error is of the order of (1/4096)^2 if the law is curved.
constexpr int steps_as_expression = 12;

}  // namespace

/// Solved percepts in the order of their priority: the essential ones, then the others, each in the author's order.
std::vector<std::size_t> PerceptSolver::by_priority() const {
  std::vector<std::size_t> all;
  for (const bool essential : {true, false})
    for (std::size_t i = 0; i < told_.size(); ++i)
      if (told_[i].solved && told_[i].asked->essential == essential) all.push_back(i);
  return all;
}

/// Whether a law depends, directly or through others, on a percept that is served after it.
bool PerceptSolver::serves_out_of_order(const std::vector<std::size_t>& order) const {
  std::vector<std::size_t> later;
  for (auto each = order.rbegin(); each != order.rend(); ++each) {
    if (exertion(told_[*each]) == 0) continue;
    std::vector<std::size_t> waiting{*each};
    std::vector<bool> seen(told_.size());
    while (!waiting.empty()) {
      const std::size_t index = waiting.back();
      waiting.pop_back();
      if (seen[index]) continue;
      seen[index] = true;
      if (std::ranges::find(later, index) != later.end()) return true;
      if (told_[index].shares != none) waiting.push_back(told_[index].shares);
      for (const std::size_t other : told_[index].couples)
        if (other != none) waiting.push_back(other);
    }
    later.push_back(*each);
  }
  return false;
}

std::vector<double> PerceptSolver::turns(const std::vector<std::size_t>& order) const {
  std::vector<double> turns(told_.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) turns[order[i]] = static_cast<double>(i);
  return turns;
}

double PerceptSolver::serve(const std::vector<std::size_t>& order, double served) {
  const std::vector<double> turns = this->turns(order);
  double force = 0;
  for (const std::size_t index : order_) {
    Told& told = told_[index];
    if (told.shares != none)
      told.size = told_[told.shares].size;
    else if (told.solved)
      told.size = told.law->carrier_of(told.asked->level, coupled_sizes(told)) *
                  (exertion(told) > 0 ? std::clamp(served - turns[index], 0.0, 1.0) : 1);
    if (std::isfinite(told.size)) force += exertion(told) * told.size;
  }
  return force;
}

void PerceptSolver::reduce() {
  const double limit = most();
  const std::vector<std::size_t> order = by_priority();
  double low = 0, high = static_cast<double>(order.size());
  if (!(serve(order, high) > limit)) return;
  for (int step = 0; step < steps_as_number; ++step) {
    const double middle = 0.5 * (low + high);
    (serve(order, middle) > limit ? high : low) = middle;
  }
  serve(order, low);
  double used = 0;
  for (const Told& told : told_)
    if (!told.solved && std::isfinite(told.size)) used += exertion(told) * told.size;
  std::vector<std::string> before;
  for (const std::size_t index : order) {
    const Told& told = told_[index];
    if (told.percept->exerts == 0) continue;
    report_reduced(told, used, before);
    used += told.percept->exerts * told.size;
    before.push_back(told.asked->name);
  }
}

/// Reports a percept that gets less than its level needs although the device could render it alone.
void PerceptSolver::report_reduced(const Told& told, double used, const std::vector<std::string>& before) {
  const double limit = most(), exerts = told.percept->exerts;
  const char* limited = device_.profile.shaker ? "m/s^2" : "N";
  const double asked = told.law->carrier_of(told.asked->level, coupled_sizes(told));
  constexpr double rounding = 1e-9;
  if (!(told.size < asked * (1 - rounding)) || exerts * asked > limit) return;
  const double level = told.law->level_of(told.size, coupled_sizes(told));
  report(Code::reduced_percept, told.asked->span,
         readable("{} {:.3g} is reduced to {:.2g}: the forces together would be {:.3g} {}, and `{}` gives "
                  "{:.3g} {}",
                  told.asked->name, told.asked->level, level, used + exerts * asked, limited, device_.profile.name,
                  limit, limited),
         Advice(before.empty() ? std::string("the forces that are fixed come first; weaken them")
                               : fmt::format("what stands above it comes first: {}; put it higher, mark it "
                                             "`essential`, or ask for less of the others",
                                             fmt::join(before, ", ")))
             .fact("asked", told.asked->level)
             .fact("reduced", level)
             .fact("most", limit, limited));
}

// ---- expressions ----------------------------------------------------------------------------------------------------

TermId PerceptSolver::asked_size(const Told& told, SolvedMaterial& solved, TermCopier& copy) const {
  solved.terms.attribute(told.asked->span);
  return *told.law->carrier(solved.terms, level_term(told, solved.terms, copy), coupled_terms(told, solved));
}

TermId PerceptSolver::serve(const std::vector<std::size_t>& order, TermId served, SolvedMaterial& solved,
                            TermCopier& copy) {
  Terms& terms = solved.terms;
  const std::vector<double> turns = this->turns(order);
  const auto apply = [&](Operation operation, TermId a, TermId b) { return terms.apply(operation, a, b); };
  const TermId nothing = terms.literal(0), whole = terms.literal(1);
  TermId force = nothing;
  for (const std::size_t index : order_) {
    Told& told = told_[index];
    if (told.shares != none) told.term = told_[told.shares].term;
    if (told.solved) {
      told.term = asked_size(told, solved, copy);
      if (exertion(told) > 0) {
        const TermId gone = apply(Operation::subtract, served, terms.literal(turns[index]));
        const TermId share = apply(Operation::minimum, apply(Operation::maximum, gone, nothing), whole);
        told.term = apply(Operation::multiply, *told.term, share);
      }
    }
    if (exertion(told) > 0)
      force = apply(Operation::add, force, apply(Operation::multiply, terms.literal(told.percept->exerts), *told.term));
  }
  return force;
}

/// Finds how far the percepts are served so that their forces equal the device's force, by bisection and a final linear
/// interpolation. If the forces never exceed the device's, all are served.
void PerceptSolver::serve_jointly(const std::vector<std::size_t>& order, SolvedMaterial& solved, TermCopier& copy) {
  Terms& terms = solved.terms;
  const auto apply = [&](Operation operation, TermId a, TermId b) { return terms.apply(operation, a, b); };
  const auto either = [&](TermId condition, TermId yes, TermId no) {
    return terms.apply(Operation::select, condition, yes, no);
  };
  const TermId limit = terms.literal(most()), all = terms.literal(static_cast<double>(order.size()));
  TermId low = terms.literal(0), high = all, half = terms.literal(0.5);
  TermId force_low = serve(order, low, solved, copy), force_high = serve(order, high, solved, copy);
  const TermId beyond = apply(Operation::less, limit, force_high);
  for (int step = 0; step < steps_as_expression; ++step) {
    const TermId middle = apply(Operation::multiply, half, apply(Operation::add, low, high));
    const TermId force = serve(order, middle, solved, copy), too_far = apply(Operation::less, limit, force);
    low = either(too_far, low, middle), force_low = either(too_far, force_low, force);
    high = either(too_far, middle, high), force_high = either(too_far, force, force_high);
  }
  const TermId share = apply(Operation::divide, apply(Operation::subtract, limit, force_low),
                             apply(Operation::subtract, force_high, force_low));
  const TermId between =
      apply(Operation::add, low, apply(Operation::multiply, share, apply(Operation::subtract, high, low)));
  serve(order, either(beyond, between, all), solved, copy);
}

void PerceptSolver::reduce(SolvedMaterial& solved, TermCopier& copy) {
  Terms& terms = solved.terms;
  const std::vector<std::size_t> order = by_priority();
  if (serves_out_of_order(order)) serve_jointly(order, solved, copy);
  const auto apply = [&](Operation operation, TermId a, TermId b) { return terms.apply(operation, a, b); };
  TermId left = terms.literal(most());
  const auto take = [&](const Told& told) {
    const TermId force = apply(Operation::multiply, terms.literal(told.percept->exerts), *told.term);
    left = apply(Operation::maximum, apply(Operation::subtract, left, force), terms.literal(0));
  };
  for (const Told& told : told_)
    if (!told.solved && exertion(told) > 0) take(told);
  for (const std::size_t index : order) {
    Told& told = told_[index];
    if (told.percept->exerts == 0) continue;
    terms.attribute(told.asked->span);
    told.term =
        apply(Operation::minimum, *told.term, apply(Operation::divide, left, terms.literal(told.percept->exerts)));
    take(told);
  }
  // A percept that exerts no force has the size for its level, given the sizes of the others now.
  for (const std::size_t index : order_) {
    Told& told = told_[index];
    if (told.shares != none) told.term = told_[told.shares].term;
    if (told.solved && told.percept->exerts == 0 && !told.couples.empty()) told.term = asked_size(told, solved, copy);
  }
}

}  // namespace wale
