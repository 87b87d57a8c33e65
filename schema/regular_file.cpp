#include "schema/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "schema/name_text.hpp"

namespace wale {
namespace {

Error unreadable_path(const std::string& path, std::string sentence, std::string mend = {}) {
  return {
      .code = Code::unreadable_file, .sentence = std::move(sentence), .mend = std::move(mend), .place = {.name = path}};
}

std::string text_of(int error) {
  return error == ENOENT || error == ENOTDIR ? "no such file" : std::generic_category().message(error);
}

/// The kind of a file that is not regular, or an empty text.
std::string other_kind(const struct stat& status) {
  if (S_ISREG(status.st_mode)) return {};
  if (S_ISDIR(status.st_mode)) return "this is a folder";
  if (S_ISFIFO(status.st_mode)) return "this is a pipe, and a file is expected";
  if (S_ISSOCK(status.st_mode)) return "this is a socket, and a file is expected";
  return "this is a device, and a file is expected";
}

Error of_other_kind(const std::string& path, const struct stat& status) {
  return unreadable_path(path, other_kind(status), S_ISFIFO(status.st_mode) ? "write its content to a file first" : "");
}

Error too_large(const std::string& path, std::size_t size, std::size_t largest) {
  char text[128];
  if (largest >= 1 << 20)
    std::snprintf(text, sizeof text, "it has %.1f MB; Wale reads up to %zu MB", static_cast<double>(size) / 1048576,
                  largest >> 20);
  else
    std::snprintf(text, sizeof text, "it has %zu bytes; Wale reads up to %zu", size, largest);
  return unreadable_path(path, text);
}

struct ClosedAtEnd {
  int descriptor;
  ~ClosedAtEnd() { close(descriptor); }
};

}  // namespace

Result<int> open_regular_file(const std::string& path) {
  if (auto possible = is_path_text(path, path); !possible) return std::move(possible.error());
  struct stat status {};
  // First by its name: to open some devices has an effect.
  if (stat(path.c_str(), &status) != 0) return unreadable_path(path, text_of(errno));
  if (!S_ISREG(status.st_mode)) return of_other_kind(path, status);
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0) return unreadable_path(path, text_of(errno));
  // The name may lead to something else by now.
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode)) return file;
  close(file);
  return of_other_kind(path, status);
}

Result<std::string> read_regular_file(const std::string& path, std::size_t largest) {
  const auto opened = open_regular_file(path);
  if (!opened) return opened.error();
  const ClosedAtEnd file{*opened};
  struct stat status {};
  if (fstat(file.descriptor, &status) != 0) return unreadable_path(path, text_of(errno));
  if (static_cast<std::size_t>(status.st_size) > largest)
    return too_large(path, static_cast<std::size_t>(status.st_size), largest);
  const auto told = static_cast<std::size_t>(status.st_size);
  // Files of /proc say that they are empty, and are not.
  constexpr std::size_t room = 1 << 16;
  std::string bytes;
  while (true) {
    const std::size_t held = bytes.size();
    bytes.resize(std::min(std::max(held, told) + room, largest + 1));
    const ssize_t count = read(file.descriptor, bytes.data() + held, bytes.size() - held);
    bytes.resize(held + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return unreadable_path(path, text_of(errno));
    if (count == 0) return bytes;
    if (bytes.size() > largest) return too_large(path, bytes.size(), largest);
  }
}

}  // namespace wale
