#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "compiler/image/drawing.hpp"
#include "compiler/image/image.hpp"

namespace wale {

/// What needs OpenImageIO, which brings 250 shared libraries and a quarter of a second to the start of every program
/// that is linked with it. So it is a library of its own, `wale_images`, which is opened when the first picture is read
/// or drawn: most runs of `wale` need none.
struct ImageLibrary {
  /// As the function of that name in image.hpp.
  std::variant<HeightImage, ImageProblem> (*read_height_image)(std::span<const std::byte> bytes,
                                                               const std::string& name, double smooth_pixels);
  /// As the function of that name in drawing.hpp.
  std::variant<std::vector<std::byte>, DrawingProblem> (*encode_drawing)(const Drawing& drawing,
                                                                         const std::string& name);
  /// A picture of red, green and blue in 0 .. 1, `width` by `height`, made smaller by means over boxes, to 8 bits each.
  std::vector<std::uint8_t> (*shrunk)(std::span<const float> rgb, int width, int height, int columns, int rows);
  /// The mean about each of `side` by `side` values, a Gaussian some `reach` pixels wide.
  std::vector<float> (*surroundings)(std::span<const float> values, int side, double reach);
};

/// Why the library cannot be opened.
struct NoImageLibrary : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Opens the library at its first use and keeps it; any thread may ask. Throws `NoImageLibrary`.
const ImageLibrary& image_library();

}  // namespace wale
