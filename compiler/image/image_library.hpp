#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compiler/image/drawing.hpp"
#include "wale/result.hpp"

namespace wale {

/// The functions that draw previews by OpenImageIO. It brings 250 shared libraries, and a program linked with it starts
/// a quarter of a second later. So these functions are in a library of their own, `wale_images`, which is opened when
/// the first picture is drawn: most runs of `wale` need none. They get no foreign bytes; those go to `decode_picture`.
struct ImageLibrary {
  /// As the function of that name in drawing.hpp.
  Result<std::vector<std::byte>> (*encode_drawing)(const Drawing& drawing, const std::string& name);
  /// Reduces a picture of `width` by `height` pixels to `columns` by `rows` by means over boxes. `rgb` is in 0 .. 1;
  /// the result has 8 bits for each colour.
  std::vector<std::uint8_t> (*shrunk)(std::span<const float> rgb, int width, int height, int columns, int rows);
  /// The weighted mean around each of `side` by `side` values; the weights are a Gaussian about `reach` pixels wide.
  std::vector<float> (*surroundings)(std::span<const float> values, int side, double reach);
};

/// Opens the library at its first use and keeps it; never null. Any thread may ask. Error: `Code::missing_library`.
Result<const ImageLibrary*> image_library();

}  // namespace wale
