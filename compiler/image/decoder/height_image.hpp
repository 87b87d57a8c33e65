#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "compiler/image/image.hpp"
#include "wale/result.hpp"

namespace wale::decoder {

/// The heights of a picture, as `read_height_image` describes them. `extension` is in lower case and without its dot.
/// Errors: `Code::unreadable_image` and `image_size`, without a place.
Result<HeightImage> height_image(std::span<const std::byte> bytes, const std::string& extension, double smooth_pixels);

}  // namespace wale::decoder
