#include "compiler/compare/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <tuple>

namespace wale {
namespace {

constexpr double same = 1e-3;  // relative: what an extraction of one and the same force may differ by

/// The percept whose carrier the cue is, which says what force a carrier of that size exerts.
const char* percept_of(CueKind kind) {
  switch (kind) {
    case CueKind::stiffness: return "springiness";
    case CueKind::wall_stiffness: return "hardness";
    case CueKind::viscosity: return "viscosity";
    case CueKind::mass: return "heaviness";
    default: return "";
  }
}

/// Whether a difference of this cue is one of force, so that a floor can be told in newtons.
bool exerts_force(CueKind kind) {
  switch (kind) {
    case CueKind::period:
    case CueKind::orientation:
    case CueKind::regularity:
    case CueKind::bump_period:
    case CueKind::vibration_frequency: return false;
    default: return true;
  }
}

class Comparer {
 public:
  Comparer(const Declarations& declarations, std::string device)
      : declarations_(declarations), device_(std::move(device)) {
    for (const Threshold* threshold : declarations_.thresholds())
      if (std::string_view(threshold->cue) == "amplitude") least_force_ = std::max(least_force_, threshold->floor);
  }

  Comparison run(const Cues& a, const Cues& b) const {
    Comparison comparison;
    for (const CueFacts& facts : cue_table()) {
      if (!a[facts.kind] && !b[facts.kind]) continue;
      comparison.cues.push_back(difference(facts, a[facts.kind], b[facts.kind]));
    }
    bool unknown = false;
    for (const CueDifference& cue : comparison.cues) {
      if (cue.noticeable && *cue.noticeable >= 1) comparison.verdict = Verdict::apart;
      unknown |= !cue.noticeable;
    }
    if (comparison.verdict != Verdict::apart && unknown) comparison.verdict = Verdict::unknown;
    return comparison;
  }

 private:
  CueDifference difference(const CueFacts& facts, std::optional<double> a, std::optional<double> b) const {
    CueDifference found{facts.kind, a, b, {}, nullptr, Evidence::estimated};
    // A period or an orientation that only one of them has is told by what else it has.
    if (!exerts_force(facts.kind) && (!a || !b)) {
      found.noticeable = 0;
      return found;
    }
    double x = a.value_or(0), y = b.value_or(0);
    if (facts.kind == CueKind::orientation) {
      const double turned = std::remainder(x - y, std::numbers::pi);
      if (std::abs(turned) < same * std::numbers::pi) found.noticeable = 0;
      return found;
    }
    if (std::abs(x - y) <= same * std::max(std::abs(x), std::abs(y))) {
      found.noticeable = 0;
      return found;
    }
    found.threshold = threshold(facts.threshold, std::abs(x), std::abs(y));
    if (!found.threshold) return found;
    const bool own = found.threshold->device == device_;
    found.evidence = std::max(
        {found.threshold->evidence, found.threshold->handle, own ? Evidence::measured : Evidence::transferred});
    // What pushes on and what holds back are no matter of ratio.
    const double by_ratio =
        x * y > 0 ? found.threshold->distance(std::abs(x), std::abs(y)) : std::numeric_limits<double>::infinity();
    const double distance = std::min(by_ratio, force_difference(facts.kind, std::abs(x - y)));
    if (std::isfinite(distance)) found.noticeable = distance;
    return found;
  }

  /// The publication that tells of two sizes: one that compared such sizes before one that did not, the better known
  /// before what is only recalled, and then the one that tells the least apart, so that nothing is called alike too
  /// early.
  const Threshold* threshold(std::string_view cue, double x, double y) const {
    const auto merit = [&](const Threshold& each) {
      const auto compared = [&](double size) { return size == 0 || each.valid.holds(size); };  // none of it is no size
      return std::tuple(each.device != device_, !compared(x) || !compared(y), each.evidence, each.weber);
    };
    const Threshold* best = nullptr;
    for (const Threshold* each : declarations_.thresholds())
      if (each->cue == cue && (!best || merit(*each) < merit(*best))) best = each;
    return best;
  }

  /// The difference of the forces over the least that is noticed, infinite where that is not known.
  double force_difference(CueKind kind, double difference) const {
    if (!exerts_force(kind) || !(least_force_ > 0)) return std::numeric_limits<double>::infinity();
    const Percept* percept = declarations_.percepts.find(percept_of(kind));
    return difference * (percept ? percept->exerts : 1) / least_force_;
  }

  const Declarations& declarations_;
  std::string device_;
  double least_force_ = 0;  ///< N, at d' = 1
};

}  // namespace

const CueDifference* Comparison::plainest() const {
  const CueDifference* found = nullptr;
  for (const CueDifference& cue : cues)
    if (cue.noticeable && (!found || *cue.noticeable > *found->noticeable)) found = &cue;
  return found;
}

Comparison compare(const Cues& a, const Cues& b, const Declarations& declarations) {
  return Comparer(declarations, a.device).run(a, b);
}

ComparisonMatrix compare_all(std::vector<Cues> materials, const Declarations& declarations) {
  ComparisonMatrix matrix{std::move(materials), {}};
  if (matrix.materials.empty()) return matrix;
  const Comparer comparer(declarations, matrix.materials.front().device);
  for (std::size_t a = 0; a < matrix.materials.size(); ++a)
    for (std::size_t b = a + 1; b < matrix.materials.size(); ++b)
      matrix.pairs.push_back({a, b, comparer.run(matrix.materials[a], matrix.materials[b])});
  return matrix;
}

const ComparedPair* ComparisonMatrix::nearest() const {
  const auto apart = [](const ComparedPair& pair) {
    const CueDifference* plainest = pair.comparison.plainest();
    return plainest ? *plainest->noticeable : 0.0;
  };
  const ComparedPair* found = nullptr;
  for (const ComparedPair& pair : pairs) {
    // Two of which too little is known are near to nobody.
    if (pair.comparison.verdict == Verdict::unknown) continue;
    if (!found || apart(pair) < apart(*found)) found = &pair;
  }
  return found;
}

}  // namespace wale
