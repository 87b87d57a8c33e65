#include "compiler/text/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <streambuf>
#include <string_view>
#include <system_error>
#include <utility>

#include "compiler/text/standard_output.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_size = 1 << 16;
constexpr int most_links = 40;  // as the kernel follows

Error unwritable(const std::string& path, const std::string& why, const std::string& mend = {}) {
  return {.code = Code::unwritable_file,
          .sentence = fmt::format("cannot write this file: {}", why),
          .mend = mend,
          .place = {.name = path}};
}

Error unwritable(const std::string& path, int error) {
  return unwritable(path, std::generic_category().message(error));
}

std::optional<struct stat> status_of(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

/// The file that a link leads to at last, whether or not it exists.
fs::path followed(fs::path path) {
  std::error_code error;
  for (int links = 0; links < most_links && fs::is_symlink(fs::symlink_status(path, error)); ++links) {
    const fs::path next = fs::read_symlink(path, error);
    if (error) break;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return path;
}

/// The descriptor that a name such as /dev/stdout or /dev/fd/3 stands for. It is written where it stands, since opening
/// the name would begin again at the first byte.
std::optional<int> named_descriptor(const std::string& path) {
  const std::string name = fs::path(path).lexically_normal().string();
  if (name == "-" || name == "/dev/stdout") return STDOUT_FILENO;
  if (name == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!name.starts_with(folder)) continue;
    int descriptor = 0;
    const char* end = name.data() + name.size();
    const auto read = std::from_chars(name.data() + folder.size(), end, descriptor);
    if (read.ec == std::errc() && read.ptr == end) return descriptor;
  }
  return std::nullopt;
}

bool is_one_of(const struct stat& output, const InputFiles& inputs) {
  return std::ranges::any_of(inputs, [&](const std::string& input) {
    const auto status = status_of(input);
    return status && status->st_dev == output.st_dev && status->st_ino == output.st_ino;
  });
}

}  // namespace

/// The bytes on their way to a descriptor. It remembers the first failure and takes no more from then on. Those to
/// standard output follow what was printed before, and their failure is told with that of everything else there.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
  }
  int error() const { return error_; }

 protected:
  int_type overflow(int_type next) override {
    if (sync() != 0) return traits_type::eof();
    if (!traits_type::eq_int_type(next, traits_type::eof())) sputc(traits_type::to_char_type(next));
    return traits_type::not_eof(next);
  }

  int sync() override {
    const char* from = pbase();
    if (descriptor_ == STDOUT_FILENO) {
      write_standard_output({from, static_cast<std::size_t>(pptr() - from)});
      from = pptr();
    }
    while (error_ == 0 && from < pptr()) {
      const ssize_t written = ::write(descriptor_, from, static_cast<std::size_t>(pptr() - from));
      if (written > 0) from += written;
      if (written < 0 && errno != EINTR) error_ = errno;
      if (written == 0) error_ = EIO;
    }
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return error_ == 0 ? 0 : -1;
  }

 private:
  int descriptor_;
  int error_ = 0;
  std::array<char, buffer_size> buffer_;
};

namespace {

/// The name by which this process can link a file that has none.
std::string name_of(int descriptor) { return fmt::format("/proc/self/fd/{}", descriptor); }

struct TemporaryFile {
  int descriptor;
  std::string name;  ///< empty as long as the file has none
};

/// Calls a function with names of temporary files in a folder, until it succeeds with one that was free: the name, or
/// an empty text, with `errno`.
template <class Make>
std::string first_free(const fs::path& folder, Make make) {
  for (unsigned number = 0;; ++number) {
    const std::string name = (folder / fmt::format(".wale-{}-{}", getpid(), number)).string();
    if (make(name.c_str())) return name;
    if (errno != EEXIST || number >= 1000) return {};
  }
}

/// A new file in a folder, with the permissions that the user's mask gives new files. Where the file system can, it has
/// no name until it is whole: then nothing of it is left behind, even if this process is killed.
Result<TemporaryFile> make_temporary(const fs::path& folder, const std::string& path) {
  const std::string place = folder.empty() ? "." : folder.string();
  if (const int nameless = ::open(place.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666); nameless >= 0) {
    if (access(name_of(nameless).c_str(), F_OK) == 0) return TemporaryFile{nameless, {}};
    close(nameless);  // without /proc it could not be named later
  }
  int descriptor = -1;
  const std::string name = first_free(folder, [&](const char* free) {
    descriptor = ::open(free, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return descriptor >= 0;
  });
  if (!name.empty()) return TemporaryFile{descriptor, name};
  if (errno == ENOENT) return unwritable(path, "there is no such folder", "make it first");
  return unwritable(path, errno);
}

}  // namespace

class OutputFile::Target {
 public:
  /// A stream: `final` is empty. Otherwise the file, called `temporary` or nothing yet, becomes `final` at the end.
  Target(std::string path, int descriptor, std::string temporary, fs::path final)
      : path_(std::move(path)),
        descriptor_(descriptor),
        temporary_(std::move(temporary)),
        final_(std::move(final)),
        buffer_(descriptor),
        stream_(&buffer_) {}
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  ~Target() {
    if (descriptor_ != STDOUT_FILENO) close(descriptor_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
  }

  std::ostream& stream() { return stream_; }

  Result<> finish() {
    stream_.flush();
    if (buffer_.error() != 0) return unwritable(path_, buffer_.error());
    if (final_.empty()) return {};
    if (fsync(descriptor_) != 0) return unwritable(path_, errno);
    // A link cannot take the place of another file, so the file has a temporary name for a moment.
    if (temporary_.empty())
      temporary_ = first_free(final_.parent_path(), [&](const char* free) {
        return linkat(AT_FDCWD, name_of(descriptor_).c_str(), AT_FDCWD, free, AT_SYMLINK_FOLLOW) == 0;
      });
    if (temporary_.empty()) return unwritable(path_, errno);
    if (std::rename(temporary_.c_str(), final_.c_str()) != 0) return unwritable(path_, errno);
    temporary_.clear();
    sync_folder();
    return {};
  }

 private:
  /// So that the name, too, outlives a failure of power. Where a file system cannot, the file itself is whole.
  void sync_folder() const {
    const fs::path folder = final_.has_parent_path() ? final_.parent_path() : fs::path(".");
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    fsync(descriptor);
    close(descriptor);
  }

  std::string path_;
  int descriptor_;
  std::string temporary_;
  fs::path final_;
  DescriptorBuffer buffer_;
  std::ostream stream_;
};

OutputFile::OutputFile(std::unique_ptr<Target> target) : target_(std::move(target)) {}
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

Result<OutputFile> OutputFile::open(const std::string& path, const InputFiles& inputs) {
  if (const auto open = named_descriptor(path)) {
    const int descriptor = *open == STDOUT_FILENO ? STDOUT_FILENO : fcntl(*open, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (descriptor < 0) return unwritable(path, errno);
    return OutputFile(std::make_unique<Target>(path, descriptor, "", fs::path()));
  }
  if (path.empty()) return unwritable(path, ENOENT);
  const auto status = status_of(path);
  if (status && S_ISDIR(status->st_mode)) return unwritable(path, EISDIR);
  if (status && S_ISREG(status->st_mode) && is_one_of(*status, inputs))
    return Error{.code = Code::output_is_input,
                 .sentence = "this file is read by the same command, so it is not written",
                 .mend = "name another file to write",
                 .place = {.name = path}};
  if (status && !S_ISREG(status->st_mode)) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) return unwritable(path, errno);
    return OutputFile(std::make_unique<Target>(path, descriptor, "", fs::path()));
  }
  if (status && access(path.c_str(), W_OK) != 0) return unwritable(path, errno);

  const fs::path final = followed(path);
  auto temporary = make_temporary(final.parent_path(), path);
  if (!temporary) return temporary.error();
  auto target = std::make_unique<Target>(path, temporary->descriptor, temporary->name, final);
  if (status) {
    // The owner stays if that is allowed; the permissions must.
    if (fchown(temporary->descriptor, status->st_uid, status->st_gid) != 0) errno = 0;
    if (fchmod(temporary->descriptor, status->st_mode & 07777) != 0) return unwritable(path, errno);
  }
  return OutputFile(std::move(target));
}

std::ostream& OutputFile::stream() { return target_->stream(); }
Result<> OutputFile::finish() { return target_->finish(); }

bool is_written_as_it_comes(const std::string& path) {
  std::error_code ignored;
  return path == "-" || fs::is_other(path, ignored);
}

bool is_same_output(const std::string& one, const std::string& other) {
  const auto place = [](const std::string& path) {
    std::error_code error;
    const fs::path file = fs::absolute(followed(path), error);
    const fs::path folder = fs::weakly_canonical(file.parent_path(), error);
    return error ? file : folder / file.filename();
  };
  return one == other || place(one) == place(other);
}

Result<> write_file(const std::string& path, std::string_view bytes, const InputFiles& inputs) {
  auto file = OutputFile::open(path, inputs);
  if (!file) return file.error();
  file->stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file->finish();
}

Result<> replace_file(const std::string& path, std::string_view bytes) {
  const auto status = status_of(path);
  if (!status) return unwritable(path, errno);
  if (!S_ISREG(status->st_mode)) return unwritable(path, "it is not a regular file");
  return write_file(path, bytes, {});
}

}  // namespace wale
