#pragma once

#include <cstddef>
#include <memory>

#include "wale/error.h"

/// The handles of the C interface: what is given to the caller, and what comes back.
namespace wale::c {

/// Notes a handle that the caller has to free. Error: std::bad_alloc.
void note_handle(const void* handle);
/// Forgets it. False if nobody has to free it: it is freed already, or was never given.
bool forget_handle(const void* handle) noexcept;

/// Gives a new handle to the caller.
template <class Handle>
void hand_out(std::unique_ptr<Handle> handle, Handle** to) {
  note_handle(handle.get());
  *to = handle.release();
}

/// Frees a handle. Null does nothing, and neither does one that is freed already.
template <class Handle>
void free_handle(Handle* handle) noexcept {
  if (forget_handle(handle)) delete handle;
}

}  // namespace wale::c
