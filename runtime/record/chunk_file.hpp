#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/record/format.hpp"
#include "wale/result.hpp"

namespace wale {

/// A recording's file as it grows: chunks one after the other, each with its own mapping. Bytes that are stored in a
/// mapped chunk are in the file even if the process is killed. Until it is complete, nobody may write in it: a store
/// into a chunk that another program has cut off would end this process (SIGBUS).
class ChunkFile {
 public:
  /// Makes a new file. Error: `unwritable_file`, also when a file of that name exists already.
  static Result<std::unique_ptr<ChunkFile>> create(const std::string& path);
  ~ChunkFile();
  ChunkFile(const ChunkFile&) = delete;
  ChunkFile& operator=(const ChunkFile&) = delete;

  /// Appends a chunk. Its blocks on the disk are allocated and each of its pages has been written once, so that a store
  /// into it makes no system call. (A page that the kernel has written out meanwhile is write-protected, and the
  /// next store into it traps once.) Error: `unwritable_file`, when the disk is full. From any thread.
  Result<std::byte*> grow(recording_format::ChunkKind kind, std::uint64_t number);
  static void unmap(std::byte* chunk) noexcept;

  /// Whether the file is still what this process made: its name leads to it, and it has all its chunks. Error:
  /// `unwritable_file`, when another program has removed, renamed or cut it. From any thread.
  Result<> is_intact() const;

  /// Removes the file, if its name still leads to it.
  void remove() noexcept;

  /// Cuts off up to `unused` chunks of ticks at the file's end, stopping at the first chunk of events. The chunks cut
  /// off must not be mapped.
  void cut(std::size_t unused) noexcept;

 private:
  ChunkFile(std::string path, int file, unsigned permissions)
      : path_(std::move(path)), file_(file), permissions_(permissions) {}

  std::string path_;
  int file_ = -1;
  unsigned permissions_ = 0;  ///< that the complete file gets
  mutable std::mutex mutex_;
  std::vector<recording_format::ChunkKind> chunks_;
};

}  // namespace wale
