#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "schema/companion.hpp"

namespace wale::command {
namespace {

struct SandpaperOptions {
  std::vector<std::string> files;
  std::string device;
};

/// Becomes the program of the window, which is a package of its own. Returns only if there is none.
int sandpaper(const SandpaperOptions& options) {
  std::vector<std::string> words = {"wale-sandpaper"};
  if (!options.device.empty()) words.insert(words.end(), {"--device", options.device});
  words.emplace_back("--");
  words.insert(words.end(), options.files.begin(), options.files.end());
  std::vector<char*> arguments;
  for (std::string& each : words) arguments.push_back(each.data());
  arguments.push_back(nullptr);
  std::error_code unreadable;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unreadable).parent_path();
  const std::string beside = (program / "wale-sandpaper").string();
  if (!unreadable && access(beside.c_str(), X_OK) == 0) {
    execv(beside.c_str(), arguments.data());
    return refuse(Error{.code = Code::short_of_resources,
                        .sentence = "`" + beside + "` cannot be started: " + std::strerror(errno)});
  }
  return refuse(Error{.code = Code::unreadable_file,
                      .sentence = "the window of Sandpaper is not installed beside `wale`",
                      .mend = "install the package wale-sandpaper; in a clone, `./wale sandpaper` builds it"});
}

Run declare_sandpaper(CLI::App& verb) {
  const auto options = std::make_shared<SandpaperOptions>();
  verb.add_option("FILE", options->files, "a Wale file whose workspace is opened; may be repeated (default: an empty workspace)");
  verb.add_option("--device", options->device,
                  "the device to feel with, as in `wale feel` (default: the mouse over the window)")
      ->type_name("DEVICE");
  verb.footer("for example: wale sandpaper kitchen.wale\n\nNothing is felt before you say so, and the space bar takes all force away.");
  return [options] { return sandpaper(*options); };
}

}  // namespace

extern const Verb sandpaper_verb{"sandpaper", "opens the window in which workspaces are laid out and felt", declare_sandpaper};

}  // namespace wale::command
