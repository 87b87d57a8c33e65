#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "library/index/probe.hpp"

namespace wale {

/// A row of the columns, and how far it is from what was sought.
struct NearRow {
  std::size_t row = 0;
  DistanceInterval distance;
};

/// The `most` rows with the least rank (`DistanceInterval::rank`), the nearest first; rows of equal rank are in the order
/// of names and modules, byte by byte. Exact: each row that could be among them is compared, and the others are left out
/// by limits that every nearer one keeps. A metric tree would be wrong, since distances over the cues that both have do not
/// keep to the triangle inequality. Only rows for which `may` holds are found; an empty `may` holds for all, and is
/// called from several threads. Uses all cores; the result does not depend on how many there are.
std::vector<NearRow> nearest(const FeltColumns& columns, const Probe& probe, std::size_t most,
                             const std::function<bool(std::size_t row)>& may = {});

}  // namespace wale
