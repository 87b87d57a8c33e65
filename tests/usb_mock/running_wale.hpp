#pragma once

#include <fcntl.h>
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
  int signal = 0;  ///< that ended it; 0: none
  std::string out, err;
};

inline std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

/// `wale` with these words, all signals at their defaults, killed in the end if it has not ended.
class Running {
 public:
  /// `config_home` is the folder of the person's own settings. Words may end with `<FILE`, for standard input.
  explicit Running(const std::string& words, const std::string& config_home = "/nonexistent") {
    std::string shell = "/bin/sh", option = "-c";
    std::string line = "ulimit -c 0; XDG_CONFIG_HOME='" + config_home + "' exec " + WALE_BINARY + " </dev/null " +
                       words + " >" + out_ + " 2>" + err_;
    char* all[] = {shell.data(), option.data(), line.data(), nullptr};
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t every;
    sigfillset(&every);
    posix_spawnattr_setsigdefault(&attributes, &every);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int error = posix_spawn(&child_, shell.c_str(), nullptr, &attributes, all, environ);
    posix_spawnattr_destroy(&attributes);
    if (error != 0) throw std::runtime_error("no shell");
  }
  ~Running() {
    if (child_ > 0) ::kill(child_, SIGKILL), waitpid(child_, nullptr, 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// On standard error, by now.
  std::string said() const { return text_of(err_); }
  void interrupt() const { tell(SIGINT); }
  void tell(int signal) const { ::kill(child_, signal); }
  pid_t process() const { return child_; }
  /// Once it has ended.
  Outcome outcome() {
    int status = 0;
    waitpid(std::exchange(child_, 0), &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, WIFSIGNALED(status) ? WTERMSIG(status) : 0, text_of(out_),
            text_of(err_)};
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
