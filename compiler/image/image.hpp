#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <variant>

#include "schema/patch_program.hpp"

namespace wale {

/// A picture taken as a height map.
struct HeightImage {
  HeightTable table;
  /// Pixels of the file per sample of the table, along x and y: 1 unless the picture was too large and was resized. A
  /// scale of s per pixel is a scale of s times this per sample.
  double pixels_per_column = 1, pixels_per_row = 1;
};

/// Why a file cannot be used as heights; a phrase that follows the file's name, "is 3 x 2 pixels; …".
struct ImageProblem {
  std::string reason;
  bool size = false;  ///< it is its size that cannot be used
};

/// The smallest and largest side of a height table, in samples. A spline needs four; what is larger is resized down.
inline constexpr int smallest_image_side = 4;
inline constexpr int largest_image_side = 4096;
/// Pictures that declare more pixels than this are refused before any is read.
inline constexpr long long most_image_pixels = 1LL << 28;
/// The widest smoothing, in pixels of the table.
inline constexpr double widest_smoothing = 64;

/// Decodes a picture (PNG, TIFF, JPEG, EXR, BMP, GIF, WebP, HDR, PNM, TGA, JPEG 2000, SGI, RLA, FITS: what
/// OpenImageIO reads, without the decoders that crash on damaged files) and takes its luminance as height.
///
/// Values are taken as stored, without linearisation: an integer's full code range is 0 .. 1, floating point is clamped
/// to 0 .. 1 and not-a-number is 0. One colour channel is the height as it is; red, green and blue are weighed by
/// Rec. 709; alpha is ignored and never multiplied in. An orientation written by a camera is applied. Of several
/// pictures in a file the first is taken.
///
/// `name` serves for its extension only, as a hint at the format; no file of that name is opened. `smooth_pixels` is
/// the standard deviation of a Gaussian in pixels of the file, 0 for none, the picture continued by its edge. The same
/// bytes give the same heights on every machine. Prints nothing; a damaged file is an ImageProblem.
std::variant<HeightImage, ImageProblem> read_height_image(std::span<const std::byte> bytes, const std::string& name,
                                                          double smooth_pixels);

}  // namespace wale
