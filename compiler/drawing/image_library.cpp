#include "compiler/drawing/image_library.hpp"

#include <dlfcn.h>

#include <string>
#include <vector>

#include "schema/companion.hpp"

namespace wale {
namespace {

Result<const ImageLibrary*> opened_image_library() {
  // A name without a folder is found where the system looks for libraries.
  std::vector<std::string> paths = companion_paths("libwale_images.so");
  paths.push_back("libwale_images.so");
  for (const std::string& path : paths) {
    if (void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
      if (const void* functions = dlsym(library, "wale_image_library"))
        return static_cast<const ImageLibrary*>(functions);
    }
  }
  const char* reason = dlerror();
  return Error{Code::missing_library,
               std::string("the image library cannot be opened: ") + (reason ? reason : "not found"),
               "put libwale_images.so beside the program that uses it",
               {"libwale_images.so"}};
}

}  // namespace

Result<const ImageLibrary*> image_library() {
  static const Result<const ImageLibrary*> library = opened_image_library();
  return library;
}

}  // namespace wale
