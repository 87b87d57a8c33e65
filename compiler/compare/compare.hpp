#pragma once

#include <optional>
#include <string>
#include <vector>

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

/// Compares two materials cue by cue: ln(ratio) / ln(1 + w), w the Weber fraction at d' = 1, and no more than the
/// difference of their forces over the least force that is noticed, so that small forces are not told apart by their
/// ratio. A cue that one has and the other has not is compared by that force alone.
Comparison compare(const Cues& a, const Cues& b, const Declarations& declarations);

/// Two of many, and how they compare.
struct ComparedPair {
  std::size_t a = 0, b = 0;
  Comparison comparison;
};

/// Every pair of many materials, row by row: (0, 1), (0, 2), …, (1, 2), …
struct ComparisonMatrix {
  std::vector<Cues> materials;
  std::vector<ComparedPair> pairs;

  /// The two that are told apart the least, or null; of those that are alike the first.
  const ComparedPair* nearest() const;
};

ComparisonMatrix compare_all(std::vector<Cues> materials, const Declarations& declarations);

/// Two materials cue by cue; of more, a table of how far apart they are, and the nearest pair.
std::string comparison_text(const ComparisonMatrix& matrix);
/// An object with `materials`, each with its cues, and `pairs`.
std::string comparison_json(const ComparisonMatrix& matrix);

}  // namespace wale
