#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "compiler/image/image.hpp"
#include "wale/result.hpp"

namespace wale::decoder {

/// The colours of a picture, as `read_colour_image` describes them. `extension` is in lower case and without its dot.
/// Errors: `Code::unreadable_image` and `image_size`, without a place.
Result<ColourImage> colour_image(std::span<const std::byte> bytes, const std::string& extension);

}  // namespace wale::decoder
