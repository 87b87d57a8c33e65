#include "runtime/device/hid_pid/hid_pid_device.hpp"

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

constexpr int hid_signs[2] = {1, -1};  // of HID's axes along ours: its y points to the user (HID 1.11 section 5.9)

int scaled_counts(std::int32_t raw, const hid::Number& range, double counts, int sign) noexcept {
  const double length = static_cast<double>(range.maximum - range.minimum);
  const double centre = (static_cast<double>(range.maximum) + static_cast<double>(range.minimum)) / 2;
  return sign * static_cast<int>(std::lround((raw - centre) * counts / length));
}

}  // namespace

std::variant<std::unique_ptr<HidPidDevice>, Refusal> HidPidDevice::open(std::shared_ptr<UsbContext> context,
                                                                        const UsbDeviceInfo& info,
                                                                        DeviceProfile profile,
                                                                        const PidTransport::Options& options) {
  Refusal refusal{
      in_words(info.vendor, info.product) + ": it is not a force device: it has no interface of the HID class", {}};
  bool is_first = true;
  for (const UsbHidInterface& interface : info.hid) {
    auto opened = PidTransport::open(context, info, interface, options);
    if (auto* transport = std::get_if<std::unique_ptr<PidTransport>>(&opened)) {
      return std::unique_ptr<HidPidDevice>(new HidPidDevice(std::move(*transport), std::move(profile)));
    }
    // A keyboard beside the joystick is not what stands in the way.
    Refusal& why = std::get<Refusal>(opened);
    if (is_first || refusal.reason.find("not a force device") != std::string::npos) refusal = std::move(why);
    is_first = false;
  }
  return refusal;
}

HidPidDevice::HidPidDevice(std::unique_ptr<PidTransport> transport, DeviceProfile profile)
    : transport_(std::move(transport)), profile_(std::move(profile)) {}

Reading HidPidDevice::sample() noexcept {
  const PidTransport::Seen seen = transport_->seen();
  const hid::PidLayout::Input& input = transport_->layout().input;
  Reading reading;
  reading.counts.x = scaled_counts(seen.x, input.x, profile_.position_counts, hid_signs[0]);
  reading.counts.y = scaled_counts(seen.y, input.y, profile_.position_counts, hid_signs[1]);
  reading.button = seen.button;
  reading.contact = transport_->was_lost() ? Contact::lost : Contact::good;
  return reading;
}

Force HidPidDevice::command(Force force) noexcept {
  const auto full = static_cast<double>(transport_->layout().set_constant_force.full());
  glm::vec2 wanted(0), exerted(0);
  for (int axis = 0; axis < 2; ++axis) {
    const double fraction = force[axis] / profile_.force_newton;
    const auto counts = hid::magnitude_counts(transport_->layout(), fraction);  // not-a-number is none
    wanted[axis] = static_cast<float>(hid_signs[axis] * static_cast<double>(counts) / full);
    exerted[axis] = static_cast<float>(static_cast<double>(counts) / full * profile_.force_newton);
  }
  if (transport_->was_lost()) return Force(0);
  transport_->command(wanted);
  return exerted;
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
