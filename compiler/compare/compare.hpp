#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/declarations/discrimination.hpp"
#include "compiler/extract/cues.hpp"

namespace wale {

/// One cue of two materials.
struct CueDifference {
  CueKind kind = CueKind::amplitude;
  std::optional<double> a, b;               ///< SI; nothing where the material has none of it
  std::optional<double> noticeable;         ///< in just noticeable differences at d' = 1; nothing: unknown
  const Threshold* threshold = nullptr;     ///< by which; null where no publication tells, or nothing differs
  Evidence evidence = Evidence::estimated;  ///< of the threshold on this device
};

enum class Verdict {
  apart,    ///< a cue differs by one just noticeable difference or more
  alike,    ///< every cue differs by less
  unknown,  ///< no known cue tells them apart, but one differs for which no threshold is known
};

struct Comparison {
  std::vector<CueDifference> cues;  ///< those that either material has, in the order of `CueKind`
  Verdict verdict = Verdict::alike;

  /// The cue with the largest known difference, or null.
  const CueDifference* plainest() const;
};

/// How far apart two are, in short.
struct Distance {
  /// Of the cue that differs most plainly, in just noticeable differences at d' = 1; 0 where nothing is known to
  /// differ.
  float noticeable = 0;
  Verdict verdict = Verdict::alike;
};

/// Compares materials on one device cue by cue: ln(ratio) / ln(1 + w), w the Weber fraction at d' = 1, and no more than
/// the difference of their forces over the least force that is noticed, so that small forces are not told apart by
/// their ratio. A cue that one has and the other has not is compared by that force alone. The declarations outlive it.
class Comparer {
 public:
  Comparer(const Declarations& declarations, const std::string& device);

  Comparison compare(const Cues& a, const Cues& b) const;
  /// The same in short, without the threshold of each cue: allocates nothing.
  Distance distance(const Cues& a, const Cues& b) const;
  /// Adds those that this pair is compared by and that nobody has looked up.
  void add_recalled(const Cues& a, const Cues& b, std::set<const Threshold*>& thresholds) const;

 private:
  template <typename Visit>
  void each_cue(const Cues& a, const Cues& b, Visit visit) const;
  std::optional<double> noticeable(const CueFacts& facts, std::optional<double> a, std::optional<double> b) const;

  std::vector<Discrimination> people_;  ///< by `CueKind`
};

/// Two of many, a < b.
struct ComparedPair {
  std::size_t a = 0, b = 0;
  Distance distance;
};

/// Every pair of many materials on one device. Of each pair only how far apart the two are is kept: a thousand
/// materials make half a million pairs.
class ComparisonMatrix {
 public:
  ComparisonMatrix(std::vector<Cues> materials, const Declarations& declarations);

  const std::vector<Cues>& materials() const { return materials_; }
  std::size_t pair_count() const { return distances_.size(); }
  /// How many pairs have this verdict.
  std::size_t count(Verdict verdict) const;
  Distance distance(std::size_t a, std::size_t b) const;
  /// The publications that pairs were compared by, although nobody has looked them up.
  std::set<const Threshold*> recalled() const;
  Comparison compare(std::size_t a, std::size_t b) const { return comparer_.compare(materials_[a], materials_[b]); }

  /// The pairs that are told apart the least, nearest first, among equals in the order of the materials. Two of which
  /// too little is known are near to nobody.
  std::vector<ComparedPair> nearest(std::size_t most) const;

 private:
  /// Row by row: (0, 1), (0, 2), …, (1, 2), …
  std::size_t index(std::size_t a, std::size_t b) const { return a * (2 * materials_.size() - a - 1) / 2 + b - a - 1; }

  std::vector<Cues> materials_;
  Comparer comparer_;
  std::vector<Distance> distances_;
};

/// Two materials cue by cue. Of more how far apart they are: a table where it fits a screen or is asked for, else those
/// pairs that are hardly told apart; and the nearest pair cue by cue.
std::string comparison_text(const ComparisonMatrix& matrix, bool with_table = false);
/// An object with `materials`, each with its cues; `matrix`, how far apart each is from those behind it; and `pairs`
/// cue by cue: of many materials the nearest ones only.
std::string comparison_json(const ComparisonMatrix& matrix);

}  // namespace wale
