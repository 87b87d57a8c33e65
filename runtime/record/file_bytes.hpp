#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "schema/result.hpp"

namespace wale {

/// Bytes to read from: a mapped file, or bytes in memory.
class FileBytes {
 public:
  FileBytes() = default;
  explicit FileBytes(std::vector<std::byte> bytes) : held_(std::move(bytes)) {}
  /// Error: `unreadable_file`.
  static Result<FileBytes> map(const std::string& path);
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
