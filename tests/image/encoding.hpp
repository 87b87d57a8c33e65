#pragma once

// Pictures for tests, written by OpenImageIO, and how they are damaged.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "compiler/image/openimageio.hpp"

namespace wale {

using Bytes = std::vector<std::byte>;

/// A picture file in memory, made of `values`: 0 .. 1, or codes if `spec` has an integer type. Throws
/// std::runtime_error.
template <class Value>
Bytes encode(const std::string& extension, OIIO::ImageSpec spec, const std::vector<Value>& values) {
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput memory(file);
  auto output = OIIO::ImageOutput::create(extension);
  if (!output || !output->set_ioproxy(&memory) || !output->open("test." + extension, spec) ||
      !output->write_image(OIIO::TypeDesc(OIIO::BaseTypeFromC<Value>::value), values.data()) || !output->close())
    throw std::runtime_error("no " + extension + ": " + (output ? output->geterror() : OIIO::geterror()));
  const auto* first = reinterpret_cast<const std::byte*>(file.data());
  return {first, first + file.size()};
}

/// Codes that reach from end to end and differ in every pixel.
template <class Value>
std::vector<Value> ramp(std::size_t count) {
  std::vector<Value> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<Value>(i * std::numeric_limits<Value>::max() / (count - 1));
  }
  return values;
}

/// A picture of 40 x 40 pixels in every format that OpenImageIO writes to memory, with its name.
inline std::vector<std::pair<std::string, Bytes>> one_of_each() {
  const auto codes = ramp<std::uint8_t>(40 * 40 * 3);
  std::vector<std::pair<std::string, Bytes>> files;
  for (const char* extension : {"png", "tif", "jpg", "exr", "bmp", "gif", "webp", "hdr", "ppm", "tga"}) {
    files.emplace_back(std::string("a.") + extension,
                       encode(extension, OIIO::ImageSpec(40, 40, 3, OIIO::TypeUInt8), codes));
  }
  return files;
}

/// Damage to files, always the same for the same seed.
class Mutations {
 public:
  explicit Mutations(std::uint32_t seed) : random_(seed) {}

  /// Four bytes changed, only among the first 200 if `in_header`.
  Bytes of(Bytes bytes, bool in_header) {
    for (int i = 0; i < 4; ++i) {
      random_ = random_ * 1664525u + 1013904223u;
      const std::size_t reach = in_header ? std::min<std::size_t>(bytes.size(), 200) : bytes.size();
      bytes[(random_ >> 8) % reach] ^= std::byte(random_ >> 24);
    }
    return bytes;
  }

 private:
  std::uint32_t random_;
};

}  // namespace wale
