// Tables in the wild, and what becomes of rows that cannot be analysed.
#include "calibration/analysis/trials.hpp"

#include <gtest/gtest.h>

#include <string>

namespace wale::analysis {
namespace {

TrialColumns rough() {
  TrialColumns columns;
  columns.sizes = {{"amplitude"}};
  return columns;
}

Result<Trials> trials_of(const std::string& text, const TrialColumns& columns = rough()) {
  const auto table = read_table("study.tsv", text);
  if (!table) return table.error();
  return read_trials(*table, columns);
}

/// The message of the error that a text must give.
std::string refusal_of(const std::string& text, const TrialColumns& columns = rough()) {
  const auto trials = trials_of(text, columns);
  EXPECT_FALSE(trials) << text;
  if (trials) return {};
  EXPECT_EQ(trials.error().code, Code::malformed_value);
  return in_words(trials.error());
}

TEST(Table, ReadsTabsAndCommas) {
  for (const char* separator : {"\t", ",", ";"}) {
    std::string text = "participant,response,amplitude\nS1,10,0.2\nS2,20,0.8\n";
    for (std::size_t at; (at = text.find(',')) != std::string::npos;) text.replace(at, 1, std::string(separator) == "," ? "\x01" : separator);
    for (char& c : text) c = c == '\x01' ? ',' : c;
    const auto trials = trials_of(text);
    ASSERT_TRUE(trials) << in_words(trials.error());
    EXPECT_EQ(trials->size(), 2u);
    EXPECT_EQ(trials->observers, (std::vector<std::string>{"S1", "S2"}));
    EXPECT_EQ(trials->answer, (std::vector<double>{10, 20}));
    EXPECT_EQ(trials->sizes[0].values, (std::vector<double>{0.2, 0.8}));
    EXPECT_EQ(trials->line, (std::vector<std::size_t>{2, 3}));
  }
}

// A file of PsychoPy on a machine with German settings: a byte-order mark, semicolons, decimal commas, quotes that are
// not doubled, and empty columns at the end of the header and of the rows.
TEST(Table, ReadsPsychoPysWideFiles) {
  const std::string text =
      "\xEF\xBB\xBFparticipant;trials.thisN;force;rating.response;note;\r\n"
      "S48;0;0,5;12,5;\"said \"rough\" twice\";\r\n"
      "S48;1;2,0;40;\"fine; \"\"really\"\"\";\r\n"
      "\r\n"
      "S49;0;0,5;3;;\r\n";
  const auto table = read_table("data.csv", text);
  ASSERT_TRUE(table) << in_words(table.error());
  EXPECT_EQ(table->columns().size(), 5u);
  EXPECT_EQ(table->cell(0, 4), "said \"rough\" twice");
  EXPECT_EQ(table->cell(1, 4), "fine; \"really\"");
  EXPECT_EQ(table->line(2), 5u);
  EXPECT_EQ(table->notes().size(), 4u) << "the mark, the quotes, the empty line, the empty column";
  TrialColumns columns;
  columns.answer = "rating.response", columns.trial = "trials.thisN";
  columns.sizes = {{"amplitude", "force", "N"}};
  const auto trials = read_trials(*table, columns);
  ASSERT_TRUE(trials) << in_words(trials.error());
  EXPECT_EQ(trials->answer, (std::vector<double>{12.5, 40, 3}));
  EXPECT_EQ(trials->sizes[0].values, (std::vector<double>{0.5, 2, 0.5}));
  EXPECT_EQ(trials->sizes[0].unit, "N");
}

TEST(Table, KeepsLineBreaksInQuotes) {
  const auto table = read_table("x.csv", "participant,says\nS1,\"one\ntwo\"\nS2,three\n");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->cell(0, 1), "one\ntwo");
  EXPECT_EQ(table->line(1), 4u);
}

TEST(Table, RefusesWhatIsNoTable) {
  const auto words = [](const std::string& text) {
    const auto table = read_table("x.csv", text);
    EXPECT_FALSE(table) << text;
    return table ? std::string() : in_words(table.error());
  };
  EXPECT_NE(words("").find("empty"), std::string::npos);
  EXPECT_NE(words("# only a comment\n").find("empty"), std::string::npos);
  EXPECT_NE(words("a,b\n").find("no rows"), std::string::npos);
  EXPECT_NE(words("a,b\n1,2,3\n").find("x.csv:2: "), std::string::npos);
  EXPECT_NE(words("a,b\n1,2\n1\n").find("x.csv:3: this row has 1 cell"), std::string::npos);
  EXPECT_NE(words("a,a\n1,2\n").find("two columns"), std::string::npos);
  EXPECT_NE(words("a,,c\n1,2,3\n").find("column 2 has no name"), std::string::npos);
  EXPECT_NE(words("a,b,\n1,2,3\n").find("column 3 has no name"), std::string::npos);
  EXPECT_NE(words("a,b\n1,\"2\n3,4\n").find("x.csv:2: a quote begins"), std::string::npos);
  EXPECT_NE(words(std::string("\xFF\xFE" "a\0,\0", 6)).find("UTF-8"), std::string::npos);
}

TEST(Trials, ListExclusionsWithTheirRule) {
  TrialColumns columns = rough();
  columns.keep = {{"block", "practice", false}, {"participant", "S9", false}};
  columns.leave_out_nonpositive = true;
  const auto trials = trials_of(
      "participant\tblock\tresponse\tamplitude\n"
      "S1\tpractice\t7\t0.2\nS1\tmain\t10\t0.2\nS1\tmain\tn/a\t0.8\nS1\tmain\t0\t0.2\nS9\tmain\t4\t0.2\nS1\tmain\t20\t0.8\n",
      columns);
  ASSERT_TRUE(trials) << in_words(trials.error());
  EXPECT_EQ(trials->size(), 2u);
  ASSERT_EQ(trials->exclusions.size(), 4u);
  EXPECT_EQ(trials->size() + trials->exclusions.size(), 6u) << "nothing is dropped in silence";
  const char* rules[] = {"only rows whose block is not practice", "no answer", "magnitudes of zero or below",
                         "only rows whose participant is not S9"};
  const std::size_t lines[] = {2, 4, 5, 6};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(trials->rules[trials->exclusions[i].rule], rules[i]);
    EXPECT_EQ(trials->exclusions[i].line, lines[i]);
  }
  columns.keep = {{"block", "warm-up", true}};
  EXPECT_NE(refusal_of("participant\tblock\tresponse\tamplitude\nS1\tmain\t1\t2\n", columns).find("no trial is left"), std::string::npos);
}

TEST(Trials, LeaveOutWhatTheStudyMarks) {
  const std::string text =
      "participant\ttrial_type\texcluded\tgrade\tresponse\tamplitude\n"
      "S1\tpractice\tn/a\tmeasured\t7\t0.2\nS1\tmain\tn/a\tmeasured\t10\t0.2\n"
      "S1\tmain\tlonger than 60 min\tmeasured\t9\t0.2\nS1\tmain\tn/a\tsimulated\t20\t0.8\n";
  const auto trials = trials_of(text);
  ASSERT_TRUE(trials) << in_words(trials.error());
  EXPECT_EQ(trials->size(), 2u);
  EXPECT_EQ(trials->rules, (std::vector<std::string>{"practice", "longer than 60 min"}));
  EXPECT_TRUE(trials->simulated) << "one simulated answer is enough";
  TrialColumns all = rough();
  all.by_study = false;
  EXPECT_EQ(trials_of(text, all)->size(), 4u);
}

TEST(Tables, InLatin1AreRefused) {
  const std::string head = "participant,response,amplitude\nS1,1,0.2\n";
  EXPECT_TRUE(trials_of(head + "\xC3\x84rzte,2,0.8\n"));
  for (const char* name : {"\xC4rzte", "M\xFCller", "\xE9"})
    EXPECT_NE(refusal_of(head + name + ",2,0.8\n").find("study.tsv:3: expected text in UTF-8"), std::string::npos)
        << refusal_of(head + name + ",2,0.8\n");
}

TEST(Trials, OnlyTheWordMeasuredIsMeasured) {
  const auto graded = [](const std::string& word) {
    return "participant,grade,response,amplitude\nS1,measured,10,0.2\nS1," + word + ",20,0.8\n";
  };
  for (const char* word : {"measured", "Measured", " measured "}) {
    const auto trials = trials_of(graded(word));
    ASSERT_TRUE(trials) << in_words(trials.error());
    EXPECT_FALSE(trials->simulated || trials->ungraded) << word;
  }
  for (const char* word : {"simulated", "Simulated", "SIMULATED"}) {
    const auto trials = trials_of(graded(word));
    ASSERT_TRUE(trials) << in_words(trials.error());
    EXPECT_TRUE(trials->simulated) << word;
  }
  for (const char* word : {"", "n/a"}) {
    const auto trials = trials_of(graded(word));
    ASSERT_TRUE(trials) << in_words(trials.error());
    EXPECT_TRUE(trials->ungraded && !trials->simulated) << word;
  }
  for (const char* word : {"A", "estimated", "published", "simulation", "pilot"})
    EXPECT_NE(refusal_of(graded(word)).find("study.tsv:3: expected measured or simulated for the grade, found `" + std::string(word)),
              std::string::npos)
        << refusal_of(graded(word));
  EXPECT_TRUE(trials_of("participant,response,amplitude\nS1,10,0.2\nS1,20,0.8\n")->ungraded);
  for (const char* device : {"pointer", "simulated", "simulated:sandpaper"}) {
    const std::string row = "S1,measured," + std::string(device);
    EXPECT_TRUE(trials_of("participant,grade,device,response,amplitude\n" + row + ",10,0.2\n" + row + ",20,0.8\n")->simulated);
  }
}

TEST(Trials, NameFileAndRowOfWhatIsWrong) {
  const std::string head = "participant,response,amplitude\n";
  EXPECT_NE(refusal_of(head + "S1,10,0.2\nS1,ten,0.8\n").find("study.tsv:3: expected a number for an answer, found `ten`"), std::string::npos);
  EXPECT_NE(refusal_of(head + "S1,0,0.2\n").find("study.tsv:2: expected a magnitude above zero, found `0`"), std::string::npos);
  EXPECT_NE(refusal_of(head + "S1,-3,0.2\n").find("study.tsv:2"), std::string::npos);
  EXPECT_NE(refusal_of(head + "S1,10,0.2\nS1,20,\n").find("study.tsv:3: the amplitude is missing"), std::string::npos);
  EXPECT_NE(refusal_of(head + "S1,10,0.2 N\nS1,20,80 gf\n").find("study.tsv:3: two units"), std::string::npos);
  EXPECT_NE(refusal_of(head + "S1,10,0.2 N\nS1,20,0.8\n").find("study.tsv:3: two units"), std::string::npos);
  EXPECT_NE(refusal_of(head + "S1,10,0.2\nS1,20,0.8 N\n").find("study.tsv:3: two units"), std::string::npos);
  EXPECT_NE(refusal_of(head + ",10,0.2\n").find("study.tsv:2: this row names no observer"), std::string::npos);
  EXPECT_NE(refusal_of(head + "S1,10,0.5\nS1,20,0.5\n").find("the amplitude is 0.5 in all 2 trials"), std::string::npos);
  EXPECT_NE(refusal_of("subject,response,amplitude\nS1,1,2\n").find("no column `participant`"), std::string::npos);
  EXPECT_NE(refusal_of("participant;response;amplitude\nS1;1,5;2\nS1;1.5;3\n").find("study.tsv:3: a decimal point"), std::string::npos);
  EXPECT_NE(refusal_of("participant,trial,response,amplitude\nS1,1,10,0.2\nS2,1,10,0.2\nS1,1,10,0.2\n")
                .find("study.tsv:4: trial 1 of S1 is there twice: first in row 2"),
            std::string::npos);
  EXPECT_NE(refusal_of("participant,device,response,amplitude\nS1,sandpaper,10,0.2\nS1,pads,10,0.8\n")
                .find("study.tsv:3: the device is `pads` here and `sandpaper` in row 2"),
            std::string::npos);
  TrialColumns ratings = rough();
  ratings.answers = Answers::ratings;
  EXPECT_NE(refusal_of(head + "S1,101,0.2\n", ratings).find("from 0 to 100"), std::string::npos);
  TrialColumns choices = rough();
  choices.answers = Answers::choices;
  EXPECT_NE(refusal_of(head + "S1,left,0.2\n", choices).find("expected 1 or 0"), std::string::npos);
}

TEST(Trials, ReadUnitsWhereTheyStand) {
  const auto unit_of = [](const std::string& column, const std::string& cells, const std::string& stated) {
    TrialColumns columns;
    columns.sizes = {{"amplitude", column, stated}};
    const auto trials = trials_of("participant\tresponse\t" + column + "\nS1\t1\t0.2" + cells + "\nS1\t2\t0.8" + cells + "\n", columns);
    EXPECT_TRUE(trials) << column << cells;
    return trials ? trials->sizes[0].unit : "";
  };
  EXPECT_EQ(unit_of("amplitude (N)", "", ""), "N");
  EXPECT_EQ(unit_of("amplitude [pu]", "", ""), "pu");
  EXPECT_EQ(unit_of("force", " mN", ""), "mN");
  EXPECT_EQ(unit_of("force", "", "N"), "N");
  EXPECT_EQ(unit_of("force", "", ""), "");
}

TEST(Trials, NoteWhoLacksStimuli) {
  const auto trials = trials_of("participant,response,amplitude\nS1,10,0.2\nS1,20,0.8\nS1,21,0.8\nS2,5,0.2\n");
  ASSERT_TRUE(trials);
  ASSERT_EQ(trials->notes.size(), 1u);
  EXPECT_EQ(trials->notes[0], "S2 has answers to 1 of 2 stimuli");
}

TEST(Trials, NoteRunsThatAreShort) {
  std::string text = "participant,run,trial,size (N),response\n";
  for (const char* who : {"A", "B"})
    for (int run = 1; run <= 2; ++run)
      for (int trial = 1; trial <= 4; ++trial)
        if (!(*who == 'B' && run == 2 && trial == 4))
          text += std::string(who) + "," + std::to_string(run) + "," + std::to_string(trial) + "," + std::to_string(trial) + ",5\n";
  const auto table = read_table("t.csv", text);
  ASSERT_TRUE(table);
  const auto trials = read_trials(*table, {.sizes = {{"size", "size (N)", ""}}});
  ASSERT_TRUE(trials) << in_words(trials.error());
  EXPECT_EQ(trials->notes, std::vector<std::string>{"B has 3 trials in run 2, and most runs have 4"});
}

TEST(Trials, ReadAThousandColumns) {
  std::string header = "participant,response,amplitude", row1 = "S1,1,0.2", row2 = "S1,2,0.8";
  for (int i = 0; i < 1000; ++i) header += ",c" + std::to_string(i), row1 += ",x", row2 += ",\"y, z\"";
  const auto trials = trials_of(header + "\n" + row1 + "\n" + row2 + "\n");
  ASSERT_TRUE(trials);
  EXPECT_EQ(trials->size(), 2u);
}

}  // namespace
}  // namespace wale::analysis
