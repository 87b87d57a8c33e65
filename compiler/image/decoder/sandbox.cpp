#include "compiler/image/decoder/sandbox.hpp"

#include <fcntl.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

namespace wale::decoder {
namespace {

/// System calls that are allowed with any arguments.
constexpr int allowed_calls[] = {
    // the open descriptors
    SCMP_SYS(read), SCMP_SYS(readv), SCMP_SYS(pread64), SCMP_SYS(write), SCMP_SYS(writev), SCMP_SYS(lseek),
    SCMP_SYS(_llseek), SCMP_SYS(fstat), SCMP_SYS(fstat64), SCMP_SYS(close),
    // memory
    SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise),
    // locks, and the clock where it is a system call
    SCMP_SYS(futex), SCMP_SYS(futex_time64), SCMP_SYS(clock_gettime), SCMP_SYS(clock_gettime64), SCMP_SYS(gettimeofday),
    // the beginning of threads that libraries have just started
    SCMP_SYS(rseq), SCMP_SYS(set_robust_list), SCMP_SYS(rt_sigprocmask),
    // the end
    SCMP_SYS(exit), SCMP_SYS(exit_group), SCMP_SYS(rt_sigreturn), SCMP_SYS(restart_syscall)};

/// System calls whose third argument is the protection of memory: allowed only if nobody asks for code.
constexpr int mapping_calls[] = {SCMP_SYS(mmap), SCMP_SYS(mmap2), SCMP_SYS(mprotect)};

/// Where a limit is smaller already, it stays.
bool limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  rlimit limits{};
  if (getrlimit(resource, &limits) != 0) return false;
  limits.rlim_max = std::min(limits.rlim_max, hard);
  limits.rlim_cur = std::min(soft, limits.rlim_max);
  return setrlimit(resource, &limits) == 0;
}

/// Whether files can still be opened. Emulators of systems take a filter and ignore it.
bool opens_files() {
  const int folder = open("/", O_PATH | O_CLOEXEC);
  if (folder >= 0) close(folder);
  return folder >= 0 || errno != EPERM;
}

}  // namespace

bool limit_resources() {
  // After the soft limit of processor time the process gets SIGXCPU, after the hard one SIGKILL.
  return limit(RLIMIT_DATA, most_memory, most_memory) &&
         limit(RLIMIT_CPU, most_processor_seconds, most_processor_seconds + 1) && limit(RLIMIT_CORE, 0, 0) &&
         limit(RLIMIT_FSIZE, 0, 0) && limit(RLIMIT_NOFILE, 3, 3);
}

std::string enter_sandbox() {
  const auto failed = [](const char* what, int error) { return std::string(what) + ": " + std::strerror(error); };
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return failed("no_new_privs", errno);
  const std::unique_ptr<void, decltype(&seccomp_release)> filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)), seccomp_release);
  if (!filter) return "libseccomp does not know this system";
  // Libraries have started threads of their own; the filter is for all of them.
  if (const int error = seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_TSYNC, 1); error != 0)
    return failed("seccomp for all threads", -error);
  for (const int call : allowed_calls)
    if (const int error = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 0); error != 0)
      return failed("seccomp rule", -error);
  for (const int call : mapping_calls) {
    const scmp_arg_cmp no_code = SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0);
    if (const int error = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 1, no_code); error != 0)
      return failed("seccomp rule", -error);
  }
  if (const int error = seccomp_load(filter.get()); error != 0) return failed("seccomp", -error);
  return opens_files() ? "the system ignores seccomp filters" : "";
}

}  // namespace wale::decoder
