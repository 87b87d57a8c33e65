#pragma once

#include <linux/input.h>
#include <umockdev.h>

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/usb_mock/usb_mock.hpp"

namespace wale::test {

/// A node of umockdev that answers ioctl, read and write by handlers of ours, and that poll finds readable only while
/// there is something to read.
class MockNode {
 public:
  /// What the kernel would do. Called on a thread of umockdev. `answer` and `take` may complete the client later.
  class Kernel {
   public:
    virtual void answer(MockNode& node, UMockdevIoctlClient* client) = 0;
    virtual void take(MockNode& node, UMockdevIoctlClient* client) = 0;
    /// The bytes that a read gives; nothing: there are none.
    virtual std::optional<std::vector<std::uint8_t>> give(MockNode& node) = 0;

   protected:
    ~Kernel() = default;
  };

  /// `path` is one that the testbed has.
  MockNode(UMockdevTestbed* testbed, std::string path, Kernel& kernel);
  ~MockNode();
  MockNode(const MockNode&) = delete;
  MockNode& operator=(const MockNode&) = delete;

  const std::string& path() const { return path_; }
  void show_whether_readable(bool is_readable);

 private:
  static gboolean when_asked(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  static gboolean when_read(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  static gboolean when_written(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);

  UMockdevTestbed* testbed_;
  const std::string path_;
  Kernel& kernel_;
  UMockdevIoctlBase* handler_;
  int fifo_ = -1;
  bool is_readable_ = false;
};

/// The kernel's side of a joystick of the PID class that it has bound: folders of sysfs, a hidraw node, and an event
/// node that plays effects by reports, as drivers/hid/usbhid/hid-pidff.c does. Both nodes and the joystick's usbfs node
/// have the same model behind them, and one report reaches it in each frame. Unlike the kernel, this keeps its nodes
/// when usbfs claims the interface: tests/qemu shows that.
class MockHidNodes final : public MockUsbDevice::Attachment, public MockNode::Kernel {
 public:
  /// `number`: of /dev/hidrawN and /dev/input/eventN, each once in a testbed. The joystick outlives it.
  MockHidNodes(UMockdevTestbed* testbed, MockJoystick& joystick, int number);
  ~MockHidNodes() override;

  const std::string& hidraw() const { return hidraw_->path(); }
  const std::string& event() const { return event_->path(); }
  /// Closes all open files of the nodes, as after a kill. umockdev does not see a kill within a call.
  void close_all();

  void frame(UsbModel& model) override;
  void unplug() override;

 private:
  /// An output report on its way to the device, and the write that waits for it, if one does.
  struct Report {
    std::vector<std::uint8_t> bytes;
    UMockdevIoctlClient* writer = nullptr;
  };
  struct Effect {
    ff_effect said{};
    std::uint8_t block = 0;
    UMockdevIoctlClient* owner = nullptr;
  };

  void remove_folders();
  void answer(MockNode& node, UMockdevIoctlClient* client) override;
  void take(MockNode& node, UMockdevIoctlClient* client) override;
  std::optional<std::vector<std::uint8_t>> give(MockNode& node) override;

  long answer_hidraw(PidModel& model, unsigned long request, std::uint8_t* data, std::size_t size);
  long report(PidModel& model, bool is_in, std::uint8_t kind, std::uint8_t* data, std::size_t size);
  long answer_event(PidModel& model, UMockdevIoctlClient* client, unsigned long request, std::uint8_t* data,
                    std::size_t size);
  long upload(PidModel& model, UMockdevIoctlClient* client, ff_effect& effect);
  long erase(PidModel& model, const UMockdevIoctlClient* client, int id);
  void play(const PidModel& model, const input_event& event);
  void take_position(const PidModel& model, const std::vector<std::uint8_t>& input);
  void send_now(PidModel& model);
  void erase_of_the_closed(PidModel& model);

  UMockdevTestbed* testbed_;
  MockJoystick& joystick_;
  std::vector<std::string> folders_;  // of sysfs, the innermost last
  bool is_gone_ = false;              // as all below, under the joystick's lock
  std::deque<Report> outputs_;
  std::deque<std::vector<std::uint8_t>> inputs_;
  std::deque<input_event> events_;
  std::array<input_absinfo, 2> axes_{};
  std::map<int, Effect> effects_;
  std::unique_ptr<MockNode> hidraw_, event_;
};

}  // namespace wale::test
