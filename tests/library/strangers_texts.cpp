// What somebody else wrote, or a path of a program, does no more than it says.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/temporary_folder.hpp"
#include "wale/library.hpp"
#include "wale/recording.hpp"
#include "wale/stage.hpp"

namespace wale::strangers_texts_test {
namespace {

void write(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

TEST(StrangersTexts, PatchesOfAnySizeAreCompiled) {
  const Library library;
  for (const std::string material : {"denim", "oak", "corduroy", "brick"})
    for (const std::string side : {"1 km", "1e12 m", "1e30 m", "3e38 m"}) {
      const auto laid = library.workspace("wale 1\nworkspace k {\n  patch cloth = " + material +
                                          " {\n    at 0 mm, 0 mm\n    size " + side + ", 1 m\n  }\n}\n");
      ASSERT_TRUE(laid) << in_words(laid.error());
      EXPECT_LE(laid->workspace.patches.front().program.default_size().width, 0.2287f) << "the workspace";
      EXPECT_EQ(laid->warnings.front().code, Code::cut_patch);
      const auto own = library.compile("wale 1\nimport std.weave\nmaterial m { perceptual { roughness 0.5 } physical {\n  patch " + side +
                                       ", 1 m\n  force = lateral(woven(hand, 2 mm, 2 mm))\n} }\n");
      ASSERT_TRUE(own) << in_words(own.error());
    }
}

TEST(Paths, WithAZeroByteAreNone) {
  const TemporaryFolder folder;
  const auto cut = [&](const std::string& name) { return (folder.path() / name).string() + std::string("\0junk", 5); };
  write(folder.path() / "m.wale", "wale 1\nmaterial m { physical { force = spring(50 N/m) } }\n");
  write(folder.path() / "w.wale", "wale 1\nworkspace w {\n  patch a = oak { at 0 mm, 0 mm }\n}\n");
  const Library library;
  ASSERT_TRUE(library.open((folder.path() / "m.wale").string()));
  EXPECT_EQ(library.open(cut("m.wale")).error().code, Code::invalid_encoding);
  EXPECT_EQ(library.open_workspace(cut("w.wale")).error().code, Code::invalid_encoding);
  EXPECT_EQ(Library({.folders = {cut("")}}).is_usable().error().code, Code::invalid_encoding);
  Stage stage(library.simulated_joystick(), {.record = RecordTo{.file = cut("run.wrec")}});
  ASSERT_TRUE(stage.add(library.find("oak")->program));
  const auto run = stage.run({.seconds = 0.01, .virtual_time = true});
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, Code::invalid_encoding) << in_words(run.error());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "run.wrec"));
  EXPECT_EQ(Recording::open(cut("m.wale")).error().code, Code::invalid_encoding);
  EXPECT_EQ(Recording::intact(cut("m.wale")).error().code, Code::invalid_encoding);
}

TEST(Names, OfAModuleAndAMaterialMeanThoseOfOnesOwnFilesFirst) {
  const TemporaryFolder folder;
  const std::string begins = "wale 1\n", physics = " { physical { force = spring(50 N/m) } }\n";
  write(folder.path() / "velvet.wale", begins + "material a" + physics + "material granite" + physics);
  write(folder.path() / "mine.wale", begins + "material mine" + physics + "material other" + physics);
  write(folder.path() / "my.wale", begins + "material mine" + physics);
  const Library library({.folders = {folder.path().string()}});
  for (const std::string name : {"velvet:granite", "mine:mine", "mine:other", "my:mine", "mine.mine", "velvet:a"}) {
    const auto found = library.find(name);
    ASSERT_TRUE(found) << in_words(found.error());
    EXPECT_EQ(found->program.description().material, name.substr(name.find_first_of(":.") + 1));
    EXPECT_TRUE(found->program.description().parameters.empty()) << name << " is one's own";
  }
  const Error several = library.find("mine").error();
  EXPECT_EQ(several.code, Code::ambiguous_material);
  EXPECT_EQ(several.nearest.size(), 2u);
  for (const std::string& each : several.nearest) EXPECT_TRUE(library.find(each)) << each;
  EXPECT_EQ(library.find("fabric.velvet:velvet")->program.description().material, "velvet");
}

}  // namespace
}  // namespace wale::strangers_texts_test
