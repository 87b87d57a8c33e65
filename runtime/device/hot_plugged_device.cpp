#include "runtime/device/hot_plugged_device.hpp"

#include <algorithm>
#include <new>

#include "runtime/device/driver.hpp"
#include "schema/without_place.hpp"

namespace wale {
namespace {

/// The number of ticks after which the velocity filter holds no position from before.
long ticks_to_settle(const DeviceProfile& profile) {
  return std::max(1L, static_cast<long>(profile.velocity_window) + 1);
}

std::array<AxisResponse, 2> responses_of(const DeviceWiring& wiring, const DeviceProfile& profile) {
  if (profile.shaker) return {};
  return {wiring.response_of(0, profile.force_newton), wiring.response_of(1, profile.force_newton)};
}

}  // namespace

HotPluggedDevice::HotPluggedDevice(std::unique_ptr<PluggedDevice> device, DeviceWiring wiring, Reopen reopen,
                                   std::chrono::milliseconds patience)
    : profile_(device->profile()),
      wiring_(std::move(wiring)),
      responses_{responses_of(wiring_, profile_)},
      reopen_(std::move(reopen)),
      patience_(patience),
      held_(device.release()) {
  attendant_ = std::thread([this] { attend(); });
}

HotPluggedDevice::~HotPluggedDevice() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  news_.notify_all();
  attendant_.join();
  for (PluggedDevice* device : {held_, offered_.load(), retired_.load()}) delete device;
}

void HotPluggedDevice::elapse(long periods) noexcept {
  if (held_ != nullptr) held_->elapse(periods);
  settling_ = std::max(0L, settling_ - periods);
}

Reading HotPluggedDevice::sample() noexcept {
  if (held_ == nullptr) {
    held_ = offered_.exchange(nullptr, std::memory_order_acquire);
    if (held_ != nullptr) settling_ = ticks_to_settle(profile_);
  }
  last_.contact = Contact::lost;
  if (held_ == nullptr) return last_;
  const Reading own = held_->sample();
  if (own.contact == Contact::lost) {
    losses_.fetch_add(1, std::memory_order_relaxed);
    retired_.store(std::exchange(held_, nullptr), std::memory_order_release);
    return last_;
  }
  last_ = own;
  for (int axis = 0; axis < 2; ++axis) {
    const SignedAxis& from = wiring_.axes[static_cast<std::size_t>(axis)];
    last_.counts[axis] = from.sign * own.counts[from.axis];
    last_.interaction[axis] = static_cast<float>(from.sign) * own.interaction[from.axis];
  }
  if (settling_ > 0) last_.contact = Contact::lost;
  return last_;
}

Force HotPluggedDevice::command(Force force) noexcept {
  if (held_ == nullptr) return Force(0);
  if (profile_.shaker) return held_->command(force);
  Force own(0), exerted(0);
  for (int axis = 0; axis < 2; ++axis) {
    const SignedAxis& to = wiring_.motors[static_cast<std::size_t>(axis)];
    own[to.axis] = static_cast<float>(to.sign * responses_[static_cast<std::size_t>(axis)].command(force[axis]));
  }
  own = held_->command(own);
  for (int axis = 0; axis < 2; ++axis) {
    const SignedAxis& to = wiring_.motors[static_cast<std::size_t>(axis)];
    exerted[axis] = static_cast<float>(responses_[static_cast<std::size_t>(axis)].force(to.sign * own[to.axis]));
  }
  return exerted;
}

HotPlugReport HotPluggedDevice::report() const {
  const std::lock_guard lock(mutex_);
  HotPlugReport report = report_;
  report.losses = losses_.load();
  report.returns = returns_.load();
  if (held_ != nullptr) {
    report.manner = held_->manner();
    add(report.tally, held_->tally());
  }
  return report;
}

void HotPluggedDevice::add(std::vector<std::pair<std::string, long>>& sum,
                           const std::vector<std::pair<std::string, long>>& more) {
  for (const auto& [name, count] : more) {
    const auto found =
        std::find_if(sum.begin(), sum.end(), [&, &sought = name](const auto& one) { return one.first == sought; });
    if (found == sum.end())
      sum.emplace_back(name, count);
    else
      found->second += count;
  }
}

bool HotPluggedDevice::rest() {
  std::unique_lock lock(mutex_);
  news_.wait_for(lock, patience_, [&] { return ends_; });
  return !ends_;
}

/// Runs on the other thread. Without memory it says less, and tries again later.
void HotPluggedDevice::attend() noexcept {
  const auto say = [this](const auto& what) noexcept {
    const std::lock_guard lock(mutex_);
    try {
      what();
    } catch (const std::bad_alloc&) {
    }
  };
  while (rest()) {
    std::unique_ptr<PluggedDevice> lost(retired_.exchange(nullptr, std::memory_order_acquire));
    if (!lost) continue;
    say([&] {
      report_.reason = lost->reason();
      report_.manner = lost->manner();
      add(report_.tally, lost->tally());
    });
    lost.reset();
    do {
      OpenedDevice opened = opened_again();
      say([&] { report_.refusal = opened ? "" : in_words_without_place(opened.error()); });
      if (!opened) continue;
      returns_.fetch_add(1, std::memory_order_relaxed);
      offered_.store(opened->release(), std::memory_order_release);
      break;
    } while (rest());
  }
}

OpenedDevice HotPluggedDevice::opened_again() const noexcept {
  try {
    return reopen_();
  } catch (const std::bad_alloc&) {
    return Error{.code = Code::short_of_resources};
  }
}

}  // namespace wale
