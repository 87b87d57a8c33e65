#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "compiler/drawing/canvas.hpp"
#include "compiler/drawing/drawing.hpp"
#include "wale/result.hpp"

namespace wale {

/// The functions that draw, by cairo and Pango, and that write pictures, by OpenImageIO. These bring 270 shared
/// libraries, and a program linked with them starts a quarter of a second later. So these functions are in a library of
/// their own, `wale_images`, which is opened when the first picture is drawn: most runs of `wale` need none. They get
/// no foreign bytes; those go to `decode_picture`.
struct ImageLibrary {
  /// As the function of that name in drawing.hpp.
  Result<std::vector<std::byte>> (*encode_drawing)(const Drawing& drawing, const std::string& name);
  /// As the function of that name in canvas.hpp, but never an error.
  std::unique_ptr<Canvas> (*new_canvas)(int width, int height, Colour paper);
  /// The weighted mean around each of `side` by `side` values; the weights are a Gaussian about `reach` pixels wide.
  std::vector<float> (*surroundings)(std::span<const float> values, int side, double reach);
};

/// Opens the library at its first use and keeps it; never null. Any thread may ask. Error: `Code::missing_library`.
Result<const ImageLibrary*> image_library();

}  // namespace wale
