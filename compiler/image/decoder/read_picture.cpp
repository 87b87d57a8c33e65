#include "compiler/image/decoder/read_picture.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "compiler/image/decoder/file_in_memory.hpp"

namespace wale::decoder {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;

constexpr int most_channels = 64;
/// In one tile, which is decoded as a whole: the most pixels of a picture, in four channels.
constexpr long long most_samples_per_tile = 4 * most_image_pixels;
constexpr long long samples_per_band = 1 << 22;

/// Whether a picture can be used, from what its header says.
Result<> usable(const ImageSpec& spec, int smallest) {
  if (spec.deep) return unreadable("a deep image has no single height per pixel");
  if (spec.depth > 1) return unreadable("the image is a volume, and a picture has two dimensions");
  if (spec.width < smallest || spec.height < smallest)
    return of_wrong_size(fmt::format("the picture has {} x {} pixels, and {} need at least {} x {}", spec.width,
                                     spec.height, smallest > 1 ? "heights" : "colours", smallest, smallest),
                         smallest);
  if (static_cast<long long>(spec.width) * spec.height > most_image_pixels)
    return of_wrong_size(fmt::format("the picture has {} x {} pixels, more than the {} that a patch can use",
                                     spec.width, spec.height, most_image_pixels),
                         smallest);
  if (spec.nchannels < 1 || spec.nchannels > most_channels)
    return unreadable(
        fmt::format("the picture has {} channels, and 1 to {} can be read", spec.nchannels, most_channels));
  if (static_cast<long long>(spec.tile_width) * spec.tile_height > most_samples_per_tile / spec.nchannels)
    return of_wrong_size(fmt::format("the picture has tiles of {} x {} pixels, which are too large to read",
                                     spec.tile_width, spec.tile_height),
                         smallest);
  return {};
}

Result<> decode_as(const std::string& format, std::span<const std::byte> bytes, const std::string& extension,
                   const std::function<Result<>(ImageInput&)>& read) {
  std::unique_ptr<ImageInput> input = ImageInput::create(format);
  if (!input)
    return unreadable("the picture cannot be read: " + words_of(OIIO::geterror(), "no decoder for " + format));
  input->threads(threads);

  ImageSpec found, wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // otherwise colours come multiplied by alpha
  OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
  // A decoder that reads files only finds this one in memory.
  const std::string name = "picture." + extension;
  const FileInMemory file(name, bytes);
  if (input->supports("ioproxy")) input->set_ioproxy(&memory);
  if (!input->open(name, found, wishes))
    return unreadable("the picture cannot be read: " + words_of(input->geterror(), "not a " + format + " file"));
  auto done = read(*input);
  input->close();
  return done;
}

/// The decoders that may read an untrusted file: each survived thousands of damaged ones. Of the others in OpenImageIO
/// 2.4, dpx, heif, iff, ico and psd crashed on damaged files; the rest are rare, or read other things than pictures.
constexpr std::array<std::string_view, 14> trusted_formats = {"png", "tiff", "jpeg",  "openexr",  "bmp", "gif", "webp",
                                                              "hdr", "pnm",  "targa", "jpeg2000", "sgi", "rla", "fits"};

bool is_trusted(std::string_view format) { return std::ranges::find(trusted_formats, format) != trusted_formats.end(); }

/// The name of OpenImageIO's decoder for an extension; empty if there is none.
std::string format_of(const std::string& extension) {
  for (const std::string& entry : OIIO::Strutil::splits(OIIO::get_string_attribute("extension_list"), ";")) {
    const auto parts = OIIO::Strutil::splits(entry, ":");
    if (parts.size() != 2) continue;
    const auto extensions = OIIO::Strutil::splits(parts[1], ",");
    if (std::ranges::find(extensions, extension) != extensions.end()) return parts[0];
  }
  return {};
}

}  // namespace

Error unreadable(std::string sentence) {
  return {Code::unreadable_image, std::move(sentence), "save it as PNG, TIFF, JPEG or EXR"};
}

Error of_wrong_size(std::string sentence, int smallest) {
  return {Code::image_size, std::move(sentence),
          fmt::format("resize it to at least {0} x {0} pixels and at most {1} x {1}", smallest, largest_image_side)};
}

std::string words_of(std::string error, const std::string& otherwise) {
  const auto lines = OIIO::Strutil::splits(OIIO::Strutil::strip(error), "\n");
  const std::string words = OIIO::Strutil::join(lines, "; ");
  return words.empty() ? otherwise : words;
}

std::vector<int> colour_channels(const ImageSpec& spec) {
  std::array<int, 3> named = {-1, -1, -1};
  std::vector<int> colours;
  for (int channel = 0; channel < spec.nchannels; ++channel) {
    const std::string name = OIIO::Strutil::lower(spec.channel_name(channel));
    if (channel != spec.alpha_channel && channel != spec.z_channel) colours.push_back(channel);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string letter(1, "rgb"[i]);
      const bool is_named = name == letter || OIIO::Strutil::ends_with(name, "." + letter);
      if (is_named && named[i] < 0) named[i] = channel;
    }
  }
  if (colours.empty()) colours.push_back(0);
  // Two channels are grey and alpha, whatever they are called.
  if (colours.size() < 3) return {colours[0]};
  if (std::ranges::all_of(named, [](int channel) { return channel >= 0; })) return {named.begin(), named.end()};
  return {colours[0], colours[1], colours[2]};
}

void prepare() {
  OIIO::attribute("threads", threads);
  OIIO::attribute("exr_threads", -1);  // none besides the caller's
  // Our own limit is smaller, and its message says what to do.
  OIIO::attribute("limits:imagesize_MB", std::numeric_limits<int>::max());
  // A decoder loads what it needs when it is first made.
  for (const std::string_view format : trusted_formats) ImageInput::create(std::string(format));
  OIIO::geterror();
}

Result<> read_picture(std::span<const std::byte> bytes, const std::string& extension,
                      const std::function<Result<>(ImageInput&)>& read) {
  const std::string expected = format_of(extension);
  std::optional<Error> problem;
  if (!expected.empty() && !is_trusted(expected)) {
    problem = unreadable(fmt::format("pictures in the format {} are not read", expected));
  } else if (!expected.empty()) {
    auto done = decode_as(expected, bytes, extension, read);
    if (done) return done;
    problem = done.error();
  }
  // Wrong extensions are common. These formats are recognised by their first bytes and read from memory.
  struct Signature {
    const char* format;
    std::string_view first_bytes;
  };
  using namespace std::string_view_literals;
  constexpr std::array signatures = {
      Signature{"png", "\x89PNG"sv},     Signature{"jpeg", "\xff\xd8\xff"sv},
      Signature{"tiff", "II*\0"sv},      Signature{"tiff", "MM\0*"sv},
      Signature{"tiff", "II+\0"sv},      Signature{"tiff", "MM\0+"sv},
      Signature{"openexr", "v/1\x01"sv}, Signature{"bmp", "BM"sv},
      Signature{"gif", "GIF8"sv},        Signature{"hdr", "#?R"sv},
      Signature{"webp", "RIFF"sv},
  };
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const Signature& signature : signatures) {
    if (signature.format == expected || !text.starts_with(signature.first_bytes)) continue;
    auto done = decode_as(signature.format, bytes, signature.format, read);
    // The first bytes are better evidence than the extension, so this decoder's error is the useful one.
    if (done) return done;
    problem = done.error();
  }
  return problem.value_or(unreadable("the file is in no picture format that OpenImageIO knows"));
}

Result<> read_bands(ImageInput& input, int smallest_side, const std::function<Result<>(const Band&)>& take) {
  const ImageSpec spec = input.spec();
  if (auto fits = usable(spec, smallest_side); !fits) return fits;
  const bool tiled = spec.tile_width > 0;
  const long long samples_per_row = static_cast<long long>(spec.width) * spec.nchannels;
  const int rows =
      tiled ? spec.tile_height : static_cast<int>(std::clamp(samples_per_band / samples_per_row, 1LL, 64LL));
  std::vector<float> band(static_cast<std::size_t>(samples_per_row * std::min(rows, spec.height)));
  for (int top = 0; top < spec.height; top += rows) {
    const int count = std::min(rows, spec.height - top);
    const int first = spec.y + top, last = first + count;
    const bool read = tiled
                          ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, first, last, 0, 1, 0, spec.nchannels,
                                             OIIO::TypeFloat, band.data())
                          : input.read_scanlines(0, 0, first, last, 0, 0, spec.nchannels, OIIO::TypeFloat, band.data());
    // A decoder that fills a gap in the data returns true and leaves a message.
    if (!read || input.has_error())
      return unreadable("the picture cannot be read: " +
                        words_of(input.geterror(), "the file ends before its pixels do"));
    for (float& value : band) value = value > 0 ? std::min(value, 1.0f) : 0.0f;
    if (auto taken = take({top, count, band}); !taken) return taken;
  }
  return {};
}

}  // namespace wale::decoder
