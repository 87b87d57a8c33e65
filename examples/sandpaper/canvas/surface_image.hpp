#pragma once

#include <QColor>
#include <QImage>
#include <glm/vec2.hpp>
#include <string>
#include <wale/shape.hpp>
#include <wale/stage.hpp>

namespace sandpaper {

/// How surfaces are shown.
enum class Look {
  relief,       ///< its colour, lit from the upper left
  blind,        ///< alike for all: only where it lies
  depth,        ///< the higher, the lighter
  force_field,  ///< where it pushes (hue) and how hard (the more, the lighter), on a hand at rest
};

/// The surface of a program with a size in m, in so many pixels. From any thread; takes some milliseconds for an image
/// of 200 by 200. `shape` is that of the patch, in its size: where the surface fades
/// out, it does so at the shape's edge. `memory` shows states and grids, and may be null. `plain` is the colour of a
/// surface that has none.
QImage surface_image(const wale::Bank& bank, const wale::Memory* memory, glm::vec2 size, const wale::Shape& shape,
                     QSize pixels, Look look, QColor plain);

/// Whether what a program remembers can change its surface.
bool surface_remembers(const wale::PatchProgram& program);

/// A colour for a material that has none, always the same for the same name: `denim(roughness: 0.3)` has that of
/// `denim`.
QColor colour_of(const std::string& made_of);

/// The place inside a shape of that size (m) that is farthest from its edge, roughly, where a name is written; m from
/// its centre.
glm::dvec2 inner_place(const wale::Shape& outline, glm::dvec2 size);

}  // namespace sandpaper
