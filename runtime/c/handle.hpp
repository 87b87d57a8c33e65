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

/// A handle that is made before the work whose result it will have: what is done then cannot fail for lack of memory.
/// Without a place for the handle there is none.
template <class Handle>
class HandleToBe {
 public:
  explicit HandleToBe(Handle** to) : to_(to) {
    if (to == nullptr) return;
    handle_ = std::make_unique<Handle>();
    note_handle(handle_.get());
  }
  ~HandleToBe() {
    if (handle_) forget_handle(handle_.get());
  }
  HandleToBe(const HandleToBe&) = delete;
  HandleToBe& operator=(const HandleToBe&) = delete;

  /// Null if nobody wants it.
  Handle* operator->() const noexcept { return handle_.get(); }
  explicit operator bool() const noexcept { return handle_ != nullptr; }
  /// Gives it to the caller.
  void give() noexcept {
    if (handle_) *to_ = handle_.release();
  }

 private:
  std::unique_ptr<Handle> handle_;
  Handle** to_;
};

/// Frees a handle. Null does nothing, and neither does one that is freed already.
template <class Handle>
void free_handle(Handle* handle) noexcept {
  if (forget_handle(handle)) delete handle;
}

}  // namespace wale::c
