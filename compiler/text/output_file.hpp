#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// The paths of the files that a command reads, found or not. None of them may be written by the same command.
using InputFiles = std::vector<std::string>;

/// A file being written: a reader meanwhile, or after a crash, finds the old file or the new one, and a full disk keeps
/// the old one. Its permissions stay; a link stays a link, and the file that it leads to is replaced.
///
/// "-", names of open descriptors (/dev/stdout, /dev/fd/3), and files that are not regular (a FIFO, a terminal) are
/// streams: their bytes go out as they come. Whether standard output took them, `finish_standard_output` tells. One
/// thread at a time.
class OutputFile {
 public:
  /// Errors: W0505 where the file cannot be written or is a folder; W0508 where it is one of `inputs`, by whatever
  /// name or link.
  static Result<OutputFile> open(const std::string& path, const InputFiles& inputs);

  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) noexcept;
  /// Without `finish`, a regular file stays as it was.
  ~OutputFile();

  /// Takes the content; its failure is told by `finish`.
  std::ostream& stream();
  /// Writes what is left, waits until the disk has it, and puts the file in its place. Call it once. Error: W0505.
  Result<> finish();

 private:
  class Target;
  explicit OutputFile(std::unique_ptr<Target> target);
  std::unique_ptr<Target> target_;
};

/// Whether two names stand for one file to write, by whatever links, whether or not it exists yet. Names of streams are
/// equal only if they are spelt alike.
bool is_same_output(const std::string& one, const std::string& other);

/// Whether an output is written as it comes, because it is "-" or something that is no regular file: a pipe, a device.
/// The ending of such a name says nothing about a format.
bool is_written_as_it_comes(const std::string& path);

/// Writes a whole file. Errors: those of `OutputFile::open` and `OutputFile::finish`.
Result<> write_file(const std::string& path, std::string_view bytes, const InputFiles& inputs);

/// Replaces the content of a file that was read, as a formatter does. Errors: W0505, also where the file is missing,
/// not regular or not writable.
Result<> replace_file(const std::string& path, std::string_view bytes);

}  // namespace wale
