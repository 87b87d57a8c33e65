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

/// `fraction` of `full` steps of force, rounded to the nearest; 0 for not-a-number.
std::int64_t force_steps(double fraction, std::int64_t full) noexcept {
  if (std::isnan(fraction)) return 0;
  return std::llround(std::clamp(fraction, -1.0, 1.0) * static_cast<double>(full));
}

/// The profile's number of force levels to each side, at most that of evdev.
std::int64_t levels_of(const DeviceProfile& profile) noexcept {
  constexpr double most = 32767;
  return static_cast<std::int64_t>(std::clamp(std::round(profile.force_counts), 1.0, most));
}

}  // namespace

Result<std::unique_ptr<HidPidDevice>> HidPidDevice::open(const std::shared_ptr<UsbContext>& context,
                                                         const UsbDeviceInfo& info, DeviceProfile profile,
                                                         const Options& options) {
  auto opened = open_pid_transport(context, info, levels_of(profile), options, options.transport);
  if (!opened) return std::move(opened).error();
  return std::unique_ptr<HidPidDevice>(new HidPidDevice(*std::move(opened), std::move(profile)));
}

Result<std::unique_ptr<HidPidDevice>> HidPidDevice::open(const std::shared_ptr<UsbContext>& context, int descriptor,
                                                         DeviceProfile profile, const Options& options) {
  auto opened = open_pid_transport(context, descriptor, levels_of(profile), options);
  if (!opened) return std::move(opened).error();
  return std::unique_ptr<HidPidDevice>(new HidPidDevice({*std::move(opened), {}}, std::move(profile)));
}

HidPidDevice::HidPidDevice(OpenedPidTransport opened, DeviceProfile profile)
    : transport_(std::move(opened.transport)), why_(std::move(opened.why)), profile_(std::move(profile)) {}

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
  const std::int64_t steps = transport_->ranges().full_force;
  const auto full = static_cast<double>(steps);
  glm::vec2 wanted(0), exerted(0);
  for (int axis = 0; axis < 2; ++axis) {
    const auto counts = force_steps(force[axis] / profile_.force_newton, steps);
    wanted[axis] = static_cast<float>(hid_signs[axis] * static_cast<double>(counts) / full);
    exerted[axis] = static_cast<float>(static_cast<double>(counts) / full * profile_.force_newton);
  }
  if (transport_->was_lost()) return Force(0);
  transport_->command(wanted);
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
