// The sandbox of the decoder, tried from inside: in a child process, by bare system calls.

#include "compiler/image/decoder/sandbox.hpp"

#include <errno.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <thread>

namespace wale::sandbox_test {
namespace {

/// The exit status of a child that runs `body`; 128 and more: ended by a signal.
template <class Body>
int status_of(Body body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool is_refused(long result) { return result == -1 && errno == EPERM; }

/// The number of the first call that is not refused, counted from 1; 0 if all are.
int first_that_succeeds() {
  char path[] = "/dev/null";
  char* words[] = {path, nullptr};
  clone_args process{};
  process.exit_signal = SIGCHLD;
  rlimit limits{1 << 20, 1 << 20};
  int number = 0;
  const auto refused = [&](long result) { return ++number, is_refused(result); };
  const bool all =
      refused(syscall(SYS_openat, AT_FDCWD, path, O_RDONLY)) &&
      refused(syscall(SYS_openat, AT_FDCWD, "new", O_CREAT)) && refused(syscall(SYS_socket, AF_INET, SOCK_STREAM, 0)) &&
      refused(syscall(SYS_socket, AF_UNIX, SOCK_STREAM, 0)) &&
      refused(syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr)) &&
      refused(syscall(SYS_clone3, &process, sizeof process)) && refused(syscall(SYS_execve, path, words, words)) &&
      refused(syscall(SYS_ptrace, 16L /* attach */, static_cast<long>(getppid()), nullptr, nullptr)) &&
      refused(syscall(SYS_kill, 0, 0)) && refused(syscall(SYS_tgkill, 1, 1, 0)) &&
      refused(syscall(SYS_prctl, PR_SET_DUMPABLE, 1, 0, 0, 0)) &&
      refused(syscall(SYS_prlimit64, 0, RLIMIT_DATA, &limits, nullptr)) &&
      refused(syscall(SYS_unlinkat, AT_FDCWD, "none", 0)) && refused(syscall(SYS_memfd_create, "memory", 0)) &&
      refused(syscall(SYS_dup, 1)) && refused(syscall(SYS_ioctl, 1, 0x5413, nullptr)) &&
      refused(syscall(SYS_process_vm_readv, 1, nullptr, 0, nullptr, 0, 0)) &&
      refused(syscall(SYS_io_uring_setup, 1, nullptr)) && refused(syscall(SYS_setuid, 0)) &&
      refused(syscall(SYS_mmap, nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  return all ? 0 : number;
}

TEST(Sandbox, RefusesEverythingButComputing) {
  EXPECT_EQ(status_of([] { return decoder::enter_sandbox().empty() ? first_that_succeeds() : 100; }), 0);
}

TEST(Sandbox, HoldsThreadsThatWereThereBefore) {
  EXPECT_EQ(status_of([] {
              std::atomic<int> found = -1;
              std::atomic<bool> entered = false;
              std::thread earlier([&] {
                while (!entered) continue;
                found = first_that_succeeds();
              });
              earlier.detach();
              if (!decoder::enter_sandbox().empty()) return 100;
              entered = true;
              while (found < 0) continue;
              return found.load();
            }),
            0);
}

TEST(Sandbox, LeavesOpenDescriptorsAndMemory) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  EXPECT_EQ(status_of([&] {
              if (!decoder::enter_sandbox().empty()) return 100;
              void* memory = mmap(nullptr, 1 << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
              if (memory == MAP_FAILED || munmap(memory, 1 << 20) != 0) return 1;
              return write(ends[1], "a", 1) == 1 ? 0 : 2;
            }),
            0);
  char read_back = 0;
  EXPECT_EQ(read(ends[0], &read_back, 1), 1);
  EXPECT_EQ(read_back, 'a');
  close(ends[0]);
  close(ends[1]);
}

TEST(Sandbox, LimitsMemoryTimeAndFiles) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer needs more memory";
#endif
  EXPECT_EQ(status_of([] {
              if (!decoder::limit_resources()) return 1;
              const auto limit = [](auto resource) {
                rlimit limits{};
                getrlimit(resource, &limits);
                return limits.rlim_cur;
              };
              if (limit(RLIMIT_CPU) != 10 || limit(RLIMIT_CORE) != 0 || limit(RLIMIT_FSIZE) != 0) return 2;
              const int flags = MAP_PRIVATE | MAP_ANONYMOUS;
              if (mmap(nullptr, 1ul << 30, PROT_READ | PROT_WRITE, flags, -1, 0) != MAP_FAILED) return 3;
              if (mmap(nullptr, 1ul << 29, PROT_READ | PROT_WRITE, flags, -1, 0) == MAP_FAILED) return 4;
              return open("/dev/null", O_RDONLY) < 0 ? 0 : 5;
            }),
            0);
}

}  // namespace
}  // namespace wale::sandbox_test
