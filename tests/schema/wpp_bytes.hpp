#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "wale/patch_program.hpp"

/// A second reader and writer of `.wpp` files for tests. It follows schema/PATCH_PROGRAM.md and shares no code with
/// schema/.
namespace wale::wpp {

using Bytes = std::vector<std::byte>;

struct Section {
  std::string kind;
  std::uint32_t flags = 0;
  Bytes content;
};

inline std::uint64_t get(const Bytes& bytes, std::size_t at, int size) {
  std::uint64_t value = 0;
  for (int i = size; i-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(bytes.at(at + i));
  return value;
}

inline void put(Bytes& bytes, std::size_t at, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.at(at + i) = static_cast<std::byte>(value >> 8 * i & 0xff);
}

inline void append(Bytes& bytes, std::uint64_t value, int size) {
  bytes.resize(bytes.size() + size);
  put(bytes, bytes.size() - size, value, size);
}

inline void append_text(Bytes& bytes, std::string_view text) {
  append(bytes, text.size(), 4);
  for (const char c : text) append(bytes, static_cast<unsigned char>(c), 1);
}

/// CRC-32, computed bit by bit. The four bytes of the checksum, at 24, count as zero.
inline std::uint32_t crc(const Bytes& bytes) {
  std::uint32_t remainder = 0xffffffff;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    remainder ^= i >= 24 && i < 28 ? 0 : std::to_integer<std::uint32_t>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? 0xedb88320 : 0);
  }
  return ~remainder;
}

/// The bytes with the checksum corrected.
inline Bytes sealed(Bytes bytes) {
  put(bytes, 24, crc(bytes), 4);
  return bytes;
}

inline std::vector<Section> sections_of(const Bytes& file) {
  std::vector<Section> sections;
  for (std::uint64_t i = 0; i < get(file, 12, 4); ++i) {
    const std::size_t entry = 32 + 24 * i;
    Section section;
    for (int c = 0; c < 4; ++c) section.kind += static_cast<char>(file[entry + c]);
    section.flags = static_cast<std::uint32_t>(get(file, entry + 4, 4));
    const auto first = file.begin() + static_cast<std::ptrdiff_t>(get(file, entry + 8, 8));
    section.content.assign(first, first + static_cast<std::ptrdiff_t>(get(file, entry + 16, 8)));
    sections.push_back(section);
  }
  return sections;
}

inline Bytes file_of(const std::vector<Section>& sections) {
  Bytes file;
  for (const int byte : {0x89, 0x57, 0x50, 0x50, 0x0d, 0x0a, 0x1a, 0x0a}) append(file, byte, 1);
  append(file, 1, 2);
  append(file, 2, 2);
  append(file, sections.size(), 4);
  append(file, 0, 8);
  append(file, 0, 4);
  append(file, 0, 4);
  std::size_t offset = 32 + 24 * sections.size();
  for (const Section& section : sections) {
    for (const char c : section.kind) append(file, static_cast<unsigned char>(c), 1);
    append(file, section.flags, 4);
    append(file, offset, 8);
    append(file, section.content.size(), 8);
    offset += (section.content.size() + 7) / 8 * 8;
  }
  for (const Section& section : sections) {
    file.insert(file.end(), section.content.begin(), section.content.end());
    file.resize((file.size() + 7) / 8 * 8);
  }
  put(file, 16, file.size(), 8);
  return sealed(file);
}

}  // namespace wale::wpp
