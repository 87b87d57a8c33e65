#include "runtime/device/falcon/falcon_device.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wale {

bool is_falcon(const UsbDeviceInfo& info) { return info.vendor == falcon::vendor && info.product == falcon::product; }

namespace {

/// Asks the person to home it, and waits until that is done, `stop` is true, the patience is over, or it is lost.
void wait_for_homing(FalconTransport& transport, const FalconOptions& options) {
  constexpr double at_once = 0.2;  // s, in which a device that was homed before reports it
  if (transport.was_lost() || transport.wait_until_homed(at_once) || transport.was_lost()) return;
  if (options.ask) options.ask("push the Falcon's handle all the way in, then pull it all the way out");
  constexpr double between_looks = 0.1;  // s
  const auto is_wanted = [&] { return options.stop == nullptr || !options.stop->load(std::memory_order_relaxed); };
  for (double waited = 0; waited < options.homing_patience && is_wanted() && !transport.was_lost();
       waited += between_looks) {
    if (transport.wait_until_homed(std::min(between_looks, options.homing_patience - waited))) return;
  }
}

ForceLimits limits_of(const TrustedDevice& trusted, const FalconOptions& options) {
  return falcon::for_moving_handle(force_limits(trusted, options.most_newton));
}

}  // namespace

Result<std::unique_ptr<FalconDevice>> FalconDevice::open(std::shared_ptr<UsbContext> context, const UsbDeviceInfo& info,
                                                         const TrustedDevice& trusted, const FalconOptions& options) {
  const std::string name = in_words(info.vendor, info.product) + ": ";
  FalconTransport::Options wanted = options.transport;
  auto firmware = read_falcon_firmware(options.firmware);
  if (firmware) wanted.session.firmware = *std::move(firmware);
  wanted.session.gate = falcon::TorqueGate(limits_of(trusted, options), options.hold.most);

  auto opened = FalconTransport::open(std::move(context), info, std::move(wanted));
  if (!opened) return std::move(opened.error());
  FalconTransport& transport = **opened;
  if (transport.wants_firmware()) {
    Error error = firmware.error();
    error.sentence = name + "it runs no firmware, and " + error.sentence;
    return error;
  }
  wait_for_homing(transport, options);
  if (transport.was_lost()) return Error{Code::lost_device, name + transport.reason()};
  if (!transport.seen().is_running)
    return Error{Code::unusable_device, name + "its encoders have not found their zeros",
                 "push the handle all the way in and pull it all the way out"};
  return std::unique_ptr<FalconDevice>(new FalconDevice(*std::move(opened), trusted, options));
}

FalconDevice::FalconDevice(std::unique_ptr<FalconTransport> transport, const TrustedDevice& trusted,
                           const FalconOptions& options)
    : transport_(std::move(transport)),
      profile_(trusted.profile()),
      plane_(limits_of(trusted, options), options.hold),
      is_held_(options.hold.stiffness > 0),
      now_(options.transport.now),
      stale_after_(static_cast<std::int64_t>(options.transport.session.stale_after * 1e6)) {}

Reading FalconDevice::sample() noexcept {
  const FalconTransport::Seen seen = transport_->seen();
  const bool is_lost = transport_->was_lost();
  is_good_ =
      !is_lost && seen.is_running && now_() - seen.heard <= stale_after_ && plane_.see(seen.encoders, seen.heard);
  Reading reading;
  const glm::dvec2 counts = plane_.position() / profile_.position_step();
  reading.counts = {static_cast<int>(std::lround(counts.x)), static_cast<int>(std::lround(counts.y))};
  reading.button = seen.buttons != 0;
  reading.contact = is_lost ? Contact::lost : is_good_ ? Contact::good : Contact::stale;
  return reading;
}

Force FalconDevice::command(Force force) noexcept {
  if (transport_->was_lost()) return Force(0);
  if (!is_good_) {
    plane_.let_go();
    transport_->command({});
    return Force(0);
  }
  const falcon::FalconPlane::Push push = plane_.push(force, now_());
  transport_->command(push.torques);
  return {static_cast<float>(push.force.x), static_cast<float>(push.force.y)};
}

std::vector<std::pair<std::string, long>> FalconDevice::tally() const {
  const falcon::FalconSessionCounts done = counts();
  return {{"forces_sent", done.commands_sent},
          {"forces_overwritten", done.overwritten},
          {"positions_received", done.answers},
          {"answers_missing", done.silences},
          {"bytes_of_no_answer", done.skipped_bytes}};
}

std::string FalconDevice::manner() const {
  return is_held_ ? "three motors; the handle is held in an upright plane"
                  : "three motors; the handle may leave its plane";
}

}  // namespace wale
