// Names of materials in place of a FILE.

#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::naming_test {
namespace {

/// The path of a shipped file.
const std::string denim = std::string(WALE_SOURCE_DIR) + "/library/fabric/denim.wale";

std::string own(const std::string& name, const std::string& more = {}) {
  return "wale 1\nmaterial " + name + " {\n  representative { " + more + " }\n  perceptual { roughness 0.3 } }\n";
}

TEST(Names, GiveTheSameAsTheirFiles) {
  const TemporaryFolder folder;
  EXPECT_EQ(wale({"describe", "denim"}).out, wale({"describe", denim}).out);
  EXPECT_EQ(wale({"sample", "denim", "--at", "1 mm, 0 mm"}).out, wale({"sample", denim, "--at", "1 mm, 0 mm"}).out);
  ASSERT_EQ(wale({"build", "denim", "-o", folder / "name.wpp"}).status, 0);
  ASSERT_EQ(wale({"build", denim, "-o", folder / "file.wpp"}).status, 0);
  EXPECT_EQ(bytes_of(folder / "name.wpp"), bytes_of(folder / "file.wpp"));
  EXPECT_EQ(wale({"preview", "denim", "-o", folder / "denim.png"}).status, 0);
  EXPECT_EQ(wale({"compare", "corduroy", "denim"}).out, wale({"compare", corduroy, denim}).out);
  EXPECT_EQ(wale({"feel", "denim", "--virtual-time", "--seconds", "0.1"}).status, 0);
}

TEST(Names, IncludeModulesTitlesAndOtherNames) {
  const Outcome named = wale({"describe", "denim"});
  for (const char* other : {"fabric.denim", "blue jeans", "Denim", "denim:denim", "fabric.denim:denim"})
    EXPECT_EQ(wale({"describe", other}).out, named.out) << other;
}

TEST(Names, IncludePathsInTheShippedLibrary) {
  const TemporaryFolder folder;
  EXPECT_EQ(wale({"describe", "library/fabric/denim.wale"}).status, 0);
  EXPECT_EQ(wale({"describe", "library/fabric/denim.wale:denim"}).status, 0);
  EXPECT_EQ(wale({"describe", "slate"}).status, 0) << "its picture is in the binary too";
}

TEST(Names, InAGivenLibraryComeBeforeShippedOnes) {
  const TemporaryFolder folder;
  folder.write("cloth.wale", own("denim"));
  const Outcome outcome = wale({"describe", "denim", "--library", folder / ".", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(outcome.json().at("percepts").at("roughness").at("level").get<double>(), 0.3, 1e-6);
  for (const char* part : {"`denim` is your own `", "cloth.wale:denim`", "`library/fabric/denim.wale:denim`"})
    EXPECT_TRUE(contains(outcome.err, part)) << part << outcome.err;
  EXPECT_EQ(wale({"describe", "denim"}).err, "") << "there is one alone";
}

// Two folders with the same module: an import finds the file of the first, and so does a name, wherever it stands.
TEST(Names, MeanTheSameInAFileAndOnTheCommandLine) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "first/cloth");
  fs::create_directories(folder / "second/cloth");
  folder.write("first/cloth/tweed.wale", own("tweed"));
  folder.write("second/cloth/tweed.wale", "wale 1\nmaterial tweed { perceptual { roughness 0.7 } }\n");
  const std::string liking = folder.write("liking.wale", "wale 1\nmaterial mine { representative { like tweed } }\n");
  const auto level = [&](const std::string& name, const char* first, const char* second) {
    const Outcome outcome =
        wale({"describe", name, "--library", folder / first, "--library", folder / second, "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("percepts").at("roughness").at("level").get<double>();
  };
  for (const std::string& name : {std::string("tweed"), std::string("cloth.tweed"), liking}) {
    EXPECT_NEAR(level(name, "first", "second"), 0.3, 1e-6) << name;
    EXPECT_NEAR(level(name, "second", "first"), 0.7, 1e-6) << name;
  }
}

TEST(Names, OfSeveralMaterialsAreListed) {
  const TemporaryFolder folder;
  folder.write("a.wale", own("one", "called \"twin\""));
  folder.write("b.wale", own("two", "called \"twin\""));
  const Outcome outcome = wale({"describe", "twin", "--library", folder / "."});
  EXPECT_EQ(outcome.status, 1);
  for (const char* part : {"W0217", "`one` of `a`", "`two` of `b`", "`a:one`"})
    EXPECT_TRUE(contains(outcome.err, part)) << part << outcome.err;
  EXPECT_EQ(wale({"describe", "a:one", "--library", folder / "."}).status, 0);
}

TEST(Names, ThatAreUnknownGiveTheNearestAndWaleFind) {
  for (const char* verb : {"describe", "feel", "compare"}) {
    const Outcome outcome = wale({verb, "corderoy"});
    EXPECT_EQ(outcome.status, 1) << verb;
    for (const char* part : {"W0201", "`corderoy` is neither a file nor a material", "`corduroy`", "wale find"})
      EXPECT_TRUE(contains(outcome.err, part)) << part << outcome.err;
  }
  EXPECT_TRUE(contains(wale({"describe", "corderoy.wale"}).err, "no such file")) << "a path is not a name";
}

TEST(Names, YieldToFilesWithANote) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder / ".");
  folder.write("denim", own("mine"));
  const Outcome file = wale({"describe", "denim", "--json"}), path = wale({"describe", "./denim", "--json"});
  fs::current_path(before);
  ASSERT_EQ(file.status, 0) << file.err;
  EXPECT_EQ(file.json().at("material"), "mine");
  EXPECT_TRUE(contains(file.err, "the material of that name is `library/fabric/denim.wale:denim`")) << file.err;
  EXPECT_EQ(path.err, "");
}

TEST(Names, OfTheOwnersDevicesAreKnownToEveryVerbWithADevice) {
  const TemporaryFolder config, folder;
  config.write("wale/devices.wale", R"(wale 1
export device my_stick {
  usb "1234:5678"
  class force_plane
  axes x, y
  motors x, y
  gain 1
  workspace disc(200 mm)
  position 4096 counts
  force 5 N, 32767 counts
  rate 900 Hz
  speed 1 m/s
  slew 200 N/s
  velocity_filter 15, 1 counts
  patch 120 mm, 120 mm, 5 mm
}
)");
  const std::vector<std::vector<std::string>> all{{"describe", "corduroy"},
                                                  {"compare", "corduroy", "denim"},
                                                  {"levels", "roughness"},
                                                  {"build", "corduroy", "-o", folder / "corduroy.wpp"},
                                                  {"preview", "corduroy", "-o", folder / "corduroy.png"},
                                                  {"sample", "corduroy", "--at", "1 mm, 2 mm"}};
  for (std::vector<std::string> words : all) {
    words.insert(words.end(), {"--device", "my_stick"});
    const Outcome known = wale(words, {}, config / ".");
    EXPECT_EQ(known.status, 0) << words.front() << known.err;
    const Outcome unknown = wale(words);
    EXPECT_EQ(unknown.status, 2) << words.front() << unknown.err;
    EXPECT_TRUE(contains(unknown.err, "W0601")) << words.front() << unknown.err;
  }
}

}  // namespace
}  // namespace wale::command_line::naming_test
