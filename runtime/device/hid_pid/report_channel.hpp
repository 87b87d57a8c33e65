#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/device/hid_pid/pid_session.hpp"
#include "runtime/keeper/let_go_plan.hpp"

namespace wale {

/// Carries a device's reports by usbfs or hidraw. It makes the transfers that a `hid::PidSession` asks for and tells
/// its listener how each ended.
class ReportChannel {
 public:
  /// Called by threads of the channel, also by several at once, but never from within a call to the channel.
  class Listener {
   public:
    /// A transfer has ended; `answer` has the bytes that came in.
    virtual void ended(const hid::Transfer& transfer, Outcome outcome, std::span<const std::uint8_t> answer) = 0;
    /// An input report has come. It is empty if the report was too long for the channel's buffer. `is_old`: it came
    /// before `listen`.
    virtual void received(std::span<const std::uint8_t> report, bool is_old) = 0;
    /// No more input reports come. `reason` outlives the channel.
    virtual void silenced(std::string_view reason, Outcome outcome) = 0;
    /// Whether a transfer that has waited may still be made. Real-time.
    virtual bool may_go(const hid::Transfer& transfer) const noexcept = 0;

   protected:
    ~Listener() = default;
  };

  virtual ~ReportChannel() = default;

  /// Begins a transfer and returns at once. `done`: the listener will be told how it ended. Other outcomes: it could
  /// not begin, and the listener is not told. Real-time once the session runs, except for the system calls of usbfs.
  virtual Outcome submit(const hid::Transfer& transfer, bool is_setting_up) noexcept = 0;
  /// Begins to take input reports; call it once. The outcome is as for `submit`.
  virtual Outcome listen() noexcept = 0;
  /// Waits until all submitted transfers have ended; afterwards the listener is not called.
  virtual void close() = 0;
  /// The greatest number of transfers under way, besides one poll.
  virtual int most_under_way() const noexcept = 0;
  virtual hid::HidInterface interface() const noexcept = 0;
  /// How a keeper sends these packets by the same way, and the descriptor that it gets for that; -1: its plan has a
  /// path.
  virtual LetGoPlan let_go_plan(const hid::PidSession::Leaving& leaving) const = 0;
  virtual int descriptor() const noexcept = 0;
};

}  // namespace wale
