#include "runtime/device/hid_pid/hidraw_channel.hpp"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "runtime/device/hid_pid/report_descriptor.hpp"
#include "runtime/device/usb/system_error.hpp"

namespace wale {
namespace {

/// More than any report of the PID class, and within the 14 bits that an ioctl has for a size.
constexpr std::size_t most_report_bytes = 4096;

constexpr std::uint8_t output_report = 2, feature_report = 3;

Outcome outcome_of_errno(int error) noexcept {
  switch (error) {
    case EPIPE: return Outcome::stalled;
    case ETIMEDOUT: return Outcome::timed_out;
    case ENODEV:
    case ESHUTDOWN:
    case ENXIO: return Outcome::gone;
    default: return Outcome::failed;
  }
}

}  // namespace

HidrawNode::HidrawNode(OwnedDescriptor descriptor, IoctlCall ioctl)
    : descriptor_(std::move(descriptor)), ioctl_(ioctl) {}

Result<HidrawNode> HidrawNode::open(const std::string& path, IoctlCall ioctl) {
  HidrawNode node(OwnedDescriptor(::open(path.c_str(), O_RDWR | O_CLOEXEC)), ioctl);
  if (!node.descriptor_) return why_not_opened(errno, path);
  if (Result<> learned = node.learn(path); !learned) return std::move(learned).error();
  return node;
}

Result<HidrawNode> HidrawNode::of(int descriptor, IoctlCall ioctl) {
  HidrawNode node(OwnedDescriptor::copy_of(descriptor), ioctl);
  const std::string name = "descriptor " + std::to_string(descriptor);
  if (!node.descriptor_) return why_not_opened(errno, name);
  if (Result<> learned = node.learn(name); !learned) return std::move(learned).error();
  return node;
}

Result<> HidrawNode::learn(const std::string& name) {
  int size = 0;
  hidraw_report_descriptor known{};
  if (call(HIDIOCGRDESCSIZE, &size) < 0) return why_not_opened(errno, name);
  known.size = static_cast<std::uint32_t>(std::clamp(size, 0, HID_MAX_DESCRIPTOR_SIZE));
  if (call(HIDIOCGRDESC, &known) < 0) return why_not_opened(errno, name);
  report_descriptor_.assign(known.value, known.value + known.size);
  const auto parsed = hid::parse_report_descriptor(report_descriptor_);
  if (parsed) has_ids_ = std::ranges::any_of(parsed->reports, [](const auto& report) { return report.id != 0; });
  return {};
}

HidrawChannel::HidrawChannel(HidrawNode node, const PidTransportOptions& options, Listener& listener)
    : node_(std::move(node)),
      listener_(listener),
      ends_reading_(eventfd(0, EFD_CLOEXEC)),
      buffer_(most_report_bytes + 1) {
  writer_ = std::thread([this] { make_transfers(); });
  if (options.priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = options.priority;
    pthread_setschedparam(writer_.native_handle(), SCHED_FIFO, &parameters);
  }
}

HidrawChannel::~HidrawChannel() { close(); }

hid::HidInterface HidrawChannel::interface() const noexcept {
  return {0, static_cast<std::uint16_t>(node_.report_descriptor().size()), true};
}

LetGoPlan HidrawChannel::let_go_plan(const hid::PidSession::Leaving& leaving) const {
  LetGoPlan plan;
  plan.node = LetGoPlan::Node::hidraw;
  for (std::size_t i = 0; i < leaving.size; ++i) {
    std::vector<std::uint8_t> report;
    if (!node_.has_ids()) report.push_back(0);
    const auto data = leaving.packets[i].view();
    report.insert(report.end(), data.begin(), data.end());
    plan.add({.way = LetGoStep::Way::report, .is_farewell = i >= leaving.farewell}, report);
  }
  return plan;
}

Outcome HidrawChannel::submit(const hid::Transfer& transfer, bool) noexcept {
  const std::lock_guard lock(mutex_);
  if (closes_ || count_ == waiting_.size()) return Outcome::failed;
  waiting_[(first_ + count_++) % waiting_.size()] = transfer;
  wanted_.notify_one();
  return Outcome::done;
}

Outcome HidrawChannel::listen() noexcept {
  if (!ends_reading_) return Outcome::failed;
  reader_ = std::thread([this] { read_inputs(); });
  return Outcome::done;
}

void HidrawChannel::close() {
  {
    const std::lock_guard lock(mutex_);
    if (closes_) return;
    closes_ = true;
    wanted_.notify_one();
  }
  writer_.join();
  const std::uint64_t one = 1;
  if (write(ends_reading_.get(), &one, sizeof one) < 0) return;  // does not happen: an own eventfd always takes it
  if (reader_.joinable()) reader_.join();
}

void HidrawChannel::make_transfers() {
  while (true) {
    hid::Transfer transfer;
    {
      std::unique_lock lock(mutex_);
      wanted_.wait(lock, [&] { return closes_ || count_ > 0; });
      if (closes_) return;
      transfer = waiting_[first_];
      first_ = (first_ + 1) % waiting_.size();
      --count_;
    }
    std::span<const std::uint8_t> answer;
    const Outcome outcome = listener_.may_go(transfer) ? make(transfer, answer) : Outcome::failed;
    listener_.ended(transfer, outcome, answer);
  }
}

Outcome HidrawChannel::make(const hid::Transfer& transfer, std::span<const std::uint8_t>& answer) {
  constexpr std::uint8_t class_in = 0xa1;  // HID 1.11 section 7.2
  if (transfer.kind != hid::Transfer::Kind::control_in) return send(transfer);
  if (transfer.request_type == class_in) return ask(transfer, answer);
  answer = node_.report_descriptor();  // the only standard request of a session
  return Outcome::done;
}

Outcome HidrawChannel::send(const hid::Transfer& transfer) {
  const auto data = transfer.data.view();
  const std::size_t before = node_.has_ids() ? 0 : 1;
  buffer_[0] = 0;
  std::copy(data.begin(), data.end(), buffer_.begin() + static_cast<std::ptrdiff_t>(before));
  const std::size_t size = data.size() + before;
  const bool is_control = transfer.kind == hid::Transfer::Kind::control_out;
  ssize_t taken = 0;
  do {
    if (is_control && transfer.value >> 8 == feature_report) {
      taken = node_.call(HIDIOCSFEATURE(size), buffer_.data());
    } else if (is_control && transfer.value >> 8 == output_report) {
      taken = node_.call(HIDIOCSOUTPUT(size), buffer_.data());
    } else {
      taken = write(node_.descriptor(), buffer_.data(), size);
    }
  } while (taken < 0 && errno == EINTR);
  return taken >= 0 ? Outcome::done : outcome_of_errno(errno);
}

Outcome HidrawChannel::ask(const hid::Transfer& transfer, std::span<const std::uint8_t>& answer) {
  const std::size_t before = node_.has_ids() ? 0 : 1;
  const std::size_t size = std::min<std::size_t>(transfer.length + before, most_report_bytes);
  buffer_[0] = static_cast<std::uint8_t>(transfer.value & 0xff);
  const bool is_feature = transfer.value >> 8 == feature_report;
  int got = 0;
  do {
    got = node_.call(is_feature ? HIDIOCGFEATURE(size) : HIDIOCGINPUT(size), buffer_.data());
  } while (got < 0 && errno == EINTR);
  if (got < 0) return errno == ENOTTY ? Outcome::stalled : outcome_of_errno(errno);  // Linux before 5.11 has no GINPUT
  answer = std::span(buffer_).first(std::min(static_cast<std::size_t>(got), size));
  answer = answer.subspan(std::min(before, answer.size()));
  return Outcome::done;
}

/// Passes the reports on that the kernel has held while the device was set up.
void HidrawChannel::read_old_inputs(std::vector<std::uint8_t>& report) {
  constexpr int most_held = 64;  // HIDRAW_BUFFER_SIZE, linux/hidraw.h
  for (int i = 0; i < most_held; ++i) {
    pollfd wait{node_.descriptor(), POLLIN, 0};
    if (poll(&wait, 1, 0) != 1 || (wait.revents & (POLLERR | POLLHUP)) != 0) return;
    const ssize_t got = read(node_.descriptor(), report.data(), report.size());
    if (got <= 0) return;
    listener_.received({report.data(), static_cast<std::size_t>(got)}, true);
  }
}

void HidrawChannel::read_inputs() {
  std::vector<std::uint8_t> report(most_report_bytes);
  read_old_inputs(report);
  while (true) {
    pollfd waits[2] = {{node_.descriptor(), POLLIN, 0}, {ends_reading_.get(), POLLIN, 0}};
    if (poll(waits, 2, -1) < 0 && errno != EINTR)
      return listener_.silenced("its position cannot be read", Outcome::failed);
    if (waits[1].revents != 0) return;
    if (waits[0].revents == 0) continue;
    const ssize_t got = read(node_.descriptor(), report.data(), report.size());
    if (got > 0) {
      listener_.received({report.data(), static_cast<std::size_t>(got)}, false);
    } else if (got == 0 || (errno != EINTR && errno != EAGAIN)) {
      // hidraw returns EIO for a device that is gone, and rarely for another reason.
      return listener_.silenced("it was unplugged", Outcome::gone);
    }
  }
}

}  // namespace wale
