#pragma once

namespace wale::command {

/// Lets this process keep the memory that it frees, for its next use. A reading takes and frees some hundred blocks of
/// about a megabyte, and to get fresh pages for each from the kernel takes a fifth of its time. Called once, before
/// threads are started.
void keep_freed_memory();

}  // namespace wale::command
