#include "compiler/command/deep_thread.hpp"

#include <signal.h>
#include <sys/resource.h>

#include <memory>
#include <system_error>
#include <utility>

namespace wale::command {

namespace {

constexpr std::size_t handlers_bytes = 64 * 1024;

}  // namespace

DeepThread::DeepThread(std::function<void()> work)
    : work_(std::move(work)), handlers_stack_(std::make_unique<char[]>(handlers_bytes)) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, deep_stack);
  const int error = pthread_create(&thread_, &attributes, run, this);
  pthread_attr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category(), "a thread cannot be started");
}

void* DeepThread::run(void* self) {
  stack_t stack{};
  stack.ss_sp = static_cast<DeepThread*>(self)->handlers_stack_.get();
  stack.ss_size = handlers_bytes;
  sigaltstack(&stack, nullptr);
  static_cast<DeepThread*>(self)->work_();
  stack.ss_flags = SS_DISABLE;
  sigaltstack(&stack, nullptr);
  return nullptr;
}

void DeepThread::join() {
  if (!std::exchange(is_joined_, true)) pthread_join(thread_, nullptr);
}

int with_deep_stack(const std::function<int()>& command) {
  constexpr rlim_t enough = rlim_t{8} << 20;  // the usual limit
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= enough) return command();
  // Threads that are started without a size, as the loop of a device is, get the default, which glibc took from the
  // limit.
  pthread_attr_t attributes;
  if (pthread_getattr_default_np(&attributes) == 0) {
    pthread_attr_setstacksize(&attributes, enough);
    pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
  }
  int status = 0;
  DeepThread thread([&] { status = command(); });
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  thread.join();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return status;
}

}  // namespace wale::command
