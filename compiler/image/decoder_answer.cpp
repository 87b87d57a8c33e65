#include "compiler/image/decoder_answer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace wale {
namespace {

constexpr std::uint32_t answer_mark = 0x52444157;  // "WADR" in memory
constexpr std::size_t longest_text = 1000;

enum class Kind : std::uint32_t { heights = 1, unreadable_image, image_size, no_sandbox, colours };

/// How an answer begins. Heights or colours follow, row by row, or the two texts. Decoder and reader run on the same
/// machine, so the order of bytes is its own.
struct AnswerHeader {
  std::uint32_t mark = answer_mark;
  Kind kind = Kind::heights;
  std::uint32_t columns = 0, rows = 0;
  double pixels_per_column = 1, pixels_per_row = 1;
  std::uint32_t sentence_bytes = 0, mend_bytes = 0;
};
static_assert(sizeof(AnswerHeader) == 40);

void append(std::vector<std::byte>& bytes, const void* from, std::size_t count) {
  const auto* first = static_cast<const std::byte*>(from);
  bytes.insert(bytes.end(), first, first + count);
}

/// Printable ASCII: the text may come from a hostile file and go to a terminal.
std::string printable(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    const auto c = std::to_integer<unsigned char>(byte);
    text += c >= 0x20 && c < 0x7f ? static_cast<char>(c) : '?';
  }
  return text;
}

bool is_side(std::uint32_t side, std::uint32_t smallest) { return side >= smallest && side <= largest_image_side; }

bool is_reduction(double pixels_per_sample) {
  return pixels_per_sample >= 1 && pixels_per_sample <= static_cast<double>(most_image_pixels);
}

/// The samples of a picture, which are all that stands behind its header.
template <class Sample>
std::optional<std::vector<Sample>> read_samples(const AnswerHeader& header, std::span<const std::byte> rest,
                                                std::uint32_t smallest_side) {
  if (!is_side(header.columns, smallest_side) || !is_side(header.rows, smallest_side)) return std::nullopt;
  if (header.sentence_bytes != 0 || header.mend_bytes != 0) return std::nullopt;
  if (!is_reduction(header.pixels_per_column) || !is_reduction(header.pixels_per_row)) return std::nullopt;
  const std::size_t count = std::size_t{header.columns} * header.rows;
  if (rest.size() != count * sizeof(Sample)) return std::nullopt;
  std::vector<Sample> samples(count);
  std::memcpy(samples.data(), rest.data(), rest.size());
  return samples;
}

std::optional<Error> read_error(const AnswerHeader& header, std::span<const std::byte> rest) {
  Error error;
  switch (header.kind) {
    case Kind::unreadable_image: error.code = Code::unreadable_image; break;
    case Kind::image_size: error.code = Code::image_size; break;
    case Kind::no_sandbox: error.code = Code::no_sandbox; break;
    default: return std::nullopt;
  }
  if (header.sentence_bytes == 0 || header.sentence_bytes > longest_text || header.mend_bytes > longest_text ||
      rest.size() != header.sentence_bytes + header.mend_bytes)
    return std::nullopt;
  error.sentence = printable(rest.first(header.sentence_bytes));
  error.mend = printable(rest.subspan(header.sentence_bytes));
  return error;
}

/// The header of an answer; empty where the bytes do not begin with one.
std::optional<AnswerHeader> header_of(std::span<const std::byte> bytes) {
  AnswerHeader header;
  if (bytes.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof header);
  return header.mark == answer_mark ? std::optional(header) : std::nullopt;
}

template <class List>
std::vector<std::byte> write_samples(const AnswerHeader& header, const List& samples) {
  const std::size_t count = samples.size() * sizeof *samples.data();
  std::vector<std::byte> bytes;
  bytes.reserve(sizeof header + count);
  append(bytes, &header, sizeof header);
  append(bytes, samples.data(), count);
  return bytes;
}

std::vector<std::byte> write_error(const Error& error) {
  AnswerHeader header;
  std::vector<std::byte> bytes;
  header.kind = error.code == Code::image_size   ? Kind::image_size
                : error.code == Code::no_sandbox ? Kind::no_sandbox
                                                 : Kind::unreadable_image;
  const std::string sentence = error.sentence.substr(0, longest_text), mend = error.mend.substr(0, longest_text);
  header.sentence_bytes = static_cast<std::uint32_t>(sentence.size());
  header.mend_bytes = static_cast<std::uint32_t>(mend.size());
  append(bytes, &header, sizeof header);
  append(bytes, sentence.data(), sentence.size());
  append(bytes, mend.data(), mend.size());
  return bytes;
}

}  // namespace

std::vector<std::string> DecoderArguments::words() const {
  char smooth[64];
  const auto end = std::to_chars(smooth, smooth + sizeof smooth, smooth_pixels).ptr;  // the shortest that reads back
  return {extension, std::string(smooth, end), sandbox == Sandbox::required ? "required" : "if-possible",
          samples == Samples::heights ? "heights" : "colours"};
}

std::optional<DecoderArguments> DecoderArguments::read(std::span<const char* const> words) {
  if (words.size() != 4) return std::nullopt;
  DecoderArguments arguments{words[0], 0, Sandbox::required};
  const char* end = words[1] + std::strlen(words[1]);
  const auto read = std::from_chars(words[1], end, arguments.smooth_pixels);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  if (std::strcmp(words[2], "if-possible") == 0)
    arguments.sandbox = Sandbox::if_possible;
  else if (std::strcmp(words[2], "required") != 0)
    return std::nullopt;
  if (std::strcmp(words[3], "colours") == 0)
    arguments.samples = Samples::colours;
  else if (std::strcmp(words[3], "heights") != 0)
    return std::nullopt;
  return arguments;
}

std::vector<std::byte> write_answer(const Result<HeightImage>& image) {
  if (!image) return write_error(image.error());
  return write_samples({answer_mark, Kind::heights, image->table.width, image->table.height, image->pixels_per_column,
                        image->pixels_per_row, 0, 0},
                       image->table.heights);
}

std::vector<std::byte> write_colour_answer(const Result<ColourImage>& image) {
  if (!image) return write_error(image.error());
  return write_samples(
      {answer_mark, Kind::colours, image->width, image->height, image->pixels_per_column, image->pixels_per_row, 0, 0},
      image->pixels);
}

std::optional<Result<HeightImage>> read_answer(std::span<const std::byte> bytes) {
  const auto header = header_of(bytes);
  if (!header) return std::nullopt;
  const auto rest = bytes.subspan(sizeof *header);
  if (header->kind == Kind::heights) {
    auto heights = read_samples<std::uint16_t>(*header, rest, smallest_image_side);
    if (!heights) return std::nullopt;
    return HeightImage{
        {header->columns, header->rows, *std::move(heights)}, header->pixels_per_column, header->pixels_per_row};
  }
  auto error = read_error(*header, rest);
  return error ? std::optional(Result<HeightImage>(*std::move(error))) : std::nullopt;
}

std::optional<Result<ColourImage>> read_colour_answer(std::span<const std::byte> bytes) {
  const auto header = header_of(bytes);
  if (!header) return std::nullopt;
  const auto rest = bytes.subspan(sizeof *header);
  if (header->kind == Kind::colours) {
    auto pixels = read_samples<std::uint32_t>(*header, rest, 1);
    if (!pixels) return std::nullopt;
    return ColourImage{header->columns, header->rows, *std::move(pixels), header->pixels_per_column,
                       header->pixels_per_row};
  }
  auto error = read_error(*header, rest);
  return error ? std::optional(Result<ColourImage>(*std::move(error))) : std::nullopt;
}

}  // namespace wale
