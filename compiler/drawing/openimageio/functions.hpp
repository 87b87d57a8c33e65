#pragma once

#include "compiler/drawing/image_library.hpp"

/// The functions of `ImageLibrary` that are written with OpenImageIO.
namespace wale::openimageio {

Result<std::vector<std::byte>> encode_drawing(const Drawing& drawing, const std::string& name);
std::vector<float> surroundings(std::span<const float> values, int side, double reach);

}  // namespace wale::openimageio
