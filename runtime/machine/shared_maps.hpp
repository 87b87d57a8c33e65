#pragma once

#include <memory>

#include "runtime/machine/spline.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// A sampled map that programs share: its heights and their spline.
struct SharedMap {
  explicit SharedMap(const HeightTable& heights) : table(heights), spline(table) {}

  const HeightTable table;
  const Spline spline;
};

/// The map of these heights, of which a process has only one: an existing map with exactly these heights, or a new one.
/// From any thread but the real-time one: it allocates, and waits while another thread makes a map.
std::shared_ptr<const SharedMap> shared_map(const HeightTable& table);

}  // namespace wale
