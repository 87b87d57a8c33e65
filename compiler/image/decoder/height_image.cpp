#include "compiler/image/decoder/height_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "compiler/image/decoder/read_picture.hpp"
#include "compiler/image/decoder/sandbox.hpp"

namespace wale::decoder {
namespace {

using OIIO::ImageBuf;
using OIIO::ImageInput;
using OIIO::ImageSpec;
namespace algorithm = OIIO::ImageBufAlgo;

/// Heights of 0 .. 1, one channel, rows from the top.
struct HeightField {
  int width = 0, height = 0;
  int orientation = 1;
  std::vector<float> heights;
};

/// Which channels are summed into the height, with what weights; the other weights are zero.
std::vector<float> luminance_weights(const ImageSpec& spec) {
  constexpr std::array<float, 3> rec709 = {0.2126f, 0.7152f, 0.0722f};
  std::vector<float> weights(static_cast<std::size_t>(spec.nchannels), 0.0f);
  const std::vector<int> colours = colour_channels(spec);
  for (std::size_t i = 0; i < colours.size(); ++i)
    weights[static_cast<std::size_t>(colours[i])] = colours.size() == 1 ? 1.0f : rec709[i];
  return weights;
}

Result<> read_luminance(ImageInput& input, HeightField& field) {
  const ImageSpec spec = input.spec();
  std::vector<float> weights;
  field = {spec.width, spec.height, spec.get_int_attribute("Orientation", 1), {}};
  return read_bands(input, smallest_image_side, [&](const Band& band) -> Result<> {
    if (weights.empty()) weights = luminance_weights(spec);
    field.heights.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
    const ImageBuf source(ImageSpec(spec.width, band.rows, spec.nchannels, OIIO::TypeFloat), band.values.data());
    float* row = &field.heights[static_cast<std::size_t>(band.top) * static_cast<std::size_t>(spec.width)];
    ImageBuf sum(ImageSpec(spec.width, band.rows, 1, OIIO::TypeFloat), row);
    if (!algorithm::channel_sum(sum, source, weights, {}, threads))
      return unreadable("its channels cannot be summed into heights: " +
                        words_of(sum.geterror(), "OpenImageIO refused"));
    return {};
  });
}

HeightField field_of(const ImageBuf& buffer) {
  HeightField field{buffer.spec().width, buffer.spec().height, 1, {}};
  field.heights.resize(static_cast<std::size_t>(field.width) * static_cast<std::size_t>(field.height));
  buffer.get_pixels(buffer.roi(), OIIO::TypeFloat, field.heights.data());
  return field;
}

ImageBuf buffer_of(HeightField& field) {
  ImageSpec spec(field.width, field.height, 1, OIIO::TypeFloat);
  return ImageBuf(spec, field.heights.data());
}

/// Turned as the camera was held, which the file's orientation says.
HeightField upright(HeightField field) {
  if (field.orientation <= 1 || field.orientation > 8) return field;
  ImageBuf source = buffer_of(field);
  source.set_orientation(field.orientation);
  ImageBuf turned = algorithm::reorient(source, threads);
  return turned.has_error() ? field : field_of(turned);
}

/// Resized so that no side is longer than `largest_image_side`. The filter has no negative lobes: they would ring at a
/// step, and a ripple that the eye does not notice is felt.
HeightField fitted(HeightField field) {
  const int longest = std::max(field.width, field.height);
  if (longest <= largest_image_side) return field;
  const auto shrink = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(side) * largest_image_side / longest)));
  };
  const OIIO::ROI size(0, shrink(field.width), 0, shrink(field.height), 0, 1, 0, 1);
  const ImageBuf source = buffer_of(field);
  return field_of(algorithm::resize(source, "blackman-harris", 0.0f, size, threads));
}

/// Weights of a Gaussian centred on 0, with a standard deviation of `sigma` samples, cut at 4 standard deviations.
/// ImageBufAlgo::make_kernel("gaussian") is cut at 2, which makes it narrower than it says.
ImageBuf gaussian_row(double sigma, bool upright_row) {
  const int reach = std::max(1, static_cast<int>(std::ceil(4 * sigma)));
  const int length = 2 * reach + 1;
  ImageSpec spec(upright_row ? 1 : length, upright_row ? length : 1, 1, OIIO::TypeFloat);
  (upright_row ? spec.y : spec.x) = -reach;
  (upright_row ? spec.full_y : spec.full_x) = -reach;
  ImageBuf kernel(spec);
  for (int i = -reach; i <= reach; ++i) {
    const float weight = static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma)));
    kernel.setpixel(upright_row ? 0 : i, upright_row ? i : 0, OIIO::cspan<float>(weight));
  }
  return kernel;
}

HeightField smoothed(HeightField field, double sigma_x, double sigma_y) {
  const ImageBuf source = buffer_of(field);
  const ImageBuf across = algorithm::convolve(source, gaussian_row(sigma_x, false), true, {}, threads);
  return field_of(algorithm::convolve(across, gaussian_row(sigma_y, true), true, {}, threads));
}

HeightTable quantised(const HeightField& field) {
  HeightTable table{static_cast<std::uint32_t>(field.width), static_cast<std::uint32_t>(field.height), {}};
  table.heights.reserve(field.heights.size());
  for (float height : field.heights) {
    table.heights.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(height, 0.0f, 1.0f) * 65535.0)));
  }
  return table;
}

Result<HeightImage> heights_from(HeightField whole, double smooth_pixels) {
  whole = upright(std::move(whole));
  const double columns = whole.width, rows = whole.height;
  HeightField field = fitted(std::move(whole));
  if (std::min(field.width, field.height) < smallest_image_side)
    return of_wrong_size(fmt::format("the picture has {} x {} pixels, too long and narrow for heights", columns, rows),
                         smallest_image_side);
  HeightImage image;
  image.pixels_per_column = columns / field.width;
  image.pixels_per_row = rows / field.height;
  if (smooth_pixels > 0) {
    const double sigma_x = smooth_pixels / image.pixels_per_column, sigma_y = smooth_pixels / image.pixels_per_row;
    if (std::max(sigma_x, sigma_y) > widest_smoothing)
      return Error{Code::unreadable_image,
                   fmt::format("the picture cannot be smoothed by {} pixels; {} is the most", smooth_pixels,
                               std::floor(widest_smoothing * image.pixels_per_column)),
                   "smooth less, or make the picture smaller first"};
    field = smoothed(std::move(field), sigma_x, sigma_y);
  }
  image.table = quantised(field);
  return image;
}

}  // namespace

Result<HeightImage> height_image(std::span<const std::byte> bytes, const std::string& extension, double smooth_pixels) {
  try {
    HeightField field;
    if (auto read = read_picture(bytes, extension, [&](ImageInput& input) { return read_luminance(input, field); });
        !read)
      return std::move(read).error();
    return heights_from(std::move(field), smooth_pixels);
  } catch (const std::bad_alloc&) {
    return unreadable(fmt::format("the picture needs more than {} MB of memory to decode", most_memory >> 20));
  } catch (const std::exception& exception) {  // a decoder's own
    return unreadable(std::string("the picture cannot be read: ") + exception.what());
  }
}

}  // namespace wale::decoder
