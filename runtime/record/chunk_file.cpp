#include "runtime/record/chunk_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "schema/name_text.hpp"

namespace wale {
namespace {

using namespace recording_format;

constexpr std::size_t least_page = 4096;
constexpr mode_t read_only = 0444, all_permissions = 07777;

/// While it exists, a file that this thread would make larger than the process may (RLIMIT_FSIZE) is EFBIG, and not the
/// signal that ends the process.
class SizeIsAnError {
 public:
  SizeIsAnError() {
    sigemptyset(&signal_), sigaddset(&signal_, SIGXFSZ);
    sigset_t waiting;
    was_waiting_ = sigpending(&waiting) == 0 && sigismember(&waiting, SIGXFSZ) == 1;
    pthread_sigmask(SIG_BLOCK, &signal_, &before_);
  }
  ~SizeIsAnError() {
    constexpr timespec at_once{0, 0};
    if (!was_waiting_) sigtimedwait(&signal_, nullptr, &at_once);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  SizeIsAnError(const SizeIsAnError&) = delete;
  SizeIsAnError& operator=(const SizeIsAnError&) = delete;

 private:
  sigset_t signal_, before_;
  bool was_waiting_ = false;
};

/// Why nothing can be recorded in the file, and what to do about it.
Error unwritable(const std::string& path, int error) {
  const auto because = [&](const std::string& reason, const std::string& mend) {
    return Error{.code = Code::unwritable_file, .sentence = reason, .mend = mend, .place = {.name = path}};
  };
  switch (error) {
    case EEXIST: {
      struct stat there {};
      if (lstat(path.c_str(), &there) == 0 && S_ISDIR(there.st_mode))
        return because("this is a folder", "name a new file in it, as in `" + path + "/run.wrec`");
      if (lstat(path.c_str(), &there) == 0 && S_ISLNK(there.st_mode) && stat(path.c_str(), &there) != 0)
        return because("this is a link to a file that does not exist", "name that file itself, or remove the link");
      if (stat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode))
        return because("this is a device or a pipe, and a recording is a regular file",
                       "name a file that does not exist yet");
      return because("the file exists already, and a recording never overwrites a file",
                     "delete it or choose another name");
    }
    case ENOENT: return because("there is no such folder", "make it first");
    case EACCES:
    case EROFS: return because("no file can be written in this folder", "choose another folder");
    case EFBIG:
      return because("the file would exceed the limit on its size (ulimit -f)", "raise the limit or record elsewhere");
    case ENOSPC:
    case EDQUOT: return because("the disk is full", "make room or record elsewhere");
    case ENAMETOOLONG: return because("the name of the file is too long", "choose a shorter one");
    case ENOTDIR: return because("a part of the path is a file and no folder", "choose another folder");
    default:
      return because("the file cannot be written: " + std::generic_category().message(error), "record elsewhere");
  }
}

}  // namespace

Result<std::unique_ptr<ChunkFile>> ChunkFile::create(const std::string& path) {
  if (auto possible = is_path_text(path, path); !possible) return std::move(possible.error());
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file < 0) return unwritable(path, errno);
  FileHeader header{.magic = magic,
                    .version = version,
                    .first_chunk = first_chunk,
                    .chunk_size = chunk_size,
                    .tick_size = sizeof(TickEntry)};
  header.check = check_of(header);
  const SizeIsAnError no_signal;
  int error = posix_fallocate(file, 0, first_chunk);
  if (error == 0 && pwrite(file, &header, sizeof header, 0) != sizeof header) error = ENOSPC;
  struct stat made {};
  if (error == 0 && fstat(file, &made) != 0) error = errno;
  if (error == 0) {
    // If this fails, as on a file system without permissions, nobody is kept from cutting the file.
    [[maybe_unused]] const int kept = fchmod(file, made.st_mode & read_only);
    try {
      return std::unique_ptr<ChunkFile>(new ChunkFile(path, file, made.st_mode & all_permissions));
    } catch (...) {
      close(file);
      unlink(path.c_str());
      throw;
    }
  }
  close(file);
  unlink(path.c_str());
  return unwritable(path, error);
}

ChunkFile::~ChunkFile() {
  [[maybe_unused]] const int given_back = fchmod(file_, permissions_);
  close(file_);
}

Result<std::byte*> ChunkFile::grow(ChunkKind kind, std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  if (chunks_.size() == chunks_.capacity()) chunks_.reserve(2 * chunks_.size() + 16);  // before the file grows
  const auto offset = static_cast<off_t>(first_chunk + chunks_.size() * chunk_size);
  const SizeIsAnError no_signal;
  if (const int error = posix_fallocate(file_, offset, chunk_size)) {
    [[maybe_unused]] const int cut = ftruncate(file_, offset);  // so that the file ends with a whole chunk
    return unwritable(path_, error);
  }
  void* mapped = mmap(nullptr, chunk_size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file_, offset);
  if (mapped == MAP_FAILED) return unwritable(path_, errno);
  chunks_.push_back(kind);
  auto* chunk = static_cast<std::byte*>(mapped);
  // MAP_POPULATE makes pages present; only a store makes them writable.
  for (std::size_t at = 0; at < chunk_size; at += least_page)
    *const_cast<volatile std::byte*>(chunk + at) = std::byte{0};
  ChunkHeader header{.kind = kind, .check = 0, .number = number};
  header.check = check_of(header);
  std::memcpy(chunk + sizeof(std::uint64_t), reinterpret_cast<const std::byte*>(&header) + sizeof(std::uint64_t),
              sizeof header - sizeof(std::uint64_t));
  std::uint64_t first = 0;
  std::memcpy(&first, &header, sizeof first);
  std::atomic_ref(*reinterpret_cast<std::uint64_t*>(chunk)).store(first, std::memory_order_release);
  return chunk;
}

Result<> ChunkFile::is_intact() const {
  const std::lock_guard lock(mutex_);
  const auto lost = [&](const char* sentence) {
    return Error{.code = Code::unwritable_file,
                 .sentence = sentence,
                 .mend = "leave the file alone until the run is over",
                 .place = {.name = path_}};
  };
  struct stat own {
  }, named{};
  if (fstat(file_, &own) != 0) return unwritable(path_, errno);
  if (own.st_nlink == 0) return lost("another program has removed the file");
  if (static_cast<std::size_t>(own.st_size) < first_chunk + chunks_.size() * chunk_size)
    return lost("another program has cut the file short");
  if (stat(path_.c_str(), &named) != 0 || named.st_dev != own.st_dev || named.st_ino != own.st_ino)
    return lost("another program has renamed the file");
  return {};
}

void ChunkFile::remove() noexcept {
  struct stat own {
  }, named{};
  const bool is_own = fstat(file_, &own) == 0 && lstat(path_.c_str(), &named) == 0 && named.st_dev == own.st_dev &&
                      named.st_ino == own.st_ino;
  if (is_own) unlink(path_.c_str());
}

void ChunkFile::unmap(std::byte* chunk) noexcept {
  if (chunk != nullptr) munmap(chunk, chunk_size);
}

void ChunkFile::cut(std::size_t unused) noexcept {
  const std::lock_guard lock(mutex_);
  for (; unused > 0 && !chunks_.empty() && chunks_.back() == ChunkKind::ticks; --unused) chunks_.pop_back();
  // If this fails, the file is longer than needed and still correct.
  [[maybe_unused]] const int cut = ftruncate(file_, static_cast<off_t>(first_chunk + chunks_.size() * chunk_size));
}

}  // namespace wale
