// calibration/RESEARCHERS_AFTERNOON.md: its commands print what it shows.
#include <gtest/gtest.h>

#include <regex>

#include "tests/command_line/running.hpp"

namespace wale::command_line::researching_test {
namespace {

/// Runs a command of a shell in a folder; returns what it prints, with its errors.
std::string printed_in(const TemporaryFolder& folder, const std::string& command) {
  const std::string out = folder / "printed";
  const std::string line = "cd " + quoted(folder / ".") + " && { PATH=" + quoted(folder / "bin") +
                           ":$PATH XDG_CONFIG_HOME=/nonexistent " + command + " ; } >" + quoted(out) + " 2>&1";
  [[maybe_unused]] const int status = std::system(line.c_str());
  return bytes_of(out);
}

/// Whether a text has the shown lines in this order, where `…` stands for any lines.
bool has_lines(const std::string& text, const std::string& shown) {
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
    while (anywhere && (found = text.find(line, found)) != std::string::npos && found > 0 && text[found - 1] != '\n')
      ++found;
    if (found == std::string::npos || text.compare(found, line.size(), line) != 0) return false;
    at = found + line.size(), anywhere = false;
  }
  return anywhere || at == text.size();
}

TEST(Researching, TheAfternoonPrintsWhatItsPageShows) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "bin");
  fs::create_symlink(WALE_BINARY, folder / "bin/wale");
  std::istringstream page(bytes_of(std::string(WALE_SOURCE_DIR) + "/calibration/RESEARCHERS_AFTERNOON.md"));
  const std::regex naming("^`([a-z_/.]+)`:$");
  std::string name, kind, block;
  int commands = 0;
  const auto run_console = [&](const std::string& text) {
    std::istringstream lines(text);
    std::string command, shown;
    const auto compare = [&] {
      if (command.empty()) return;
      ++commands;
      EXPECT_TRUE(command.starts_with("wale ")) << command;
      const std::string printed = printed_in(folder, command);
      EXPECT_TRUE(has_lines(printed, shown)) << "`" << command << "` prints\n"
                                             << printed << "and the page shows\n"
                                             << shown;
    };
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("$ ")) {
        compare();
        command = line.substr(2), shown.clear();
      } else {
        shown += line + "\n";
      }
    compare();
  };
  bool open = false;
  for (std::string line; std::getline(page, line);) {
    std::smatch found;
    if (!line.starts_with("```")) {
      if (open)
        block += line + "\n";
      else if (std::regex_match(line, found, naming))
        name = found[1];
      continue;
    }
    open = !open;
    if (open) {
      kind = line.substr(3), block.clear();
      continue;
    }
    if (kind == "console")
      run_console(block);
    else
      folder.write(name, block);
  }
  EXPECT_EQ(commands, 10);
  EXPECT_TRUE(contains(bytes_of(folder / "study.html"), "the session was interrupted once"));
  EXPECT_TRUE(bytes_of(folder / "plots/law.png").starts_with("\x89PNG"));
  EXPECT_EQ(wale({"check", folder / "roughness.wale"}).status, 0);
}

}  // namespace
}  // namespace wale::command_line::researching_test
