#include "compiler/text/replace_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace wale {
namespace {

namespace fs = std::filesystem;

/// A temporary file beside another. The destructor removes it unless it was renamed.
class Temporary {
 public:
  explicit Temporary(const fs::path& beside)
      : name_((beside.parent_path() / ("." + beside.filename().string() + ".XXXXXX")).string()),
        descriptor_(mkstemp(name_.data())) {}
  ~Temporary() {
    if (descriptor_ >= 0) close(descriptor_);
    if (descriptor_ >= 0 && !kept_) unlink(name_.c_str());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  bool open() const { return descriptor_ >= 0; }

  bool write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }

  /// Copies the owner, if that is allowed, and the permissions; false if the permissions cannot be copied.
  bool take_permissions_of(const struct stat& other) {
    if (fchown(descriptor_, other.st_uid, other.st_gid) != 0) errno = 0;
    return fchmod(descriptor_, other.st_mode & 07777) == 0;
  }

  bool rename_to(const fs::path& path) {
    kept_ = fsync(descriptor_) == 0 && std::rename(name_.c_str(), path.c_str()) == 0;
    return kept_;
  }

 private:
  std::string name_;
  int descriptor_ = -1;
  bool kept_ = false;
};

Error unwritable(const std::string& path, const std::string& why) {
  return {.code = Code::unwritable_file,
          .sentence = fmt::format("cannot write this file: {}", why),
          .place = {.name = path}};
}

}  // namespace

Result<> replace_file(const std::string& path, std::string_view bytes) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  if (error) return unwritable(path, error.message());
  struct stat status {};
  if (stat(target.c_str(), &status) != 0) return unwritable(path, std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return unwritable(path, "it is not a regular file");
  if (access(target.c_str(), W_OK) != 0) return unwritable(path, std::strerror(errno));
  Temporary temporary(target);
  if (!temporary.open() || !temporary.write(bytes) || !temporary.take_permissions_of(status) ||
      !temporary.rename_to(target))
    return unwritable(path, std::strerror(errno));
  return {};
}

}  // namespace wale
