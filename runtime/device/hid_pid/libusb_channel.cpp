#include "runtime/device/hid_pid/libusb_channel.hpp"

#include <libusb.h>

#include <algorithm>
#include <utility>

#include "runtime/device/usb/kernel_nodes.hpp"

namespace wale {
namespace {

constexpr int inputs_under_way = 4, controls = 2;
constexpr std::size_t most_control_bytes = hid::most_descriptor_bytes;

}  // namespace

Result<LibusbInterface> LibusbInterface::claim(std::shared_ptr<UsbContext> context, const UsbDeviceInfo& info,
                                               const UsbHidInterface& interface) {
  libusb_device* device = context->find(info);
  if (device == nullptr) return why_not_usable(LIBUSB_ERROR_NO_DEVICE, info);
  libusb_device_handle* handle = nullptr;
  const int error = libusb_open(device, &handle);
  libusb_unref_device(device);
  if (error != 0) return why_not_usable(error, info);
  return claim(std::move(context), {}, handle, info, interface);
}

Result<LibusbInterface> LibusbInterface::claim(std::shared_ptr<UsbContext> context, int descriptor,
                                               const UsbDeviceInfo& info, const UsbHidInterface& interface) {
  OwnedDescriptor own = OwnedDescriptor::copy_of(descriptor);
  libusb_device_handle* handle = nullptr;
  const int error = libusb_wrap_sys_device(context->handle(), own.get(), &handle);
  if (error != 0) return why_not_usable(error, info);
  return claim(std::move(context), std::move(own), handle, info, interface);
}

Result<LibusbInterface> LibusbInterface::claim(std::shared_ptr<UsbContext> context, OwnedDescriptor descriptor,
                                               libusb_device_handle* handle, const UsbDeviceInfo& info,
                                               const UsbHidInterface& interface) {
  libusb_set_auto_detach_kernel_driver(handle, 1);  // may fail: a system without this feature has no such drivers
  if (const int error = libusb_claim_interface(handle, interface.number); error != 0) {
    libusb_close(handle);
    return why_not_usable(error, info);
  }
  return LibusbInterface(std::move(context), std::move(descriptor), handle, interface);
}

LibusbInterface::LibusbInterface(std::shared_ptr<UsbContext> context, OwnedDescriptor descriptor,
                                 libusb_device_handle* handle, const UsbHidInterface& interface)
    : context_(std::move(context)), descriptor_(std::move(descriptor)), handle_(handle), interface_(interface) {}

LibusbInterface::LibusbInterface(LibusbInterface&& other) noexcept
    : context_(std::move(other.context_)),
      descriptor_(std::move(other.descriptor_)),
      handle_(std::exchange(other.handle_, nullptr)),
      interface_(other.interface_) {}

LibusbInterface::~LibusbInterface() {
  if (handle_ == nullptr) return;
  libusb_release_interface(handle_, interface_.number);
  libusb_close(handle_);
}

LibusbChannel::LibusbChannel(LibusbInterface interface, const PidTransportOptions& options, Listener& listener)
    : interface_(std::move(interface)),
      listener_(listener),
      timeout_(options.timeout),
      set_up_timeout_(options.set_up_timeout),
      most_outputs_(std::max(1, options.session.most_in_flight)) {
  const UsbHidInterface& described = interface_.description();
  // The buffer holds whole packets, so that no report overflows it; a report that fills its packets ends there too.
  const std::size_t packet = std::max<std::size_t>(1, described.in_bytes);
  const std::size_t input_bytes = (hid::most_packet_bytes + packet - 1) / packet * packet;
  for (int i = 0; i < inputs_under_way && described.in_endpoint != 0; ++i) add_slot(true, input_bytes);
  // One more slot than transfers under way: the listener submits the next one while a slot still holds the last answer.
  for (int i = 0; i < controls + most_outputs_ + 1; ++i) {
    add_slot(false, LIBUSB_CONTROL_SETUP_SIZE + most_control_bytes);
  }
}

LibusbChannel::~LibusbChannel() {
  close();
  for (const auto& slot : slots_) libusb_free_transfer(slot->usb);
}

void LibusbChannel::add_slot(bool is_input, std::size_t bytes) {
  auto slot = std::make_unique<Slot>();
  slot->owner = this;
  slot->usb = libusb_alloc_transfer(0);
  slot->buffer.resize(bytes);
  slot->is_input = is_input;
  slots_.push_back(std::move(slot));
}

hid::HidInterface LibusbChannel::interface() const noexcept {
  const UsbHidInterface& described = interface_.description();
  return {described.number, described.report_descriptor_bytes, described.out_endpoint != 0};
}

LetGoPlan LibusbChannel::let_go_plan(const hid::PidSession::Leaving& leaving) const {
  const UsbHidInterface& described = interface_.description();
  LetGoPlan plan;
  plan.node = LetGoPlan::Node::usbfs;
  plan.interface = described.number;
  libusb_device* const device = libusb_get_device(interface_.handle());
  plan.set_path(usbfs_node(libusb_get_bus_number(device), libusb_get_device_address(device)));
  for (std::size_t i = 0; i < leaving.size; ++i) {
    const auto data = leaving.packets[i].view();
    // SET_REPORT of an output report (HID 1.11, section 7.2.2), where the endpoint takes none.
    plan.add({.way = LetGoStep::Way::packet,
              .endpoint = described.out_endpoint,
              .request_type = 0x21,
              .request = 9,
              .value = static_cast<std::uint16_t>(0x0200 | (leaving.have_ids ? data.front() : 0)),
              .index = described.number,
              .is_farewell = i >= leaving.farewell},
             data);
  }
  return plan;
}

Outcome LibusbChannel::submit(const hid::Transfer& transfer, bool is_setting_up) noexcept {
  const std::lock_guard lock(mutex_);
  const auto free =
      std::find_if(slots_.begin(), slots_.end(), [](const auto& slot) { return !slot->is_input && !slot->is_busy; });
  if (free == slots_.end()) return Outcome::failed;
  Slot& slot = **free;
  slot.wanted = transfer;
  const auto when_ended = [](libusb_transfer* usb) {
    auto& ended = *static_cast<Slot*>(usb->user_data);
    ended.owner->transfer_ended(ended);
  };
  const unsigned timeout = is_setting_up ? set_up_timeout_ : timeout_;
  const auto data = transfer.data.view();
  if (transfer.kind == hid::Transfer::Kind::interrupt_out) {
    std::copy(data.begin(), data.end(), slot.buffer.begin());
    libusb_fill_interrupt_transfer(slot.usb, interface_.handle(), interface_.description().out_endpoint,
                                   slot.buffer.data(), static_cast<int>(data.size()), when_ended, &slot, timeout);
  } else {
    const auto length = std::min<std::size_t>(transfer.length, most_control_bytes);
    libusb_fill_control_setup(slot.buffer.data(), transfer.request_type, transfer.request, transfer.value,
                              transfer.index, static_cast<std::uint16_t>(length));
    std::copy(data.begin(), data.end(), slot.buffer.begin() + LIBUSB_CONTROL_SETUP_SIZE);
    libusb_fill_control_transfer(slot.usb, interface_.handle(), slot.buffer.data(), when_ended, &slot, timeout);
  }
  const int error = libusb_submit_transfer(slot.usb);
  slot.is_busy = error == 0;
  return error == 0 ? Outcome::done : outcome_of_submitting(error);
}

Outcome LibusbChannel::listen() noexcept {
  const std::lock_guard lock(mutex_);
  for (const auto& slot : slots_) {
    if (!slot->is_input) continue;
    if (const Outcome outcome = submit_input(*slot); outcome != Outcome::done) return outcome;
  }
  return Outcome::done;
}

/// Under the lock.
Outcome LibusbChannel::submit_input(Slot& slot) {
  const auto when_ended = [](libusb_transfer* usb) {
    auto& ended = *static_cast<Slot*>(usb->user_data);
    ended.owner->input_ended(ended);
  };
  libusb_fill_interrupt_transfer(slot.usb, interface_.handle(), interface_.description().in_endpoint,
                                 slot.buffer.data(), static_cast<int>(slot.buffer.size()), when_ended, &slot, 0);
  const int error = libusb_submit_transfer(slot.usb);
  slot.is_busy = error == 0;
  return error == 0 ? Outcome::done : outcome_of_submitting(error);
}

/// On the event thread, as `transfer_ended`.
void LibusbChannel::input_ended(Slot& slot) {
  const libusb_transfer& usb = *slot.usb;
  const Outcome outcome = outcome_of(usb.status);
  const auto why = [](Outcome failure) {
    return failure == Outcome::gone ? "it was unplugged" : "its position cannot be read";
  };
  bool goes_on = true;
  if (outcome == Outcome::done) {
    listener_.received({slot.buffer.data(), static_cast<std::size_t>(std::max(0, usb.actual_length))}, false);
  } else if (usb.status == LIBUSB_TRANSFER_OVERFLOW) {
    listener_.received({}, false);
  } else {
    goes_on = false;
    if (usb.status != LIBUSB_TRANSFER_CANCELLED) listener_.silenced(why(outcome), outcome);
  }
  if (goes_on) {
    Outcome again = Outcome::done;
    {
      const std::lock_guard lock(mutex_);
      if (!closes_) {
        again = submit_input(slot);
        if (again == Outcome::done) return;
        slot.is_busy = true;  // until the listener has been told
      }
    }
    if (again != Outcome::done) listener_.silenced(why(again), again);
  }
  release(slot);
}

void LibusbChannel::transfer_ended(Slot& slot) {
  const auto got = static_cast<std::size_t>(std::max(0, slot.usb->actual_length));
  Outcome outcome = outcome_of(slot.usb->status);
  std::span<const std::uint8_t> answer;
  if (slot.wanted.kind == hid::Transfer::Kind::control_in) {
    answer = std::span(slot.buffer).subspan(LIBUSB_CONTROL_SETUP_SIZE, got);
  } else if (outcome == Outcome::done && got < slot.wanted.length) {
    outcome = Outcome::failed;
  }
  listener_.ended(slot.wanted, outcome, answer);
  release(slot);
}

void LibusbChannel::release(Slot& slot) {
  const std::lock_guard lock(mutex_);
  slot.is_busy = false;
  released_.notify_all();
}

void LibusbChannel::close() {
  std::unique_lock lock(mutex_);
  closes_ = true;
  for (const auto& slot : slots_) {
    if (slot->is_busy) libusb_cancel_transfer(slot->usb);
  }
  released_.wait(lock, [&] { return is_idle(); });
}

/// Under the lock.
bool LibusbChannel::is_idle() const {
  return std::none_of(slots_.begin(), slots_.end(), [](const auto& slot) { return slot->is_busy; });
}

}  // namespace wale
