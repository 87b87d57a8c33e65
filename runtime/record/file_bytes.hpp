#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "schema/patch_program.hpp"

namespace wale {

/// Bytes to read from: a mapped file's, or some at hand.
class FileBytes {
 public:
  FileBytes() = default;
  explicit FileBytes(std::vector<std::byte> bytes) : held_(std::move(bytes)) {}
  /// Refused when the file cannot be read.
  static std::variant<FileBytes, Refusal> map(const std::string& path);
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept { *this = std::move(other); }
  FileBytes& operator=(FileBytes&& other) noexcept {
    std::swap(mapped_, other.mapped_);
    std::swap(held_, other.held_);
    return *this;
  }

  std::span<const std::byte> span() const { return mapped_.data() != nullptr ? mapped_ : held_; }

 private:
  std::span<const std::byte> mapped_;
  std::vector<std::byte> held_;
};

}  // namespace wale
