#include "runtime/device/falcon/falcon_transport.hpp"

#include <libusb.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "runtime/device/usb/kernel_nodes.hpp"
#include "runtime/device/usb/usb_transfers.hpp"

namespace wale {
namespace {

constexpr std::uint8_t vendor_out = 0x40;
constexpr int lane_bits = 16;

std::uint64_t lane(std::int16_t number, int index) noexcept {
  return std::uint64_t{static_cast<std::uint16_t>(number)} << (lane_bits * index);
}
std::int16_t number_in(std::uint64_t lanes, int index) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(lanes >> (lane_bits * index)));
}

}  // namespace

Result<std::unique_ptr<FalconTransport>> FalconTransport::open(std::shared_ptr<UsbContext> context,
                                                               const UsbDeviceInfo& info, Options options) {
  const auto refused = [&](int error) {
    Error why = why_not_usable(error, info);
    why.sentence = in_words(info.vendor, info.product) + ": " + why.sentence;
    return why;
  };
  libusb_device* device = context->find(info);
  if (device == nullptr) return refused(LIBUSB_ERROR_NO_DEVICE);
  libusb_device_handle* handle = nullptr;
  int error = libusb_open(device, &handle);
  libusb_unref_device(device);
  if (error != 0) return refused(error);
  libusb_set_auto_detach_kernel_driver(handle, 1);  // the one for serial lines
  error = libusb_claim_interface(handle, falcon::first_interface);
  if (error != 0) {
    libusb_close(handle);
    return refused(error);
  }
  const std::optional<KeeperOptions> keeper = options.keeper;
  std::unique_ptr<FalconTransport> transport(new FalconTransport(std::move(context), handle, std::move(options)));
  transport->wait_until_set_up();
  if (transport->was_lost()) return transport;
  if (Result<> kept = transport->get_keeper(keeper); !kept) return std::move(kept).error();
  return transport;
}

FalconTransport::FalconTransport(std::shared_ptr<UsbContext> context, libusb_device_handle* handle, Options options)
    : context_(std::move(context)),
      handle_(handle),
      timeout_(options.timeout),
      set_up_timeout_(options.set_up_timeout),
      now_(options.now),
      session_(std::move(options.session)) {
  for (Slot& slot : slots_) {
    slot.owner = this;
    slot.usb = libusb_alloc_transfer(0);
  }
  const std::lock_guard lock(mutex_);
  pump();
}

FalconTransport::~FalconTransport() {
  {
    std::unique_lock lock(mutex_);
    session_.stop();
    pump();
    // Each of the last transfers ends, at the latest after its timeout.
    changed_.wait(lock, [&] { return session_.state() == falcon::FalconSession::State::over; });
    closes_ = true;
    for (const Slot& slot : slots_) {
      if (slot.is_busy) libusb_cancel_transfer(slot.usb);
    }
    changed_.wait(lock, [&] { return is_idle(); });
  }
  keeper_.reset();  // now that nothing is sent any more
  libusb_release_interface(handle_, falcon::first_interface);
  libusb_close(handle_);
  for (const Slot& slot : slots_) libusb_free_transfer(slot.usb);
}

/// While the device pushes nothing yet. The keeper sends two packets without torque, in case that the first one meets
/// half of another.
Result<> FalconTransport::get_keeper(const std::optional<KeeperOptions>& options) {
  if (!options) return {};
  LetGoPlan plan;
  plan.node = LetGoPlan::Node::usbfs;
  plan.interface = falcon::first_interface;
  libusb_device* const device = libusb_get_device(handle_);
  plan.set_path(usbfs_node(libusb_get_bus_number(device), libusb_get_device_address(device)));
  const falcon::Packet none = falcon::encode({.keeps_homing = false});
  for (int i = 0; i < 2; ++i) {
    plan.add({.way = LetGoStep::Way::packet, .endpoint = falcon::out_endpoint}, none);
  }
  auto keeper = Keeper::start(plan, -1, *options);
  if (!keeper) return std::move(keeper).error();
  const std::lock_guard lock(mutex_);
  keeper_ = *std::move(keeper);
  return {};
}

/// Before packets are made. Under the lock.
void FalconTransport::heed_keeper() {
  if (!keeper_) return;
  const Keeper::Verdict verdict = keeper_->look();
  switch (verdict) {
    case Keeper::Verdict::good: break;
    case Keeper::Verdict::late: session_.hush(); break;
    case Keeper::Verdict::stalled:
    case Keeper::Verdict::slept:
    case Keeper::Verdict::gone: session_.lose(keeper_->why(verdict), Outcome::failed); break;
    case Keeper::Verdict::latched: session_.give_up(keeper_->why(verdict)); break;
  }
}

/// The last look before a packet goes.
bool FalconTransport::may_go(bool pushes) const noexcept {
  if (!keeper_) return true;
  if (pushes) keeper_->note_push();
  const Keeper::Verdict verdict = keeper_->look();
  return verdict == Keeper::Verdict::good || (verdict != Keeper::Verdict::latched && !pushes);
}

void FalconTransport::wait_until_set_up() {
  using State = falcon::FalconSession::State;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return session_.state() != State::setting_up && session_.state() != State::leaving; });
}

bool FalconTransport::wait_until_homed(double seconds) {
  using State = falcon::FalconSession::State;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return session_.state() != State::homing; });
  return session_.state() == State::running;
}

void FalconTransport::command(const falcon::Torques& torques) noexcept {
  if (keeper_) keeper_->beat();  // first: a torque that is sent is then watched over
  // Only one thread commands, so nobody else changes the number.
  const auto number =
      static_cast<std::uint16_t>(static_cast<std::uint16_t>(number_in(wanted_.load(std::memory_order_relaxed), 3)) + 1);
  wanted_.store(
      lane(torques[0], 0) | lane(torques[1], 1) | lane(torques[2], 2) | lane(static_cast<std::int16_t>(number), 3),
      std::memory_order_release);
}

FalconTransport::Seen FalconTransport::seen() const noexcept {
  const std::int64_t heard = heard_.load(std::memory_order_acquire);
  const std::uint64_t packed = seen_.load(std::memory_order_acquire);
  return {{number_in(packed, 0), number_in(packed, 1), number_in(packed, 2)},
          static_cast<std::uint8_t>(packed >> 48 & 15),
          (packed >> 52 & 1) != 0,
          heard};
}

/// Packs the session's answer for `seen`, and notes when the device is lost.
void FalconTransport::publish() {
  if (const auto& answer = session_.answer()) {
    const bool is_running = session_.state() == falcon::FalconSession::State::running;
    seen_.store(lane(answer->encoders[0], 0) | lane(answer->encoders[1], 1) | lane(answer->encoders[2], 2) |
                    std::uint64_t{answer->buttons} << 48 | std::uint64_t{is_running} << 52,
                std::memory_order_release);
    heard_.store(session_.heard(), std::memory_order_release);
  }
  if (session_.was_lost()) lost_.store(true, std::memory_order_release);
  changed_.notify_all();
}

/// Submits the transfers that the session asks for. Under the lock.
void FalconTransport::pump() {
  const std::uint64_t wanted = wanted_.load(std::memory_order_acquire);
  if (const auto number = static_cast<std::uint16_t>(number_in(wanted, 3)); number != taken_) {
    taken_ = number;
    session_.command({number_in(wanted, 0), number_in(wanted, 1), number_in(wanted, 2)}, now_());
  }
  heed_keeper();
  while (const auto transfer = session_.next(now_())) {
    if (may_go(transfer->kind == falcon::Transfer::Kind::write && session_.holds_force())) {
      submit(*transfer);
    } else {
      session_.finish(*transfer, Outcome::failed, {}, now_());
    }
  }
  if (keeper_ && session_.is_slack()) keeper_->note_slack();
  publish();
}

void FalconTransport::submit(const falcon::Transfer& transfer) {
  using Kind = falcon::Transfer::Kind;
  Slot& slot = slots_[static_cast<std::size_t>(transfer.kind)];
  slot.wanted = transfer;
  const auto when_ended = [](libusb_transfer* usb) {
    auto& ended = *static_cast<Slot*>(usb->user_data);
    ended.owner->ended(ended);
  };
  const auto bytes = transfer.view();
  switch (transfer.kind) {
    case Kind::control:
      libusb_fill_control_setup(slot.buffer.data(), vendor_out, transfer.request, transfer.value, 0, 0);
      libusb_fill_control_transfer(slot.usb, handle_, slot.buffer.data(), when_ended, &slot, set_up_timeout_);
      break;
    case Kind::write:
      std::copy(bytes.begin(), bytes.end(), slot.buffer.begin());
      libusb_fill_bulk_transfer(slot.usb, handle_, falcon::out_endpoint, slot.buffer.data(),
                                static_cast<int>(bytes.size()), when_ended, &slot, timeout_);
      break;
    case Kind::read:
      libusb_fill_bulk_transfer(slot.usb, handle_, falcon::in_endpoint, slot.buffer.data(), falcon::most_usb_bytes,
                                when_ended, &slot, timeout_);
      break;
  }
  slot.is_busy = true;
  if (const int error = libusb_submit_transfer(slot.usb); error != 0) {
    slot.is_busy = false;
    session_.finish(transfer, outcome_of_submitting(error), {}, now_());
  }
}

/// A transfer has ended. On the event thread.
void FalconTransport::ended(Slot& slot) {
  const std::lock_guard lock(mutex_);
  slot.is_busy = false;
  const auto got = static_cast<std::size_t>(std::max(0, slot.usb->actual_length));
  Outcome outcome = outcome_of(slot.usb->status);
  std::span<const std::uint8_t> came_in;
  if (slot.wanted.kind == falcon::Transfer::Kind::read) {
    came_in = std::span(slot.buffer).first(std::min(got, slot.buffer.size()));
  } else if (outcome == Outcome::done && got < slot.wanted.size) {
    outcome = Outcome::failed;
  }
  session_.finish(slot.wanted, outcome, came_in, now_());
  if (!closes_) pump();
  publish();
}

bool FalconTransport::is_idle() const {
  return std::none_of(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.is_busy; });
}

std::string FalconTransport::reason() const {
  const std::lock_guard lock(mutex_);
  return std::string(session_.reason());
}

bool FalconTransport::wants_firmware() const {
  const std::lock_guard lock(mutex_);
  return session_.wants_firmware();
}

falcon::FalconSessionCounts FalconTransport::counts() const {
  const std::lock_guard lock(mutex_);
  return session_.counts();
}

}  // namespace wale
