// A session is logged and read back.
#include <cstdio>
#include <string>
#include <wale/session_log.hpp>

#include "expect.hpp"

int main() {
  const std::string path = "consumer.session";
  std::remove(path.c_str());
  {
    auto log = wale::SessionLog::create(path, {.participant = "S48", .seed = 7, .device = "sandpaper", .file = {}, .versions = {}});
    EXPECT(log.has_value());
    const auto answer = log->append(wale::SessionAnswer{"pile", "board", "2"});
    EXPECT(answer.has_value() && *answer == 2);
    EXPECT(log->append(wale::SessionTakenBack{{*answer}}).has_value());
    EXPECT(!wale::SessionLog::create(path, {}).has_value());
  }
  const auto record = wale::open_session_log(path);
  EXPECT(record.has_value() && record->problems.empty() && record->entries.size() == 3);
  EXPECT(record->standing_answers().empty() && !record->ended());
  std::remove(path.c_str());
}
