#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/device/hid_pid/pid_session.hpp"
#include "runtime/keeper/let_go_plan.hpp"

namespace wale {

/// Carries a device's reports by usbfs or hidraw. It makes the transfers that a `hid::PidSession` wants and reports how
/// each ended.
class ReportChannel {
 public:
  /// Told by threads of the channel, one at a time or several at once, and never from within a call to the channel.
  class Listener {
   public:
    /// A transfer has ended; `answer` is what came in.
    virtual void ended(const hid::Transfer& transfer, Outcome outcome, std::span<const std::uint8_t> answer) = 0;
    /// An input report has come. An empty one is a report that could not be held.
    virtual void received(std::span<const std::uint8_t> report) = 0;
    /// No input reports come any more. `reason` outlives the channel.
    virtual void silenced(std::string_view reason, Outcome outcome) = 0;
    /// Whether a transfer that has waited may still be made. Real-time.
    virtual bool may_go(const hid::Transfer& transfer) const noexcept = 0;

   protected:
    ~Listener() = default;
  };

  virtual ~ReportChannel() = default;

  /// Begins to make a transfer, and returns at once. `done`: the listener will be told how it ended; anything else: it
  /// could not begin, and nobody is told. Real-time once the session runs, but for the system calls of usbfs.
  virtual Outcome submit(const hid::Transfer& transfer, bool is_setting_up) noexcept = 0;
  /// Begins to take input reports, once. An outcome as of `submit`.
  virtual Outcome listen() noexcept = 0;
  /// Waits until whatever was submitted has ended, and tells the listener nothing afterwards.
  virtual void close() = 0;
  /// At most so many transfers may be under way besides one poll.
  virtual int most_under_way() const noexcept = 0;
  virtual hid::HidInterface interface() const noexcept = 0;
  /// How a keeper sends these packets by the same way, and the descriptor that it gets for that; -1: its plan has a path.
  virtual LetGoPlan let_go_plan(const hid::PidSession::Leaving& leaving) const = 0;
  virtual int descriptor() const noexcept = 0;
};

}  // namespace wale
