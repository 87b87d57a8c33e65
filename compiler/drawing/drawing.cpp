#include "compiler/drawing/drawing.hpp"

#include "compiler/drawing/image_library.hpp"

namespace wale {

Result<std::vector<std::byte>> encode_drawing(const Drawing& drawing, const std::string& name) {
  const auto library = image_library();
  if (!library) return library.error();
  return (*library)->encode_drawing(drawing, name);
}

}  // namespace wale
