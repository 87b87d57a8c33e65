#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace wale::decoder {

/// A file that `fopen` finds under `name` while this object lives, though no disk has it. Some of OpenImageIO's
/// decoders (SGI, FITS, RLA) only read files by name, and the sandbox has none. One at a time, in one thread.
class FileInMemory {
 public:
  FileInMemory(const std::string& name, std::span<const std::byte> bytes);
  ~FileInMemory();
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;
};

}  // namespace wale::decoder
