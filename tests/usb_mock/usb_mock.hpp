#pragma once

#include <umockdev.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/usb/pid_model.hpp"
#include "tests/usb/usb_model.hpp"

namespace wale::test {

/// A USB device as usbfs shows it to an unmodified libusb: its node answers the ioctls by which transfers are submitted
/// and reaped, and a model of the device makes the packets. Runs under umockdev-wrapper only.
class MockUsbDevice {
 public:
  MockUsbDevice(UMockdevTestbed* testbed, std::unique_ptr<UsbModel> model, int port, int address);
  virtual ~MockUsbDevice();
  MockUsbDevice(const MockUsbDevice&) = delete;
  MockUsbDevice& operator=(const MockUsbDevice&) = delete;

  /// One frame: at most one packet for each endpoint.
  void frame();
  /// Whether the driver has taken whatever has ended, and has asked for more in vain: what it does about that is done.
  bool is_served();
  /// Waits for that; false: it has waited for long.
  bool wait_until_served();
  /// Whatever is on its way ends, and nothing is taken any more.
  void unplug();
  /// Nobody has it open any more, as after a process that was killed: that the kernel would see, and this cannot.
  void close_all();

  const std::string& syspath() const { return syspath_; }
  const std::string& node() const { return node_; }

  std::atomic<bool> is_claimed_elsewhere{false};
  std::atomic<int> claims{0}, releases{0}, drivers_back{0}, unknown_ioctls{0};

 protected:
  std::mutex mutex_;
  std::condition_variable served_;
  std::unique_ptr<UsbModel> model_;

 private:
  /// A transfer of usbfs: the caller's `usbdevfs_urb` and its buffer.
  struct Urb {
    UMockdevIoctlData* urb = nullptr;
    UMockdevIoctlData* buffer = nullptr;
    UMockdevIoctlClient* client = nullptr;  // whose it is
    long due = 0;                           // of a control transfer: the frame in which it ends
  };

  static gboolean when_asked(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  void answer(UMockdevIoctlClient* client);
  void forget_the_closed();
  void set_unserved(UMockdevIoctlClient* client);
  int submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  int discard(UMockdevIoctlData* argument);
  int transfer_at_once(gulong request, UMockdevIoctlData* argument);
  int reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  void end(const Urb& urb, int status, int length);
  static void release(const Urb& urb);
  static UsbModel::SetUp set_up(const Urb& urb);
  void control(const Urb& urb);
  void show_whether_ready();

  std::string syspath_, node_;
  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_ = nullptr;
  gulong connection_ = 0;
  std::map<std::uint8_t, std::deque<Urb>> endpoints_;
  std::deque<Urb> controls_, done_;
  UMockdevIoctlClient* unserved_ = nullptr;  // for whom one has ended, until it has asked for more in vain
  long frame_ = 0;
  int fifo_ = -1;
  bool is_shown_ready_ = true, is_gone_ = false;
};

/// One that a model of this kind makes.
template <class Model>
class MockDevice final : public MockUsbDevice {
 public:
  MockDevice(UMockdevTestbed* testbed, Model model, int port, int address)
      : MockUsbDevice(testbed, std::make_unique<Model>(std::move(model)), port, address) {}

  /// Calls `look` with the model while nobody else uses it.
  template <class Look>
  auto with_model(Look look) {
    const std::lock_guard lock(mutex_);
    return look(static_cast<Model&>(*model_));
  }
};
using MockJoystick = MockDevice<PidModel>;

/// The models' time, for a driver in this process: a millisecond for each frame that has passed.
std::int64_t mock_microseconds() noexcept;

/// A testbed with devices, and what makes their frames pass. A frame passes only when every device is served, so that a
/// driver that has to wait for the processor misses none: by themselves, a millisecond each or slower, or one by one,
/// by the test's thread, while it keeps `InStep`.
class UsbMock {
 public:
  UsbMock();
  ~UsbMock();

  /// Plugs one in at a port, 1 .. 9, under a new address each time; as one that another program has claimed, if so.
  template <class Model>
  std::shared_ptr<MockDevice<Model>> plug(Model model, int port, bool is_claimed_elsewhere = false) {
    auto device = std::make_shared<MockDevice<Model>>(testbed_, std::move(model), port, ++address_);
    device->is_claimed_elsewhere = is_claimed_elsewhere;
    show(device);
    return device;
  }
  void unplug(const std::shared_ptr<MockUsbDevice>& device);

  /// While it lives frames pass only by `pass_frame`, of the thread that made it.
  class InStep {
   public:
    explicit InStep(UsbMock& mock) : mock_(mock) { ++mock_.in_step_; }
    ~InStep() { --mock_.in_step_; }
    InStep(const InStep&) = delete;
    InStep& operator=(const InStep&) = delete;

   private:
    UsbMock& mock_;
  };
  /// One frame, and what the driver does about it on its event thread. Throws std::runtime_error where the driver does
  /// not take what has ended.
  void pass_frame();

  /// False: frames that pass by themselves wait for no driver, as those of a real device, also where it is stopped.
  std::atomic<bool> waits_for_drivers{true};

  /// Frames since the beginning.
  long frames() const { return frames_.load(); }

 private:
  void show(std::shared_ptr<MockUsbDevice> device);
  bool is_served();
  void frame();

  UMockdevTestbed* testbed_;
  std::mutex mutex_;
  std::vector<std::shared_ptr<MockUsbDevice>> devices_;
  int address_ = 1;
  std::atomic<bool> ends_{false};
  std::atomic<int> in_step_{0};
  std::atomic<long> frames_{0};
  std::thread thread_;
};

}  // namespace wale::test
