// Workspaces of a text in memory, as a program asks for them.
#include <gtest/gtest.h>

#include "tests/temporary_folder.hpp"
#include "wale/library.hpp"
#include "wale/stage.hpp"

namespace wale::library_workspaces_test {
namespace {

constexpr const char* desk =
    "wale 1\n"
    "\n"
    "/// On the table.\n"
    "workspace desk {\n"
    "  patch board = oak { at -40 mm, 0 mm; size 40 mm, 40 mm }\n"
    "  patch cloth = \"denim\"(roughness: 0.3) {\n"
    "    at   40 mm, 0 mm\n"
    "    size 40 mm, 40 mm\n"
    "    shape ellipse\n"
    "    mark roughness, low 0.2, \"still denim\"\n"
    "  }\n"
    "}\n"
    "movie demo { frames desk }\n"
    "keys sorting { of desk; area 80 mm, 80 mm; labels random }\n"
    "groups sorted { of desk; group board, \"hard\" }\n";

std::string part(const TextPart& of) { return std::string(desk).substr(of.begin, of.end - of.begin); }

TEST(LibraryWorkspaces, HaveProgramsPlacesShapesMarksAndTheirText) {
  const Library library;
  const auto compiled = library.workspace(desk);
  ASSERT_TRUE(compiled) << explained(compiled.error());
  const Workspace& workspace = compiled->workspace;
  EXPECT_EQ(workspace.name, "desk");
  EXPECT_EQ(workspace.documentation, "On the table.");
  ASSERT_EQ(workspace.patches.size(), 2u);
  ASSERT_EQ(compiled->in_text.size(), 2u);
  const WorkspacePatch& cloth = workspace.patches[1];
  EXPECT_EQ(cloth.made_of, "\"denim\"(roughness: 0.3)");
  EXPECT_NEAR(cloth.options.at.x, 0.04f, 1e-6f);
  EXPECT_NEAR(cloth.options.shape.size().x, 0.04f, 1e-6f);
  ASSERT_EQ(cloth.marks.size(), 1u);
  EXPECT_EQ(cloth.marks[0].says, "still denim");
  EXPECT_EQ(cloth.program.description().device.name, "sandpaper");
  const PatchInText& in_text = compiled->in_text[1];
  EXPECT_EQ(part(in_text.name), "cloth");
  EXPECT_EQ(part(in_text.material), "\"denim\"(roughness: 0.3)");
  EXPECT_TRUE(part(in_text.statement).starts_with("patch cloth =") && part(in_text.statement).ends_with("}"));
  ASSERT_EQ(in_text.settings.size(), 4u);
  EXPECT_EQ(in_text.settings[1].first, "size");
  EXPECT_EQ(part(in_text.settings[1].second), "size 40 mm, 40 mm");
  EXPECT_EQ(part(compiled->name), "desk");
  EXPECT_TRUE(part(compiled->statement).starts_with("workspace desk {"));
  EXPECT_EQ(part(compiled->in_text[0].statement), "patch board = oak { at -40 mm, 0 mm; size 40 mm, 40 mm }");
}

TEST(LibraryWorkspaces, TellWhatIsWrongWithTheFoldersAndTheNames) {
  const Library library({.folders = {"/nonexistent/x"}});
  EXPECT_EQ(library.workspace(desk).error().code, Code::unreadable_file);
  EXPECT_EQ(library.open_workspace("/nonexistent/a.wale").error().place.name, "folders");
  EXPECT_EQ(library.presentation(desk).error().code, Code::unreadable_file);
  EXPECT_EQ(Library().workspace(desk, {.name = "a\nb"}).error().code, Code::malformed_value);
  EXPECT_EQ(Library().workspace(desk, {.device = "\xff"}).error().code, Code::invalid_encoding);
}

TEST(LibraryWorkspaces, OfFilesThatCannotBeReadSayWhatToName) {
  const TemporaryFolder folder;
  for (const char* name : {"no.wws", "no.wale"}) {
    const Error error = Library().open_workspace(folder / name).error();
    EXPECT_EQ(error.code, Code::unreadable_file);
    EXPECT_NE(error.mend.find("workspace file"), std::string::npos) << error.mend;
  }
  const Error bad = Library().open_workspace(folder.write("bad.wws", std::string("\0WWS", 4))).error();
  EXPECT_EQ(bad.code, Code::damaged_file);
  EXPECT_TRUE(bad.place.name.ends_with("bad.wws"));
}

TEST(LibraryWorkspaces, AreTheSameFromAFile) {
  const Library library;
  const auto compiled = library.workspace(desk);
  ASSERT_TRUE(compiled);
  const TemporaryFolder folder;
  const auto bytes = write_workspace(compiled->workspace);
  const std::string built = folder.write("desk.wws", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const std::string file = folder.write("desk.wale", desk);
  const auto of_file = library.open_workspace(built), of_text = library.open_workspace(file);
  ASSERT_TRUE(of_file) << explained(of_file.error());
  ASSERT_TRUE(of_text) << explained(of_text.error());
  EXPECT_TRUE(write_workspace(of_file->workspace) == bytes);
  // The lines that instructions come from are named by the file.
  EXPECT_TRUE(write_workspace(of_text->workspace) ==
              write_workspace(library.workspace(desk, {.name = file})->workspace));
  EXPECT_TRUE(of_file->in_text.empty());
  EXPECT_EQ(library.open_workspace(built, {.device = "falcon"}).error().code, Code::other_device);
  EXPECT_EQ(library.open_workspace(folder / "none.wws").error().code, Code::unreadable_file);
  EXPECT_EQ(library.open_workspace(folder.write("a.wws", "not one")).error().code, Code::damaged_file);
}

TEST(LibraryWorkspaces, ErrorsAndWarningsHaveTheirPlace) {
  const Library library;
  EXPECT_EQ(library.workspace(desk, {.workspace = "desc"}).error().nearest, std::vector<std::string>{"desk"});
  EXPECT_EQ(library.workspace("wale 1\n").error().code, Code::unknown_workspace);
  EXPECT_EQ(library.workspace(desk, {.device = "none"}).error().code, Code::unknown_device);
  const auto wrong = library.workspace("wale 1\nworkspace a {\n  patch b = okk { size 1 mm }\n}\n");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().place.number, 3u);
  EXPECT_EQ(wrong.error().others.size(), 1u);
  const auto beyond =
      library.workspace("wale 1\nworkspace a {\n  patch b = oak { at 100 mm, 0 mm; size 60 mm, 40 mm }\n}\n");
  ASSERT_TRUE(beyond);
  ASSERT_EQ(beyond->warnings.size(), 1u);
  EXPECT_EQ(beyond->warnings[0].code, Code::beyond_reach);
  const std::string alike =
      "wale 1\nworkspace a {\n  patch b = corduroy { at -20 mm, 0 mm; size 40 mm, 40 mm }\n"
      "  patch c = corduroy(roughness: 0.6) { at 20 mm, 0 mm; size 40 mm, 40 mm }\n}\n";
  EXPECT_TRUE(library.workspace(alike)->warnings.empty());
  ASSERT_EQ(library.workspace(alike, {.legibility = true})->warnings.size(), 1u);
  EXPECT_EQ(library.workspace(alike, {.legibility = true})->warnings[0].code, Code::indistinct_neighbours);
}

TEST(LibraryWorkspaces, ArePresentedInMoviesByKeysAndInGroups) {
  const Library library;
  const auto shown = library.presentation(desk);
  ASSERT_TRUE(shown) << explained(shown.error());
  EXPECT_EQ(shown->workspaces, std::vector<std::string>{"desk"});
  ASSERT_EQ(shown->movies.size(), 1u);
  EXPECT_EQ(shown->movies[0].frames, std::vector<std::string>{"desk"});
  EXPECT_EQ(part(shown->movies[0].statement), "movie demo { frames desk }");
  ASSERT_EQ(shown->keys.size(), 1u);
  EXPECT_TRUE(shown->keys[0].numbered_at_random);
  EXPECT_FALSE(shown->keys[0].key);
  ASSERT_EQ(shown->groups.size(), 1u);
  EXPECT_EQ(shown->groups[0].groups.at(0).says, "hard");
}

}  // namespace
}  // namespace wale::library_workspaces_test
