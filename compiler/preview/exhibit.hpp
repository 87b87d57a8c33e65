#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "wale/memory.hpp"
#include "wale/program.hpp"

namespace wale {

/// What a preview shows of a program: the area, the line of the section, and the speed.
struct Exhibit {
  bool has_relief = false;       ///< the surface's height varies
  bool pushes_at_rest = false;   ///< a hand at rest somewhere on the patch feels a force
  bool resists_motion = false;   ///< the force depends on velocity
  double side = 0;               ///< m; side of the square that is shown, around the patch's centre
  int axis = 0;                  ///< of the section: 0 is x, 1 is y
  double aside = 0;              ///< m; distance of the section from the centre
  std::optional<double> period;  ///< m; of the force's relief as it is read, or else of the picture's
  double speed = 0;              ///< m/s; forces against velocity are shown up to this speed
};

/// Chooses what to show of a program: eight periods of its texture, or the whole patch if it has none or shows marks.
/// Heights here and below are those of the given memory; without one, those for a hand that enters at the centre.
Exhibit exhibit_of(const Bank& bank, const Memory* memory = nullptr);

/// A quantity along a line: `at` in m or m/s, ascending.
struct Profile {
  std::vector<double> at, values;
};

/// The height of the surface along the section, at `count` positions.
Profile height_along(const Bank& bank, const Memory* memory, const Exhibit& exhibit, int count);
/// The force along the section's axis on a hand that moves along it at `speed` (m/s).
Profile force_along(const Bank& bank, const Exhibit& exhibit, double speed, int count);
/// The same force on a hand at the patch's centre, against its velocity.
Profile force_against_speed(const Bank& bank, const Exhibit& exhibit, int count);

/// The position of the middle of pixel (column, row) of `count` by `count` pixels over the exhibit; row 0 is at the
/// top, where y is largest.
glm::vec2 pixel_position(const Exhibit& exhibit, int column, int row, int count);

}  // namespace wale
