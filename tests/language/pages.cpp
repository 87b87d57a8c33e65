// README.md and the pages that it links name only files and folders that exist.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace wale::pages_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = WALE_SOURCE_DIR;

std::string text_of(const fs::path& page) {
  std::ifstream file(page);
  EXPECT_TRUE(file) << page;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Links of a page to files and folders of the project, as written, without their fragment (`#…`).
std::vector<std::string> links_of(const std::string& text) {
  static const std::regex link(R"(\]\(([^)#]+)(#[^)]*)?\))");
  std::vector<std::string> links;
  for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match)
    if ((*match)[1].str().find("://") == std::string::npos) links.push_back((*match)[1]);
  return links;
}

/// README.md and all pages that can be reached from it.
std::set<fs::path> pages() {
  std::set<fs::path> found{root / "README.md"};
  for (bool more = true; more;) {
    more = false;
    for (const fs::path& page : std::set<fs::path>(found))
      for (const std::string& link : links_of(text_of(page)))
        if (const fs::path to = (page.parent_path() / link).lexically_normal(); to.extension() == ".md")
          more |= found.insert(to).second;
  }
  return found;
}

TEST(Pages, LinkToExistingFiles) {
  const auto all = pages();
  EXPECT_GE(all.size(), 9u);
  for (const fs::path& page : all)
    for (const std::string& link : links_of(text_of(page)))
      EXPECT_TRUE(fs::exists(page.parent_path() / link)) << page << " links to " << link;
}

TEST(Pages, TheFrontPageIsShortAndHasTheTwoCommands) {
  const std::string page = text_of(root / "README.md");
  EXPECT_LT(std::ranges::count(page, '\n'), 90);
  EXPECT_NE(page.find("\n./wale feel library/fabric/corduroy.wale\n"), std::string::npos);
  EXPECT_NE(page.find("\ntests/run\n"), std::string::npos);
}

TEST(Pages, TheFrontPageShowsAWholeFile) {
  const std::string page = text_of(root / "README.md");
  EXPECT_NE(page.find("```\n" + text_of(root / "library/fabric/corduroy.wale") + "```\n"), std::string::npos);
}

/// The README of a folder names each folder in it, as `room/`.
TEST(Pages, NameEveryRoom) {
  for (const char* folder : {"compiler", "runtime", "calibration", "tests"}) {
    const std::string page = text_of(root / folder / "README.md");
    for (const auto& entry : fs::directory_iterator(root / folder)) {
      const std::string room = entry.path().filename();
      if (!entry.is_directory() || room == "include") continue;
      EXPECT_TRUE(page.find("`" + room + "/`") != std::string::npos || page.find(room + "/](") != std::string::npos ||
                  page.find("/" + room + "/") != std::string::npos)
          << folder << "/README.md does not name " << room << "/";
    }
  }
}

/// A path in backquotes that begins with a folder of the project exists.
TEST(Pages, NameExistingPaths) {
  static const std::regex path(R"(`((?:calibration|compiler|examples|library|runtime|schema|tests)/[A-Za-z0-9_./]+)`)");
  for (const fs::path& page : pages()) {
    const std::string text = text_of(page);
    for (std::sregex_iterator match(text.begin(), text.end(), path), end; match != end; ++match) {
      const std::string name = (*match)[1];
      static const std::regex placeholder("[A-Z]{3,}|nnnn");  // NAME, KIND, Wnnnn
      if (std::regex_search(fs::path(name).replace_extension().string(), placeholder) && !fs::exists(root / name))
        continue;
      EXPECT_TRUE(fs::exists(root / name)) << page << " names " << name;
    }
  }
}

}  // namespace
}  // namespace wale::pages_test
