#pragma once

#include <memory>
#include <string>
#include <vector>

#include "compiler/drawing/canvas.hpp"
#include "library/index/entry.hpp"
#include "wale/result.hpp"

namespace wale {

/// What one material reads of one percept.
struct CoveredLevel {
  std::string material;
  double reads = 0;   ///< 0 .. 1; a greater level counts as 1
  LevelBounds means;  ///< where 95 % of the means of other groups lie, within 0 .. 1
};

/// A range of levels, or two, that no material reads.
struct EmptyRange {
  double low = 0, high = 0;
};

/// One percept of a library.
struct CoveredPercept {
  std::string percept;
  std::vector<CoveredLevel> levels;  ///< rising
  std::vector<EmptyRange> empty;     ///< of a tenth at least that no interval reaches, the widest first
};

/// Two percepts that materials have at once.
struct CoveredPair {
  std::size_t a = 0, b = 0;    ///< in `Coverage::percepts`
  std::size_t materials = 0;   ///< that read both
  EmptyRange empty_a, empty_b; ///< sides of the largest rectangle, in twentieths, that no material's intervals reach
};

/// Where a library has materials in percept space, and where it has none.
struct Coverage {
  std::size_t materials = 0;             ///< that were read
  std::size_t without = 0;               ///< that read no percept
  std::vector<CoveredPercept> percepts;  ///< those that most materials read first
  std::vector<CoveredPair> pairs;        ///< all pairs of the first six percepts
  std::vector<std::string> unfelt;       ///< percepts that no material reads, of `known`
};

/// What the programs of the materials read. `known` are all percepts that there are.
Coverage coverage_of(const std::vector<Entry>& entries, const std::vector<std::string>& known);

/// For people: what is covered, and the empty regions by name.
std::string coverage_text(const Coverage& coverage);
std::string coverage_json(const Coverage& coverage);

/// A picture: a strip for each percept with the level of each material, its interval, and the empty ranges; and a square
/// for each pair that some materials have at once, with a point for each material and the largest empty rectangle. Error: `missing_library`.
Result<std::unique_ptr<Canvas>> draw_coverage(const Coverage& coverage);

}  // namespace wale
