#include "compiler/image/drawing.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "compiler/image/openimageio.hpp"

namespace wale {

std::variant<std::vector<std::byte>, DrawingProblem> encode_drawing(const Drawing& drawing, const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  const auto unknown = [&] {
    OIIO::geterror();
    return DrawingProblem{
        extension.empty() ? fmt::format("cannot write {}: its name ends in no picture format; try .png", name)
                          : fmt::format("cannot write {}: pictures are not written as .{}; try .png", name, extension)};
  };
  if (extension.empty() || extension == "null" || extension == "nul") return unknown();
  auto output = OIIO::ImageOutput::create(extension);
  if (!output || !output->supports("ioproxy")) return unknown();

  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput memory(file);
  output->threads(1);
  OIIO::ImageSpec spec(drawing.width, drawing.height, 3, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (!output->set_ioproxy(&memory) || !output->open("drawing." + extension, spec) ||
      !output->write_image(OIIO::TypeUInt8, drawing.rgb.data()) || !output->close()) {
    return DrawingProblem{fmt::format("cannot write {}: {}", name, OIIO::Strutil::strip(output->geterror()))};
  }
  const auto* first = reinterpret_cast<const std::byte*>(file.data());
  return std::vector<std::byte>(first, first + file.size());
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
