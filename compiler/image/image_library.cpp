#include "compiler/image/image_library.hpp"

#include <dlfcn.h>

#include <string>

namespace wale {
namespace {

Result<const ImageLibrary*> opened_image_library() {
  // The path of the build; for a program that was moved, the system's search path.
  for (const char* path : {WALE_IMAGE_LIBRARY, "libwale_images.so"}) {
    if (void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL)) {
      if (const void* functions = dlsym(library, "wale_image_library"))
        return static_cast<const ImageLibrary*>(functions);
    }
  }
  const char* reason = dlerror();
  return Error{Code::missing_library,
               std::string("the image library cannot be opened: ") + (reason ? reason : "not found"),
               "put libwale_images.so in a folder that LD_LIBRARY_PATH names",
               {"libwale_images.so"}};
}

}  // namespace

Result<const ImageLibrary*> image_library() {
  static const Result<const ImageLibrary*> library = opened_image_library();
  return library;
}

}  // namespace wale
