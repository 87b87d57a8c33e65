#include "compiler/image/decoder/colour_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <new>

#include "compiler/image/decoder/read_picture.hpp"
#include "compiler/image/decoder/sandbox.hpp"

namespace wale::decoder {
namespace {

/// The pixels as the file stores them, and how the camera was held (1 to 8, as in Exif).
struct StoredColours {
  std::uint32_t width = 0, height = 0;
  int orientation = 1;
  std::vector<std::uint32_t> pixels;

  bool is_on_its_side() const { return orientation >= 5 && orientation <= 8; }
  /// The pixel that is shown in this column and row.
  std::uint32_t shown(std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t right = width - 1, bottom = height - 1;
    std::array<std::uint32_t, 2> at = {x, y};
    switch (orientation) {
      case 2: at = {right - x, y}; break;
      case 3: at = {right - x, bottom - y}; break;
      case 4: at = {x, bottom - y}; break;
      case 5: at = {y, x}; break;
      case 6: at = {y, bottom - x}; break;
      case 7: at = {right - y, bottom - x}; break;
      case 8: at = {right - y, x}; break;
      default: break;
    }
    return pixels[std::size_t{at[1]} * width + at[0]];
  }
};

/// 8 bits of a value in 0 .. 1.
std::uint32_t byte_of(float value) { return static_cast<std::uint32_t>(std::lround(255 * value)); }

Result<> read_colours(OIIO::ImageInput& input, StoredColours& colours) {
  const OIIO::ImageSpec spec = input.spec();
  const std::vector<int> channels = colour_channels(spec);
  colours = {static_cast<std::uint32_t>(std::max(spec.width, 0)),
             static_cast<std::uint32_t>(std::max(spec.height, 0)),
             spec.get_int_attribute("Orientation", 1),
             {}};
  return read_bands(input, 1, [&](const Band& band) -> Result<> {
    colours.pixels.reserve(std::size_t{colours.width} * colours.height);
    const std::size_t count = std::size_t{colours.width} * static_cast<std::size_t>(band.rows);
    for (std::size_t i = 0; i < count; ++i) {
      const float* pixel = &band.values[i * static_cast<std::size_t>(spec.nchannels)];
      const auto part = [&](std::size_t which) { return byte_of(pixel[channels[channels.size() == 1 ? 0 : which]]); };
      const std::uint32_t alpha = spec.alpha_channel < 0 ? 255 : byte_of(pixel[spec.alpha_channel]);
      colours.pixels.push_back(alpha << 24 | part(0) << 16 | part(1) << 8 | part(2));
    }
    return {};
  });
}

/// Upright, and no side longer than `largest_image_side`.
ColourImage shown_colours(const StoredColours& stored) {
  const std::uint32_t width = stored.is_on_its_side() ? stored.height : stored.width;
  const std::uint32_t height = stored.is_on_its_side() ? stored.width : stored.height;
  const std::uint32_t longest = std::max(width, height);
  const auto shrunk = [&](std::uint32_t side) {
    if (longest <= largest_image_side) return side;
    const double share = static_cast<double>(largest_image_side) / longest;
    return static_cast<std::uint32_t>(std::max(1L, std::lround(side * share)));
  };
  ColourImage image{shrunk(width), shrunk(height), {}, 1, 1};
  image.pixels_per_column = static_cast<double>(width) / image.width;
  image.pixels_per_row = static_cast<double>(height) / image.height;
  image.pixels.reserve(std::size_t{image.width} * image.height);
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x)
      image.pixels.push_back(stored.shown(static_cast<std::uint32_t>((x + 0.5) * image.pixels_per_column),
                                          static_cast<std::uint32_t>((y + 0.5) * image.pixels_per_row)));
  return image;
}

}  // namespace

Result<ColourImage> colour_image(std::span<const std::byte> bytes, const std::string& extension) {
  try {
    StoredColours stored;
    if (auto read =
            read_picture(bytes, extension, [&](OIIO::ImageInput& input) { return read_colours(input, stored); });
        !read)
      return std::move(read).error();
    return shown_colours(stored);
  } catch (const std::bad_alloc&) {
    return unreadable(fmt::format("the picture needs more than {} MB of memory to decode", most_memory >> 20));
  } catch (const std::exception& exception) {  // a decoder's own
    return unreadable(std::string("the picture cannot be read: ") + exception.what());
  }
}

}  // namespace wale::decoder
