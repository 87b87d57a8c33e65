#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "runtime/device/hid_pid/hid_pid_device.hpp"

namespace wale::test {

/// A device's node without a kernel: one end of a socketpair that keeps packets apart, for the driver to read, write
/// and wait on, and `ioctl`, which finds the fake by the socket. A thread of its own passes frames, a millisecond or
/// more apart, and counts the time that drivers go by.
class NodeFake {
 public:
  NodeFake();
  virtual ~NodeFake();
  NodeFake(const NodeFake&) = delete;
  NodeFake& operator=(const NodeFake&) = delete;

  /// The driver's end. Open as long as this lives.
  int descriptor() const { return ends_[0]; }
  void unplug();

  static int ioctl(int descriptor, unsigned long request, void* argument);
  static std::int64_t now() noexcept;
  /// For drivers: this fake's ioctl and time.
  static HidPidDevice::Options options();

 protected:
  /// Under the lock: answers a call as the kernel does, or sets `errno`.
  virtual int answer(unsigned long request, void* argument) = 0;
  /// Under the lock, once a frame.
  virtual void frame() = 0;
  int device_end() const { return ends_[1]; }
  /// Of derived classes, when they are whole and before they are not.
  void start();
  void stop();

  std::mutex mutex_;

 private:
  int ends_[2] = {-1, -1};
  unsigned long inode_ = 0;
  bool is_gone_ = false;
  std::atomic<bool> stops_{false};
  std::thread clock_;
};

}  // namespace wale::test
