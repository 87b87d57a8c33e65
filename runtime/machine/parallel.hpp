#pragma once

#include <cstddef>
#include <functional>

namespace wale {

/// Divides 0 .. count - 1 into contiguous parts and calls `work(begin, end)` for each, on as many threads as the
/// machine has cores, the calling thread included. Parts are in the order of threads, so each thread does the same work
/// each time. If the system gives no thread, the caller does the rest. An exception from `work` is thrown again when
/// all parts are done. Allocates.
void in_parallel(std::size_t count, const std::function<void(std::size_t begin, std::size_t end)>& work);

}  // namespace wale
