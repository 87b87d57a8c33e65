#include "runtime/keeper/process/device_node.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace wale::keeper {
namespace {

/// ms, for each packet. A full-speed device takes one within 2 ms; one that takes none cannot be told anything.
constexpr unsigned timeout = 50;

}  // namespace

DeviceNode::DeviceNode(const LetGoPlan& plan, int handed) : plan_(plan), node_(-1) {
  // An evdev effect belongs to the open file that made it, so that one is used.
  if (plan.path[0] != 0 && plan.node != LetGoPlan::Node::evdev) node_ = open(plan.path.data(), O_RDWR | O_CLOEXEC);
  if (node_ < 0) {
    node_ = handed;
  } else if (handed >= 0) {
    close(handed);  // or the device would stay open for as long as this process lives
  }
}

void DeviceNode::let_go() {
  if (plan_.node == LetGoPlan::Node::usbfs) claim();
  for (std::uint8_t i = 0; i < plan_.count; ++i) {
    if (!plan_.steps[i].is_farewell) make(plan_.steps[i]);
  }
}

void DeviceNode::say_farewell() {
  for (std::uint8_t i = 0; i < plan_.count; ++i) {
    if (plan_.steps[i].is_farewell) make(plan_.steps[i]);
  }
  if (plan_.node != LetGoPlan::Node::usbfs) return;
  unsigned interface = plan_.interface;
  ioctl(node_, USBDEVFS_RELEASEINTERFACE, &interface);
  usbdevfs_ioctl connect{plan_.interface, USBDEVFS_CONNECT, nullptr};
  ioctl(node_, USBDEVFS_IOCTL, &connect);
}

/// Without flags, this takes the interface from another user of usbfs too, and ends what that has under way. Whoever
/// has lost it cannot submit anything more. It is repeated without harm.
void DeviceNode::claim() const {
  usbdevfs_disconnect_claim wanted{};
  wanted.interface = plan_.interface;
  ioctl(node_, USBDEVFS_DISCONNECT_CLAIM, &wanted);
}

void DeviceNode::make(const LetGoStep& step) const {
  switch (step.way) {
    case LetGoStep::Way::report: {
      [[maybe_unused]] const ssize_t written = write(node_, step.bytes.data(), step.size);
      return;
    }
    case LetGoStep::Way::packet:
      if (!send_packet(step)) send_control(step);
      return;
    case LetGoStep::Way::control: return send_control(step);
    case LetGoStep::Way::stop: {
      input_event event{};
      event.type = EV_FF;
      event.code = static_cast<std::uint16_t>(step.effect);
      [[maybe_unused]] const ssize_t written = write(node_, &event, sizeof event);
      return;
    }
    case LetGoStep::Way::erase: ioctl(node_, EVIOCRMFF, static_cast<long>(step.effect)); return;
  }
}

bool DeviceNode::send_packet(const LetGoStep& step) const {
  if (step.endpoint == 0) return false;
  usbdevfs_bulktransfer transfer{};  // of interrupt endpoints too
  transfer.ep = step.endpoint;
  transfer.len = step.size;
  transfer.timeout = timeout;
  transfer.data = const_cast<std::uint8_t*>(step.bytes.data());
  return ioctl(node_, USBDEVFS_BULK, &transfer) >= 0;
}

void DeviceNode::send_control(const LetGoStep& step) const {
  if (step.request_type == 0) return;
  usbdevfs_ctrltransfer transfer{};
  transfer.bRequestType = step.request_type;
  transfer.bRequest = step.request;
  transfer.wValue = step.value;
  transfer.wIndex = step.index;
  transfer.wLength = step.size;
  transfer.timeout = timeout;
  transfer.data = const_cast<std::uint8_t*>(step.bytes.data());
  ioctl(node_, USBDEVFS_CONTROL, &transfer);
}

}  // namespace wale::keeper
