#include "runtime/device/hid_pid/pid_transport.hpp"

#include <libusb.h>
#include <pthread.h>
#include <sched.h>
#include <time.h>

#include <algorithm>
#include <bit>
#include <chrono>

namespace wale {
namespace {

constexpr int inputs_under_way = 4, controls = 2;
constexpr std::size_t most_control_bytes = hid::most_descriptor_bytes;
constexpr int seen_bits = 28;

}  // namespace

std::variant<std::unique_ptr<PidTransport>, Refusal> PidTransport::open(std::shared_ptr<UsbContext> context,
                                                                        const UsbDeviceInfo& info,
                                                                        const UsbHidInterface& interface,
                                                                        const Options& options) {
  const auto refused = [&](const std::string& reason) {
    return Refusal{in_words(info.vendor, info.product) + ": " + reason, {}};
  };
  libusb_device* device = context->find(info);
  if (device == nullptr) return refused(why_not_usable(LIBUSB_ERROR_NO_DEVICE, info).reason);
  libusb_device_handle* handle = nullptr;
  int error = libusb_open(device, &handle);
  libusb_unref_device(device);
  if (error != 0) return refused(why_not_usable(error, info).reason);
  libusb_set_auto_detach_kernel_driver(handle, 1);  // a system without such drivers has none in the way
  error = libusb_claim_interface(handle, interface.number);
  if (error != 0) {
    libusb_close(handle);
    return refused(why_not_usable(error, info).reason);
  }
  std::unique_ptr<PidTransport> transport(new PidTransport(std::move(context), handle, interface, options));
  if (transport->wait_until_running()) return transport;
  const std::string reason = transport->reason();
  return refused(reason.empty() ? "it tells no position" : reason);
}

PidTransport::PidTransport(std::shared_ptr<UsbContext> context, libusb_device_handle* handle,
                           const UsbHidInterface& interface, const Options& options)
    : context_(std::move(context)),
      handle_(handle),
      interface_(interface),
      timeout_(options.timeout),
      set_up_timeout_(options.set_up_timeout),
      now_(options.now),
      session_(hid::HidInterface{interface.number, interface.report_descriptor_bytes, interface.out_endpoint != 0},
               options.session) {
  const auto add = [&](bool is_input, std::size_t bytes) {
    auto slot = std::make_unique<Slot>();
    slot->owner = this;
    slot->usb = libusb_alloc_transfer(0);
    slot->buffer.resize(bytes);
    slot->is_input = is_input;
    slots_.push_back(std::move(slot));
  };
  // Whole packets, so that no report runs over; one that fills its packets ends there too.
  const std::size_t packet = std::max<std::size_t>(1, interface.in_bytes);
  const std::size_t input_bytes = (hid::most_packet_bytes + packet - 1) / packet * packet;
  for (int i = 0; i < inputs_under_way && interface.in_endpoint != 0; ++i) add(true, input_bytes);
  for (int i = 0; i < controls + std::max(1, options.session.most_in_flight); ++i) {
    add(false, LIBUSB_CONTROL_SETUP_SIZE + most_control_bytes);
  }
  sem_init(&commanded_, 0, 0);
  writer_ = std::thread([this] { write_forces(); });
  if (options.priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = options.priority;
    pthread_setschedparam(writer_.native_handle(), SCHED_FIFO, &parameters);
  }
  const std::lock_guard lock(mutex_);
  pump();
}

PidTransport::~PidTransport() {
  ends_.store(true, std::memory_order_release);
  sem_post(&commanded_);
  writer_.join();
  {
    std::unique_lock lock(mutex_);
    session_.stop();
    pump();
    // Each of its last transfers ends, if only by its timeout.
    changed_.wait(lock, [&] { return session_.state() == hid::PidSession::State::over; });
    closes_ = true;
    for (const auto& slot : slots_) {
      if (slot->is_busy) libusb_cancel_transfer(slot->usb);
    }
    changed_.wait(lock, [&] { return is_idle(); });
  }
  libusb_release_interface(handle_, interface_.number);
  libusb_close(handle_);
  for (const auto& slot : slots_) libusb_free_transfer(slot->usb);
  sem_destroy(&commanded_);
}

/// Until the device runs and has told where it is, or is lost.
bool PidTransport::wait_until_running() {
  using State = hid::PidSession::State;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return session_.state() == State::running || session_.state() == State::over; });
  // One that only tells changes is asked after a while (`input_silence`).
  changed_.wait_for(lock, std::chrono::seconds(1),
                    [&] { return session_.state() != State::running || session_.input().has_value(); });
  return session_.state() == State::running && session_.input().has_value();
}

void PidTransport::command(glm::vec2 force) noexcept {
  const std::uint64_t x = std::bit_cast<std::uint32_t>(force.x), y = std::bit_cast<std::uint32_t>(force.y);
  wanted_.store(x << 32 | y, std::memory_order_release);
  sem_post(&commanded_);
}

PidTransport::Seen PidTransport::seen() const noexcept {
  const std::uint64_t packed = seen_.load(std::memory_order_acquire);
  const auto number = [](std::uint64_t bits) {
    const std::int64_t sign = std::int64_t{1} << (seen_bits - 1);
    return static_cast<std::int32_t>((static_cast<std::int64_t>(bits & ((1u << seen_bits) - 1)) ^ sign) - sign);
  };
  return {number(packed >> seen_bits), number(packed), (packed >> (2 * seen_bits) & 1) != 0};
}

/// Packs the session's input for `seen`, and says when the device is lost.
void PidTransport::publish() {
  if (const auto& input = session_.input()) {
    const auto bits = [](std::int64_t value) {
      const std::int64_t most = (std::int64_t{1} << (seen_bits - 1)) - 1;
      return static_cast<std::uint64_t>(std::clamp(value, -most, most)) & ((1u << seen_bits) - 1);
    };
    seen_.store(std::uint64_t{input->button} << (2 * seen_bits) | bits(input->x) << seen_bits | bits(input->y),
                std::memory_order_release);
  }
  if (session_.was_lost()) lost_.store(true, std::memory_order_release);
  changed_.notify_all();
}

/// The writer's thread.
void PidTransport::write_forces() {
  while (true) {
    timespec until{};
    clock_gettime(CLOCK_MONOTONIC, &until);
    constexpr long patience = 20'000'000, second = 1'000'000'000;  // ns; refreshes and silences are due then
    until.tv_nsec += patience;
    if (until.tv_nsec >= second) until.tv_nsec -= second, ++until.tv_sec;
    const bool is_commanded = sem_clockwait(&commanded_, CLOCK_MONOTONIC, &until) == 0;
    while (is_commanded && sem_trywait(&commanded_) == 0) {  // several commands: only the newest counts
    }
    if (ends_.load(std::memory_order_acquire)) return;
    const std::lock_guard lock(mutex_);
    if (is_commanded) {
      const std::uint64_t wanted = wanted_.load(std::memory_order_acquire);
      session_.command({std::bit_cast<float>(static_cast<std::uint32_t>(wanted >> 32)),
                        std::bit_cast<float>(static_cast<std::uint32_t>(wanted))},
                       now_());
    }
    pump();
  }
}

/// Submits what the session wants. Under the lock.
void PidTransport::pump() {
  while (const auto transfer = session_.next(now_())) submit(*transfer);
  if (!listens_ && session_.state() == hid::PidSession::State::running) listen();
  publish();
}

void PidTransport::submit(const hid::Transfer& transfer) {
  const auto free =
      std::find_if(slots_.begin(), slots_.end(), [](const auto& slot) { return !slot->is_input && !slot->is_busy; });
  if (free == slots_.end()) return session_.finish(transfer, hid::Outcome::failed, {}, now_());
  Slot& slot = **free;
  slot.wanted = transfer;
  const auto when_ended = [](libusb_transfer* usb) {
    auto& ended = *static_cast<Slot*>(usb->user_data);
    ended.owner->ended(ended);
  };
  const unsigned timeout = session_.state() == hid::PidSession::State::setting_up ? set_up_timeout_ : timeout_;
  const auto data = transfer.data.view();
  if (transfer.kind == hid::Transfer::Kind::interrupt_out) {
    std::copy(data.begin(), data.end(), slot.buffer.begin());
    libusb_fill_interrupt_transfer(slot.usb, handle_, interface_.out_endpoint, slot.buffer.data(),
                                   static_cast<int>(data.size()), when_ended, &slot, timeout);
  } else {
    const auto length = std::min<std::size_t>(transfer.length, most_control_bytes);
    libusb_fill_control_setup(slot.buffer.data(), transfer.request_type, transfer.request, transfer.value,
                              transfer.index, static_cast<std::uint16_t>(length));
    std::copy(data.begin(), data.end(), slot.buffer.begin() + LIBUSB_CONTROL_SETUP_SIZE);
    libusb_fill_control_transfer(slot.usb, handle_, slot.buffer.data(), when_ended, &slot, timeout);
  }
  slot.is_busy = true;
  if (const int error = libusb_submit_transfer(slot.usb); error != 0) {
    slot.is_busy = false;
    session_.finish(transfer, outcome_of_submitting(error), {}, now_());
  }
}

void PidTransport::listen() {
  listens_ = true;
  for (const auto& slot : slots_) {
    if (slot->is_input) submit_input(*slot);
  }
}

void PidTransport::submit_input(Slot& slot) {
  const auto when_ended = [](libusb_transfer* usb) {
    auto& ended = *static_cast<Slot*>(usb->user_data);
    ended.owner->ended(ended);
  };
  libusb_fill_interrupt_transfer(slot.usb, handle_, interface_.in_endpoint, slot.buffer.data(),
                                 static_cast<int>(slot.buffer.size()), when_ended, &slot, 0);
  slot.is_busy = true;
  if (const int error = libusb_submit_transfer(slot.usb); error != 0) {
    slot.is_busy = false;
    const bool is_gone = error == LIBUSB_ERROR_NO_DEVICE;
    session_.lose(is_gone ? "it was unplugged" : "its position cannot be read", outcome_of_submitting(error));
  }
}

/// A transfer has ended. On the event thread.
void PidTransport::ended(Slot& slot) {
  const std::lock_guard lock(mutex_);
  const libusb_transfer& usb = *slot.usb;
  slot.is_busy = false;
  const std::int64_t now = now_();
  const auto got = static_cast<std::size_t>(std::max(0, usb.actual_length));
  hid::Outcome outcome = outcome_of(usb.status);
  if (slot.is_input) {
    if (!closes_ && session_.state() != hid::PidSession::State::over) {
      if (usb.status == LIBUSB_TRANSFER_COMPLETED) {
        session_.receive({slot.buffer.data(), got}, now);
      } else if (usb.status == LIBUSB_TRANSFER_OVERFLOW) {
        session_.receive({}, now);  // counts as nonsense
      } else {
        session_.lose(outcome == hid::Outcome::gone ? "it was unplugged" : "its position cannot be read", outcome);
      }
      if (session_.state() == hid::PidSession::State::running) submit_input(slot);
    }
  } else {
    std::span<const std::uint8_t> answer;
    if (slot.wanted.kind == hid::Transfer::Kind::control_in) {
      answer = std::span(slot.buffer).subspan(LIBUSB_CONTROL_SETUP_SIZE, got);
    } else if (outcome == hid::Outcome::done && got < slot.wanted.length) {
      outcome = hid::Outcome::failed;
    }
    session_.finish(slot.wanted, outcome, answer, now);
  }
  if (!closes_) pump();
  publish();
}

bool PidTransport::is_idle() const {
  return std::none_of(slots_.begin(), slots_.end(), [](const auto& slot) { return slot->is_busy; });
}

std::string PidTransport::reason() const {
  const std::lock_guard lock(mutex_);
  return std::string(session_.reason());
}

hid::PidSessionCounts PidTransport::counts() const {
  const std::lock_guard lock(mutex_);
  return session_.counts();
}

std::optional<hid::Telemetry> PidTransport::telemetry() const {
  const std::lock_guard lock(mutex_);
  return session_.telemetry();
}

}  // namespace wale
