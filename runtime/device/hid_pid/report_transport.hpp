#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "runtime/device/hid_pid/pid_transport.hpp"
#include "runtime/device/hid_pid/report_channel.hpp"
#include "wale/result.hpp"

namespace wale {

/// A session with a joystick by reports of the PID class, which a channel carries. One thread submits forces as soon as
/// they are commanded; the channel's threads report the outcomes.
class ReportTransport final : public PidTransport, private ReportChannel::Listener {
 public:
  using Channel = std::function<std::unique_ptr<ReportChannel>(ReportChannel::Listener&)>;

  /// Sets the device up from zero force, in a few tens of milliseconds. The error says why the device cannot be used;
  /// the device is then left as it was.
  static Result<std::unique_ptr<PidTransport>> open(PidTransportKind kind, const Channel& channel,
                                                    const PidTransportOptions& options);
  /// Stops the device, waits for transfers under way, and gives the channel back.
  ~ReportTransport() override;

  PidTransportKind kind() const noexcept override { return kind_; }
  std::string reason() const override;
  hid::PidSessionCounts counts() const override;
  std::optional<hid::Telemetry> telemetry() const override;
  hid::Arrangement arrangement() const override;
  const Ranges& ranges() const noexcept override { return ranges_; }

 private:
  ReportTransport(PidTransportKind kind, const Channel& channel, const PidTransportOptions& options);
  Result<> wait_until_running();
  Result<> get_keeper(const std::optional<KeeperOptions>& options);
  void heed_keeper();
  bool may_go(const hid::Transfer& transfer) const noexcept override;
  void write_forces();
  void pump();
  void publish();

  void ended(const hid::Transfer& transfer, Outcome outcome, std::span<const std::uint8_t> answer) override;
  void received(std::span<const std::uint8_t> report, bool is_old) override;
  void silenced(std::string_view reason, Outcome outcome) override;

  const PidTransportKind kind_;
  const MicrosecondClock now_;
  Ranges ranges_;

  mutable std::mutex mutex_;  // of all that follows; never taken by the real-time thread
  std::condition_variable changed_;
  std::unique_ptr<ReportChannel> channel_;
  hid::PidSession session_;
  bool listens_ = false, closes_ = false;
  std::thread writer_;
};

}  // namespace wale
