#include "runtime/machine/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace wale {

namespace {

/// Threads that calls of `in_parallel` have started and not yet joined.
std::atomic<std::size_t> started{0};

/// So many of the wanted threads as there are idle cores for, counted as started. Work that is divided already is not
/// divided again: more threads than cores only wait for each other.
std::size_t take_idle(std::size_t wanted) {
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  std::size_t now = started.load(std::memory_order_relaxed), taken = 0;
  do {
    taken = now + 1 < cores ? std::min(wanted, cores - 1 - now) : 0;
  } while (!started.compare_exchange_weak(now, now + taken, std::memory_order_relaxed));
  return taken;
}

}  // namespace

void in_parallel(std::size_t count, const std::function<void(std::size_t begin, std::size_t end)>& work) {
  const std::size_t helping = take_idle(std::max<std::size_t>(count, 1) - 1), parts = helping + 1;
  std::vector<std::exception_ptr> thrown(parts);
  const auto run = [&](std::size_t part) noexcept {
    try {
      work(count * part / parts, count * (part + 1) / parts);
    } catch (...) {
      thrown[part] = std::current_exception();
    }
    if (part > 0) started.fetch_sub(1, std::memory_order_relaxed);
  };
  std::vector<std::thread> threads;
  threads.reserve(parts);
  std::size_t given = 1;  // the calling thread takes part 0
  try {
    for (; given < parts; ++given) threads.emplace_back(run, given);
  } catch (const std::system_error&) {  // the system gives no more threads
  }
  run(0);
  for (std::size_t part = given; part < parts; ++part) run(part);
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& each : thrown)
    if (each) std::rethrow_exception(each);
}

}  // namespace wale
