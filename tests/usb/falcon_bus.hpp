#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "runtime/device/falcon/falcon_session.hpp"
#include "tests/usb/falcon_model.hpp"

namespace wale::test {

/// A session and a model of a Falcon without USB between them. In each frame of a millisecond, one packet goes each
/// way. Time is the number of frames, so the clock does not matter.
class FalconBus {
 public:
  static constexpr std::int64_t frame_time = 1000, timeout = 50'000;  // microseconds

  /// Unless the options have limits, torques pass as they are commanded.
  FalconBus(FalconModel& model, falcon::FalconSessionOptions options)
      : session(options.gate.has_limits() ? std::move(options) : unlimited(std::move(options))), model_(&model) {}

  static falcon::FalconSessionOptions unlimited(falcon::FalconSessionOptions options) {
    options.gate = falcon::TorqueGate({.gain = glm::dvec2(1e-6)}, 1);  // so weak that nothing reaches its peak
    return options;
  }

  /// Moves time to the next frame.
  void frame() {
    now += frame_time;
    if (model_ != nullptr) {
      model_->step();
      for (std::size_t i = 0; i < submitted_.size();) {
        const Submitted each = submitted_[i];
        if (!end(each, i)) ++i;
      }
    }
    pump();
  }

  /// Submits the transfers that the session asks for now.
  void pump() {
    while (auto transfer = session.next(now)) {
      if (model_ == nullptr) {
        session.finish(*transfer, Outcome::gone, {}, now);
        continue;
      }
      submitted_.push_back({*transfer, now});
      const auto writes = std::count_if(submitted_.begin(), submitted_.end(), [](const Submitted& each) {
        return each.transfer.kind == falcon::Transfer::Kind::write;
      });
      most_writes = std::max(most_writes, static_cast<long>(writes));
    }
  }

  template <class Condition>
  bool run_until(Condition holds, int frames = 10'000) {
    pump();
    for (int i = 0; i < frames && !holds(); ++i) frame();
    return holds();
  }

  void unplug() {
    model_ = nullptr;
    for (const Submitted& each : std::exchange(submitted_, {})) session.finish(each.transfer, Outcome::gone, {}, now);
  }

  falcon::FalconSession session;
  std::int64_t now = 0;
  long most_writes = 0;

 private:
  struct Submitted {
    falcon::Transfer transfer;
    std::int64_t at = 0;
  };
  std::deque<Submitted> submitted_;

  /// Ends a transfer if its time has come, and takes it from the list.
  bool end(const Submitted& each, std::size_t index) {
    using Kind = falcon::Transfer::Kind;
    const falcon::Transfer& transfer = each.transfer;
    const auto finish = [&](Outcome outcome, const UsbModel::Bytes& came_in = {}) {
      submitted_.erase(submitted_.begin() + static_cast<std::ptrdiff_t>(index));
      session.finish(transfer, outcome, came_in, now);
      return true;
    };
    if (transfer.kind == Kind::control) {
      const auto low = static_cast<std::uint8_t>(transfer.value & 0xff);
      const auto high = static_cast<std::uint8_t>(transfer.value >> 8);
      const bool is_taken = model_->control({0x40, transfer.request, low, high, 0, 0, 0, 0}, {}).has_value();
      return finish(is_taken ? Outcome::done : Outcome::stalled);
    }
    if (transfer.kind == Kind::write && model_->listens(falcon::out_endpoint)) {
      const auto bytes = transfer.view();
      const bool is_taken = model_->take(falcon::out_endpoint, {bytes.begin(), bytes.end()});
      return finish(is_taken ? Outcome::done : Outcome::stalled);
    }
    if (transfer.kind == Kind::read) {
      if (const auto packet = model_->give(falcon::in_endpoint)) return finish(Outcome::done, *packet);
    }
    return now - each.at >= timeout && finish(Outcome::timed_out);
  }

  FalconModel* model_;
};

}  // namespace wale::test
