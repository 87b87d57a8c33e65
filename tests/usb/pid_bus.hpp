#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "runtime/device/hid_pid/pid_session.hpp"
#include "tests/usb/pid_model.hpp"

namespace wale::test {

/// A session and a model of a device without USB between them. In each frame of a millisecond, one packet goes each way
/// and control transfers end. Time is the number of frames, so the clock does not matter.
class PidBus {
 public:
  static constexpr std::int64_t frame_time = 1000, timeout = 100'000;  // microseconds

  explicit PidBus(PidModel& model, hid::PidSessionOptions options = {}, std::uint16_t descriptor_bytes = 0)
      : session(
            hid::HidInterface{
                0, descriptor_bytes != 0 ? descriptor_bytes : static_cast<std::uint16_t>(model.descriptor.size()),
                true},
            options),
        model_(&model) {}

  /// Moves time to the next frame.
  void frame() {
    now += frame_time;
    if (model_ != nullptr) {
      model_->step();
      end_transfers();
      if (const auto report = model_->input()) session.receive(*report, now);
    }
    pump();
  }

  /// Submits the transfers that the session asks for now.
  void pump() {
    while (auto transfer = session.next(now)) {
      if (model_ == nullptr) {
        session.finish(*transfer, hid::Outcome::gone, {}, now);
      } else {
        submitted.push_back({*transfer, now});
        most_in_flight = std::max(most_in_flight, submitted.size());
        if (transfer->purpose == hid::Transfer::Purpose::force) forces.push_back({transfer->data, newest});
      }
    }
  }

  /// Passes frames until the session runs or has ended, for at most one second.
  void settle() {
    pump();
    for (int i = 0; i < 1000 && (session.state() == hid::PidSession::State::setting_up ||
                                 session.state() == hid::PidSession::State::leaving);
         ++i) {
      frame();
    }
  }

  void unplug() {
    model_ = nullptr;
    const auto gone = std::exchange(submitted, {});
    for (const Submitted& each : gone) session.finish(each.transfer, hid::Outcome::gone, {}, now);
  }

  /// A Set Constant Force packet, with the newest command at its submission.
  struct Sent {
    hid::Packet packet;
    glm::dvec2 newest{0};
  };

  void command(glm::dvec2 force, std::int64_t at) {
    newest = force;
    session.command(force, at);
    pump();
  }

  hid::PidSession session;
  std::int64_t now = 0;
  glm::dvec2 newest{0};
  std::size_t most_in_flight = 0;
  std::vector<Sent> forces;

 private:
  struct Submitted {
    hid::Transfer transfer;
    std::int64_t at = 0;
  };
  std::deque<Submitted> submitted;

  void end_transfers() {
    using Kind = hid::Transfer::Kind;
    bool has_sent = false;  // one packet a frame on the interrupt endpoint
    for (std::size_t i = 0; i < submitted.size();) {
      const Submitted each = submitted[i];
      const bool is_out = each.transfer.kind == Kind::interrupt_out;
      const bool is_poll = each.transfer.purpose == hid::Transfer::Purpose::poll;
      const bool is_deaf = model_->faults.silent || (is_out && model_->is_deaf_to_outputs()) ||
                           (is_poll && model_->faults.deaf_to_polls);
      if (is_out && has_sent) {
        ++i;
        continue;
      }
      if (is_deaf && now - each.at < timeout) {
        if (is_out) has_sent = true;
        ++i;
        continue;
      }
      submitted.erase(submitted.begin() + static_cast<std::ptrdiff_t>(i));
      if (is_deaf) {
        session.finish(each.transfer, hid::Outcome::timed_out, {}, now);
        continue;
      }
      end(each.transfer, has_sent);
    }
  }

  void end(const hid::Transfer& transfer, bool& has_sent) {
    const auto bytes = transfer.data.view();
    const std::vector<std::uint8_t> data(bytes.begin(), bytes.end());
    if (transfer.kind == hid::Transfer::Kind::interrupt_out) {
      has_sent = true;
      session.finish(transfer, model_->output(data) ? hid::Outcome::done : hid::Outcome::stalled, {}, now);
      return;
    }
    const auto low = [](std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xff); };
    const auto high = [](std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8); };
    const auto answer =
        model_->control({transfer.request_type, transfer.request, low(transfer.value), high(transfer.value),
                         low(transfer.index), high(transfer.index), low(transfer.length), high(transfer.length)},
                        data);
    session.finish(transfer, answer ? hid::Outcome::done : hid::Outcome::stalled,
                   answer ? *answer : std::vector<std::uint8_t>{}, now);
  }

  PidModel* model_;
};

}  // namespace wale::test
