#include "runtime/device/hid_pid/hid_pid_device.hpp"

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

constexpr int hid_signs[2] = {1, -1};  // HID's axes relative to ours: its y points to the user (HID 1.11 section 5.9)

int scaled_counts(std::int32_t raw, std::int64_t minimum, std::int64_t maximum, double counts, int sign) noexcept {
  const double length = static_cast<double>(maximum - minimum);
  const double centre = (static_cast<double>(maximum) + static_cast<double>(minimum)) / 2;
  return sign * static_cast<int>(std::lround((raw - centre) * counts / length));
}

std::int64_t levels_of(const DeviceProfile& profile) noexcept {
  constexpr double most = 32767;
  return static_cast<std::int64_t>(std::clamp(std::round(profile.force_counts), 1.0, most));
}

/// With the limits of the declaration and the user.
PidTransportOptions limited(PidTransportOptions options, const ForceLimits& limits) {
  options.session.limits = limits;
  return options;
}

}  // namespace

Result<std::unique_ptr<HidPidDevice>> HidPidDevice::open(const std::shared_ptr<UsbContext>& context,
                                                         const UsbDeviceInfo& info, const TrustedDevice& trusted,
                                                         const Options& options) {
  const ForceLimits limits = force_limits(trusted, options.most_newton);
  auto opened =
      open_pid_transport(context, info, levels_of(trusted.profile()), limited(options, limits), options.transport);
  if (!opened) return std::move(opened).error();
  return std::unique_ptr<HidPidDevice>(new HidPidDevice(*std::move(opened), trusted.profile(), limits));
}

Result<std::unique_ptr<HidPidDevice>> HidPidDevice::open(const std::shared_ptr<UsbContext>& context, int descriptor,
                                                         const TrustedDevice& trusted, const Options& options) {
  const ForceLimits limits = force_limits(trusted, options.most_newton);
  auto opened = open_pid_transport(context, descriptor, levels_of(trusted.profile()), limited(options, limits));
  if (!opened) return std::move(opened).error();
  return std::unique_ptr<HidPidDevice>(new HidPidDevice({*std::move(opened), {}}, trusted.profile(), limits));
}

HidPidDevice::HidPidDevice(OpenedPidTransport opened, DeviceProfile profile, const ForceLimits& limits)
    : transport_(std::move(opened.transport)),
      why_(std::move(opened.why)),
      profile_(std::move(profile)),
      limits_(limits) {}

Reading HidPidDevice::sample() noexcept {
  const PidTransport::Seen seen = transport_->seen();
  const PidTransport::Ranges& ranges = transport_->ranges();
  Reading reading;
  reading.counts.x = scaled_counts(seen.x, ranges.x_minimum, ranges.x_maximum, profile_.position_counts, hid_signs[0]);
  reading.counts.y = scaled_counts(seen.y, ranges.y_minimum, ranges.y_maximum, profile_.position_counts, hid_signs[1]);
  reading.button = seen.button;
  reading.contact = transport_->was_lost() ? Contact::lost : Contact::good;
  return reading;
}

Force HidPidDevice::command(Force force) noexcept {
  if (transport_->was_lost()) return Force(0);
  const std::int64_t steps = transport_->ranges().full_force;
  const glm::vec2 share(force / static_cast<float>(profile_.force_newton));
  transport_->command({static_cast<float>(hid_signs[0]) * share.x, static_cast<float>(hid_signs[1]) * share.y});
  // The transport goes by the same limits and the same steps: this is what it sends, unless a newer command comes.
  const glm::dvec2 allowed = hid::within(limits_, share);
  Force exerted(0);
  for (int axis = 0; axis < 2; ++axis)
    exerted[axis] = static_cast<float>(static_cast<double>(hid::commanded_counts(allowed[axis], steps)) /
                                       static_cast<double>(steps) * profile_.force_newton);
  return exerted;
}

std::string HidPidDevice::manner() const {
  const std::string manner = std::string(hid::in_words(arrangement())) + ", by " + std::string(in_words(transport()));
  return why_.empty() ? manner : manner + " (" + why_ + ")";
}

std::vector<std::pair<std::string, long>> HidPidDevice::tally() const {
  const hid::PidSessionCounts done = counts();
  std::vector<std::pair<std::string, long>> tally{
      {"forces_sent_x", done.forces_sent[0]},    {"forces_sent_y", done.forces_sent[1]},
      {"directions_sent", done.directions_sent}, {"forces_overwritten", done.overwritten},
      {"effects_refreshed", done.refreshes},     {"positions_received", done.inputs},
      {"positions_asked_for", done.polls},       {"bad_reports", done.bad_inputs}};
  if (const auto told = telemetry()) {  // what it did, beside what it was told to do: of 32767
    tally.push_back({"most_torque_told_x", told->most_torque[0]});
    tally.push_back({"most_torque_told_y", told->most_torque[1]});
  }
  return tally;
}

}  // namespace wale
