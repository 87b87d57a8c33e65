// Arrays and waves: two counts, then the cells.
#include <fmt/format.h>

#include <algorithm>

#include "wale/thesis_files.hpp"

namespace wale {
namespace {

constexpr std::size_t header = 4;  // bytes

Error damaged(const std::string& name, std::size_t byte, std::string sentence, std::string mend, std::string expected,
              std::string found) {
  return {.code = Code::damaged_file,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = name, .number = byte},
          .expected = std::move(expected),
          .found = std::move(found)};
}

}  // namespace

Result<ThesisArray> read_thesis_array(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() < header)
    return damaged(name, bytes.size(),
                   fmt::format("expected the width and the height of an array in 4 bytes, found a file of {}", bytes.size()),
                   "copy the file again as it is, without a conversion of text", "4 bytes or more",
                   fmt::format("{} bytes", bytes.size()));
  const auto count = [&](std::size_t at) {
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[at]) << 8 | std::to_integer<unsigned>(bytes[at + 1]));
  };
  ThesisArray array{count(0), count(2), {}};
  for (const auto& [what, value, at] : {std::tuple("wide", array.width, 0u), std::tuple("high", array.height, 2u)})
    if (value == 0)
      return damaged(name, at, fmt::format("expected an array that is 1 cell {} or more, found 0", what),
                     "a file of the thesis counts its cells from one: this is another kind of file", "1 or more", "0");
  const std::size_t cells = std::size_t{array.width} * array.height, expected = cells + header;
  if (bytes.size() != expected)
    return damaged(name, std::min(bytes.size(), expected),
                   fmt::format("expected {} bytes for {} by {} cells, found {}", expected, array.width, array.height, bytes.size()),
                   bytes.size() < expected ? "the file is cut short, or is no array: copy it again"
                                           : "the file is longer than its array, or is no array: copy its data fork alone",
                   fmt::format("{} bytes", expected), fmt::format("{} bytes", bytes.size()));
  array.cells.resize(cells);
  std::ranges::transform(bytes.subspan(header), array.cells.begin(), [](std::byte each) { return std::to_integer<std::uint8_t>(each); });
  return array;
}

Result<std::vector<std::byte>> write_thesis_array(const ThesisArray& array) {
  const std::size_t cells = std::size_t{array.width} * array.height;
  if (cells == 0 || array.cells.size() != cells)
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("expected {} cells for {} by {}, found {}", cells, array.width, array.height, array.cells.size()),
                 .mend = "an array has 1 to 65535 cells in each direction",
                 .place = {.name = "cells"}};
  std::vector<std::byte> bytes;
  bytes.reserve(cells + header);
  for (const std::uint16_t count : {array.width, array.height}) {
    bytes.push_back(static_cast<std::byte>(count >> 8));
    bytes.push_back(static_cast<std::byte>(count & 0xff));
  }
  for (const std::uint8_t cell : array.cells) bytes.push_back(std::byte{cell});
  return bytes;
}

}  // namespace wale
