#include "runtime/device/simulated/load_trace.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace wale {

Result<Trace> load_trace(const std::string& path) {
  const auto unreadable = [&](const std::string& why) {
    return Error{Code::unreadable_file, "the file cannot be read: " + why, "", {.name = path}};
  };
  if (std::filesystem::is_directory(path)) return unreadable("it is a folder");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return unreadable(std::strerror(errno));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  auto trace = read_trace(text);
  if (!trace) trace.error().place.name = path;
  return trace;
}

}  // namespace wale
