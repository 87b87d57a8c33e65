#pragma once

#include <functional>
#include <glm/vec2.hpp>

#include "document/document.hpp"

namespace sandpaper {

/// The full size of a patch, m.
using SizeOf = std::function<glm::dvec2(const Placed&)>;

enum class Alignment { left, right, top, bottom, centre_x, centre_y };

/// Moves the chosen patches so that their edges or centres lie on one line, that of the outermost, or of the middle.
void align(Document& document, Alignment alignment, const SizeOf& size_of);

/// Moves the chosen patches, or all if none is chosen, to where a device with that workspace (diameter, m) reaches
/// them, as little as possible. A texture is never scaled, so a patch that is too large stays too large. Returns how
/// many were moved.
int fit(Document& document, double diameter, const SizeOf& size_of);

/// Copies of the chosen patches, a little to the lower right, which are then chosen.
void duplicate(Document& document);

}  // namespace sandpaper
