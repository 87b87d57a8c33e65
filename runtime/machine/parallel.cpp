#include "runtime/machine/parallel.hpp"

#include <algorithm>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace wale {

void in_parallel(std::size_t count, const std::function<void(std::size_t begin, std::size_t end)>& work) {
  const std::size_t parts =
      std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, std::max<std::size_t>(count, 1));
  std::vector<std::exception_ptr> thrown(parts);
  const auto run = [&](std::size_t part) noexcept {
    try {
      work(count * part / parts, count * (part + 1) / parts);
    } catch (...) {
      thrown[part] = std::current_exception();
    }
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
