#include "compiler/image/drawing.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "compiler/image/image_library.hpp"

namespace wale {

Result<std::vector<std::byte>> encode_drawing(const Drawing& drawing, const std::string& name) {
  const auto library = image_library();
  if (!library) return library.error();
  return (*library)->encode_drawing(drawing, name);
}

Result<> save_drawing(const Drawing& drawing, const std::string& path) {
  const auto bytes = encode_drawing(drawing, path);
  if (!bytes) return bytes.error();

  const auto unwritable = [&](int error) {
    return Error{Code::unwritable_file, fmt::format("cannot write the picture: {}", std::strerror(error)), {}, {path}};
  };
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return unwritable(errno);
  const bool written = std::fwrite(bytes->data(), 1, bytes->size(), file) == bytes->size();
  const int write_error = errno;
  if (std::fclose(file) == 0 && written) return {};
  const int error = written ? errno : write_error;
  // Half a picture is worse than none. A device such as /dev/full is not removed: it is not a file of this program.
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
  return unwritable(error);
}

}  // namespace wale
