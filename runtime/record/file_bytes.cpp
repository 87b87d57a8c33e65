#include "runtime/record/file_bytes.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace wale {

Result<FileBytes> FileBytes::map(const std::string& path) {
  const auto unreadable = [&](int error) {
    return Error{.code = Code::unreadable_file,
                 .sentence = "the file cannot be read: " + std::generic_category().message(error),
                 .place = {.name = path}};
  };
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return unreadable(errno);
  struct stat status {};
  int error = fstat(file, &status) != 0  ? errno
              : S_ISDIR(status.st_mode)  ? EISDIR
              : !S_ISREG(status.st_mode) ? EINVAL
                                         : 0;
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
  if (error != 0) return unreadable(error);
  return bytes;
}

FileBytes::~FileBytes() {
  if (mapped_.data() != nullptr) munmap(const_cast<std::byte*>(mapped_.data()), mapped_.size());
}

}  // namespace wale
