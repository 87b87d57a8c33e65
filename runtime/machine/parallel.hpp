#pragma once

#include <cstddef>
#include <functional>

namespace wale {

/// Calls `work(begin, end)` for parts of 0 .. count - 1 that cover it once, on as many threads as the machine has
/// cores; the calling thread is one of them. Parts are contiguous and in the order of threads, so each thread does the
/// same work each time. Where there is one core, or the system gives no thread, the caller does the rest. What `work`
/// throws is thrown again, once all are done. Allocates.
void in_parallel(std::size_t count, const std::function<void(std::size_t begin, std::size_t end)>& work);

}  // namespace wale
