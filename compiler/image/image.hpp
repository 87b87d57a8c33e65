#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compiler/text/resolver.hpp"
#include "wale/patch_program.hpp"
#include "wale/result.hpp"

namespace wale {

/// A picture used as a height map.
struct HeightImage {
  HeightTable table;
  /// Pixels of the file per sample of the table, along x and y: 1 unless the picture was too large and was resized. A
  /// scale per pixel times this is the scale per sample.
  double pixels_per_column = 1, pixels_per_row = 1;
};

/// A picture in its colours.
struct ColourImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint32_t> pixels;  ///< row by row from the top: 0xAARRGGBB, of which AA is 0 where it is transparent
  double pixels_per_column = 1, pixels_per_row = 1;  ///< of the file, as in `HeightImage`
};

/// The smallest and largest side of a height table, in samples. A spline needs four; larger pictures are resized down.
inline constexpr int smallest_image_side = 4;
inline constexpr int largest_image_side = 4096;
/// The most pixels of a picture: what the largest height table holds. A picture that declares more is refused before
/// any is read.
inline constexpr long long most_image_pixels = 1LL * largest_image_side * largest_image_side;
/// The widest smoothing, in pixels of the table.
inline constexpr double widest_smoothing = 64;

/// Decodes a picture in its colours: as `read_height_image`, with these differences. Red, green and blue have 8 bits
/// each, a picture with one colour channel is grey, and alpha is kept. A side may have a single pixel. A picture that
/// is too large is reduced by leaving pixels out, so that no colour arises that it does not have.
Result<ColourImage> read_colour_image(std::span<const std::byte> bytes, const std::string& name,
                                      Sandbox sandbox = Sandbox::required);

/// Decodes a picture (PNG, TIFF, JPEG, EXR, BMP, GIF, WebP, HDR, PNM, TGA, JPEG 2000, SGI, RLA, FITS: what
/// OpenImageIO reads, without the decoders that crash on damaged files) and takes its luminance as height.
///
/// Values are used as stored, without linearisation: an integer's full range of codes is 0 .. 1, floating point is
/// clamped to 0 .. 1, and not-a-number is 0. A single colour channel is the height itself; red, green and blue are
/// weighted by Rec. 709. Alpha is ignored and never multiplied in. An orientation written by a camera is applied. If a
/// file holds several pictures, the first is used.
///
/// The extension of `name` is a hint at the format; no file of that name is opened. `smooth_pixels` is the standard
/// deviation of a Gaussian in pixels of the file, 0 for none; beyond the edge the picture continues with its edge's
/// value. The same bytes give the same heights on every machine.
///
/// Pictures are untrusted, and so they are decoded by `decode_picture` in a process without rights. The last few are
/// remembered, so that a process decodes each of its pictures once. May be called from any thread.
///
/// Errors: `Code::image_size`, `unreadable_image`, `missing_library`, `short_of_resources`, and `no_sandbox` where the
/// system offers none and `sandbox` requires one; the place has `name`.
Result<HeightImage> read_height_image(std::span<const std::byte> bytes, const std::string& name, double smooth_pixels,
                                      Sandbox sandbox = Sandbox::required);

}  // namespace wale
