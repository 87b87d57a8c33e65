#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <utility>

namespace wale {

/// An open file descriptor, which its destructor closes. -1: none.
class OwnedDescriptor {
 public:
  OwnedDescriptor() = default;
  explicit OwnedDescriptor(int descriptor) noexcept : descriptor_(descriptor) {}
  OwnedDescriptor(OwnedDescriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  OwnedDescriptor& operator=(OwnedDescriptor&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~OwnedDescriptor() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  /// A second descriptor of the same open file. Programs that this process starts do not inherit it.
  static OwnedDescriptor copy_of(int descriptor) noexcept {
    return OwnedDescriptor(fcntl(descriptor, F_DUPFD_CLOEXEC, 0));
  }

  int get() const noexcept { return descriptor_; }
  explicit operator bool() const noexcept { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

}  // namespace wale
