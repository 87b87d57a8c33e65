#include "runtime/record/file_bytes.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "schema/regular_file.hpp"

namespace wale {

Result<FileBytes> FileBytes::map(const std::string& path) {
  const auto opened = open_regular_file(path);
  if (!opened) {
    Error error = opened.error();
    error.sentence = "the file cannot be read: " + error.sentence;
    return error;
  }
  const int file = *opened;
  struct stat status {};
  int error = fstat(file, &status) != 0 ? errno : 0;
  FileBytes bytes;
  if (error == 0 && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* mapped = mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0);
    if (mapped == MAP_FAILED)
      error = errno;
    else
      bytes.mapped_ = {static_cast<const std::byte*>(mapped), size};
  }
  close(file);
  if (error == 0) return bytes;
  return Error{.code = Code::unreadable_file,
               .sentence = "the file cannot be read: " + std::generic_category().message(error),
               .place = {.name = path}};
}

FileBytes::~FileBytes() {
  if (mapped_.data() != nullptr) munmap(const_cast<std::byte*>(mapped_.data()), mapped_.size());
}

}  // namespace wale
