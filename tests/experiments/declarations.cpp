// Experiments as they are written, checked, formatted and described.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "compiler/describe_experiment.hpp"
#include "compiler/format/format.hpp"
#include "tests/experiments/texts.hpp"

namespace wale::experiments_test {
namespace {

TEST(ExperimentDeclaration, StimuliAreCrossedWithTheFactorsThatTheyName) {
  const Design made(design("stimulus bench(amplitude: strong * 2, period: period), smooth\n"
                           "factor strong 0.2 N, 400 mN\nfactor period 1.2 mm, 2.5 mm, 5 mm\n"
                           "task magnitude_estimation, modulus 10"));
  const auto& experiment = made.experiment();
  ASSERT_EQ(experiment.stimuli.size(), 7u);
  EXPECT_EQ(experiment.stimuli[0].name, "bench(amplitude: 0.2 N * 2, period: 1.2 mm)");
  EXPECT_EQ(experiment.stimuli[1].name, "bench(amplitude: 0.2 N * 2, period: 2.5 mm)");
  EXPECT_EQ(experiment.stimuli[3].name, "bench(amplitude: 400 mN * 2, period: 1.2 mm)");
  EXPECT_EQ(experiment.stimuli[6].name, "smooth");
  EXPECT_EQ(experiment.stimuli[3].levels, (std::vector<std::optional<std::size_t>>{1, 0}));
  EXPECT_EQ(experiment.stimuli[6].levels, (std::vector<std::optional<std::size_t>>{std::nullopt, std::nullopt}));
  EXPECT_NEAR(*experiment.factors[0].levels[1].value, 0.4, 1e-12);
  EXPECT_EQ(experiment.factors[0].unit, "N");
  EXPECT_EQ(*experiment.modulus, 10);
  // The program of a stimulus is that of the material written out.
  const auto ready = made.ready();
  EXPECT_NEAR(ready.stimuli[3].description().parameters[0].value, 0.8f, 1e-6f);
}

TEST(ExperimentDeclaration, FactorsMayBeMaterialsAndSteps) {
  const Design made("wale 1\nmaterial a { physical { param size = 1 N in 0 N .. 4 N; force = lateral(cos(x / 1 mm), amplitude: "
                    "size) } }\nmaterial b { physical { param size = 1 N in 0 N .. 4 N; force = lateral(grating(x, period: 3 "
                    "mm), amplitude: size) } }\nexperiment test {\nstimulus kind(size: size)\nfactor kind a, b\n"
                    "factor size 0.5 N .. 2 N, steps 3\ntask rating, \"smooth\", \"rough\"\n}\n");
  const auto& experiment = made.experiment();
  ASSERT_EQ(experiment.stimuli.size(), 6u);
  EXPECT_EQ(experiment.stimuli[0].made_of, "a(size: 0.5 N)");
  EXPECT_EQ(experiment.stimuli[4].made_of, "b(size: 1 N)") << "equal ratios: 0.5, 1, 2";
  EXPECT_EQ(experiment.lowest, "smooth");
  EXPECT_EQ(experiment.highest, "rough");
}

TEST(ExperimentDeclaration, EvenStepsMayBeginAtZero) {
  const Design made(design("stimulus bench(amplitude: a * 1 N)\nfactor a 0 .. 1, steps 5, even\ntask rating"));
  std::vector<double> levels;
  for (const auto& each : made.experiment().factors[0].levels) levels.push_back(*each.value);
  EXPECT_EQ(levels, (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
}

TEST(ExperimentDeclaration, MistakesAreToldEach) {
  const std::string bench = "stimulus bench(amplitude: a)\nfactor a 0.2 N, 0.8 N\n";
  for (const auto& [settings, message] : std::vector<std::pair<std::string, std::string>>{
           {"task rating", "the experiment `test` lacks `stimulus`"},
           {"stimulus smooth", "the experiment `test` lacks `task`"},
           {bench + "task ratng", "no such name of a task: `ratng`"},
           {bench + "task rating; colour red", "an experiment has no setting `colour`"},
           {"stimulus bench(amplitude: a)\nfactor a 0.2 N, 3 mm\ntask rating", "the levels of a factor must have one dimension"},
           {"stimulus bench(amplitude: a)\nfactor a 0.2 N, 200 mN\ntask rating", "the level 200 mN is there twice"},
           {"stimulus smooth\nfactor a 0.2 N, 0.8 N\ntask rating", "no stimulus depends on the factor `a`"},
           {bench + "factor a 1 N\ntask rating", "there are two factors `a`"},
           {"stimulus bench(amplitude: a)\nfactor a 0.2 N .. 2 N\ntask rating", "a range needs its number of steps"},
           {"stimulus bench(amplitude: a)\nfactor a 0 N .. 2 N, steps 3\ntask rating", "steps of equal ratio must begin above 0"},
           {"stimulus bench(amplitude: a)\nfactor a 2 N .. 1 N, steps 3\ntask rating",
            "a range goes from the lower to the higher end"},
           {"stimulus bench(amplitude: a)\nfactor a 1 N .. 2 N, steps 2.5\ntask rating", "a range has 2 to 500 steps"},
           {"stimulus smooth(size: 1 N)\ntask rating", "`smooth` has no parameter `size`"},
           {"stimulus velour2\ntask rating", "no material is called `velour2`"},
           {bench + "task two_interval", "`two_interval` compares with a standard"},
           {bench + "task rating; standard smooth", "`rating` compares with no standard"},
           {bench + "task two_interval; standard bench(amplitude: b)\n", "nothing here is called `b`"},
           {bench + "task two_interval; standard smooth; method up_down", "an adaptive method moves along a factor"},
           {bench + "task two_interval; standard smooth; method up_down, over a", "`a` has too few levels to move along"},
           {bench + "task two_interval; standard smooth; method up_down, over b", "there is no factor `b`"},
           {bench + "task rating; method quest_plus, over a",
            "`rating` has no right and wrong answers that a method could go by"},
           {bench + "task sorting, groups 3", "2 stimuli cannot be sorted into 3 groups"},
           {bench + "task rating, groups 2", "`rating` does not take this"},
           {bench + "task rating; repetitions 0", "expected a whole number from 1 to 1000"},
           {bench + "task rating; practice 1, nothing", "there is no stimulus `nothing`"},
           {bench + "task rating; break 0 s", "a duration must be above 0, and at most 30 days"},
           {bench + "task rating; break 5 mm", "expected time, found length"},
           {bench + "task rating; order backwards", "the order is `random` or `fixed`"},
           {bench + "task rating; question sure how \"Sure?\"", "there is no kind of answer `how`"},
           {bench + "task rating; question a text \"A?\"; closing a text \"B?\"", "there are two questions `a`"},
           {bench + "task rating; question trial text \"A?\"", "`trial` is the name of an answer or a column already"},
           {bench + "task rating; motion up", "no such name of a motion: `up`"},
           {bench + "task rating; catch 20 %", "only one_interval and same_different have catch trials"},
           {bench + "task rating; interrupted later", "expected `resume`, `practice` or `restart` and how long ago, or `refuse`"},
       }) {
    const auto messages = messages_of(design(settings));
    ASSERT_FALSE(messages.empty()) << settings;
    EXPECT_EQ(messages, std::vector<std::string>{message}) << settings;
  }
}

TEST(ExperimentDeclaration, TooManyStimuliAreRefusedAtOnce) {
  const auto messages = messages_of(design("stimulus bench(amplitude: a, period: p)\nfactor a 0.1 N .. 2 N, steps 200\n"
                                           "factor p 1 mm .. 5 mm, steps 200\ntask rating"));
  EXPECT_EQ(messages, std::vector<std::string>{"an experiment has at most 2000 stimuli"});
}

TEST(ExperimentDeclaration, CannotBeExportedAndIsFormattedAsARecord) {
  EXPECT_EQ(messages_of("wale 1\nmaterial a { physical { force = lateral(cos(x / 1 mm), amplitude: 1 N) } }\n"
                        "export experiment e { stimulus a; task rating }\n"),
            std::vector<std::string>{"an experiment cannot be exported: no other file names it"});
  const std::string written =
      "wale 1\n\nexperiment e {\n  stimulus oak, denim\n  task     sorting, groups 2\n  break    5 min, after block\n}\n";
  SourceSet sources;
  Diagnostics diagnostics;
  EXPECT_EQ(format(sources, sources.add("t.wale", written), diagnostics), written);
}

TEST(ExperimentDeclaration, NamesMaterialsOfTheLibrary) {
  const Design made("wale 1\nexperiment e {\nstimulus oak, cloth(roughness: level)\nfactor cloth denim, velvet\n"
                    "factor level 0.2, 0.4\ntask rating\n}\n");
  EXPECT_EQ(made.experiment().stimuli.size(), 5u);
}

TEST(ExperimentDescription, SaysHowLongAndWhichPairsAreAlike) {
  const Design made(design("stimulus bench(amplitude: a)\nfactor a 1 N, 1.01 N, 3 N\ntask magnitude_estimation\n"
                           "practice 3; repetitions 2; present 3 s; break 5 min, after block"));
  const auto description = describe_experiment(made.experiment(), made.made(), default_device, made.module.declarations());
  EXPECT_EQ(description.trials, 9u);
  // 9 presentations of 3 s, 9 answers of 4 s, one break between two blocks.
  EXPECT_NEAR(description.seconds, 9 * 3 + 9 * 4 + 300, 1e-9);
  EXPECT_EQ(description.pairs, 3u);
  ASSERT_EQ(description.alike, 1u);
  EXPECT_EQ(description.nearest[0].a, "bench(amplitude: 1 N)");
  EXPECT_EQ(description.nearest[0].b, "bench(amplitude: 1.01 N)");
  EXPECT_LT(description.nearest[0].noticeable, 1);
  EXPECT_TRUE(description.unrendered.empty());
}

TEST(ExperimentDescription, SaysWhatTheDeviceDoesNotRender) {
  const Design made("wale 1\nmaterial strong { physical { param a = 1 N in 0 N .. 60 N; force = lateral(cos(x / 1 mm), "
                    "amplitude: a) } }\nexperiment e {\nstimulus strong(a: a)\nfactor a 1 N, 50 N\ntask rating\n}\n");
  const auto description = describe_experiment(made.experiment(), made.made(), default_device, made.module.declarations());
  ASSERT_EQ(description.unrendered.size(), 1u) << experiment_text(description);
  EXPECT_EQ(description.unrendered[0].name, "strong(a: 50 N)");
}

/// The figures of the thesis: section 4.4, 5.2.3 and 6.2.
TEST(ShippedExperiments, TheThesissHaveItsNumbers) {
  const auto load = [](const std::string& name) {
    const std::string path = std::string(WALE_SOURCE_DIR) + "/calibration/experiments/" + name;
    std::ifstream file(path);
    return Design(std::string(std::istreambuf_iterator<char>(file), {}), path);
  };
  const Design four = load("minsky1995_chapter4.wale");
  const auto& confidence = four.experiment();
  EXPECT_EQ(confidence.stimuli.size(), 102u);
  EXPECT_EQ(confidence.practice, 36);
  EXPECT_EQ(confidence.repetitions, 2);
  EXPECT_EQ(confidence.pause, 300);
  EXPECT_EQ(confidence.longest, 3600);
  EXPECT_EQ(confidence.task, TrialTask::confidence);
  const Design five = load("minsky1995_chapter5.wale");
  EXPECT_EQ(five.experiment().stimuli.size(), 30u);
  EXPECT_EQ(five.experiment().practice, 30);
  EXPECT_EQ(five.experiment().repetitions, 3);
  const Design six = load("minsky1995_chapter6.wale");
  EXPECT_EQ(six.experiment().stimuli.size(), 12u);
  EXPECT_EQ(six.experiment().groups, (std::vector<int>{2, 3, 4}));
}

TEST(ShippedExperiments, HaveNoErrorAndAreFormatted) {
  for (const auto& entry : std::filesystem::directory_iterator(std::string(WALE_SOURCE_DIR) + "/calibration/experiments")) {
    if (entry.path().extension() != ".wale") continue;
    std::ifstream file(entry.path());
    const std::string text(std::istreambuf_iterator<char>(file), {});
    SourceSet sources;
    Diagnostics diagnostics;
    const auto resolver = file_resolver({});
    const SourceId source = sources.add(entry.path().string(), text);
    const auto module = check_source(sources, source, *resolver, diagnostics);
    for (const auto& each : diagnostics.all()) ADD_FAILURE() << render_text(each, sources, false);
    EXPECT_FALSE(module.experiments.empty()) << entry.path();
    EXPECT_EQ(format(sources, source, diagnostics), text) << entry.path();
  }
}

}  // namespace
}  // namespace wale::experiments_test
