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

/// The force that a unit of this cue exerts, N per unit; 1 for a force, 0 for what is none. Other units have that of the
/// percept whose carrier the cue is; a cue that carries none, such as the stiffness of a second wall, that of one which
/// is told by the same threshold in the same unit. Without such a percept the force is not known: 0.
double exerts(const CueFacts& facts, const Declarations& declarations) {
  const std::string_view unit = facts.unit;
  if (!facts.exerts) return 0;
  if (unit == "N") return 1;
  double own = 0, alike = 0;
  declarations.percepts.each([&](const std::string&, const Percept& percept) {
    if (percept.extractor == Extractor::none || !(percept.exerts > 0)) return;
    if (percept.extractor == facts.extractor) own = percept.exerts;
    for (const CueFacts& each : cue_table()) {
      const bool same_threshold = each.threshold == std::string_view(facts.threshold) && each.unit == unit;
      if (each.extractor == percept.extractor && same_threshold) alike = percept.exerts;
    }
  });
  return own > 0 ? own : alike;
}

bool is_direction(CueKind kind) {
  return kind == CueKind::orientation || kind == CueKind::push_axis || kind == CueKind::stiffness_axis ||
         kind == CueKind::vibration_axis || kind == CueKind::sway_axis || kind == CueKind::viscosity_axis ||
         kind == CueKind::friction_axis || kind == CueKind::mass_axis || kind == CueKind::drag_axis ||
         kind == CueKind::noise_axis || kind == CueKind::step_axis || kind == CueKind::finest_axis ||
         kind == CueKind::coarsest_axis || is_full_direction(kind);
}

/// Whether a cue only says how large something is whose course no cue tells, or that swings: nobody has published how
/// well people tell forces that swing apart. The threshold for a texture's amplitude says when such sizes are surely
/// told apart. It does not say that those which differ by less feel alike.
bool is_of_unread(CueKind kind) {
  return kind == CueKind::other_force || kind == CueKind::small_feature || kind == CueKind::uneven_drag ||
         kind == CueKind::changing_drag || kind == CueKind::drag_lost_by_use ||
         kind == CueKind::uneven_vibration || kind == CueKind::uneven_mass ||
         kind == CueKind::changing_vibration || kind == CueKind::changing_sway || kind == CueKind::other_vibration ||
         kind == CueKind::other_sway || kind == CueKind::vibration;
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

/// Whether a relief is a sum of waves along one direction that is felt by its waves, and not by the period after which
/// they all repeat.
bool is_sum(const Cues& cues) { return cues[CueKind::orientation] && cues[CueKind::finest_wave]; }

/// The figures by which a material is compared, that depend on nothing but it. Across its axis, what is alike in all
/// directions has its one size. The period after which a sum of waves repeats jumps with the least change of one of
/// them, and so do its regularity and how abrupt it is within a 16th of that period: of a sum, regularity is the share
/// in waves, and abruptness is told within a 16th of its finest wave, since the change in a short way grows with the way.
std::optional<double> own_value(CueKind kind, const Cues& cues) {
  if (is_across(kind) && !cues[kind]) return cues[*whole_of(kind)];
  if (!is_sum(cues)) return cues[kind];
  const std::optional<double>&period = cues[CueKind::period], &abruptness = cues[CueKind::abruptness];
  if (kind == CueKind::regularity && cues[CueKind::in_waves]) return cues[CueKind::in_waves];
  if (kind == CueKind::abruptness && period && abruptness) return *abruptness * *cues[CueKind::finest_wave] / *period;
  return cues[kind];
}

struct ComparedValues {
  std::optional<double> a, b;
};

/// The periods by which two reliefs are compared. Waves of a sum correspond to those of the other that are nearest in
/// period, each to one, and the two that are farthest apart are told.
ComparedValues compared_periods(const Cues& a, const Cues& b) {
  const std::optional<double>&of_a = a[CueKind::period], &of_b = b[CueKind::period];
  if (!of_a || !of_b || !(is_sum(a) || is_sum(b))) return {of_a, of_b};
  const auto waves = [](const Cues& of) {
    return is_sum(of) ? std::pair(*of[CueKind::finest_wave], *of[CueKind::coarsest_wave])
                      : std::pair(*of[CueKind::period], *of[CueKind::period]);
  };
  const auto [fine_a, coarse_a] = waves(a);
  const auto [fine_b, coarse_b] = waves(b);
  const bool several = fine_a != coarse_a && fine_b != coarse_b;
  ComparedValues found{fine_a, fine_b};
  const auto apart = [](double one, double other) { return std::abs(std::log(one / other)); };
  const auto look_at = [&](double one, double other) {
    const double now = apart(*found.a, *found.b), then = apart(one, other);
    if (several ? then > now : then < now) found = {one, other};
  };
  look_at(coarse_a, coarse_b);
  if (!several) look_at(fine_a, coarse_b), look_at(coarse_a, fine_b);
  return found;
}

ComparedValues compared(CueKind kind, const Cues& a, const Cues& b) {
  return kind == CueKind::period ? compared_periods(a, b) : ComparedValues{own_value(kind, a), own_value(kind, b)};
}

/// Whether waves beside the strongest are the same part of both reliefs, so that the amplitude tells how they differ.
bool is_same_part(const Cues& a, const Cues& b) {
  const auto part = [](const Cues& of) {
    return of[CueKind::other_waves] && of[CueKind::amplitude]
               ? *of[CueKind::other_waves] / *of[CueKind::amplitude] : 0;
  };
  constexpr double alike = 0.02;
  return part(a) > 0 && std::abs(part(a) - part(b)) <= alike * part(a);
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
  const auto [a, b] = compared(facts.kind, of_a, of_b);
  const auto whole = whole_of(facts.kind);
  if (facts.kind == CueKind::other_waves && is_same_part(of_a, of_b)) return 0.0;
  if (!facts.exerts && (!a || !b)) {
    // The period of the one and the other waves of the sum tell it.
    const bool of_sum = facts.kind == CueKind::finest_wave || facts.kind == CueKind::coarsest_wave;
    if (of_sum && of_a[CueKind::orientation] && of_b[CueKind::orientation]) return 0.0;
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
    // The regularity has what is in waves.
    if (facts.kind != CueKind::in_waves && (a[facts.kind] || b[facts.kind])) visit(facts, noticeable(facts, a, b));
}

/// Why a difference is not known.
std::string Comparer::why_unknown(const CueFacts& facts, const Cues& of_a, const Cues& of_b) const {
  const auto [a, b] = compared(facts.kind, of_a, of_b);
  const Discrimination& people = people_[static_cast<std::size_t>(facts.kind)];
  if (is_direction(facts.kind) || !people.known()) return "no published threshold";
  if (!facts.exerts && (!a || !b)) return "no published threshold between some and none";
  if (facts.kind == CueKind::other_force && a && b && !(std::abs(*a - *b) > same_of(facts.kind) * std::abs(*a)))
    return "of one size, and its course is not read";
  if (is_of_unread(facts.kind)) return "no threshold of its own, and less apart than those of other forces tell surely";
  return "no smallest difference is published";
}

Comparison Comparer::compare(const Cues& a, const Cues& b) const {
  Comparison comparison;
  bool unknown = false;
  const Sizes of_a = sizes_of(a, speed_), of_b = sizes_of(b, speed_);
  each_cue(a, b, [&](const CueFacts& facts, std::optional<double> noticeable) {
    const auto [value_a, value_b] = compared(facts.kind, a, b);
    CueDifference found;
    found.kind = facts.kind, found.a = value_a, found.b = value_b, found.noticeable = noticeable;
    if (!noticeable) found.why_unknown = why_unknown(facts, a, b);
    const Discrimination& people = people_[static_cast<std::size_t>(facts.kind)];
    // Equal cues need no threshold, and a direction has none.
    const bool has_sizes = facts.exerts || (found.a && found.b);
    if (noticeable != 0.0 && has_sizes) found.threshold = people.threshold(found.a.value_or(0), found.b.value_or(0));
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
  if (is_direction(kind) || is_across(kind) || kind == CueKind::in_waves || (!facts.exerts && !a[kind]))
    return {-infinite, infinite};
  const std::optional<double> own = kind == CueKind::period && is_sum(a) ? a[CueKind::finest_wave] : own_value(kind, a);
  const double size = own.value_or(0);
  // What is not read and differs by less than one is unknown, not near.
  SizeRange range = people_[static_cast<std::size_t>(kind)].within(size, is_of_unread(kind) ? std::max(most, 1.0) : most);
  const double same = std::abs(size) * same_of(kind) / (1 - same_of(kind));
  range.low = std::min(range.low, size - same), range.high = std::max(range.high, size + same);
  // A sum of waves has a longer period than its waves, and is as much more abrupt within it.
  if (kind == CueKind::period || kind == CueKind::abruptness) range.high = infinite;
  return range;
}

void Comparer::add_recalled(const Cues& a, const Cues& b, std::set<const Threshold*>& thresholds) const {
  for (const CueFacts& facts : cue_table()) {
    const Discrimination& people = people_[static_cast<std::size_t>(facts.kind)];
    if (!people.may_be_recalled() || (!a[facts.kind] && !b[facts.kind])) continue;
    const std::optional<double> apart = noticeable(facts, a, b);
    if (!apart || *apart == 0) continue;
    const auto [value_a, value_b] = compared(facts.kind, a, b);
    const double of_a = value_a.value_or(0), of_b = value_b.value_or(0);
    const Threshold* const floor = people.floor_between(of_a, of_b);
    const Threshold* const threshold = floor ? floor : people.threshold(of_a, of_b);
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
