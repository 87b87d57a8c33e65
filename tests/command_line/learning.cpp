// The pages of examples/learn: their blocks compile without a warning, their commands print what is shown, and their
// pictures are what `wale preview` draws. `WALE_REDRAW=1 build/tests/test_command_line --gtest_filter=Learning.*` draws
// the pictures anew.

#include <gtest/gtest.h>

#include <regex>

#include "tests/command_line/running.hpp"

namespace wale::command_line::learning_test {
namespace {

const fs::path pages_folder = fs::path(WALE_SOURCE_DIR) / "examples/learn";
const char* const pages[] = {"README.md", "RECIPES.md", "FORCES.md"};

/// A fenced block, or a picture, in the order of the page.
struct Part {
  std::string kind;  ///< what is behind the opening fence; "picture"
  std::string text;  ///< of a picture its file, as written
  std::string name;  ///< of the file that the line above the block names last
  int line = 0;
};

std::vector<Part> parts_of(const std::string& page) {
  std::istringstream lines(bytes_of(pages_folder / page));
  std::vector<Part> parts;
  static const std::regex picture(R"(^!\[.*\]\((.+)\)$)"), naming(R"(`(\w+\.wale)`[^`]*:$)");
  bool inside = false;
  std::string name = "recipe.wale";
  int number = 0;
  for (std::string line, whole; std::getline(lines, line);) {
    ++number;
    std::smatch found;
    if (line.starts_with("```")) {
      if (!inside) parts.push_back({line.substr(3), "", name, number});
      inside = !inside;
      name = "recipe.wale";
    } else if (inside) {
      parts.back().text += line + "\n";
    } else if (std::regex_search(line, found, picture)) {
      parts.push_back({"picture", found[1], "", number});
    } else if (std::regex_search(line, found, naming)) {
      name = found[1];
    }
  }
  EXPECT_FALSE(inside) << page << " has a block that does not end";
  return parts;
}

/// Whether a text is as a page shows it, where a line with `…` alone stands for any lines.
bool is_as_shown(const std::string& text, const std::string& shown) {
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
    if (anywhere) {
      while ((found = text.find(line, found)) != std::string::npos && found > 0 && text[found - 1] != '\n') ++found;
      if (found == std::string::npos) return false;
    } else if (text.compare(at, line.size(), line) != 0) {
      return false;
    }
    at = found + line.size();
    anywhere = false;
  }
  return anywhere || at == text.size();
}

/// A page is gone through from above, as a person does, in a folder that has its pictures.
class Walk {
 public:
  Walk() {
    for (const auto& entry : fs::directory_iterator(pages_folder))
      if (entry.path().extension() == ".png") fs::copy(entry.path(), folder_ / entry.path().filename().string());
    fs::create_directory(folder_ / "bin");
    fs::create_symlink(WALE_BINARY, folder_ / "bin/wale");
  }
  void write(const Part& block) { folder_.write(current_ = block.name, block.text); }
  const std::string& current() const { return current_; }
  std::string file(const std::string& name) const { return folder_ / name; }

  /// What a command prints, with its errors.
  std::string run(const std::string& command) {
    const std::string out = folder_ / "printed";
    const std::string line = "cd " + quoted(folder_ / ".") + " && PATH=" + quoted(folder_ / "bin") +
                             ":$PATH XDG_CONFIG_HOME=/nonexistent " + command + " >" + quoted(out) + " 2>&1 </dev/null";
    [[maybe_unused]] const int status = std::system(line.c_str());
    return bytes_of(out);
  }

 private:
  TemporaryFolder folder_;
  std::string current_;
};

TEST(Learning, EveryBlockCompilesWithoutAWarningInTheStandardStyle) {
  int blocks = 0;
  for (const char* page : pages) {
    Walk walk;
    for (const Part& part : parts_of(page)) {
      EXPECT_TRUE(part.kind == "wale" || part.kind == "wale-error" || part.kind == "console" || part.kind == "picture")
          << page << ":" << part.line << " has a block of a kind that is not tested";
      if (part.kind != "wale") continue;
      ++blocks;
      walk.write(part);
      EXPECT_EQ(walk.run("wale check " + part.name), "1 file: 0 errors, 0 warnings\n") << page << ":" << part.line;
      walk.run("wale format " + part.name);
      EXPECT_EQ(bytes_of(walk.file(part.name)), part.text) << page << ":" << part.line;
    }
  }
  EXPECT_GE(blocks, 25);
}

TEST(Learning, EveryCommandPrintsWhatThePageShows) {
  int commands = 0;
  for (const char* page : pages) {
    Walk walk;
    for (const Part& part : parts_of(page)) {
      if (part.kind.starts_with("wale")) walk.write(part);
      if (part.kind != "console") continue;
      std::istringstream lines(part.text);
      std::string command, shown;
      const auto compare = [&] {
        if (command.empty()) return;
        ++commands;
        const std::string printed = walk.run(command);
        EXPECT_TRUE(is_as_shown(printed, shown))
            << page << ":" << part.line << " shows for `" << command << "`\n" << shown << "and it prints\n" << printed;
      };
      for (std::string line; std::getline(lines, line);)
        if (line.starts_with("$ ")) {
          compare();
          command = line.substr(2), shown.clear();
          EXPECT_TRUE(command.starts_with("wale ") || command.starts_with("touch ")) << command;
        } else {
          shown += line + "\n";
        }
      compare();
    }
  }
  EXPECT_GE(commands, 8);
}

TEST(Learning, EveryPictureIsWhatPreviewDraws) {
  int pictures = 0;
  static const std::regex workspace(R"(\nworkspace (\w+))");
  for (const char* page : pages) {
    Walk walk;
    std::string last;
    for (const Part& part : parts_of(page)) {
      if (part.kind == "wale") walk.write(part), last = part.text;
      if (part.kind != "picture") continue;
      ++pictures;
      ASSERT_FALSE(last.empty()) << page << ":" << part.line;
      std::smatch found;
      const std::string what = std::regex_search(last, found, workspace) ? "--workspace " + found[1].str() : "--small";
      const std::string printed = walk.run("wale preview " + walk.current() + " " + what + " -o drawn.png");
      EXPECT_EQ(printed, "") << page << ":" << part.line;
      if (std::getenv("WALE_REDRAW"))
        fs::copy_file(walk.file("drawn.png"), pages_folder / part.text, fs::copy_options::overwrite_existing);
      EXPECT_TRUE(bytes_of(walk.file("drawn.png")) == bytes_of(pages_folder / part.text))
          << page << ":" << part.line << ": " << part.text << " is not what is drawn";
    }
  }
  EXPECT_GE(pictures, 20);
}

TEST(Learning, WhatAPageShowsIsComparedLineByLine) {
  EXPECT_TRUE(is_as_shown("a\nb\n", "a\nb\n"));
  EXPECT_FALSE(is_as_shown("a\nb\n", "a\n"));
  EXPECT_FALSE(is_as_shown("a\nb\nc\n", "…\nb\n"));
  EXPECT_TRUE(is_as_shown("a\nb\nc\n", "…\nb\n…\n"));
  EXPECT_FALSE(is_as_shown("a\nbb\nc\n", "…\nb\n…\n"));
}

}  // namespace
}  // namespace wale::command_line::learning_test
