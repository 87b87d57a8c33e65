#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "runtime/device/hid_pid/hid_pid_device.hpp"

namespace wale::test {

/// A device's node without a kernel. The driver reads, writes and polls one end of a socketpair, which keeps packets
/// apart; `ioctl` finds the fake by the socket. The fake's own thread passes one frame each millisecond or slower. It
/// counts frames as the drivers' time.
class NodeFake {
 public:
  NodeFake();
  virtual ~NodeFake();
  NodeFake(const NodeFake&) = delete;
  NodeFake& operator=(const NodeFake&) = delete;

  /// The driver's end of the socketpair. It is open for the lifetime of the fake.
  int descriptor() const { return ends_[0]; }
  void unplug();

  static int ioctl(int descriptor, unsigned long request, void* argument);
  static std::int64_t now() noexcept;
  /// The fake's ioctl and time, for drivers.
  static HidPidDevice::Options options();

 protected:
  /// Answers a call as the kernel does, or sets `errno`. Called under the lock.
  virtual int answer(unsigned long request, void* argument) = 0;
  /// Called once per frame, under the lock.
  virtual void frame() = 0;
  int device_end() const { return ends_[1]; }
  /// Derived classes call one at the end of their constructor, the other at the start of their destructor.
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
