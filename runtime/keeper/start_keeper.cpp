#include "runtime/keeper/start_keeper.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <vector>

namespace wale {
namespace {

constexpr char what_it_is_for[] = "nothing may push a joystick without the program that lets it go";

Error no_keeper(std::string sentence, std::string place) {
  return {Code::no_keeper, std::move(sentence), what_it_is_for, {.name = std::move(place)}};
}

/// What the intermediate process is to do, and what came of it. It shares this memory.
struct Start {
  const char* program = nullptr;
  char* const* words = nullptr;
  std::span<const int> descriptors;
  const posix_spawnattr_t* attributes = nullptr;
  pid_t keeper = 0;
  int error = 0;
};

/// Runs in the intermediate process, in this process's memory, while the thread that made it waits. Its table of
/// descriptors is its own.
int start_and_leave(void* start) {
  Start& wanted = *static_cast<Start*>(start);
  for (const int descriptor : wanted.descriptors) fcntl(descriptor, F_SETFD, 0);
  wanted.error = posix_spawn(&wanted.keeper, wanted.program, nullptr, wanted.attributes, wanted.words, environ);
  _exit(0);
}

/// All signals blocked and at their defaults: Ctrl-C and the end of a session must not end a keeper before its owner.
class DeafAttributes {
 public:
  DeafAttributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &all);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~DeafAttributes() { posix_spawnattr_destroy(&attributes_); }
  DeafAttributes(const DeafAttributes&) = delete;
  DeafAttributes& operator=(const DeafAttributes&) = delete;
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

}  // namespace

Result<std::string> find_keeper(const std::string& named, const std::vector<std::string>& places) {
  if (!named.empty()) {
    if (access(named.c_str(), X_OK) == 0) return named;
    return no_keeper("the keeper is no program that can be run", named);
  }
  for (const std::string& place : places)
    if (access(place.c_str(), X_OK) == 0) return place;
  return no_keeper("there is no wale-keeper where this program or its library would have it",
                   places.empty() ? "/proc/self/exe" : places.front());
}

// A child of this process would raise SIGCHLD when it ends, and an application's handler or `waitpid(-1)` would meet a
// process that it does not know. So an intermediate process starts the keeper and ends at once. It is made by clone
// without a signal for its end, and runs nothing but `start_and_leave`, as the child of a vfork does. (A process that
// executes a program raises SIGCHLD at its end whatever clone was told, so one step is not enough.)
Result<pid_t> start_keeper(const std::string& program, std::span<const std::string> words,
                           std::span<const int> descriptors) {
  std::vector<char*> raw{const_cast<char*>(program.c_str())};
  for (const std::string& word : words) raw.push_back(const_cast<char*>(word.c_str()));
  raw.push_back(nullptr);
  constexpr std::size_t stack_bytes = 128 * 1024;
  void* stack = mmap(nullptr, stack_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
  if (stack == MAP_FAILED) return no_keeper("the keeper cannot be started: no memory", program);

  const DeafAttributes attributes;
  Start start{program.c_str(), raw.data(), descriptors, attributes.get()};
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);  // no handler may run in the intermediate process
  const pid_t intermediate =
      clone(start_and_leave, static_cast<char*>(stack) + stack_bytes, CLONE_VM | CLONE_VFORK, &start);
  const int error = errno;
  if (intermediate > 0) {
    while (waitpid(intermediate, nullptr, __WCLONE) < 0 && errno == EINTR) {
    }
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  munmap(stack, stack_bytes);
  const int failure = intermediate < 0 ? error : start.error;
  if (failure != 0)
    return no_keeper("the keeper cannot be started: " + std::generic_category().message(failure), program);
  return start.keeper;
}

}  // namespace wale
