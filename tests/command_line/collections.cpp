// Building many materials at once, and libraries in other folders.

#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::collections_test {
namespace {

const std::string three =
    "wale 1\nmaterial a { perceptual { roughness 0.5 } }\nmaterial b { physical { force = viscous(2 N s/m) } }\n"
    "material c { physical { force = spring(20 N/m) } }\n";

TEST(BuildAll, EveryMaterialIsAProgramOfItsName) {
  const TemporaryFolder folder;
  const std::string file = folder.write("three.wale", three), out = folder / "made/here";
  const Outcome outcome = wale({"build", "--all", file, "-o", out});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* name : {"a", "b", "c"}) {
    const std::string program = out + "/" + name + ".wpp", alone = folder / "alone.wpp";
    ASSERT_TRUE(fs::exists(program)) << outcome.out;
    EXPECT_TRUE(contains(outcome.out, program + "  " + std::to_string(fs::file_size(program)) + " bytes\n"))
        << outcome.out;
    ASSERT_EQ(wale({"build", file, "--material", name, "-o", alone}).status, 0);
    EXPECT_EQ(bytes_of(program), bytes_of(alone)) << name;
  }
  EXPECT_TRUE(outcome.out.ends_with("3 of 3 materials built\n")) << outcome.out;
  EXPECT_EQ(wale({"build", "--all", file, "-o", out}).status, 0) << "the programs are replaced";
}

TEST(BuildAll, AnErrorDoesNotStopTheOthers) {
  const TemporaryFolder folder;
  // A percept that contradicts the amplitude is an error of this material only, found when it is solved.
  const std::string file =
      folder.write("two.wale",
                   "wale 1\nmaterial bad { perceptual { roughness 0.5 } physical { height h = grating(x, 2 mm)\n"
                   "force = lateral(h, amplitude: 5 mN) } }\nmaterial good { perceptual { roughness 0.5 } }\n");
  const Outcome outcome = wale({"build", "--all", file, "-o", folder / "out"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "`bad` is not built")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "error[W")) << outcome.err;
  EXPECT_FALSE(contains(outcome.err, "`good`")) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "1 of 2 materials built")) << outcome.out;
  EXPECT_TRUE(fs::exists(folder / "out/good.wpp"));
  EXPECT_FALSE(fs::exists(folder / "out/bad.wpp"));
}

TEST(BuildAll, RefusesAFileAsFolderAndFilesWithoutMaterials) {
  const TemporaryFolder folder;
  const std::string file = folder.write("three.wale", three), taken = folder.write("taken", "mine");
  const Outcome outcome = wale({"build", "--all", file, "-o", taken});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "is a file")) << outcome.err;
  EXPECT_EQ(bytes_of(taken), "mine");
  EXPECT_EQ(wale({"build", "--all", folder.write("none.wale", "wale 1\n"), "-o", folder / "out"}).status, 1);
  EXPECT_FALSE(fs::exists(folder / "out"));
  ASSERT_EQ(wale({"build", file, "-o", folder / "a.wpp"}).status, 0);
  EXPECT_EQ(wale({"build", "--all", folder / "a.wpp", "-o", folder / "out"}).status, 2);
  EXPECT_EQ(wale({"build", "--all", file, "--material", "a", "-o", folder / "out"}).status, 2);
}

/// A folder with a library in `shared` and a file that imports from it.
struct Borrower {
  Borrower() {
    fs::create_directories(folder / "shared/stiff");
    folder.write("shared/stiff/door.wale", "wale 1\nexport let hinge = 30 N/m\n");
    file = folder.write("mine.wale", "wale 1\nimport stiff.door\nmaterial a { physical { force = spring(hinge) } }\n");
  }
  TemporaryFolder folder;
  std::string file;
};

TEST(Libraries, AreGivenOnTheCommandLine) {
  const Borrower borrower;
  const std::string shared = borrower.folder / "shared", other = borrower.folder / "other";
  fs::create_directory(other);
  EXPECT_TRUE(contains(wale({"describe", borrower.file}).err, "W0212"));
  const std::vector<std::vector<std::string>> commands{{"check", borrower.file},
                                                       {"describe", borrower.file},
                                                       {"build", borrower.file, "-o", borrower.folder / "a.wpp"},
                                                       {"build", "--all", borrower.file, "-o", borrower.folder / "all"},
                                                       {"sample", borrower.file, "--at", "1 mm, 0 mm"},
                                                       {"preview", borrower.file, "-o", borrower.folder / "a.png"},
                                                       {"feel", borrower.file, "--virtual-time", "--seconds", "0.1"}};
  for (auto words : commands) {
    EXPECT_EQ(wale(words).status, 1) << testing::PrintToString(words);
    words.insert(words.end(), {"--library", other, "--library", shared});
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, 0) << testing::PrintToString(words) << outcome.err;
  }
}

TEST(Libraries, AreGivenByTheEnvironment) {
  const Borrower borrower;
  setenv("WALE_LIBRARY", ((borrower.folder / "other") + "::" + (borrower.folder / "shared")).c_str(), 1);
  const Outcome outcome = wale({"sample", borrower.file, "--at", "10 mm, 0 mm", "--json"});
  setenv("WALE_LIBRARY", "/nope", 1);
  for (const std::vector<std::string>& words : {std::vector<std::string>{"describe", corduroy},
                                                {"check", corduroy},
                                                {"find", "corduroy"},
                                                {"compare", corduroy, "denim"}}) {
    const Outcome warned = wale(words);
    EXPECT_EQ(warned.status, 0) << warned.err;
    EXPECT_TRUE(contains(warned.err, "warning: WALE_LIBRARY names `/nope`, which is no folder\n")) << warned.err;
  }
  unsetenv("WALE_LIBRARY");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(outcome.json().at(0).at("fx").get<double>(), -0.3, 1e-6);  // 30 N/m, 10 mm
}

TEST(Libraries, AFilesOwnFolderComesFirst) {
  const Borrower borrower;
  fs::create_directories(borrower.folder / "stiff");
  borrower.folder.write("stiff/door.wale", "wale 1\nexport let hinge = 10 N/m\n");
  const auto sampled =
      wale({"sample", borrower.file, "--at", "10 mm, 0 mm", "--json", "--library", borrower.folder / "shared"}).json();
  EXPECT_NEAR(sampled.at(0).at("fx").get<double>(), -0.1, 1e-6);
}

}  // namespace
}  // namespace wale::command_line::collections_test
