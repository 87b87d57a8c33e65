#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "wale/memory.hpp"
#include "wale/program.hpp"

namespace wale {

/// What there is to show of a program: where, along which line, at what speed.
struct Exhibit {
  bool has_relief = false;       ///< the surface's height varies
  bool pushes_at_rest = false;   ///< a hand at rest somewhere on the patch feels a force
  bool resists_motion = false;   ///< the force depends on velocity
  double side = 0;               ///< m; of the square around the patch's centre that is shown
  int axis = 0;                  ///< along which the section through the centre runs: 0 x, 1 y
  double aside = 0;              ///< m; how far the section runs from the centre, across its axis
  std::optional<double> period;  ///< m; the longer of the texture's periods along x and y, if it has one
  double speed = 0;              ///< m/s; up to which forces against velocity are shown
};

/// Looks at a program: eight periods of its texture or, where it has none or shows marks, the whole patch. Heights here
/// and below are as the memory has them; without one, as a hand finds them that enters at the centre.
Exhibit exhibit_of(const Bank& bank, const Memory* memory = nullptr);

/// A quantity along a line: `at` in m or m/s, ascending.
struct Profile {
  std::vector<double> at, values;
};

/// The surface's height along the section, at `count` positions.
Profile height_along(const Bank& bank, const Memory* memory, const Exhibit& exhibit, int count);
/// The force along the section's own axis on a hand that moves along it at `speed` (m/s).
Profile force_along(const Bank& bank, const Exhibit& exhibit, double speed, int count);
/// The same force on a hand at the patch's centre, against its velocity.
Profile force_against_speed(const Bank& bank, const Exhibit& exhibit, int count);

/// The position of the middle of pixel (column, row) of `count` by `count` over the exhibit; row 0 is the top, where y
/// is largest.
glm::vec2 pixel_position(const Exhibit& exhibit, int column, int row, int count);

}  // namespace wale
