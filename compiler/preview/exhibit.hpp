#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compiler/drawing/plot.hpp"
#include "wale/memory.hpp"
#include "wale/program.hpp"
#include "wale/shape.hpp"

namespace wale {

/// What a preview shows of a program: the area, the line of the section, and the speed.
struct Exhibit {
  bool has_relief = false;       ///< the surface's height varies
  bool pushes_at_rest = false;   ///< a hand at rest somewhere on the patch feels a force
  bool resists_motion = false;   ///< the force depends on velocity
  double side = 0;               ///< m; side of the square that is shown
  double patch_side = 0;         ///< m; the shorter side of the patch: more than `side` if only the middle is shown
  glm::dvec2 centre{0};          ///< m; of the square that is shown, from the patch's centre
  glm::dvec2 patch_half{0};      ///< m; half of the patch's width and height
  glm::dvec2 through{0};         ///< m; a place on the section
  glm::dvec2 way{1, 0};          ///< direction of the section, of length 1
  std::string way_name = "x";    ///< "x", "y", "30°"
  std::optional<double> period;  ///< m; of the force's relief as it is read, or else of the picture's
  /// The level of the texture, by the strongest percept that a force down the slopes carries; empty if there is none.
  std::optional<double> felt;
  Shape shape;       ///< of the patch, in its size
  double speed = 0;  ///< m/s; forces against velocity are shown up to this speed
  /// m; of the hand whose force is shown against velocity: where it resists motion, on the section if it does so there.
  glm::dvec2 moving_at{0};
};

/// What a person chooses of a preview.
struct SectionChoice {
  std::optional<double> along;   ///< rad to the left of x: the direction of the section
  std::optional<glm::dvec2> at;  ///< m from the patch's centre: a place on it
  std::string name;              ///< of the direction, for titles
};

/// Chooses what to show of a program: eight periods of its texture, or the whole patch if it has none, if it shows
/// marks, or if there is more to feel or to see outside. Heights here and below are those of the given memory; without
/// one, those for a hand that enters at the centre.
Exhibit exhibit_of(const Bank& bank, const Memory* memory = nullptr, const SectionChoice& section = {});

/// The part of the section that is shown, by the distance along it from the foot of the patch's centre, m: the place on
/// an axis is the place on the patch. No part of it is outside the patch.
struct SectionRange {
  double from = 0, to = 0;
};
SectionRange section_range(const Exhibit& exhibit);
/// The place at such a distance, m.
glm::dvec2 on_section(const Exhibit& exhibit, double distance);

/// The height of the surface along the section, at `count` positions.
Profile height_along(const Bank& bank, const Memory* memory, const Exhibit& exhibit, int count);
/// The force along the section on a hand that moves along it at `speed` (m/s); with `across`, that to its left.
Profile force_along(const Bank& bank, const Exhibit& exhibit, double speed, int count, bool across = false);
/// The same force on a hand at the exhibit's place for moving hands, against its velocity.
Profile force_against_speed(const Bank& bank, const Exhibit& exhibit, int count, bool across = false);

/// The position of the middle of pixel (column, row) of `count` by `count` pixels over the exhibit; row 0 is at the
/// top, where y is largest.
glm::vec2 pixel_position(const Exhibit& exhibit, int column, int row, int count);

}  // namespace wale
