#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/record/format.hpp"
#include "wale/program.hpp"

namespace wale {

/// A recording's file as it grows: chunks one after the other, each mapped for itself. What is stored in a mapped chunk
/// is in the file whatever becomes of the process.
class ChunkFile {
 public:
  /// A new file. Throws a `Refusal` when there is one already, or none can be made.
  explicit ChunkFile(std::string path);
  ~ChunkFile();
  ChunkFile(const ChunkFile&) = delete;
  ChunkFile& operator=(const ChunkFile&) = delete;

  /// One more chunk, whose blocks on the disk are its own already and whose every page has been written once, so that
  /// storing in it asks the system for nothing. (A page that the kernel has written out meanwhile is write-protected,
  /// and the next store into it traps once.) Throws a `Refusal` when the disk is full. From any thread.
  std::byte* grow(recording_format::ChunkKind kind, std::uint64_t number);
  static void unmap(std::byte* chunk) noexcept;

  /// Cuts off the last `unused` chunks of ticks, as far as nothing lies behind them. Nobody has them mapped.
  void cut(std::size_t unused) noexcept;

 private:
  std::string path_;
  int file_ = -1;
  std::mutex mutex_;
  std::vector<recording_format::ChunkKind> chunks_;
};

}  // namespace wale
