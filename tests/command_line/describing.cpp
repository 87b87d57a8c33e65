// `wale describe` on documentation, ranges, memories, marks and modules; `wale feel` on restored states and limits.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/command_line/running.hpp"

namespace wale::command_line::describing_test {
namespace {

const std::string sledge = R"(wale 1

/// A block on a spring.
/// It lags behind.
material sledge {
  physical {
    param k = 60 N/m in 10 N/m .. 200 N/m, soft 30 N/m .. 120 N/m  "stiffness"
    param c = 2 N s/m in 0 N s/m .. 5 N s/m
    state p : position = hand in -60 mm .. 60 mm
    memory track : length = 1 mm in 0 mm .. 5 mm, cell 2 mm
    patch 80 mm, 60 mm
    p' = (hand - p) / 100 ms
    next track = track + 1 mm/s * dt
    force = k * (p - hand) - c * velocity
    show spring(p, hand, 7 mm, colour: "#204060")
    show box(p, 20 mm, 10 mm, colour: "#8a5a2b")
    show colour(0.5, 0.5, track / 5 mm)
  }
}
)";

const std::string module = R"(wale 1

/// Litres a second.
export unit lps = 0.001 m^3/s
export dimension flow = area * velocity
/// Standard gravity.
export let gravity = 9.80665 m/s^2
let hidden = 2
/// A bump of a height of 1.
export function bump(place: length, width: length = 4 mm, power = 2) = exp(-(length(place) / width)^hidden * power)
function inner(a) = a
export function twice(a) = inner(2 * a)
)";

// The share of a component is its weight over the sum of all, which is at most 1, also if all weights are nearly 0.
TEST(Describe, ABlendIsNotSaidToAskForMoreThanItsComponents) {
  const TemporaryFolder folder;
  const std::string file = folder.write("mix.wale", "wale 1\nmaterial mix = 70 % corduroy + 0.3 denim\n");
  const Outcome outcome = wale({"describe", file});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_FALSE(contains(outcome.out, "limited by the compiler")) << outcome.out;
}

TEST(Describe, ProvesABoundAndGrades) {
  const TemporaryFolder folder;
  const auto of = [&](const std::string& physical) {
    return wale(
               {"describe", folder.write("m.wale", "wale 1\nmaterial m { physical { " + physical + " } }\n"), "--json"})
        .json();
  };
  // The bound of a spring is 40 N/m * 0.2286 m along each axis, as places are within the workspace, not the patch.
  const auto spring = of("patch 80 mm, 80 mm; force = -40 N/m * hand");
  EXPECT_NEAR(spring.at("force").at("bound_newton").get<double>(), 40 * 0.2286 * std::sqrt(2.0), 0.02);
  EXPECT_NEAR(spring.at("stiffness").at("max_newton_per_metre").get<double>(), 40, 1e-3);
  EXPECT_NEAR(spring.at("grade").at("required_damping").get<double>(), 40.0 / 1800, 1e-5);
  EXPECT_EQ(spring.at("grade").at("name"), "unknown");
  EXPECT_FALSE(spring.at("force").at("limit_matters").get<bool>());
  EXPECT_GT(spring.at("cost").get<int>(), 0);
  // Above the device's 10 N, the bound is the limit.
  const auto stiff = of("force = -400 N/m * hand");
  EXPECT_NEAR(stiff.at("force").at("bound_newton").get<double>(), 10 * std::sqrt(2.0), 0.01);
  EXPECT_TRUE(stiff.at("force").at("limit_matters").get<bool>());
  const auto ice = of("active 0.5 W; force = 2 N s/m * velocity");
  EXPECT_EQ(ice.at("grade").at("name"), "active");
  EXPECT_NEAR(ice.at("grade").at("required_damping").get<double>(), 2, 0.01);
}

TEST(Describe, HasStatesMemoriesAndMarks) {
  const TemporaryFolder folder;
  const std::string file = folder.write("sledge.wale", sledge);
  const auto described = wale({"describe", file, "--json"}).json();
  EXPECT_EQ(described.at("documentation"), "A block on a spring.\nIt lags behind.");
  const auto& states = described.at("states");
  ASSERT_EQ(states.size(), 2u);
  EXPECT_EQ(states[0].at("name"), "p.x");
  EXPECT_DOUBLE_EQ(states[0].at("min_si").get<double>(), -0.06);
  EXPECT_DOUBLE_EQ(states[1].at("max_si").get<double>(), 0.06);
  const auto& memory = described.at("memories").at(0);
  EXPECT_EQ(memory.at("name"), "track");
  EXPECT_EQ(memory.at("columns"), 40);  // 80 mm in cells of 2 mm
  EXPECT_EQ(memory.at("rows"), 30);
  EXPECT_EQ(memory.at("bytes"), 40 * 30 * 4);
  EXPECT_DOUBLE_EQ(memory.at("initial_si").get<double>(), 0.001);
  const auto& shows = described.at("shows");
  EXPECT_EQ(shows.at("colour"), true);
  EXPECT_EQ(shows.at("relief"), false);
  EXPECT_EQ(shows.at("marks").at(0), (nlohmann::json{{"kind", "spring"}, {"colour", "#204060"}}));
  EXPECT_EQ(shows.at("marks").at(1), (nlohmann::json{{"kind", "box"}, {"colour", "#8a5a2b"}}));
  for (const char* section : {"setup", "peak", "enter", "tick", "picture", "frame"})
    EXPECT_TRUE(described.at("sections").at(section).contains("cost")) << section;

  const std::string text = wale({"describe", file}).out;
  for (const char* part : {"A block on a spring.\n", "It lags behind.\n", "p.x", "-0.06 .. 0.06", "40 x 30 cells",
                           "4800 bytes", "spring #204060", "the hand's velocity and its memory"})
    EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
}

TEST(Describe, HasUsualRangesWhereTheyAreNarrower) {
  const TemporaryFolder folder;
  const std::string file = folder.write("sledge.wale", sledge);
  const auto parameters = wale({"describe", file, "--json"}).json().at("parameters");
  EXPECT_DOUBLE_EQ(parameters.at(0).at("soft_min").get<double>(), 30);
  EXPECT_DOUBLE_EQ(parameters.at(0).at("soft_max").get<double>(), 120);
  EXPECT_FALSE(parameters.at(1).contains("soft_min"));
  const std::string text = wale({"describe", file}).out;
  EXPECT_TRUE(contains(text, "usually 30 .. 120 N/m")) << text;
  EXPECT_FALSE(contains(text, "usually 0 .. 5")) << text;
}

TEST(Describe, SaysWhyThereIsNoPercept) {
  const TemporaryFolder folder;
  const auto reason = [&](const std::string& force, const char* of) {
    const std::string file = folder.write("a.wale", "wale 1\nmaterial a { physical { force = " + force + " } }\n");
    return wale({"describe", file, "--json"}).json().at(of).get<std::string>();
  };
  EXPECT_TRUE(contains(reason("-2 N s/m * velocity", "no_texture"), "the hand's velocity"));
  EXPECT_TRUE(contains(reason("spring(20 N/m)", "no_texture"), "depends on the position"));
  EXPECT_TRUE(contains(reason("spring(20 N/m) * sin(time * 6 / 1 s)", "no_texture"), "time"));
  EXPECT_TRUE(contains(reason("vector(1 N, 0 N)", "no_percept"), "the same everywhere"));
  EXPECT_TRUE(contains(reason("lateral(sin(2 pi * x / 0.3 mm), amplitude: 1 N)", "no_percept"), "0.3 mm"));
  EXPECT_TRUE(contains(reason("0 N/m * hand", "no_percept"), "does not push"));
  EXPECT_FALSE(wale({"describe", corduroy, "--json"}).json().contains("no_percept"));
  EXPECT_FALSE(wale({"describe", corduroy, "--json"}).json().contains("no_texture"));
}

/// The lines that LANGUAGE.md says `describe` prints of the corduroy.
TEST(Describe, SaysOfTheCorduroyWhatItsPageSays) {
  const std::string page = bytes_of(std::string(WALE_SOURCE_DIR) + "/schema/LANGUAGE.md");
  const std::string from = "```text\nfeels\n";
  const auto begin = page.find(from);
  ASSERT_NE(begin, std::string::npos);
  std::istringstream block(page.substr(begin + 8, page.find("```", begin + 8) - begin - 8));
  const std::string said = wale({"describe", corduroy}).out;
  int lines = 0;
  for (std::string line; std::getline(block, line); ++lines)
    EXPECT_TRUE(contains(said, line + "\n")) << line << "\n" << said;
  EXPECT_GT(lines, 20);
}

TEST(Describe, ListsTheExportsOfAModule) {
  const TemporaryFolder folder;
  const std::string file = folder.write("module.wale", module);
  const Outcome outcome = wale({"describe", file, "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto described = outcome.json();
  EXPECT_EQ(described.at("file"), file);
  const auto& functions = described.at("functions");
  ASSERT_EQ(functions.size(), 2u) << "in the order written, without `inner`";
  EXPECT_EQ(functions[0].at("name"), "bump");
  EXPECT_EQ(functions[0].at("documentation"), "A bump of a height of 1.");
  const auto& arguments = functions[0].at("arguments");
  ASSERT_EQ(arguments.size(), 3u);
  EXPECT_EQ(arguments[0], (nlohmann::json{{"name", "place"}, {"dimension", "length"}}));
  EXPECT_EQ(arguments[1], (nlohmann::json{{"name", "width"}, {"dimension", "length"}, {"default", "4 mm"}}));
  EXPECT_EQ(arguments[2], (nlohmann::json{{"name", "power"}, {"default", "2"}}));
  EXPECT_EQ(functions[1].at("name"), "twice");
  ASSERT_EQ(described.at("constants").size(), 1u);
  EXPECT_EQ(described.at("constants")[0].at("value"), "9.80665 m/s^2");
  EXPECT_EQ(described.at("constants")[0].at("documentation"), "Standard gravity.");
  ASSERT_EQ(described.at("units").size(), 1u);
  EXPECT_DOUBLE_EQ(described.at("units")[0].at("in_si").get<double>(), 0.001);
  EXPECT_EQ(described.at("units")[0].at("dimension"), "flow");
  EXPECT_EQ(described.at("units")[0].at("documentation"), "Litres a second.");
  EXPECT_EQ(described.at("dimensions").at(0).at("factors"), "m^3 s^-1");

  const std::string text = wale({"describe", file}).out;
  EXPECT_TRUE(contains(text, "bump(place: length, width: length = 4 mm, power = 2)\n")) << text;
  EXPECT_TRUE(contains(text, "A bump of a height of 1.")) << text;
  EXPECT_FALSE(contains(text, "inner")) << text;
  EXPECT_FALSE(contains(text, "hidden =")) << text;
}

TEST(Describe, ListsExportedRecords) {
  const TemporaryFolder folder;
  const std::string levels =
      folder.write("levels.wale", "wale 1\nexport levels roughness { mild 0.31 }\nlevels hardness { mild 0.3 }\n");
  const auto described = wale({"describe", levels, "--json"}).json();
  EXPECT_EQ(described.at("records"), (nlohmann::json{{{"what", "levels"}, {"name", "roughness"}}}));
  const std::string text = wale({"describe", "--exports", levels}).out;
  EXPECT_TRUE(contains(text, "levels       roughness\n")) << text;
  EXPECT_FALSE(contains(text, "hardness")) << text;
  const std::string nothing = folder.write("nothing.wale", "wale 1\nlet a = 1\n");
  EXPECT_TRUE(contains(wale({"describe", "--exports", nothing}).out, "exports nothing"));
}

TEST(Describe, ReadsTheFilesOfTheLanguageAsModules) {
  const auto described = wale({"describe", std::string(WALE_SOURCE_DIR) + "/schema/units.wale", "--json"}).json();
  EXPECT_EQ(described.at("functions").size(), 0u);
  EXPECT_EQ(described.at("dimensions").at(0).at("name"), "length");
  EXPECT_EQ(described.at("units").at(0).at("name"), "m");
}

TEST(Describe, ListsExportsOfAFileWithMaterialsOnRequest) {
  const TemporaryFolder folder;
  const std::string file = folder.write("both.wale", module + "material a { physical { force = viscous(2 N s/m) } }\n");
  EXPECT_EQ(wale({"describe", file, "--json"}).json().at("material"), "a");
  EXPECT_EQ(wale({"describe", file, "--exports", "--json"}).json().at("functions").size(), 2u);
  // A file with neither materials nor exports is an error.
  EXPECT_EQ(wale({"describe", folder.write("none.wale", "wale 1\n")}).status, 1);
}

TEST(Feel, CountsRestoredStates) {
  const TemporaryFolder folder;
  const std::string file = folder.write("broken.wale", R"(wale 1
material broken {
  physical {
    state q = 0 in -1 .. 1
    next q = sqrt(-1 - time / 1 s) + 0 * q
    force = -1 N/m * hand * (1 + q)
  }
}
)");
  const std::vector<std::string> command{"feel", file, "--virtual-time", "--seconds", "0.1"};
  const Outcome text = wale(command);
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_TRUE(contains(text.out, "90 times a state was not a number")) << text.out;  // every tick of 0.1 s at 900 Hz
  auto with_json = command;
  with_json.emplace_back("--json");
  EXPECT_EQ(wale(with_json).json().at("guards").at("restored"), 90);
  EXPECT_FALSE(contains(wale({"feel", corduroy, "--virtual-time", "--seconds", "0.1"}).out, "not a number and"));
}

TEST(Set, OutsideTheUsualRangeIsAWarning) {
  const TemporaryFolder folder;
  const std::string file = folder.write("sledge.wale", sledge);
  const Outcome outcome = wale({"describe", file, "--json", "--set", "k=150 N/m"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "warning[W0308]")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "from 30 N/m to 120 N/m")) << outcome.err;
  EXPECT_DOUBLE_EQ(outcome.json().at("parameters").at(0).at("value").get<double>(), 150);
  EXPECT_EQ(wale({"describe", file, "--set", "k=30 N/m"}).err, "") << "the ends of the range belong to it";
  EXPECT_EQ(wale({"describe", file, "--set", "k=250 N/m"}).status, 2);
}

TEST(Describing, KeepsWordsOfFeels) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("m.wale",
                   "wale 1\n\nmaterial m {\n  representative { feels \"pleasant\", \"like ball bearings\" }\n"
                   "  physical { force = spring(40 N/m) }\n}\n");
  EXPECT_TRUE(contains(wale({"describe", file}).out, "pleasant, like ball bearings"));
  EXPECT_EQ(wale({"describe", file, "--json"}).json().at("representative").at("feels"),
            (std::vector<std::string>{"pleasant", "like ball bearings"}));
}

TEST(Describing, SaysHowWellALevelIsKnownAndWhatACatalogueKeeps) {
  const TemporaryFolder folder;
  const std::string file = folder.write(
      "m.wale",
      "wale 1\n\nmaterial cord {\n  representative {\n    called \"cord\"\n    called de \"Cord\", \"Kord\"\n"
      "    source \"a ruler\", \"a book\"\n    licence \"CC-BY-4.0\"\n    replaces old_cord, older_cord\n  }\n"
      "  perceptual { roughness medium \u00b1 0.1 estimated }\n"
      "  physical { force = lateral(grating(x, period: 2.5 mm)) }\n}\nmaterial finer = cord(roughness: 0.3)\n"
      "material alike { representative { like cord } }\n");
  const auto json = wale({"describe", file, "--material", "cord", "--json"}).json();
  const auto& said = json.at("representative");
  EXPECT_EQ(said.at("called de"), (std::vector<std::string>{"Cord", "Kord"}));
  EXPECT_EQ(said.at("source"), (std::vector<std::string>{"a ruler", "a book"}));
  EXPECT_EQ(said.at("licence"), "CC-BY-4.0");
  EXPECT_EQ(said.at("replaces"), (std::vector<std::string>{"old_cord", "older_cord"}));
  EXPECT_EQ(json.at("percepts").at("roughness").at("asked_evidence"), "estimated");
  EXPECT_TRUE(contains(wale({"describe", file}).out, "(estimated)"));
  // The program alone knows it too, and at another level nobody has said anything.
  ASSERT_EQ(wale({"build", file, "--material", "cord", "-o", folder / "cord.wpp"}).status, 0);
  EXPECT_EQ(wale({"describe", folder / "cord.wpp", "--json"}).json().at("percepts").at("roughness").at("asked_evidence"),
            "estimated");
  EXPECT_EQ(wale({"describe", file, "--material", "cord", "--set", "roughness=0.2", "--json"}).json().at("percepts").at("roughness").at(
                "asked_evidence"),
            nullptr);
  const auto evidence_of = [&](const char* material) {
    return wale({"describe", file, "--material", material, "--json"}).json().at("percepts").at("roughness").at(
        "asked_evidence");
  };
  EXPECT_EQ(evidence_of("finer"), nullptr);
  EXPECT_EQ(evidence_of("alike"), "estimated");
}

// F = -60 N/m (hand - rest) is 60 N/m * rest in the middle.
TEST(Describe, ASpringIsToldByThePlaceToWhichItPulls) {
  const TemporaryFolder folder;
  const auto file = [&](const std::string& force) {
    return folder.write("m.wale", "wale 1\nmaterial m { physical { force = " + force + " } }\n");
  };
  const std::string aside = file("spring(60 N/m, rest: vector(20 mm, -10 mm))");
  const auto json = wale({"describe", aside, "--json"}).json();
  EXPECT_NEAR(json.at("spring_rest_m").at(0).get<double>(), 0.02, 2e-4);
  EXPECT_NEAR(json.at("spring_rest_m").at(1).get<double>(), -0.01, 2e-4);
  const std::string text = wale({"describe", aside}).out;
  EXPECT_TRUE(contains(text, "its spring pulls to 20 mm, -10 mm from the middle")) << text;
  EXPECT_TRUE(contains(text, "a push in the middle of 1.34 N")) << text;
  for (const char* other : {"spring(60 N/m)", "vector(0.3 N, 0.4 N)"}) {
    const std::string told = wale({"describe", file(other)}).out;
    EXPECT_FALSE(contains(told, "its spring pulls")) << told;
  }
}

TEST(Feeling, WithNoMoreForceThanTheUserAllows) {
  const auto felt = [](const std::string& most) {
    return wale({"feel", corduroy, "--virtual-time", "--seconds", "2", "--max-force", most, "--json"});
  };
  const auto limited = felt("1 N").json();
  EXPECT_LE(limited.at("actuator").at("max_newton").get<double>(), 1.005);
  EXPECT_GT(limited.at("guards").at("user_limit").get<long>(), 100);
  EXPECT_EQ(felt("9 N").json().at("guards").at("user_limit"), 0);
  // The crossings are the hand's, and what is delivered is judged against what may come.
  const auto& roughness = limited.at("percepts").at("roughness");
  EXPECT_NEAR(roughness.at("let_through").get<double>(), 1, 1e-6);
  EXPECT_NEAR(roughness.at("delivered").get<double>(), 1, 0.02);
  for (const char* wrong : {"0 N", "-2 N", "3", "5 mm", "much"}) {
    EXPECT_EQ(felt(wrong).status, 2) << wrong;
    EXPECT_FALSE(felt(wrong).err.empty()) << wrong;
  }
}

TEST(Feeling, AVibrationHasNoTextureToCross) {
  const TemporaryFolder folder;
  const std::string force = "force = vector(0 N, 0.4 N * sin(2 pi * phase(100 Hz)))";
  const std::string shaking =
      folder.write("shaking.wale", "wale 1\nmaterial shaking { physical { active 0.5 W\n " + force + " } }\n");
  const auto felt = [](const std::string& what) {
    return wale({"feel", what, "--virtual-time", "--seconds", "1"}).out;
  };
  EXPECT_FALSE(contains(felt(shaking), "crossings")) << felt(shaking);
  EXPECT_TRUE(contains(felt(shaking), "the hand ranged over")) << felt(shaking);
  EXPECT_TRUE(contains(felt(corduroy), "crossings"));
}

TEST(Describe, AnUnknownMaterialIsNoFateOnAnyDevice) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{corduroy, "--material", "cordroy"}, std::vector<std::string>{corduroy + ":cordroy"}})
    for (const bool json : {false, true}) {
      std::vector<std::string> all{"describe", "--device", "all"};
      all.insert(all.end(), words.begin(), words.end());
      if (json) all.push_back("--json");
      const Outcome outcome = wale(all);
      EXPECT_EQ(outcome.status, words.size() == 1 ? 1 : 2) << "an unknown name in an option is wrong usage";
      EXPECT_EQ(outcome.out, "");
      EXPECT_TRUE(contains(outcome.err, "W0602")) << outcome.err;
      EXPECT_TRUE(contains(outcome.err, "did you mean `corduroy`?")) << outcome.err;
    }
}

}  // namespace
}  // namespace wale::command_line::describing_test
