#pragma once

#include "compiler/drawing/image_library.hpp"

/// The functions of `ImageLibrary` that are written with cairo and Pango.
namespace wale::cairo {

std::unique_ptr<Canvas> new_canvas(int width, int height, Colour paper);

}  // namespace wale::cairo
