#pragma once

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/temporary_folder.hpp"

namespace wale::test {

struct Outcome {
  int status = -1;
  std::string out, err;
};

inline std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

/// A process of `wale` with these arguments. The destructor kills it if it still runs.
class Running {
 public:
  /// `config_home` is the folder of the person's own settings.
  explicit Running(const std::string& words, const std::string& config_home = "/nonexistent") {
    std::string shell = "/bin/sh", option = "-c";
    std::string line = "XDG_CONFIG_HOME='" + config_home + "' exec " + WALE_BINARY + " " + words + " </dev/null >" +
                       out_ + " 2>" + err_;
    char* all[] = {shell.data(), option.data(), line.data(), nullptr};
    if (posix_spawn(&child_, shell.c_str(), nullptr, nullptr, all, environ) != 0) throw std::runtime_error("no shell");
  }
  ~Running() {
    if (child_ > 0) kill(child_, SIGKILL), waitpid(child_, nullptr, 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// Its standard error so far.
  std::string said() const { return text_of(err_); }
  void interrupt() const { kill(child_, SIGINT); }
  /// Waits for the end of the process.
  Outcome outcome() {
    int status = 0;
    waitpid(std::exchange(child_, 0), &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, text_of(out_), text_of(err_)};
  }

 private:
  TemporaryFolder folder_;
  std::string out_ = folder_ / "out", err_ = folder_ / "err";
  pid_t child_ = 0;
};

inline Outcome run_wale(const std::string& words, const std::string& config_home = "/nonexistent") {
  return Running(words, config_home).outcome();
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace wale::test
