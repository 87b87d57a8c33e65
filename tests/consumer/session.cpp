// A session is logged and read back, with no other library of Wale's named than the one of logs.
#include <cstdio>
#include <string>
#include <wale/session_log.hpp>

#include "expect.hpp"

int main() {
  const std::string path = "consumer.session";
  std::remove(path.c_str());
  {
    auto log = wale::SessionLog::create(
        path, {.participant = "S48", .seed = 7, .device = "sandpaper", .file = "pile.wale", .versions = {{"consumer", "1"}}});
    EXPECT(log.has_value());
    const auto answer = log->append(wale::SessionAnswer{"pile", "board", "2"});
    EXPECT(answer.has_value() && *answer == 2);
    EXPECT(log->append(wale::SessionTakenBack{{*answer}}).has_value());
    // A log is never written over.
    EXPECT(!wale::SessionLog::create(path, {}).has_value());
  }
  const auto record = wale::open_session_log(path);
  EXPECT(record.has_value() && record->problems.empty() && record->entries.size() == 3);
  const auto* begin = std::get_if<wale::SessionBegin>(&record->entries.front().event);
  EXPECT(begin != nullptr && begin->participant == "S48" && begin->seed == 7 && begin->device == "sandpaper");
  EXPECT(begin->file == "pile.wale" && begin->versions.at("consumer") == "1");
  EXPECT(record->standing_answers().empty() && !record->ended());
  std::remove(path.c_str());
}
