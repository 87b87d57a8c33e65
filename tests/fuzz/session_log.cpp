// A libFuzzer target for logs of sessions. Any bytes are refused with a reason, or read; each line that is kept is written
// as a line that reads the same. The input follows the first line of a log, so that the fuzzer reaches the later checks;
// an input that begins with '{' is read alone.
#include <cstdlib>
#include <string>

#include "wale/session_log.hpp"

namespace {

void demand(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace wale;
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!bytes.starts_with("{"))
    bytes = *session_line({.event = SessionBegin{"S48", 7, "sandpaper", "kitchen.wale", {{"wale", "0.1.0"}}}}) + "\n" + bytes;
  const auto record = read_session_log(bytes, "fuzzed");
  if (!record) {
    demand(!record.error().sentence.empty());
    return 0;
  }
  for (const Error& each : record->problems) demand(each.place.number && !each.sentence.empty());
  std::string again;
  for (const SessionEntry& each : record->entries) {
    const auto line = session_line(each);
    demand(line.has_value());
    again += *line + "\n";
  }
  (void)record->standing_answers();
  const auto twice = read_session_log(again, "again");
  demand(twice.has_value() && twice->entries.size() <= record->entries.size());
  for (std::size_t i = 0; i < twice->entries.size(); ++i) demand(twice->entries[i].event.index() == record->entries[i].event.index());
  return 0;
}
