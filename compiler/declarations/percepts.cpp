#include "compiler/declarations/percepts.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "compiler/declarations/in_double.hpp"

namespace wale {

double normal_quantile(double p) {
  return boost::math::quantile(boost::math::normal_distribution<double, InDouble>(), p);
}

double sensitivity(Task task, double criterion) {
  // Macmillan and Creelman 2005, Detection Theory, chapters 1 and 7.
  const bool one_interval = task == Task::yes_no || task == Task::one_interval;
  return (one_interval ? 2.0 : std::sqrt(2.0)) * normal_quantile(criterion);
}

double Threshold::distance(double a, double b) const {
  const double small = std::min(a, b), large = std::max(a, b);
  if (small == large) return 0;
  const double by_ratio =
      small > 0 ? std::log(large / small) / std::log1p(weber) : std::numeric_limits<double>::infinity();
  const double by_floor = floor > 0 ? (large - small) / floor : std::numeric_limits<double>::infinity();
  return std::min(by_ratio, by_floor);
}

bool Threshold::compared(double a, double b) const {
  const auto holds = [&](double size) { return size == 0 || valid->range.holds(std::abs(size)); };
  return !valid || (holds(a) && holds(b));
}

std::vector<std::string> Threshold::unmet(double a, double b, const Sizes& of_a, const Sizes& of_b) const {
  std::vector<std::string> found;
  const auto add = [&](const Condition& condition) { found.push_back(condition.quantity + " " + condition.written); };
  if (!compared(a, b)) add(*valid);
  for (const Condition& condition : conditions) {
    const auto meets = [&](const Sizes& sizes) {
      const auto size = sizes.find(condition.quantity);
      return size == sizes.end() || condition.range.holds(std::abs(size->second));
    };
    if (!meets(of_a) || !meets(of_b)) add(condition);
  }
  return found;
}

const Rule::Case* Rule::first(const Sizes& sizes, const std::string& kind) const {
  const auto found = std::ranges::find_if(cases, [&](const Case& each) {
    return (each.kind.empty() || each.kind == kind) &&
           std::ranges::all_of(each.conditions, [&](const Condition& condition) {
             const auto size = sizes.find(condition.quantity);
             return size != sizes.end() && condition.range.holds(size->second);
           });
  });
  return found == cases.end() ? nullptr : &*found;
}

}  // namespace wale
