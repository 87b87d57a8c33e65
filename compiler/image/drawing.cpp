#include "compiler/image/drawing.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "compiler/image/image_library.hpp"

namespace wale {

std::variant<std::vector<std::byte>, DrawingProblem> encode_drawing(const Drawing& drawing, const std::string& name) {
  try {
    return image_library().encode_drawing(drawing, name);
  } catch (const NoImageLibrary& reason) {
    return DrawingProblem{fmt::format("cannot write {}: {}", name, reason.what())};
  }
}

std::optional<DrawingProblem> save_drawing(const Drawing& drawing, const std::string& path) {
  auto encoded = encode_drawing(drawing, path);
  if (auto* problem = std::get_if<DrawingProblem>(&encoded)) return *problem;
  const auto& bytes = std::get<std::vector<std::byte>>(encoded);

  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return DrawingProblem{fmt::format("cannot write {}: {}", path, std::strerror(errno))};
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int write_error = errno;
  if (std::fclose(file) == 0 && written) return std::nullopt;
  const int error = written ? errno : write_error;
  // Half a picture is worse than none; a device such as /dev/full is not ours to remove.
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
  return DrawingProblem{fmt::format("cannot write {}: {}", path, std::strerror(error))};
}

}  // namespace wale
