#pragma once

#include <umockdev.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/usb/pid_model.hpp"

namespace wale::test {

/// A USB joystick as usbfs shows it to an unmodified libusb: its node answers the ioctls by which transfers are
/// submitted and reaped, and a model of the device makes the packets. Runs under umockdev-wrapper only.
class MockJoystick {
 public:
  MockJoystick(UMockdevTestbed* testbed, PidModel model, int port, int address);
  ~MockJoystick();
  MockJoystick(const MockJoystick&) = delete;
  MockJoystick& operator=(const MockJoystick&) = delete;

  /// One frame: at most one packet for each endpoint.
  void frame();
  /// Whatever is on its way ends, and nothing is taken any more.
  void unplug();

  /// Calls `look` with the model while nobody else uses it.
  template <class Look>
  auto with_model(Look look) {
    const std::lock_guard lock(mutex_);
    return look(model_);
  }

  const std::string& syspath() const { return syspath_; }
  const std::string& node() const { return node_; }

  std::atomic<bool> is_claimed_elsewhere{false};
  std::atomic<int> claims{0}, releases{0}, drivers_back{0}, unknown_ioctls{0};

 private:
  /// A transfer of usbfs: the caller's `usbdevfs_urb` and its buffer.
  struct Urb {
    UMockdevIoctlData* urb = nullptr;
    UMockdevIoctlData* buffer = nullptr;
  };

  static gboolean when_asked(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  void answer(UMockdevIoctlClient* client);
  int submit(UMockdevIoctlData* argument);
  int discard(UMockdevIoctlData* argument);
  int reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  void end(const Urb& urb, int status, int length);
  void control(const Urb& urb);
  void show_whether_ready();

  std::mutex mutex_;
  PidModel model_;
  std::string syspath_, node_;
  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_ = nullptr;
  gulong connection_ = 0;
  std::deque<Urb> in_, out_, late_, done_;
  int fifo_ = -1;
  bool is_shown_ready_ = true, is_gone_ = false;
};

/// A testbed with joysticks, and the thread whose frames move them.
class UsbMock {
 public:
  UsbMock();
  ~UsbMock();

  /// Plugs one in at a port, 1 .. 9, under a new address each time.
  std::shared_ptr<MockJoystick> plug(PidModel model, int port);
  void unplug(const std::shared_ptr<MockJoystick>& joystick);

  /// Frames since the beginning.
  long frames() const { return frames_.load(); }

 private:
  UMockdevTestbed* testbed_;
  std::mutex mutex_;
  std::vector<std::shared_ptr<MockJoystick>> joysticks_;
  int address_ = 1;
  std::atomic<bool> ends_{false};
  std::atomic<long> frames_{0};
  std::thread thread_;
};

}  // namespace wale::test
