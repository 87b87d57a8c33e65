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

/// A USB device as usbfs shows it to an unmodified libusb. Its node answers the ioctls that submit and reap transfers.
/// A model of the device makes the packets. It works only under umockdev-wrapper.
class MockUsbDevice {
 public:
  MockUsbDevice(UMockdevTestbed* testbed, std::unique_ptr<UsbModel> model, int port, int address);
  virtual ~MockUsbDevice();
  MockUsbDevice(const MockUsbDevice&) = delete;
  MockUsbDevice& operator=(const MockUsbDevice&) = delete;

  /// Nodes beside usbfs with the same model behind them. Both functions are called under the device's lock.
  class Attachment {
   public:
    virtual ~Attachment() = default;
    virtual void frame(UsbModel& model) = 0;
    virtual void unplug() = 0;
  };
  void attach(Attachment* attachment);

  /// Passes one frame, with at most one packet per endpoint.
  void frame();
  /// Whether the driver has reaped all ended transfers and has found no more. It has then reacted to all of them.
  bool is_served();
  /// Waits until the driver is served. Returns false after a long wait.
  bool wait_until_served();
  /// Ends all transfers under way. The device takes no more.
  void unplug();
  /// Closes the device for all clients, as the kernel does when a process is killed. The mock cannot notice that
  /// itself.
  void close_all();

  /// Whether a request of any client is being answered just now. The mock reads a request's memory from its client, so
  /// a client that is stopped in the middle of one holds the mock, which no process can do to a kernel.
  static bool is_answering() { return answering_ != 0; }

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
    UMockdevIoctlClient* client = nullptr;  // the owner
    long due = 0;                           // for a control transfer: the frame in which it ends
  };

  static inline std::atomic<int> answering_{0};

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
  UMockdevIoctlClient* unserved_ = nullptr;  // has an ended transfer, and has not yet found that there are no more
  long frame_ = 0;
  Attachment* attachment_ = nullptr;
  int fifo_ = -1;
  bool is_shown_ready_ = true, is_gone_ = false;
};

/// A mock device with a model of type `Model`.
template <class Model>
class MockDevice final : public MockUsbDevice {
 public:
  MockDevice(UMockdevTestbed* testbed, Model model, int port, int address)
      : MockUsbDevice(testbed, std::make_unique<Model>(std::move(model)), port, address) {}

  /// Calls `look` with the model, under the lock.
  template <class Look>
  auto with_model(Look look) {
    const std::lock_guard lock(mutex_);
    return look(static_cast<Model&>(*model_));
  }
};
using MockJoystick = MockDevice<PidModel>;

/// The models' time, for a driver in this process: one millisecond per frame.
std::int64_t mock_microseconds() noexcept;

/// A testbed with devices, and the thread that passes their frames. A frame passes only when every device is served, so
/// a driver that waits for the processor misses none. Frames pass by themselves, each in a millisecond or more. While
/// an `InStep` exists, only the test's thread passes them.
class UsbMock {
 public:
  UsbMock();
  ~UsbMock();

  /// Plugs a device in at a port, 1 .. 9, with a new address each time. If `is_claimed_elsewhere`, another program has
  /// claimed it.
  template <class Model>
  std::shared_ptr<MockDevice<Model>> plug(Model model, int port, bool is_claimed_elsewhere = false) {
    auto device = std::make_shared<MockDevice<Model>>(testbed_, std::move(model), port, ++address_);
    device->is_claimed_elsewhere = is_claimed_elsewhere;
    show(device);
    return device;
  }
  void unplug(const std::shared_ptr<MockUsbDevice>& device);

  UMockdevTestbed* testbed() const { return testbed_; }

  /// While it exists, frames pass only by `pass_frame`, from the thread that made it.
  class InStep {
   public:
    explicit InStep(UsbMock& mock) : mock_(mock) { ++mock_.in_step_; }
    ~InStep() { --mock_.in_step_; }
    InStep(const InStep&) = delete;
    InStep& operator=(const InStep&) = delete;

   private:
    UsbMock& mock_;
  };
  /// Passes one frame, and waits until the driver's event thread has reacted. Throws std::runtime_error if the driver
  /// does not reap the ended transfers.
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
