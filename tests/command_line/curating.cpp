// The verbs for those who look after a library, and library/CURATORS_DAY.md: its commands print what it shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "tests/command_line/running.hpp"

namespace wale::command_line::curating_test {
namespace {

/// Runs a command of a shell in a folder; returns what it prints, with its errors.
std::string run_in(const TemporaryFolder& folder, const std::string& command) {
  const std::string out = folder / "printed";
  const std::string line = "cd " + quoted(folder / ".") + " && PATH=" + quoted(folder / "bin") +
                           ":$PATH XDG_CONFIG_HOME=/nonexistent " + command + " >" + quoted(out) + " 2>&1 </dev/null";
  [[maybe_unused]] const int status = std::system(line.c_str());
  return bytes_of(out);
}

/// Whether a text is as a page shows it, where a line with `…` alone stands for any lines.
bool shows(const std::string& text, const std::string& shown) {
  std::istringstream lines(shown);
  std::size_t at = 0;
  bool anywhere = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == "…") {
      anywhere = true;
      continue;
    }
    line += "\n";
    std::size_t found = at;
    while (anywhere && (found = text.find(line, found)) != std::string::npos && found > 0 && text[found - 1] != '\n') ++found;
    if (found == std::string::npos || text.compare(found, line.size(), line) != 0) return false;
    at = found + line.size(), anywhere = false;
  }
  return anywhere || at == text.size();
}

TEST(Curating, TheDayPrintsWhatItsPageShows) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "bin");
  fs::create_symlink(WALE_BINARY, folder / "bin/wale");
  std::istringstream page(bytes_of(std::string(WALE_SOURCE_DIR) + "/library/CURATORS_DAY.md"));
  const std::regex naming("^`([a-z_/.]+)`:$");
  std::string name, kind, block;
  int commands = 0;
  const auto walk_console = [&](const std::string& text) {
    std::istringstream lines(text);
    std::string command, shown;
    const auto compare = [&] {
      if (command.empty()) return;
      ++commands;
      if (command.starts_with("wale library compare before")) {  // a copy of yesterday's
        const std::string now = bytes_of(folder / "shelf/toy/studs.wale");
        EXPECT_NE(now.find("flat_stud_plate"), std::string::npos);
      }
      const std::string printed = run_in(folder, command);
      EXPECT_TRUE(shows(printed, shown)) << "`" << command << "` prints\n" << printed << "and the page shows\n" << shown;
    };
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("$ ")) {
        compare();
        command = line.substr(2), shown.clear();
        EXPECT_TRUE(command.starts_with("wale ") || command.starts_with("mv ") || command.starts_with("mkdir ")) << command;
      } else {
        shown += line + "\n";
      }
    compare();
  };
  for (std::string line; std::getline(page, line);) {
    std::smatch found;
    if (!line.starts_with("```")) {
      if (!kind.empty())
        block += line + "\n";
      else if (std::regex_match(line, found, naming))
        name = found[1];
      continue;
    }
    if (kind.empty()) {
      kind = line.substr(3), block.clear();
      continue;
    }
    if (kind == "console") {
      walk_console(block);
    } else {
      // The copy that the evening compares with is what the noon left.
      if (fs::exists(folder / "shelf/toy/studs.wale") && name.starts_with("shelf/"))
        fs::copy(folder / "shelf", folder / "before", fs::copy_options::recursive);
      ASSERT_NE(name, "");
      folder.write(name, block);
    }
    kind.clear();
  }
  EXPECT_EQ(commands, 12);
  EXPECT_TRUE(fs::exists(folder / "public/material/flat_stud_plate.html"));
  EXPECT_TRUE(contains(bytes_of(folder / "public/material/flat_stud_plate.json"), "\"@type\": \"Dataset\""));
  EXPECT_EQ(bytes_of(folder / "offered.png").substr(1, 3), "PNG");
  EXPECT_FALSE(fs::exists(folder / "offered/studs.wale"));
}

const std::string cord =
    "wale 1\n\n/// Ribs.\nmaterial broad_cord {\n  representative {\n    title  \"Broad cord\"\n    called \"ribs\"\n"
    "    called de \"Rippen\"\n    kind   trial.woven\n    source \"an estimate\"\n  }\n  perceptual { roughness 0.6 estimated }\n"
    "  physical {\n    height ribs = grating(x, period: 3.3 mm)\n    force = lateral(ribs)\n  }\n}\n";

TEST(Curating, CheckHasATrueStatusAndJson) {
  const TemporaryFolder folder;
  folder.write("wale.project", "licence \"CC0-1.0\"\n");
  const std::string file = folder.write("trial/cord.wale", cord);
  const Outcome taken = wale({"library", "check", folder / ".", "--json"});
  EXPECT_EQ(taken.status, 0) << taken.out << taken.err;
  EXPECT_EQ(taken.json().at("accepted"), true);
  folder.write("wale.project", "");
  const Outcome refused = wale({"library", "check", file});
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(contains(refused.out, "error[W0902]: `broad_cord` has no licence\n")) << refused.out;
  EXPECT_EQ(wale({"library", "check", folder / "none"}).status, 1);
  EXPECT_EQ(wale({"library", "check", "--since"}).status, 2);
  EXPECT_EQ(wale({"library", "check", file, "--since", folder.write("odd.json", "no json")}).status, 1);
  EXPECT_EQ(bytes_of(folder / "odd.json"), "no json") << "what another program wrote stays";
  EXPECT_EQ(wale({"library", "chekc", file}).status, 2);
  EXPECT_EQ(wale({"library"}).status, 2);
}

TEST(Curating, CoverageAndCompareHaveJsonAndPictures) {
  const TemporaryFolder folder;
  folder.write("old/cord.wale", cord);
  std::string other = cord;
  other.replace(other.find("3.3 mm"), 6, "8.0 mm");
  folder.write("new/cord.wale", other);
  const Outcome covered = wale({"library", "coverage", folder / "old", "--json", "-o", folder / "c.svg"});
  EXPECT_EQ(covered.status, 0) << covered.err;
  EXPECT_EQ(covered.json().at("percepts").at("roughness").at("materials").at(0).at("material"), "broad_cord");
  EXPECT_TRUE(contains(bytes_of(folder / "c.svg"), "<svg"));
  const Outcome same = wale({"library", "compare", folder / "old", folder / "old", "--json"});
  EXPECT_EQ(same.status, 0);
  EXPECT_EQ(same.json().at("same"), 1);
  const Outcome changed = wale({"library", "compare", folder / "old", folder / "new", "--json"});
  EXPECT_EQ(changed.status, 1) << "a name has another meaning";
  EXPECT_GT(changed.json().at("changed").at("broad_cord").at("cues").at("period").at("noticeable"), 1);
  folder.write("new/broken.wale", "wale 1\n\nmaterial broken { physical { force = } }\n");
  const Outcome broken = wale({"library", "sheet", folder / "new", "-o", folder / "s.png"});
  EXPECT_EQ(broken.status, 1) << "and draws the others";
  EXPECT_EQ(bytes_of(folder / "s.png").substr(1, 3), "PNG");
  EXPECT_TRUE(contains(broken.err, "`broken` cannot be built"));
  EXPECT_EQ(wale({"library", "sheet", folder / "new", "-o", folder / "new/cord.wale"}).status, 2);
  EXPECT_EQ(bytes_of(folder / "new/cord.wale"), other) << "an input is never an output";
  EXPECT_EQ(wale({"library", "compare", folder / "old"}).status, 2);
}

TEST(Curating, FilesThatCannotBeReadAreNamed) {
  const TemporaryFolder folder;
  folder.write("shelf/wale.project", "licence \"CC0-1.0\"\n");
  folder.write("shelf/trial/cord.wale", cord);
  folder.write("shelf/trial/garbage.wale", "garbage");
  folder.write("shelf/trial/number.wale", "wale 1\n\nmaterial 2e_b {\n}\n");
  const std::string index = folder / "an.index";
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"index", folder / "shelf", "-o", index}, {"index", folder / "shelf", "-o", index},
           {"site", folder / "shelf", "-o", folder / "site"}, {"coverage", folder / "shelf"},
           {"sheet", folder / "shelf", "-o", folder / "s.png"}}) {
    std::vector<std::string> all = {"library"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome done = wale(all);
    EXPECT_EQ(done.status, 1) << words.front();
    for (const char* name : {"garbage.wale", "number.wale"})
      EXPECT_TRUE(contains(done.err, name)) << words.front() << ": " << done.err;
  }
  EXPECT_TRUE(fs::exists(folder / "site/material/broad_cord.html")) << "the rest is published";
  const Outcome near = wale({"find", "--roughness", "0..1", "--index", index, "--most", "20"});
  EXPECT_EQ(near.status, 0) << near.err;
  EXPECT_TRUE(near.out.starts_with("broad_cord")) << "and indexed";
  EXPECT_FALSE(contains(near.out, "garbage")) << near.out;
  EXPECT_TRUE(contains(wale({"find", "garbage", "--index", index}).out, "does not compile"));
}

TEST(Curating, ImportMakesDraftsThatSayWhatIsMissing) {
  const TemporaryFolder folder;
  folder.write("in/stone.txt", "0 1 2 3 2 1\n0 NaN 2 3 2 1\n0 1 2 3 2 1\n0 1 2 3 2 1\n");
  folder.write("in/rated.csv", "material,roughness\nTerry towel,5\n");
  folder.write("in/README", "no measurement\n");
  const Outcome made = wale({"library", "import", folder / "in", "--scale", "0.5 mm", "--unit", "1 um", "--bad", "NaN", "--range",
                             "1,7", "-o", folder / "drafts"});
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(made.out, "2 drafts; each says what is missing\n")) << made.out;
  const std::string stone = bytes_of(folder / "drafts/stone.wale");
  EXPECT_TRUE(contains(stone, "// - `stone` has no kind: ")) << stone;
  EXPECT_TRUE(contains(stone, "1 of 24 heights, which were not measured"));
  const Outcome formatted = wale({"format", "--check", folder / "drafts/stone.wale"});
  EXPECT_EQ(formatted.status, 0) << formatted.out << formatted.err;
  EXPECT_TRUE(contains(bytes_of(folder / "drafts/terry_towel.wale"), "roughness 0.667 transferred"));
  // Nothing that is there is written over.
  EXPECT_EQ(wale({"library", "import", folder / "in/rated.csv", "--range", "1,7", "-o", folder / "drafts"}).status, 0);
  EXPECT_TRUE(fs::exists(folder / "drafts/terry_towel_2.wale"));
  const Outcome wrong = wale({"library", "import", folder / "in/stone.txt", "--scale", "1 mm", "--unit", "1 um", "-o", folder / "d"});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_TRUE(contains(wrong.err, "stone.txt: row 2: expected a number, found \"NaN\"")) << wrong.err;
  EXPECT_FALSE(fs::exists(folder / "d"));
  EXPECT_EQ(wale({"library", "import", folder / "in/stone.txt", "-o", folder / "d"}).status, 2);
  EXPECT_EQ(wale({"library", "import", folder / "in/README", "-o", folder / "d"}).status, 2);
  EXPECT_EQ(wale({"library", "import", folder / "in", "--range", "7,1", "-o", folder / "d"}).status, 2);
}

TEST(Curating, VerbsOfTwoWordsAreInManualAndCompletion) {
  const TemporaryFolder manual;
  ASSERT_EQ(wale({"manual", manual / "."}).status, 0);
  const std::string completion = bytes_of(manual / "wale.bash");
  for (const char* verb : {"check", "sheet", "coverage", "compare", "import"}) {
    const Outcome help = wale({"library", verb, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_TRUE(contains(help.out, std::string("wale library ") + verb)) << help.out;
    EXPECT_FALSE(contains(help.out, "library-")) << help.out;
    EXPECT_TRUE(contains(bytes_of(manual / (std::string("wale-library-") + verb + ".1")), std::string("library ") + verb)) << verb;
    EXPECT_TRUE(contains(completion, verb)) << verb;
  }
}

}  // namespace
}  // namespace wale::command_line::curating_test
