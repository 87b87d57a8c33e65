#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/temporary_folder.hpp"

/// Runs the `wale` binary.
namespace wale::command_line {

namespace fs = std::filesystem;

inline const std::string corduroy = std::string(WALE_SOURCE_DIR) + "/library/fabric/corduroy.wale";

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The status and outputs of a command.
struct Outcome {
  int status = -1;  ///< 128 or more: ended by a signal
  std::string out, err;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

inline std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Runs `wale` with these arguments and with `typed` as standard input, for an owner whose settings are in `config`.
/// Colours are off, since outputs are files.
inline Outcome wale(const std::vector<std::string>& words, const std::string& typed = {},
                    const std::string& config = "/nonexistent") {
  const TemporaryFolder folder;
  std::string command = "XDG_CONFIG_HOME=" + quoted(config) + " " + quoted(WALE_BINARY);
  for (const auto& word : words) command += " " + quoted(word);
  command += " <" + (typed.empty() ? "/dev/null" : quoted(folder.write("typed", typed))) + " >" +
             quoted(folder / "out") + " 2>" + quoted(folder / "err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, bytes_of(folder / "out"), bytes_of(folder / "err")};
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The text of library/fabric/corduroy.wale with `from` replaced by `to`.
inline std::string corduroy_with(const std::string& from, const std::string& to) {
  std::string text = bytes_of(corduroy);
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("the corduroy has no " + from);
  return text.replace(at, from.size(), to);
}

}  // namespace wale::command_line
