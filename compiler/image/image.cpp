#include "compiler/image/image.hpp"

#include "compiler/image/image_library.hpp"

namespace wale {

Result<HeightImage> read_height_image(std::span<const std::byte> bytes, const std::string& name, double smooth_pixels) {
  const auto library = image_library();
  if (!library) return library.error();
  return (*library)->read_height_image(bytes, name, smooth_pixels);
}

}  // namespace wale
