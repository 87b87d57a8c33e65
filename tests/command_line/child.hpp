#pragma once

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/command_line/running.hpp"

namespace wale::command_line {

/// A `wale` process that runs until it gets a signal. It may be given a terminal; its signals are at their defaults.
class Child {
 public:
  Child(std::vector<std::string> words, const std::string& out, const std::string& err,
        const std::string& terminal = {}, const std::vector<int>& ignored = {}) {
    child_ = fork();
    if (child_ != 0) return;
    for (int signal = 1; signal < 32; ++signal) ::signal(signal, SIG_DFL);
    for (const int signal : ignored) ::signal(signal, SIG_IGN);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    if (!terminal.empty()) {
      setsid();
      open(terminal.c_str(), O_RDWR);  // a leader of a session without one gets it as its own
    }
    dup2(open("/dev/null", O_RDONLY), 0);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 1);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 2);
    std::vector<char*> arguments;
    words.insert(words.begin(), WALE_BINARY);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(WALE_BINARY, arguments.data());
    _exit(127);
  }
  ~Child() {
    if (child_ > 0) kill(child_, SIGKILL), waitpid(child_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void tell(int signal) const { kill(child_, signal); }
  pid_t process() const { return child_; }
  bool has_ended(int& status) {
    if (waitpid(child_, &status, WNOHANG) != child_) return false;
    child_ = 0;
    return true;
  }
  /// As waitpid tells it.
  int wait(int options = 0) {
    int status = 0;
    waitpid(child_, &status, options);
    if (!WIFSTOPPED(status)) child_ = 0;
    return status;
  }

 private:
  pid_t child_ = 0;
};

/// Waits until the condition holds. Returns false after a minute.
template <class Condition>
bool eventually(Condition&& condition) {
  for (int i = 0; i < 6000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace wale::command_line
