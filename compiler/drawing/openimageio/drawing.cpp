#include <algorithm>
#include <filesystem>

#include "compiler/drawing/openimageio/functions.hpp"
#include "compiler/image/openimageio.hpp"

namespace wale::openimageio {

Result<std::vector<std::byte>> encode_drawing(const Drawing& drawing, const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  const auto unknown = [&] {
    OIIO::geterror();
    return Error{Code::malformed_value,
                 extension.empty() ? "the name of a picture needs an extension"
                                   : fmt::format("pictures cannot be written as .{}", extension),
                 "use the extension .png",
                 {name}};
  };
  if (extension.empty() || extension == "null" || extension == "nul") return unknown();
  auto output = OIIO::ImageOutput::create(extension);
  if (!output || !output->supports("ioproxy")) return unknown();

  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput memory(file);
  output->threads(1);
  OIIO::ImageSpec spec(drawing.width, drawing.height, 3, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (extension == "jpg" || extension == "jpeg") spec.attribute("Compression", "jpeg:85");  // no loss that is seen
  if (!output->set_ioproxy(&memory) || !output->open("drawing." + extension, spec) ||
      !output->write_image(OIIO::TypeUInt8, drawing.rgb.data()) || !output->close()) {
    return Error{Code::unwritable_file,
                 fmt::format("cannot write the picture: {}", OIIO::Strutil::strip(output->geterror())),
                 {},
                 {name}};
  }
  const auto* first = reinterpret_cast<const std::byte*>(file.data());
  return std::vector<std::byte>(first, first + file.size());
}

std::vector<float> surroundings(std::span<const float> values, int side, double reach) {
  using namespace OIIO::ImageBufAlgo;
  OIIO::ImageBuf source(OIIO::ImageSpec(side, side, 1, OIIO::TypeFloat));
  source.set_pixels(source.roi(), OIIO::TypeFloat, values.data());
  // Blurring a reduced picture gives nearly the same result, faster.
  const int small = std::clamp(static_cast<int>(12 * side / reach), 16, side);
  const auto width = static_cast<float>(reach * small / side);
  const auto few = resize(source, "triangle", 0.0f, OIIO::ROI(0, small, 0, small, 0, 1, 0, 1), 1);
  const auto blurred = convolve(few, make_kernel("gaussian", width, width), true, {}, 1);
  const auto around = resize(blurred, "gaussian", 0.0f, source.roi(), 1);
  std::vector<float> means(values.size());
  around.get_pixels(around.roi(), OIIO::TypeFloat, means.data());
  return means;
}

}  // namespace wale::openimageio
