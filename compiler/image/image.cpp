#include "compiler/image/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <list>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/image/decode_picture.hpp"
#include "schema/home_process.hpp"

namespace wale {
namespace {

std::size_t bytes_of(const HeightImage& image) { return image.table.heights.size() * sizeof(image.table.heights[0]); }
std::size_t bytes_of(const ColourImage& image) { return image.pixels.size() * sizeof(image.pixels[0]); }

/// The pictures that were decoded last, with their heights or colours. A material asks for the same one several times.
template <class Image>
class DecodedPictures {
 public:
  std::optional<Image> find(std::span<const std::byte> bytes, const DecoderArguments& arguments) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(pictures_, [&](const Picture& each) {
      return each.extension == arguments.extension && each.smooth_pixels == arguments.smooth_pixels &&
             std::ranges::equal(each.bytes, bytes);
    });
    if (found == pictures_.end()) return std::nullopt;
    pictures_.splice(pictures_.begin(), pictures_, found);
    return found->image;
  }

  void remember(std::span<const std::byte> bytes, const DecoderArguments& arguments, const Image& image) {
    const std::lock_guard lock(mutex_);
    pictures_.push_front({arguments.extension, arguments.smooth_pixels, {bytes.begin(), bytes.end()}, image});
    held_ += pictures_.front().size();
    while (held_ > most_held && pictures_.size() > 1) {
      held_ -= pictures_.back().size();
      pictures_.pop_back();
    }
  }

 private:
  /// In bytes. One picture is always kept, however large it is.
  static constexpr std::size_t most_held = 128u << 20;

  struct Picture {
    std::string extension;
    double smooth_pixels = 0;
    std::vector<std::byte> bytes;
    Image image;

    std::size_t size() const { return bytes.size() + bytes_of(image); }
  };

  std::mutex mutex_;
  std::list<Picture> pictures_;  // the last used first
  std::size_t held_ = 0;
};

/// In lower case and without its dot. Only letters and digits make an extension of a picture.
std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool plain = std::ranges::all_of(extension, [](unsigned char c) { return c < 0x80 && std::isalnum(c); });
  return plain && extension.size() <= 16 ? extension : "";
}

/// The picture, decoded by `decode` unless it is remembered.
template <class Image, class Decode>
Result<Image> decoded(std::span<const std::byte> bytes, const std::string& name, const DecoderArguments& arguments,
                      const Decode& decode) {
  const auto unreadable = [&](std::string sentence, std::string mend) {
    return Error{Code::unreadable_image, std::move(sentence), std::move(mend), {.name = name}};
  };
  if (!(arguments.smooth_pixels >= 0))
    return unreadable("a picture cannot be smoothed by a negative number of pixels", "write a positive length");
  if (bytes.empty()) return unreadable("the file is empty", "save it as PNG, TIFF, JPEG or EXR");
  if (bytes.size() > largest_asset)
    return unreadable(fmt::format("the file has {} MB, and pictures of up to {} MB are read", bytes.size() >> 20,
                                  largest_asset >> 20),
                      "save it as PNG");
  static PerProcess<DecodedPictures<Image>> all;
  DecodedPictures<Image>& pictures = *all;
  if (auto known = pictures.find(bytes, arguments)) return *std::move(known);
  auto image = decode(bytes, arguments);
  if (image)
    pictures.remember(bytes, arguments, *image);
  else if (image.error().place.name.empty())
    image.error().place.name = name;
  return image;
}

}  // namespace

Result<HeightImage> read_height_image(std::span<const std::byte> bytes, const std::string& name, double smooth_pixels,
                                      Sandbox sandbox) {
  return decoded<HeightImage>(bytes, name, {extension_of(name), smooth_pixels, sandbox},
                              [](const auto& picture, const auto& how) { return decode_picture(picture, how); });
}

Result<ColourImage> read_colour_image(std::span<const std::byte> bytes, const std::string& name, Sandbox sandbox) {
  return decoded<ColourImage>(bytes, name, {extension_of(name), 0, sandbox, Samples::colours},
                              [](const auto& picture, const auto& how) { return decode_colours(picture, how); });
}

}  // namespace wale
