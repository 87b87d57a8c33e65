#pragma once

namespace wale::test {

/// How often this thread has asked for memory, in a program of which allocations.cpp is a part.
inline thread_local long allocations = 0;

}  // namespace wale::test
