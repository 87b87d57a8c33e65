#include "runtime/device/simulated/load_trace.hpp"

#include "schema/regular_file.hpp"

namespace wale {
namespace {

/// In bytes: three hours at a thousand lines of 40 bytes a second.
constexpr std::size_t largest_trace = std::size_t{512} << 20;

}  // namespace

Result<Trace> load_trace(const std::string& path) {
  const auto text = read_regular_file(path, largest_trace);
  if (!text) {
    Error error = text.error();
    error.sentence = "the file cannot be read: " + error.sentence;
    return error;
  }
  auto trace = read_trace(*text);
  if (!trace) trace.error().place.name = path;
  return trace;
}

}  // namespace wale
