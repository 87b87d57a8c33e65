#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "compiler/read/strokes.hpp"

namespace wale {

/// How the resistance to a hand at 0.2 m/s differs; all N, 0 where it does not.
struct DragByPlace {
  glm::dvec2 forward{0}, backward{0};  ///< of hands towards +x and +y, and towards -x and -y; means over places
  double least = 0, most = 0;          ///< over places, without the rarest: on the way that is resisted most
};

/// Of hands all over the patch outside of a wall; of a program that remembers, by strokes along x and then as many
/// along y (`opposed`: `opposed_on` them), and, if what drags has turned about within some millimetres (`turns_soon`),
/// where hands that go through the whole patch feel least and most. Nothing of a program with memories over the patch.
DragByPlace drag_by_place(const Bank& bank, const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed,
                          const Outside& outside, bool turns_soon);

}  // namespace wale
