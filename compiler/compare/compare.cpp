#include "compiler/compare/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <tuple>

namespace wale {
namespace {

constexpr double same = 1e-3;  // relative: two extractions of the same force may differ by this much

/// The force that a unit of this cue exerts, by the percept whose carrier it is, in N per unit; 1 for a force, 0 for
/// what is none.
double exerts(const CueFacts& facts, const Declarations& declarations) {
  if (!facts.exerts) return 0;
  double found = 1;
  declarations.percepts.each([&](const std::string&, const Percept& percept) {
    if (facts.extractor != Extractor::none && percept.extractor == facts.extractor && percept.exerts > 0)
      found = percept.exerts;
  });
  return found;
}

bool is_direction(CueKind kind) {
  return kind == CueKind::orientation || kind == CueKind::push_axis || kind == CueKind::stiffness_axis ||
         kind == CueKind::vibration_axis || kind == CueKind::sway_axis || kind == CueKind::viscosity_axis ||
         kind == CueKind::friction_axis || kind == CueKind::mass_axis || kind == CueKind::drag_axis ||
         kind == CueKind::noise_axis || kind == CueKind::step_axis || kind == CueKind::finest_axis ||
         kind == CueKind::coarsest_axis || is_full_direction(kind);
}

/// Whether a cue only says how large something is whose course no cue tells. The threshold for a texture's amplitude says
/// when such sizes are surely told apart. It does not say that those which differ by less feel alike.
bool is_of_unread(CueKind kind) {
  return kind == CueKind::other_force || kind == CueKind::small_feature || kind == CueKind::uneven_drag ||
         kind == CueKind::changing_drag || kind == CueKind::drag_lost_by_use || kind == CueKind::uneven_vibration || kind == CueKind::uneven_mass ||
         kind == CueKind::changing_vibration || kind == CueKind::changing_sway || kind == CueKind::other_vibration ||
         kind == CueKind::other_sway;
}

/// Up to where two values that are read are the same, and nobody has measured what people notice: as well as the
/// direction of what travels, and by chance the rate of a noise, are read.
double same_of(CueKind kind) {
  switch (kind) {
    case CueKind::travel: return 0.015;
    case CueKind::noise_rate: return 0.35;
    case CueKind::coming: return 0.05;
    case CueKind::vibration_half:
    case CueKind::sway_half: return 0.05;
    default: return is_of_unread(kind) ? 0.02 : same;
  }
}

/// Whether an other force of the same size is surely the same: one that pushes much the same way everywhere, which its
/// rows x and y tell, and that of the same program.
bool is_same_other_force(const Cues& a, const Cues& b) {
  const auto pushes = [](const Cues& of) { return of[CueKind::other_push_x] || of[CueKind::other_push_y]; };
  return (a.executed != 0 && a.executed == b.executed) || (pushes(a) && pushes(b));
}

bool is_across(CueKind kind) {
  return kind == CueKind::stiffness_across || kind == CueKind::viscosity_across || kind == CueKind::friction_across ||
         kind == CueKind::mass_across || kind == CueKind::drag_across;
}

/// A cue's value in a material. Across its axis, what is alike in all directions has its one size.
std::optional<double> value_of(CueKind kind, const Cues& cues) {
  return is_across(kind) && !cues[kind] ? cues[*whole_of(kind)] : cues[kind];
}

Verdict verdict_of(const std::optional<double>& plainest, bool unknown) {
  if (plainest && *plainest >= 1) return Verdict::apart;
  return unknown ? Verdict::unknown : Verdict::alike;
}

}  // namespace

const CueDifference* Comparison::plainest() const {
  const CueDifference* found = nullptr;
  for (const CueDifference& cue : cues)
    if (cue.noticeable && (!found || *cue.noticeable > *found->noticeable)) found = &cue;
  return found;
}

Comparer::Comparer(const Declarations& declarations, const std::string& device) {
  for (const CueFacts& facts : cue_table()) {
    people_.emplace_back(declarations, facts.threshold, device, exerts(facts, declarations));
  }
  speed_ = speed_of_strokes(declarations);
}

/// The difference in just noticeable differences; empty if no publication gives a threshold.
std::optional<double> Comparer::noticeable(const CueFacts& facts, const Cues& of_a, const Cues& of_b) const {
  const std::optional<double> a = value_of(facts.kind, of_a), b = value_of(facts.kind, of_b);
  const auto whole = whole_of(facts.kind);
  if (!facts.exerts && (!a || !b)) {
    // If only one material has a texture, its other cues tell the two apart. If both have one, and only one of them has
    // a period or a direction, they differ, and nobody has measured how plainly. A cue of its own has no other to tell it.
    const bool told_by_whole = whole && !(of_a[*whole] && of_b[*whole]);
    return told_by_whole ? std::optional(0.0) : std::nullopt;
  }
  const double x = a.value_or(0), y = b.value_or(0);
  if (is_direction(facts.kind)) {
    const double turned = std::remainder(x - y, (is_full_direction(facts.kind) ? 2 : 1) * std::numbers::pi);
    return std::abs(turned) < same_of(facts.kind) * std::numbers::pi ? std::optional(0.0) : std::nullopt;
  }
  if (std::abs(x - y) <= same_of(facts.kind) * std::max(std::abs(x), std::abs(y)))
    return facts.kind == CueKind::other_force && !is_same_other_force(of_a, of_b) ? std::nullopt : std::optional(0.0);
  const std::optional<double> distance = people_[static_cast<std::size_t>(facts.kind)].distance(x, y);
  return is_of_unread(facts.kind) && distance && *distance < 1 ? std::nullopt : distance;
}

template <typename Visit>
void Comparer::each_cue(const Cues& a, const Cues& b, Visit visit) const {
  for (const CueFacts& facts : cue_table())
    if (a[facts.kind] || b[facts.kind]) visit(facts, noticeable(facts, a, b));
}

Comparison Comparer::compare(const Cues& a, const Cues& b) const {
  Comparison comparison;
  bool unknown = false;
  const Sizes of_a = sizes_of(a, speed_), of_b = sizes_of(b, speed_);
  each_cue(a, b, [&](const CueFacts& facts, std::optional<double> noticeable) {
    CueDifference found{
        facts.kind, value_of(facts.kind, a), value_of(facts.kind, b), noticeable, nullptr, Evidence::estimated, {}};
    const Discrimination& people = people_[static_cast<std::size_t>(facts.kind)];
    // Equal cues need no threshold, and a direction has none.
    const bool compared = facts.exerts || (found.a && found.b);
    if (noticeable != 0.0 && compared) found.threshold = people.threshold(found.a.value_or(0), found.b.value_or(0));
    if (found.threshold) {
      found.evidence = people.evidence(*found.threshold);
      found.outside = found.threshold->unmet(found.a.value_or(0), found.b.value_or(0), of_a, of_b);
      found.floor = people.floor_between(found.a.value_or(0), found.b.value_or(0));
      if (found.floor) found.least = people.floor(*found.threshold);
    }
    unknown |= !noticeable;
    comparison.cues.push_back(found);
  });
  const CueDifference* plainest = comparison.plainest();
  comparison.verdict = verdict_of(plainest ? plainest->noticeable : std::nullopt, unknown);
  return comparison;
}

Distance Comparer::distance(const Cues& a, const Cues& b) const {
  double plainest = 0;
  bool unknown = false;
  each_cue(a, b, [&](const CueFacts&, std::optional<double> noticeable) {
    unknown |= !noticeable;
    plainest = std::max(plainest, noticeable.value_or(0));
  });
  return {static_cast<float>(plainest), verdict_of(plainest, unknown)};
}

DistanceInterval Comparer::interval(const Cues& a, const Cues& b) const {
  DistanceInterval found;
  each_cue(a, b, [&](const CueFacts&, std::optional<double> noticeable) {
    if (!noticeable) ++found.unknown;
    found.low = std::max(found.low, noticeable.value_or(0));
  });
  return found;
}

SizeRange Comparer::within(CueKind kind, const Cues& a, double most) const {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const CueFacts& facts = cue_table()[static_cast<std::size_t>(kind)];
  // Across an axis, and for what has only a direction, other cues decide too.
  if (is_direction(kind) || is_across(kind) || (!facts.exerts && !a[kind])) return {-infinite, infinite};
  const double size = a[kind].value_or(0);
  // What is not read and differs by less than one is unknown, not near.
  SizeRange range = people_[static_cast<std::size_t>(kind)].within(size, is_of_unread(kind) ? std::max(most, 1.0) : most);
  const double same = std::abs(size) * same_of(kind) / (1 - same_of(kind));
  range.low = std::min(range.low, size - same), range.high = std::max(range.high, size + same);
  return range;
}

void Comparer::add_recalled(const Cues& a, const Cues& b, std::set<const Threshold*>& thresholds) const {
  for (const CueFacts& facts : cue_table()) {
    const Discrimination& people = people_[static_cast<std::size_t>(facts.kind)];
    if (!people.may_be_recalled() || (!a[facts.kind] && !b[facts.kind])) continue;
    const std::optional<double> apart = noticeable(facts, a, b);
    if (!apart || *apart == 0) continue;
    const Threshold* threshold =
        people.threshold(value_of(facts.kind, a).value_or(0), value_of(facts.kind, b).value_or(0));
    if (threshold->recalled()) thresholds.insert(threshold);
  }
}

ComparisonMatrix::ComparisonMatrix(std::vector<Cues> materials, const Declarations& declarations)
    : materials_(std::move(materials)), comparer_(declarations, materials_.empty() ? "" : materials_.front().device) {
  const std::size_t count = materials_.size();
  if (count > 1) distances_.reserve(count * (count - 1) / 2);
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b) distances_.push_back(comparer_.distance(materials_[a], materials_[b]));
}

std::set<const Threshold*> ComparisonMatrix::recalled() const {
  std::set<const Threshold*> thresholds;
  for (std::size_t a = 0; a < materials_.size(); ++a)
    for (std::size_t b = a + 1; b < materials_.size(); ++b)
      comparer_.add_recalled(materials_[a], materials_[b], thresholds);
  return thresholds;
}

std::size_t ComparisonMatrix::count(Verdict verdict) const {
  return static_cast<std::size_t>(std::ranges::count(distances_, verdict, &Distance::verdict));
}

Distance ComparisonMatrix::distance(std::size_t a, std::size_t b) const {
  return a == b ? Distance{} : distances_[index(std::min(a, b), std::max(a, b))];
}

std::vector<ComparedPair> ComparisonMatrix::nearest(std::size_t most) const {
  const auto nearer = [](const ComparedPair& a, const ComparedPair& b) {
    return std::tuple(a.distance.noticeable, a.a, a.b) < std::tuple(b.distance.noticeable, b.a, b.b);
  };
  std::vector<ComparedPair> found;  // a heap: the farthest of the pairs kept is on top
  for (std::size_t a = 0; a < materials_.size(); ++a)
    for (std::size_t b = a + 1; b < materials_.size(); ++b) {
      const ComparedPair pair{a, b, distances_[index(a, b)]};
      if (pair.distance.verdict == Verdict::unknown) continue;
      if (found.size() == most && (most == 0 || !nearer(pair, found.front()))) continue;
      if (found.size() == most) std::ranges::pop_heap(found, nearer), found.pop_back();
      found.push_back(pair);
      std::ranges::push_heap(found, nearer);
    }
  std::ranges::sort_heap(found, nearer);
  return found;
}

}  // namespace wale
