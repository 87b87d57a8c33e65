#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/declarations/discrimination.hpp"
#include "compiler/read/cues.hpp"

namespace wale {

/// One cue of two materials.
struct CueDifference {
  CueKind kind = CueKind::amplitude;
  std::optional<double> a, b;               ///< SI; empty if the material does not have this cue
  std::optional<double> noticeable;         ///< in just noticeable differences at d' = 1; empty if unknown
  std::string why_unknown;                  ///< in words, if `noticeable` is empty: "no published threshold"
  const Threshold* threshold = nullptr;     ///< that gives `noticeable`; null if none is published or nothing differs
  Evidence evidence = Evidence::estimated;  ///< of the threshold on this device
  /// The conditions of the threshold's measurement that the materials do not meet, as written; beyond them it is
  /// extrapolated.
  std::vector<std::string> outside;
  /// The publication whose smallest difference gives `noticeable`, and not the fraction of `threshold`; null if the
  /// fraction does.
  const Threshold* floor = nullptr;
  double least = 0;  ///< SI: that difference, at d' = 1
};

enum class Verdict {
  apart,    ///< a cue differs by one just noticeable difference or more
  alike,    ///< every cue differs by less
  unknown,  ///< no cue with a known threshold tells them apart, but a cue without one differs
};

struct Comparison {
  std::vector<CueDifference> cues;  ///< those that either material has, in the order of `CueKind`
  Verdict verdict = Verdict::alike;

  /// The cue with the largest known difference, or null.
  const CueDifference* plainest() const;
};

/// How far apart two materials are, in short.
struct Distance {
  /// The largest known difference of a cue, in just noticeable differences at d' = 1; 0 if no known difference exists.
  float noticeable = 0;
  Verdict verdict = Verdict::alike;
};

/// A distance of which parts may be unknown.
struct DistanceInterval {
  /// The largest known difference of a cue, in just noticeable differences at d' = 1: the distance is not less.
  double low = 0;
  /// How many cues differ, or may differ, by an amount that is not known. If there is none, the distance is `low`;
  /// otherwise nothing bounds it from above.
  std::size_t unknown = 0;

  /// What orders distances: a cue that is unknown counts as one just noticeable difference.
  double rank() const { return low + static_cast<double>(unknown); }
};

/// Compares materials on one device cue by cue. The distance of a cue is ln(ratio) / ln(1 + w) with w the Weber
/// fraction at d' = 1. It is at most the difference of the two forces over the smallest force that people notice, so
/// that small forces are not told apart by their ratio alone. If only one material has a cue, only that difference of
/// force counts. The declarations must outlive the comparer.
class Comparer {
 public:
  Comparer(const Declarations& declarations, const std::string& device);

  Comparison compare(const Cues& a, const Cues& b) const;
  /// The same in short, without the threshold of each cue. Allocates nothing.
  Distance distance(const Cues& a, const Cues& b) const;
  /// The same as an interval. Allocates nothing.
  DistanceInterval interval(const Cues& a, const Cues& b) const;
  /// For a search among many: the values of a cue outside of which a material is more than `most` from `a` by this cue
  /// alone. A material without the cue counts as one with the value 0 if a difference of the cue is one of force;
  /// otherwise it is never too far. The range may be wider than it need be.
  SizeRange within(CueKind kind, const Cues& a, double most) const;
  /// Adds the thresholds that this pair is compared by and that nobody has looked up in the publication.
  void add_recalled(const Cues& a, const Cues& b, std::set<const Threshold*>& thresholds) const;

 private:
  template <typename Visit>
  void each_cue(const Cues& a, const Cues& b, Visit visit) const;
  std::optional<double> noticeable(const CueFacts& facts, const Cues& of_a, const Cues& of_b) const;
  std::string why_unknown(const CueFacts& facts, const Cues& of_a, const Cues& of_b) const;

  std::vector<Discrimination> people_;  ///< by `CueKind`
  std::optional<double> speed_;         ///< mean speed of the hand `normal` as it strokes, m/s
};

/// Two of many materials, a < b.
struct ComparedPair {
  std::size_t a = 0, b = 0;
  Distance distance;
};

/// All pairs of many materials on one device. Only the distance of each pair is stored: a thousand materials have half
/// a million pairs.
class ComparisonMatrix {
 public:
  ComparisonMatrix(std::vector<Cues> materials, const Declarations& declarations);

  const std::vector<Cues>& materials() const { return materials_; }
  std::size_t pair_count() const { return distances_.size(); }
  /// How many pairs have this verdict.
  std::size_t count(Verdict verdict) const;
  Distance distance(std::size_t a, std::size_t b) const;
  /// The thresholds that pairs are compared by and that nobody has looked up in the publication.
  std::set<const Threshold*> recalled() const;
  Comparison compare(std::size_t a, std::size_t b) const { return comparer_.compare(materials_[a], materials_[b]); }

  /// The pairs with the smallest distance, nearest first; equal pairs are in the order of the materials. Pairs whose
  /// distance is unknown are left out.
  std::vector<ComparedPair> nearest(std::size_t most) const;

 private:
  /// Row by row: (0, 1), (0, 2), …, (1, 2), …
  std::size_t index(std::size_t a, std::size_t b) const { return a * (2 * materials_.size() - a - 1) / 2 + b - a - 1; }

  std::vector<Cues> materials_;
  Comparer comparer_;
  std::vector<Distance> distances_;
};

/// How well a threshold is known here, in words: "transferred", "extrapolated from amplitude 2.5 N .. 10 N", and what
/// of it is not stated in the publication.
std::string threshold_words(const Threshold& threshold, Evidence evidence, const std::vector<std::string>& outside);
/// "0.1 N at least, assumed: Tan 1992": the smallest difference that is noticed, in a unit, and who says so.
std::string floor_words(const Threshold& floor, double least, const std::string& unit);
/// The same as a member `floor` of a JSON object.
void write_floor(nlohmann::ordered_json& json, const Threshold& floor, double least);
/// The conditions under which a threshold was measured, in words: "amplitude 2.5 N .. 10 N, criterion assumed".
std::string threshold_conditions(const Threshold& threshold);
/// How well a threshold is known here, as members of a JSON object: the fraction at d' = 1, the grade, what was
/// assumed, the conditions of the measurement and those that are not met.
void write_threshold(nlohmann::ordered_json& json, const Threshold& threshold, Evidence evidence,
                     const std::vector<std::string>& outside);

/// For two materials: cue by cue. For more: a table of distances if it fits a screen or if `with_table` asks for it,
/// otherwise the pairs that are hard to tell apart; then the nearest pair cue by cue.
std::string comparison_text(const ComparisonMatrix& matrix, bool with_table = false);
/// An object with `materials`, each with its cues; `matrix`, the distances of each material from those after it; and
/// `pairs`, cue by cue. With many materials, `pairs` has only the nearest ones.
std::string comparison_json(const ComparisonMatrix& matrix);

}  // namespace wale
