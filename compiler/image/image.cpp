#include "compiler/image/image.hpp"

#include "compiler/image/image_library.hpp"

namespace wale {

std::variant<HeightImage, ImageProblem> read_height_image(std::span<const std::byte> bytes, const std::string& name,
                                                          double smooth_pixels) {
  try {
    return image_library().read_height_image(bytes, name, smooth_pixels);
  } catch (const NoImageLibrary& reason) {
    return ImageProblem{std::string("cannot be read: ") + reason.what()};
  }
}

}  // namespace wale
