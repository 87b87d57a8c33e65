// The log of a session: what it says, that it is on the disk, and what is left of it after anything.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/temporary_folder.hpp"
#include "wale/library.hpp"
#include "wale/patch_program.hpp"
#include "wale/session_log.hpp"

namespace {

/// The size of the file when it was last brought to the disk, and how often one was.
long synced_files = 0, synced_bytes = -1;

}  // namespace

/// The library's calls come here, since the program's own functions come first.
extern "C" int fsync(int file) {
  ++synced_files;
  synced_bytes = static_cast<long>(lseek(file, 0, SEEK_END));
  return static_cast<int>(syscall(SYS_fsync, file));
}

namespace wale::session_log_test {
namespace {

std::string contents_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

const SessionBegin begun{"S48", 1995, "sandpaper", "kitchen.wale", {{"sandpaper", "0.1.0"}, {"wale", "0.1.0"}}};

std::vector<SessionEvent> one_of_each() {
  return {SessionProgram{"board", "denim(roughness: 0.3)", 0x0123456789abcdef},
          SessionOrder{"keys", "sorting", 7, {{"board", "483", glm::dvec2(-0.0625, 0.03125)}, {"cloth", "", {}}}},
          SessionShown{"key", "board", "483", 2},
          SessionShown{"frame", "kitchen", "", 0},
          SessionAnswer{"pile", "board", "1"},
          SessionAnswer{"label", "1", "rough, \"like bark\"\nand ★"},
          SessionTakenBack{{6, 7}},
          SessionPlaced{"patches", "kitchen",
                        {{.name = "board", .at = {-0.0625, 0.03125}, .size = glm::dvec2(0.25, 0.5), .shape = "ellipse",
                          .rim = 0.001953125, .layer = 2},
                         {.name = "cloth"}},
                        {"river"}},
          SessionPlaced{"keys", "sorting", {{.name = "cloth", .at = {0.125, 0}}}, {}},
          SessionGroups{"sorted", "kitchen", {{{"board", "cloth"}, "hard"}, {{}, ""}}},
          SessionNote{""},
          SessionOther{"estimate", R"({"magnitude":12.5,"of":["board"]})"},
          SessionEnd{"done"}};
}

/// A log with one of each event.
std::string written_to(const std::string& path) {
  auto log = SessionLog::create(path, begun);
  EXPECT_TRUE(log) << in_words(log.error());
  std::uint64_t line = 1;
  for (const SessionEvent& each : one_of_each()) {
    const auto number = log->append(each);
    EXPECT_TRUE(number) << in_words(number.error());
    EXPECT_EQ(*number, ++line);
  }
  return path;
}

TEST(SessionLog, ReadsWhatWasWritten) {
  const TemporaryFolder folder;
  const auto record = open_session_log(written_to(folder / "one.session"));
  ASSERT_TRUE(record) << in_words(record.error());
  EXPECT_TRUE(record->problems.empty()) << in_words(record->problems.front());
  const auto events = one_of_each();
  ASSERT_EQ(record->entries.size(), events.size() + 1);
  EXPECT_EQ(record->entries[0].event, SessionEvent(begun));
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(record->entries[i + 1].event, events[i]) << i;
    EXPECT_EQ(record->entries[i + 1].number, i + 2);
    EXPECT_GE(record->entries[i + 1].seconds, record->entries[i].seconds);
  }
  EXPECT_TRUE(record->ended());
  EXPECT_TRUE(record->standing_answers().empty());
}

/// The lines of the page calibration/session/SESSION_LOG.md, as they stand there.
TEST(SessionLog, IsAsItsPageSays) {
  const std::string page = contents_of(WALE_SOURCE_DIR "/calibration/session/SESSION_LOG.md");
  const std::size_t from = page.find("```json\n") + 8;
  const std::string shown = page.substr(from, page.find("```", from) - from);
  const auto record = read_session_log(shown, "page");
  ASSERT_TRUE(record) << in_words(record.error());
  for (const Error& each : record->problems) ADD_FAILURE() << in_words(each);
  std::string again;
  std::set<std::size_t> kinds;
  for (const SessionEntry& each : record->entries)
    again += *session_line(each) + "\n", kinds.insert(each.event.index());
  EXPECT_EQ(again, shown);
  EXPECT_EQ(kinds.size(), std::variant_size_v<SessionEvent>) << "the page shows each event";
  ASSERT_EQ(record->standing_answers().size(), 2u);
  EXPECT_EQ(std::get<SessionAnswer>(record->standing_answers()[1]->event), (SessionAnswer{"pile", "mat", "1"}));
}

TEST(SessionLog, HasLengthsAsAPersonWritesThem) {
  const auto line = session_line({.event = SessionOrder{"places", "w", 1, {{"a", "", glm::dvec2(0.1 + 0.2, 0.0242)}}}});
  ASSERT_TRUE(line);
  EXPECT_NE(line->find("\"at_mm\":[300.0,24.2]"), std::string::npos) << *line;
}

TEST(SessionLog, IsOnTheDiskBeforeTheCallReturns) {
  const TemporaryFolder folder;
  const std::string path = folder / "one.session";
  auto log = SessionLog::create(path, begun);
  ASSERT_TRUE(log);
  for (int i = 0; i < 5; ++i) {
    const long before = synced_files;
    ASSERT_TRUE(log->append(SessionNote{std::string(static_cast<std::size_t>(100 * i), 'x')}));
    EXPECT_EQ(synced_files, before + 1);
    EXPECT_EQ(synced_bytes, static_cast<long>(std::filesystem::file_size(path)));
  }
}

TEST(SessionLog, OfAKilledProcessHasAllThatItWasTold) {
  const TemporaryFolder folder;
  const std::string path = folder / "killed.session";
  int told[2];
  ASSERT_EQ(pipe(told), 0);
  const pid_t child = fork();
  if (child == 0) {
    auto log = SessionLog::create(path, begun);
    for (int i = 0; log && i < 100000; ++i)
      if (log->append(SessionAnswer{"pile", "board", std::to_string(i)})) (void)!::write(told[1], "x", 1);
    _exit(0);
  }
  close(told[1]);
  char byte;
  std::size_t acknowledged = 0;
  while (acknowledged < 50 && ::read(told[0], &byte, 1) == 1) ++acknowledged;
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  while (::read(told[0], &byte, 1) == 1) ++acknowledged;
  close(told[0]);
  ASSERT_TRUE(WIFSIGNALED(status));
  const auto record = open_session_log(path);
  ASSERT_TRUE(record) << in_words(record.error());
  EXPECT_LE(record->problems.size(), 1u);
  EXPECT_FALSE(record->ended());
  const auto answers = record->standing_answers();
  ASSERT_GE(answers.size(), acknowledged);
  EXPECT_LE(answers.size(), acknowledged + 1);
  for (std::size_t i = 0; i < answers.size(); ++i)
    EXPECT_EQ(std::get<SessionAnswer>(answers[i]->event).answer, std::to_string(i));
}

TEST(SessionLog, ThatIsCutAnywhereKeepsAllWholeLines) {
  const TemporaryFolder folder;
  const std::string whole = contents_of(written_to(folder / "one.session"));
  const std::size_t first = whole.find('\n') + 1;
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    const std::string cut = whole.substr(0, length);
    const auto record = read_session_log(cut, "cut.session");
    if (length < first) {
      ASSERT_FALSE(record);
      EXPECT_EQ(record.error().code, Code::damaged_file);
      EXPECT_EQ(record.error().place.number, 1u);
      continue;
    }
    ASSERT_TRUE(record) << length << in_words(record.error());
    const auto lines = static_cast<std::size_t>(std::ranges::count(cut, '\n'));
    EXPECT_EQ(record->entries.size(), lines);
    if (cut.ends_with('\n')) {
      EXPECT_TRUE(record->problems.empty());
    } else {
      ASSERT_EQ(record->problems.size(), 1u) << length;
      EXPECT_TRUE(in_words(record->problems[0]).starts_with("cut.session:" + std::to_string(lines + 1) + ":"))
          << in_words(record->problems[0]);
    }
  }
}

TEST(SessionLog, SaysFileAndLineOfWhatIsMalformedAndKeepsTheRest) {
  const TemporaryFolder folder;
  const std::string whole = contents_of(written_to(folder / "one.session"));
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < whole.size(); at = whole.find('\n', at) + 1)
    lines.push_back(whole.substr(at, whole.find('\n', at) - at));
  const auto with = [&](std::size_t line, const std::string& text) {
    std::string log;
    for (std::size_t i = 0; i < lines.size(); ++i) log += (i == line ? text : lines[i]) + "\n";
    return log;
  };
  const auto swapped = [&](std::size_t line, const std::string& old, const std::string& text) {
    std::string changed = lines[line];
    const std::size_t at = changed.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return with(line, changed.replace(at, old.size(), text));
  };
  const std::string bad[] = {
      with(1, "nonsense"), with(1, ""), with(1, "[1]"), with(1, "\xff\xfe"), with(1, lines[1] + "}"),
      swapped(1, "\"hash\":\"0123456789abcdef\"", "\"hash\":\"xyz\""), swapped(1, "\"hash\"", "\"hush\""),
      swapped(1, "\"0123456789abcdef\"", "\"123456789abcdef\""), swapped(1, "\"line\":2", "\"line\":-2"),
      swapped(1, "\"line\":2", "\"line\":2.5"), swapped(1, "\"board\"", "7"), with(1, std::string(2 << 20, ' ')),
      with(1, std::string(100000, '['))};
  for (const std::string& each : bad) {
    const auto record = read_session_log(each, "bad.session");
    ASSERT_TRUE(record) << in_words(record.error());
    ASSERT_EQ(record->problems.size(), 1u) << each.substr(0, 300);
    EXPECT_EQ(record->problems[0].code, Code::damaged_file);
    EXPECT_EQ(record->problems[0].place.name, "bad.session");
    EXPECT_EQ(record->problems[0].place.number, 2u) << in_words(record->problems[0]);
    EXPECT_EQ(record->entries.size(), lines.size() - 1);
  }
  const std::size_t placed = 8;
  for (const std::string& each :
       {swapped(placed, "\"layer\":2", "\"layer\":-2"), swapped(placed, "\"at_mm\"", "\"at_cm\""),
        swapped(placed, "[250.0,500.0]", "[250.0]"), swapped(placed, "\"gone\":[\"river\"]", "\"gone\":\"river\""),
        swapped(placed, "\"ellipse\"", "2")}) {
    const auto record = read_session_log(each, "bad.session");
    ASSERT_TRUE(record && record->problems.size() == 1) << each;
    EXPECT_EQ(record->problems[0].place.number, placed + 1);
  }
  // A line that somebody took out, or copied, is noticed too.
  std::string fewer = whole;
  fewer.erase(whole.find(lines[3]), lines[3].size() + 1);
  auto record = read_session_log(fewer, "bad.session");
  ASSERT_TRUE(record && record->problems.size() == 1);
  EXPECT_NE(in_words(record->problems[0]).find("lines 4 to 4 are missing"), std::string::npos)
      << in_words(record->problems[0]);
  record = read_session_log(with(3, lines[3] + "\n" + lines[3]), "bad.session");
  ASSERT_TRUE(record && record->problems.size() == 1);
  EXPECT_EQ(record->entries.size(), lines.size());
  // What nobody answered cannot be taken back.
  record = read_session_log(swapped(7, "[6,7]", "[6,9]"), "bad.session");
  ASSERT_TRUE(record && record->problems.size() == 1);
  EXPECT_NE(in_words(record->problems[0]).find("line 9 has no answer"), std::string::npos)
      << in_words(record->problems[0]);
}

TEST(SessionLog, IsToldFromOtherFilesAndNewerOnes) {
  const TemporaryFolder folder;
  const std::string line = *session_line({.time = "2026-11-24T20:31:00.123Z", .event = begun});
  for (const std::string& other : {std::string(), std::string("wale 1\n"), std::string("{}\n"), std::string(1000, 'x'),
                                   *session_line({.event = SessionNote{"x"}}) + "\n"}) {
    const auto record = read_session_log(other, "other");
    ASSERT_FALSE(record) << other;
    EXPECT_EQ(record.error().code, Code::damaged_file);
  }
  std::string newer = line + "\n";
  newer.replace(newer.find("\"format\":1"), 10, "\"format\":2");
  EXPECT_EQ(read_session_log(newer, "newer").error().code, Code::newer_file);
  EXPECT_EQ(open_session_log(folder / "missing").error().code, Code::unreadable_file);
  EXPECT_EQ(open_session_log(folder / "").error().code, Code::unreadable_file);
}

TEST(SessionLog, IsNeverOverwrittenAndRefusesWhatItCannotHold) {
  const TemporaryFolder folder;
  const std::string path = written_to(folder / "one.session");
  const std::string before = contents_of(path);
  EXPECT_EQ(SessionLog::create(path, begun).error().code, Code::unwritable_file);
  EXPECT_EQ(contents_of(path), before);
  EXPECT_EQ(SessionLog::create(folder / "no/such/folder.session", begun).error().code, Code::unwritable_file);
  EXPECT_EQ(SessionLog::create(folder / "bad.session", {.participant = "\xff"}).error().code, Code::malformed_value);
  EXPECT_FALSE(std::filesystem::exists(folder / "bad.session"));
  auto log = SessionLog::create(folder / "two.session", begun);
  const SessionEvent refused[] = {begun,
                                  SessionNote{"\xff"},
                                  SessionNote{std::string(2 << 20, 'x')},
                                  SessionOther{"note", "{}"},
                                  SessionOther{"", "{}"},
                                  SessionOther{"mine", "[]"},
                                  SessionOther{"mine", "{"},
                                  SessionOther{"mine", R"({"line":3})"},
                                  SessionOrder{"keys", "", 0, {{"board", "", glm::dvec2(NAN, 0)}}}};
  for (const SessionEvent& each : refused) EXPECT_EQ(log->append(each).error().code, Code::malformed_value);
  EXPECT_EQ(*log->append(SessionNote{"fine"}), 2u);
  const auto record = open_session_log(log->path());
  EXPECT_TRUE(record && record->problems.empty() && record->entries.size() == 2);
}

TEST(SessionLog, OnAFullDiskEndsWithTheLineBefore) {
  const TemporaryFolder folder;
  const std::string path = folder / "full.session";
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    auto log = SessionLog::create(path, begun);
    const rlimit small{600, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &small);
    bool right = log && log->append(SessionNote{"fits"}).has_value();
    const auto full = log->append(SessionNote{std::string(1000, 'x')});
    right = right && !full && full.error().code == Code::unwritable_file;
    const rlimit large{RLIM_INFINITY, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &large);
    const auto again = log->append(SessionNote{"fits again"});
    _exit(right && again && *again == 3 ? 0 : 1);
  }
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  const auto record = open_session_log(path);
  ASSERT_TRUE(record);
  EXPECT_TRUE(record->problems.empty());
  EXPECT_EQ(record->entries.size(), 3u);
}

TEST(SessionLog, NamesAProgramByTheHashOfWhatItDoes) {
  const Library library;
  const std::string material = "material m { physical { force = vector(1 N * sin(x / 1 mm), 0 N) } }";
  const auto compiled = library.compile("wale 1\n" + material);
  ASSERT_TRUE(compiled) << in_words(compiled.error());
  // FNV-1a as its authors describe it.
  std::uint64_t hash = 14695981039346656037u;
  PatchProgram program = compiled->program.description();
  program.places = {};
  for (const std::byte each : write_patch_program(program))
    hash = (hash ^ static_cast<std::uint8_t>(each)) * 1099511628211u;
  EXPECT_EQ(program_hash(compiled->program), hash);
  // Another line in the file is no other program; another size of the force is.
  const auto lower = library.compile("wale 1\n\n\n// moved\n" + material);
  ASSERT_TRUE(lower);
  EXPECT_EQ(program_hash(lower->program), hash);
  const auto other = library.compile("wale 1\nmaterial m { physical { force = vector(1.1 N * sin(x / 1 mm), 0 N) } }");
  ASSERT_TRUE(other);
  EXPECT_NE(program_hash(other->program), hash);
}

}  // namespace
}  // namespace wale::session_log_test
