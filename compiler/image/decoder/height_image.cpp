#include "compiler/image/decoder/height_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/image/decoder/file_in_memory.hpp"
#include "compiler/image/decoder/sandbox.hpp"
#include "compiler/image/openimageio.hpp"

namespace wale::decoder {
namespace {

using OIIO::ImageBuf;
using OIIO::ImageInput;
using OIIO::ImageSpec;
namespace algorithm = OIIO::ImageBufAlgo;

// With one thread the order of additions, and so the last bit, is the same on every machine.
constexpr int threads = 1;
constexpr int most_channels = 64;
/// In one tile, which is decoded as a whole: the most pixels of a picture, in four channels.
constexpr long long most_samples_per_tile = 4 * most_image_pixels;
constexpr long long samples_per_band = 1 << 22;

/// Heights of 0 .. 1, one channel, rows from the top.
struct HeightField {
  int width = 0, height = 0;
  int orientation = 1;
  std::vector<float> heights;
};

/// OpenImageIO's message on one line, or `otherwise` if it gives none.
std::string words_of(std::string error, const std::string& otherwise) {
  const auto lines = OIIO::Strutil::splits(OIIO::Strutil::strip(error), "\n");
  const std::string words = OIIO::Strutil::join(lines, "; ");
  return words.empty() ? otherwise : words;
}

/// Which channels are summed into the height, with what weights; the other weights are zero.
std::vector<float> luminance_weights(const ImageSpec& spec) {
  constexpr std::array<float, 3> rec709 = {0.2126f, 0.7152f, 0.0722f};
  std::vector<float> weights(static_cast<std::size_t>(spec.nchannels), 0.0f);
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
  if (colours.size() < 3) {
    weights[static_cast<std::size_t>(colours[0])] = 1.0f;
    return weights;
  }
  const bool all_named = std::ranges::all_of(named, [](int channel) { return channel >= 0; });
  for (std::size_t i = 0; i < 3; ++i) weights[static_cast<std::size_t>(all_named ? named[i] : colours[i])] = rec709[i];
  return weights;
}

Error unreadable(std::string sentence) {
  return {Code::unreadable_image, std::move(sentence), "save it as PNG, TIFF, JPEG or EXR"};
}

Error of_wrong_size(std::string sentence) {
  return {Code::image_size, std::move(sentence),
          fmt::format("resize it to at least {0} x {0} pixels and at most {1} x {1}", smallest_image_side,
                      largest_image_side)};
}

/// Whether a picture can be used as heights, from what its header says.
Result<> usable(const ImageSpec& spec) {
  if (spec.deep) return unreadable("a deep image has no single height per pixel");
  if (spec.depth > 1) return unreadable("the image is a volume, and a height map has two dimensions");
  if (spec.width < smallest_image_side || spec.height < smallest_image_side)
    return of_wrong_size(fmt::format("the picture has {} x {} pixels, and heights need at least {} x {}", spec.width,
                                     spec.height, smallest_image_side, smallest_image_side));
  if (static_cast<long long>(spec.width) * spec.height > most_image_pixels)
    return of_wrong_size(fmt::format("the picture has {} x {} pixels, more than the {} that a patch can use",
                                     spec.width, spec.height, most_image_pixels));
  if (spec.nchannels < 1 || spec.nchannels > most_channels)
    return unreadable(
        fmt::format("the picture has {} channels, and 1 to {} can be read", spec.nchannels, most_channels));
  if (static_cast<long long>(spec.tile_width) * spec.tile_height > most_samples_per_tile / spec.nchannels)
    return of_wrong_size(fmt::format("the picture has tiles of {} x {} pixels, which are too large to read",
                                     spec.tile_width, spec.tile_height));
  return {};
}

/// Reads band by band, so that a large picture of many channels is never in memory as a whole.
Result<HeightField> read_luminance(ImageInput& input) {
  const ImageSpec spec = input.spec();
  if (auto fits = usable(spec); !fits) return fits.error();
  const std::vector<float> weights = luminance_weights(spec);
  HeightField field{spec.width, spec.height, spec.get_int_attribute("Orientation", 1), {}};
  field.heights.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));

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

    const ImageBuf source(ImageSpec(spec.width, count, spec.nchannels, OIIO::TypeFloat), band.data());
    float* row = &field.heights[static_cast<std::size_t>(top) * static_cast<std::size_t>(spec.width)];
    ImageBuf sum(ImageSpec(spec.width, count, 1, OIIO::TypeFloat), row);
    if (!algorithm::channel_sum(sum, source, weights, {}, threads))
      return unreadable("its channels cannot be summed into heights: " +
                        words_of(sum.geterror(), "OpenImageIO refused"));
  }
  return field;
}

Result<HeightField> decode_as(const std::string& format, std::span<const std::byte> bytes,
                              const std::string& extension) {
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
  auto field = read_luminance(*input);
  input->close();
  return field;
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

Result<HeightField> decode(std::span<const std::byte> bytes, const std::string& extension) {
  const std::string expected = format_of(extension);
  std::optional<Error> problem;
  if (!expected.empty() && !is_trusted(expected)) {
    problem = unreadable(fmt::format("pictures in the format {} are not read", expected));
  } else if (!expected.empty()) {
    auto field = decode_as(expected, bytes, extension);
    if (field) return field;
    problem = field.error();
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
    auto field = decode_as(signature.format, bytes, signature.format);
    // The first bytes are better evidence than the extension, so this decoder's error is the useful one.
    if (field) return field;
    problem = field.error();
  }
  return problem.value_or(unreadable("the file is in no picture format that OpenImageIO knows"));
}

HeightField field_of(const ImageBuf& buffer) {
  HeightField field{buffer.spec().width, buffer.spec().height, 1, {}};
  field.heights.resize(static_cast<std::size_t>(field.width) * static_cast<std::size_t>(field.height));
  buffer.get_pixels(buffer.roi(), OIIO::TypeFloat, field.heights.data());
  return field;
}

ImageBuf buffer_of(HeightField& field) {
  ImageSpec spec(field.width, field.height, 1, OIIO::TypeFloat);
  return ImageBuf(spec, field.heights.data());
}

/// Turned as the camera was held, which the file's orientation says.
HeightField upright(HeightField field) {
  if (field.orientation <= 1 || field.orientation > 8) return field;
  ImageBuf source = buffer_of(field);
  source.set_orientation(field.orientation);
  ImageBuf turned = algorithm::reorient(source, threads);
  return turned.has_error() ? field : field_of(turned);
}

/// Resized so that no side is longer than `largest_image_side`. The filter has no negative lobes: they would ring at a
/// step, and a ripple that the eye does not notice is felt.
HeightField fitted(HeightField field) {
  const int longest = std::max(field.width, field.height);
  if (longest <= largest_image_side) return field;
  const auto shrink = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(side) * largest_image_side / longest)));
  };
  const OIIO::ROI size(0, shrink(field.width), 0, shrink(field.height), 0, 1, 0, 1);
  const ImageBuf source = buffer_of(field);
  return field_of(algorithm::resize(source, "blackman-harris", 0.0f, size, threads));
}

/// Weights of a Gaussian centred on 0, with a standard deviation of `sigma` samples, cut at 4 standard deviations.
/// ImageBufAlgo::make_kernel("gaussian") is cut at 2, which makes it narrower than it says.
ImageBuf gaussian_row(double sigma, bool upright_row) {
  const int reach = std::max(1, static_cast<int>(std::ceil(4 * sigma)));
  const int length = 2 * reach + 1;
  ImageSpec spec(upright_row ? 1 : length, upright_row ? length : 1, 1, OIIO::TypeFloat);
  (upright_row ? spec.y : spec.x) = -reach;
  (upright_row ? spec.full_y : spec.full_x) = -reach;
  ImageBuf kernel(spec);
  for (int i = -reach; i <= reach; ++i) {
    const float weight = static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma)));
    kernel.setpixel(upright_row ? 0 : i, upright_row ? i : 0, OIIO::cspan<float>(weight));
  }
  return kernel;
}

HeightField smoothed(HeightField field, double sigma_x, double sigma_y) {
  const ImageBuf source = buffer_of(field);
  const ImageBuf across = algorithm::convolve(source, gaussian_row(sigma_x, false), true, {}, threads);
  return field_of(algorithm::convolve(across, gaussian_row(sigma_y, true), true, {}, threads));
}

HeightTable quantised(const HeightField& field) {
  HeightTable table{static_cast<std::uint32_t>(field.width), static_cast<std::uint32_t>(field.height), {}};
  table.heights.reserve(field.heights.size());
  for (float height : field.heights) {
    table.heights.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(height, 0.0f, 1.0f) * 65535.0)));
  }
  return table;
}

Result<HeightImage> heights_from(HeightField whole, double smooth_pixels) {
  whole = upright(std::move(whole));
  const double columns = whole.width, rows = whole.height;
  HeightField field = fitted(std::move(whole));
  if (std::min(field.width, field.height) < smallest_image_side)
    return of_wrong_size(fmt::format("the picture has {} x {} pixels, too long and narrow for heights", columns, rows));
  HeightImage image;
  image.pixels_per_column = columns / field.width;
  image.pixels_per_row = rows / field.height;
  if (smooth_pixels > 0) {
    const double sigma_x = smooth_pixels / image.pixels_per_column, sigma_y = smooth_pixels / image.pixels_per_row;
    if (std::max(sigma_x, sigma_y) > widest_smoothing)
      return Error{Code::unreadable_image,
                   fmt::format("the picture cannot be smoothed by {} pixels; {} is the most", smooth_pixels,
                               std::floor(widest_smoothing * image.pixels_per_column)),
                   "smooth less, or make the picture smaller first"};
    field = smoothed(std::move(field), sigma_x, sigma_y);
  }
  image.table = quantised(field);
  return image;
}

}  // namespace

void prepare() {
  OIIO::attribute("threads", threads);
  OIIO::attribute("exr_threads", -1);  // none besides the caller's
  // Our own limit is smaller, and its message says what to do.
  OIIO::attribute("limits:imagesize_MB", std::numeric_limits<int>::max());
  // A decoder loads what it needs when it is first made.
  for (const std::string_view format : trusted_formats) ImageInput::create(std::string(format));
  OIIO::geterror();
}

Result<HeightImage> height_image(std::span<const std::byte> bytes, const std::string& extension, double smooth_pixels) {
  try {
    auto field = decode(bytes, extension);
    if (!field) return field.error();
    return heights_from(*std::move(field), smooth_pixels);
  } catch (const std::bad_alloc&) {
    return unreadable(fmt::format("the picture needs more than {} MB of memory to decode", most_memory >> 20));
  } catch (const std::exception& exception) {  // a decoder's own
    return unreadable(std::string("the picture cannot be read: ") + exception.what());
  }
}

}  // namespace wale::decoder
