#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "compiler/read/motion.hpp"
#include "compiler/read/strokes.hpp"

namespace wale {

/// A friction along one axis and a viscosity whose principal axes are others.
struct TwoAxes {
  Principal friction;  ///< N
  Principal damping;   ///< N s/m
};

/// Of strokes along x, then as many along y, and what opposed them (`opposed_on`). Nothing if they do not show such a
/// law at all speeds, or if the axes are the same or square to each other, where one axis tells both.
std::optional<TwoAxes> two_axes(const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed);

/// The same of strokes along x and y, if they may be those of a friction along an oblique axis and another one across
/// it, each whole on any stroke that has a part along its axis. `shows` says so surely.
std::optional<TwoAxes> two_frictions(const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed);

/// Whether strokes along and across the axis of the friction of `told` show it: each finds that along itself alone.
bool shows(const TwoAxes& told, const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed);

}  // namespace wale
