#include "compiler/image/image_library.hpp"

#include <dlfcn.h>

namespace wale {
namespace {

const ImageLibrary& opened_image_library() {
  // Where it was built; else, for a program that was moved, wherever the system looks.
  for (const char* path : {WALE_IMAGE_LIBRARY, "libwale_images.so"}) {
    if (void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL)) {
      if (const void* functions = dlsym(library, "wale_image_library"))
        return *static_cast<const ImageLibrary*>(functions);
    }
  }
  const char* reason = dlerror();
  throw NoImageLibrary(std::string("this Wale has no image library: ") + (reason ? reason : "not found"));
}

}  // namespace

const ImageLibrary& image_library() {
  static const ImageLibrary& library = opened_image_library();
  return library;
}

}  // namespace wale
