#pragma once

#include "compiler/image/image_library.hpp"

/// The functions of `ImageLibrary`, written with OpenImageIO.
namespace wale::openimageio {

Result<std::vector<std::byte>> encode_drawing(const Drawing& drawing, const std::string& name);
std::vector<std::uint8_t> shrunk(std::span<const float> rgb, int width, int height, int columns, int rows);
std::vector<float> surroundings(std::span<const float> values, int side, double reach);

}  // namespace wale::openimageio
