#pragma once

#include <string>

namespace wale::decoder {

/// Limits of the process that decodes a picture.
///
/// The memory is twice what the costliest format takes for 4096 x 4096 pixels of four channels (JPEG 2000: 0.46 GB and
/// 3.2 s on a virtual machine of 2026). Shared libraries and the picture's own bytes are not counted.
inline constexpr unsigned long long most_memory = 1ull << 30;  ///< bytes of data
inline constexpr unsigned most_processor_seconds = 10;

/// Limits memory and processor time of this process, and forbids core dumps, longer files and more descriptors. Returns
/// false if the system refuses.
bool limit_resources();

/// Takes from all threads of this process everything but reading and writing open descriptors, memory without code, and
/// the end: every other system call fails with EPERM. Cannot be undone. Call it after all libraries are loaded. Returns
/// why there is no sandbox, or an empty text.
std::string enter_sandbox();

}  // namespace wale::decoder
