#pragma once

namespace wale::test {

/// The number of allocations by this thread so far. The program must link allocations.cpp.
inline thread_local long allocations = 0;

}  // namespace wale::test
