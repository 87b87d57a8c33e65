#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/record/format.hpp"
#include "schema/result.hpp"

namespace wale {

/// A recording's file as it grows: chunks one after the other, each mapped for itself. Bytes that are stored in a mapped
/// chunk are in the file even if the process is killed.
class ChunkFile {
 public:
  /// Makes a new file. Error: `unwritable_file`, also when there is a file of that name already.
  static Result<std::unique_ptr<ChunkFile>> create(const std::string& path);
  ~ChunkFile();
  ChunkFile(const ChunkFile&) = delete;
  ChunkFile& operator=(const ChunkFile&) = delete;

  /// One more chunk. Its blocks on the disk are allocated and each of its pages has been written once, so that storing
  /// in it asks the system for nothing. (A page that the kernel has written out meanwhile is write-protected, and the
  /// next store into it traps once.) Error: `unwritable_file`, when the disk is full. From any thread.
  Result<std::byte*> grow(recording_format::ChunkKind kind, std::uint64_t number);
  static void unmap(std::byte* chunk) noexcept;

  /// Cuts off the last `unused` chunks of ticks, as far as nothing lies behind them. They must not be mapped.
  void cut(std::size_t unused) noexcept;

 private:
  ChunkFile(std::string path, int file) : path_(std::move(path)), file_(file) {}

  std::string path_;
  int file_ = -1;
  std::mutex mutex_;
  std::vector<recording_format::ChunkKind> chunks_;
};

}  // namespace wale
