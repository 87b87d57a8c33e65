// Sessions: what comes next, what is kept, and how they go on.
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "calibration/experiment/planted_observer.hpp"
#include "calibration/experiment/trial_table.hpp"
#include "tests/experiments/texts.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::experiments_test {
namespace {

const std::string nine =
    "stimulus bench(amplitude: a, period: p)\nfactor a 0.2 N, 0.8 N, 2 N\nfactor p 1.2 mm, 2.5 mm, 5 mm\n"
    "task magnitude_estimation\npractice 4\nrepetitions 2\nquestion sure rating \"Sure?\"\nclosing how text \"How?\"";
const std::vector<double> nine_sizes = {0.2, 0.21, 0.22, 0.8, 0.81, 0.82, 2, 2.1, 2.2};

SessionBegin begin_of(const std::string& experiment, std::uint32_t seed = 7) {
  return {.participant = "P1", .seed = seed, .device = "sandpaper", .file = "t.wale", .versions = {}, .experiment = experiment, .grade = "simulated"};
}

/// Runs a session on numbers from its beginning, or goes on in its log.
Result<ExperimentEnd> run_on(const ReadyExperiment& ready, const std::string& path, Participant& participant,
                             const std::vector<double>& sizes, std::uint32_t seed = 7) {
  Numbers presenter(ready, sizes);
  TrialSession session(*ready.experiment, seed);
  if (!std::filesystem::exists(path)) {
    auto log = SessionLog::create(path, begin_of(ready.experiment->name, seed));
    if (!log) return log.error();
    if (const auto written = log_design(*log, ready, seed); !written) return written.error();
    return run_experiment(ready, session, *log, presenter, participant);
  }
  auto resumed = SessionLog::resume(path);
  if (!resumed) return resumed.error();
  if (const auto same = is_same_design(resumed->record, ready, path); !same) return same.error();
  for (const auto& each : resumed->record.entries) session.take(each);
  const auto line = resumed->log.append(SessionResumed{resumed->gap, "resume"});
  if (!line) return line.error();
  return run_experiment(ready, session, resumed->log, presenter, participant);
}

std::vector<SessionAnswer> answers_in(const std::string& path) {
  const auto record = open_session_log(path);
  std::vector<SessionAnswer> answers;
  if (!record) ADD_FAILURE() << record.error().sentence;
  else
    for (const auto* each : record->standing_answers()) answers.push_back(std::get<SessionAnswer>(each->event));
  return answers;
}

TEST(TrialOrder, HasEachStimulusOncePerBlockAndIsThatOfTheSeed) {
  const Design made(design(nine));
  const auto trials = trial_order(made.experiment(), 1995);
  ASSERT_EQ(trials.size(), 4u + 18u);
  for (const std::uint32_t block : {1u, 2u}) {
    std::set<std::size_t> seen;
    for (const Trial& each : trials)
      if (each.block == block) seen.insert(each.stimulus);
    EXPECT_EQ(seen.size(), 9u);
  }
  EXPECT_EQ(trial_order(made.experiment(), 1995), trials);
  EXPECT_NE(trial_order(made.experiment(), 1996), trials);
  // Written down once, so that an order in a log is given again by every later version.
  std::vector<std::size_t> first;
  for (std::size_t i = 4; i < 13; ++i) first.push_back(trials[i].stimulus);
  EXPECT_FALSE(std::ranges::is_sorted(first));
}

/// Over many seeds, each stimulus is as often first as any other.
TEST(TrialOrder, FavoursNoStimulus) {
  const Design made(design(nine));
  std::vector<int> first(9);
  constexpr int seeds = 1800;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) ++first[trial_order(made.experiment(), seed)[4].stimulus];
  double chi_square = 0;
  for (const int each : first) chi_square += (each - 200.0) * (each - 200.0) / 200;
  EXPECT_LT(chi_square, 26.1) << "8 degrees of freedom, p = 0.001; the seeds are fixed";
}

TEST(TrialOrder, NamedStimuliAreAmongThePractice) {
  const Design made(design(nine + "\n" + "").substr(0));
  CheckedExperiment experiment = made.experiment();
  experiment.practised = {3, 8};
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::multiset<std::size_t> practised;
    for (const Trial& each : trial_order(experiment, seed))
      if (each.block == 0) practised.insert(each.stimulus);
    EXPECT_EQ(practised.size(), 4u);
    EXPECT_EQ(practised.count(3), 1u);
    EXPECT_EQ(practised.count(8), 1u);
  }
}

TEST(Responses, AreWhatTheTaskTakes) {
  const auto said = [](ResponseKind kind, const char* typed) {
    const auto made = checked_response(kind, typed);
    return made ? *made : "! " + made.error().sentence;
  };
  EXPECT_EQ(said(ResponseKind::magnitude, " 12.50 "), "12.5");
  EXPECT_EQ(said(ResponseKind::magnitude, "0,5"), "0.5");
  EXPECT_EQ(said(ResponseKind::magnitude, "1/4"), "0.25");
  for (const char* wrong : {"0", "-3", "twelve", "", "1e999", "nan", "inf", "1/0", "3 4", "1,2,3", "0x10"})
    EXPECT_TRUE(said(ResponseKind::magnitude, wrong).starts_with("! expected a number above 0")) << wrong;
  EXPECT_EQ(said(ResponseKind::rating, "100 %"), "100");
  EXPECT_EQ(said(ResponseKind::rating, "0"), "0");
  for (const char* wrong : {"-1", "100.5", "%", "abc"})
    EXPECT_TRUE(said(ResponseKind::rating, wrong).starts_with("! expected a number from 0 to 100")) << wrong;
  EXPECT_EQ(said(ResponseKind::yes_no, "Y"), "yes");
  EXPECT_EQ(said(ResponseKind::same_different, "d"), "different");
  EXPECT_EQ(said(ResponseKind::interval, "2"), "2");
  EXPECT_TRUE(said(ResponseKind::interval, "3").starts_with("! expected 1 or 2"));
  EXPECT_EQ(said(ResponseKind::text, "like corduroy\r"), "like corduroy");
  EXPECT_TRUE(said(ResponseKind::text, "\xff").starts_with("!"));
  EXPECT_TRUE(said(ResponseKind::text, std::string(5000, 'a').c_str()).starts_with("!"));
}

TEST(Sessions, AskRefuseAndTakeBack) {
  const TemporaryFolder folder;
  const Design made(design("stimulus bench(amplitude: a)\nfactor a 0.2 N, 0.8 N\ntask magnitude_estimation\norder fixed\n"
                           "question sure rating \"Sure?\""));
  const auto ready = made.ready();
  Scripted person({"3", "zero", "50", "back", "4", "60", "7", "70"});
  const auto end = run_on(ready, folder / "a.trials", person, {0.2, 0.8});
  ASSERT_TRUE(end) << end.error().sentence;
  EXPECT_FALSE(end->stopped);
  EXPECT_EQ(person.refusals.size(), 1u) << "`zero` is no rating";
  const auto answers = answers_in(folder / "a.trials");
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_EQ(answers[0], (SessionAnswer{"response", "1", "4"}));
  EXPECT_EQ(answers[3], (SessionAnswer{"sure", "2", "70"}));
  // The mistyped ones are still in the log, and the table counts them.
  const auto record = open_session_log(folder / "a.trials");
  EXPECT_EQ(std::ranges::count_if(record->entries, [](const SessionEntry& each) {
              const auto* answer = std::get_if<SessionAnswer>(&each.event);
              return answer && (answer->answer == "3" || answer->answer == "50");
            }), 2);
  const auto table = trial_table(*record, "a");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows[0][*table->column("taken_back")], "2");
  EXPECT_EQ(table->rows[0][*table->column("response")], "4");
  EXPECT_EQ(table->rows[1][*table->column("a")], "0.8");
  EXPECT_EQ(table->columns[*table->column("a")].units, "N");
}

TEST(Sessions, ThatEndedCannotGoOnAndOthersDo) {
  const TemporaryFolder folder;
  const Design made(design("stimulus bench(amplitude: a)\nfactor a 0.2 N, 0.8 N\ntask magnitude_estimation\norder fixed"));
  const auto ready = made.ready();
  Scripted first({"3"});
  const auto broken_off = run_on(ready, folder / "a.trials", first, {0.2, 0.8});
  ASSERT_TRUE(broken_off);
  ASSERT_TRUE(broken_off->stopped);
  EXPECT_EQ(broken_off->trials, 1u);
  Scripted second({"9"});
  const auto end = run_on(ready, folder / "a.trials", second, {0.2, 0.8});
  ASSERT_TRUE(end) << end.error().sentence;
  EXPECT_FALSE(end->stopped);
  EXPECT_EQ(second.trials.at(0).number, 2u) << "the trial that was broken off is presented again";
  const auto table = trial_table(*open_session_log(folder / "a.trials"), "a");
  EXPECT_EQ(table->rows.at(1)[*table->column("interrupted")], "1");
  EXPECT_EQ(table->rows.at(0)[*table->column("interrupted")], "0");
  Scripted third({});
  const auto again = run_on(ready, folder / "a.trials", third, {0.2, 0.8});
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Code::wrong_moment);
}

TEST(Sessions, NeedConsentAlsoWhenTheyGoOn) {
  const TemporaryFolder folder;
  const Design made(design("stimulus smooth\ntask rating\nconsent \"You may stop.\""));
  const auto ready = made.ready();
  Scripted refusing({"perhaps", "no"});
  const auto refused = run_on(ready, folder / "a.trials", refusing, {1});
  ASSERT_TRUE(refused && refused->stopped);
  EXPECT_EQ(refusing.refusals.size(), 1u);
  EXPECT_TRUE(refusing.trials.empty());
  Scripted again({"no"});
  ASSERT_TRUE(run_on(ready, folder / "a.trials", again, {1}));
  EXPECT_TRUE(again.trials.empty()) << "nothing is presented to who has not agreed";
  Scripted agreeing({"yes"});
  ASSERT_TRUE(run_on(ready, folder / "a.trials", agreeing, {1}));
  EXPECT_EQ(agreeing.trials.size(), 1u);
  Scripted agreed({"50"});
  const auto end = run_on(ready, folder / "a.trials", agreed, {1});
  EXPECT_TRUE(end && !end->stopped) << "who has agreed is not asked again";
}

TEST(Sessions, OfAnotherDesignAreNotGoneOnWith) {
  const TemporaryFolder folder;
  const std::string text = design("stimulus bench(amplitude: a)\nfactor a 0.2 N, 0.8 N\ntask magnitude_estimation\norder fixed");
  const Design made(text), other(text + "// changed\n");
  Scripted first({"3"});
  ASSERT_TRUE(run_on(made.ready(), folder / "a.trials", first, {0.2, 0.8}));
  Scripted second({"3"});
  const auto end = run_on(other.ready(), folder / "a.trials", second, {0.2, 0.8});
  ASSERT_FALSE(end);
  EXPECT_EQ(end.error().code, Code::wrong_moment);
}

TEST(Sessions, GoOnAsFarAsTheDesignAllows) {
  const Design made(design("stimulus smooth\ntask rating\ninterrupted resume 10 min, practice 60 min, restart 1440 min"));
  EXPECT_EQ(*may_resume(made.experiment(), 599), "resume");
  EXPECT_EQ(*may_resume(made.experiment(), 601), "practice");
  EXPECT_EQ(*may_resume(made.experiment(), 3601), "restart");
  EXPECT_FALSE(may_resume(made.experiment(), 86401));
  const Design never(design("stimulus smooth\ntask rating\ninterrupted refuse"));
  EXPECT_FALSE(may_resume(never.experiment(), 1));
}

TEST(ResumedLog, ACutLineIsRemovedAndNumbersCountOn) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.trials";
  {
    auto log = SessionLog::create(path, begin_of("e"));
    ASSERT_TRUE(log);
    ASSERT_TRUE(log->append(SessionAnswer{"response", "1", "5"}));
    EXPECT_EQ(SessionLog::resume(path).error().code, Code::wrong_moment) << "it is being written";
  }
  std::ofstream(path, std::ios::app) << "{\"line\":3,\"time\":\"20";
  {
    auto resumed = SessionLog::resume(path);
    ASSERT_TRUE(resumed) << resumed.error().sentence;
    EXPECT_EQ(resumed->record.entries.size(), 2u);
    EXPECT_LT(resumed->gap, 60);
    EXPECT_EQ(*resumed->log.append(SessionResumed{1.5, "resume"}), 3u);
  }
  const auto record = open_session_log(path);
  ASSERT_TRUE(record);
  EXPECT_TRUE(record->problems.empty());
  EXPECT_EQ(std::get<SessionResumed>(record->entries.back().event), (SessionResumed{1.5, "resume"}));
  const std::string whole = [&] { std::ifstream file(path); return std::string(std::istreambuf_iterator<char>(file), {}); }();
  std::ofstream(path) << whole.substr(0, whole.find('\n') + 1) << "nonsense\n" << whole.substr(whole.find('\n') + 1);
  EXPECT_EQ(SessionLog::resume(path).error().code, Code::damaged_file) << "in the middle a line is lost";
}

/// A participant that tells a pipe each answer that the session has taken: whoever asks the next thing has it on the disk.
class Telling final : public Participant {
 public:
  Telling(Participant& inner, int pipe) : inner_(inner), pipe_(pipe) {}
  void begin(const Trial& trial, std::size_t of, int interval, int intervals) override {
    tell_last();
    inner_.begin(trial, of, interval, intervals);
  }
  void felt(const Presented& presented, const FeltSize& felt) override { inner_.felt(presented, felt); }
  Result<std::string> say(const Question& question) override {
    tell_last();
    auto said = inner_.say(question);
    if (said && question.kind == Question::Kind::trial)
      last_ = fmt::format("{} {} {}\n", question.trial->number, question.asked->name, *said);
    return said;
  }
  void refuse(const std::string& why) override { inner_.refuse(why); }
  void tell(const std::string&) override {}

 private:
  void tell_last() {
    if (!last_.empty()) (void)!write(pipe_, last_.data(), last_.size());
    last_.clear();
  }
  Participant& inner_;
  int pipe_;
  std::string last_;
};

/// A process that is killed at 50 moments, spread over the whole session by a fixed sequence, loses no answer that it
/// had taken, and the session goes on to the same end as one that was never broken off.
TEST(Sessions, AKilledProcessLosesNoAnswer) {
  const TemporaryFolder folder;
  const Design made(design(nine));
  const auto ready = made.ready();
  PlantedObserver whole(*ready.experiment, {}, 7);
  ASSERT_TRUE(run_on(ready, folder / "whole.trials", whole, nine_sizes));
  const auto expected = answers_in(folder / "whole.trials");
  ASSERT_EQ(expected.size(), 22u * 2 + 1);
  const Draws draws(1995, 99);
  int broken_off = 0;
  for (int moment = 0; moment < 50; ++moment) {
    const std::string path = folder / fmt::format("killed{}.trials", moment);
    const std::size_t enough = draws.bits(static_cast<std::uint64_t>(moment)) % 400;  // bytes told until it is killed
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      close(ends[0]);
      PlantedObserver observer(*ready.experiment, {}, 7);
      Telling telling(observer, ends[1]);
      const auto end = run_on(ready, path, telling, nine_sizes);
      _exit(end ? 0 : 1);
    }
    close(ends[1]);
    std::string told;
    char bytes[64];
    while (told.size() <= enough) {
      const ssize_t count = read(ends[0], bytes, sizeof bytes);
      if (count <= 0) break;
      told.append(bytes, static_cast<std::size_t>(count));
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    for (ssize_t count; (count = read(ends[0], bytes, sizeof bytes)) > 0;) told.append(bytes, static_cast<std::size_t>(count));
    close(ends[0]);
    const auto record = open_session_log(path);
    if (!record) continue;  // killed before its first line
    std::set<std::string> kept;
    for (const auto* each : record->standing_answers()) {
      const auto& answer = std::get<SessionAnswer>(each->event);
      kept.insert(fmt::format("{} {} {}", answer.about, answer.question, answer.answer));
    }
    for (std::size_t at = 0, end; (end = told.find('\n', at)) != std::string::npos; at = end + 1)
      EXPECT_TRUE(kept.contains(told.substr(at, end - at))) << told.substr(at, end - at);
    if (record->ended()) continue;
    ++broken_off;
    PlantedObserver observer(*ready.experiment, {}, 7);
    const auto end = run_on(ready, path, observer, nine_sizes);
    if (!end) {
      EXPECT_TRUE(kept.empty()) << end.error().sentence;  // killed while the design was written
      continue;
    }
    EXPECT_EQ(answers_in(path), expected);
  }
  EXPECT_GT(broken_off, 25) << "otherwise the kills came too late to show anything";
}

TEST(Sorting, EachSortEndsWithItsGroupsAndGoesOnAfterABreak) {
  const TemporaryFolder folder;
  const Design made(design("stimulus bench(amplitude: a)\nfactor a 0.2 N, 0.25 N, 1 N, 3 N\ntask sorting, groups 2, 3"));
  const auto ready = made.ready();
  const std::vector<double> sizes = {0.2, 0.25, 1, 3};
  TrialSession fresh(*ready.experiment, 7);
  const auto sort = fresh.next_sort();
  ASSERT_TRUE(sort);
  EXPECT_EQ(std::set<std::string>(sort->labels.begin(), sort->labels.end()).size(), 4u);
  Scripted person({"done", sort->labels[0] + " 3", "nonsense", sort->labels[0], sort->labels[0] + " 1", sort->labels[1] + " 1",
                   sort->labels[2] + " 1", sort->labels[3] + " 1", "done", "name 1 smooth", sort->labels[3] + " 2"});
  const auto broken_off = run_on(ready, folder / "a.trials", person, sizes);
  ASSERT_TRUE(broken_off && broken_off->stopped);
  EXPECT_EQ(person.refusals.size(), 4u) << "not all sorted, no third group, no such number, one group only";
  Scripted second({"done"});
  ASSERT_TRUE(run_on(ready, folder / "a.trials", second, sizes));
  PlantedObserver observer(*ready.experiment, {}, 7);
  const auto end = run_on(ready, folder / "a.trials", observer, sizes);
  ASSERT_TRUE(end && !end->stopped);
  const auto record = open_session_log(folder / "a.trials");
  std::vector<SessionGroups> sorts;
  for (const auto& each : record->entries)
    if (const auto* groups = std::get_if<SessionGroups>(&each.event)) sorts.push_back(*groups);
  ASSERT_EQ(sorts.size(), 2u);
  ASSERT_EQ(sorts[0].groups.size(), 2u);
  EXPECT_EQ(sorts[0].groups[0].patches.size(), 3u);
  EXPECT_EQ(sorts[0].groups[0].says, "smooth");
  // By magnitude the two weakest are nearest.
  ASSERT_EQ(sorts[1].groups.size(), 3u);
  EXPECT_EQ(sorts[1].groups[0].patches, (std::vector<std::string>{"bench(amplitude: 0.2 N)", "bench(amplitude: 0.25 N)"}));
  const auto table = trial_table(*record, "a");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows.size(), 8u);
}

TEST(Adjustment, EndsWhereTheParticipantSaysSo) {
  const TemporaryFolder folder;
  const Design made(design("stimulus bench(amplitude: a)\nstandard bench(amplitude: 1 N)\nfactor a 0.5 N .. 2 N, steps 5\n"
                           "task adjustment, over a\nrepetitions 2"));
  const auto ready = made.ready();
  PlantedLaw exact;
  exact.noise = 0;
  PlantedObserver observer(*ready.experiment, exact, 7);
  const auto end = run_on(ready, folder / "a.trials", observer, {0.5, 0.707107, 1, 1.41421, 2, 1});
  ASSERT_TRUE(end && !end->stopped);
  for (const auto& answer : answers_in(folder / "a.trials")) EXPECT_NEAR(std::stod(answer.answer), 1, 0.5);
}

}  // namespace
}  // namespace wale::experiments_test
