#include "schema/read_device.hpp"

namespace wale::patch_program_format {

DeviceProfile read_device(ByteReader& in) {
  DeviceProfile device;
  device.name = in.text("the device's name");
  const auto figure = [&in](double& value, std::string_view what) { value = in.finite_f64(what); };
  figure(device.workspace_diameter, "the workspace's diameter");
  figure(device.position_counts, "the position's counts");
  figure(device.force_newton, "the force");
  figure(device.force_counts, "the force's counts");
  figure(device.rate, "the rate");
  figure(device.speed_limit, "the speed limit");
  figure(device.slew, "the slew");
  figure(device.continuous_newton, "the continuous force");
  figure(device.heating_seconds, "the time constant of heating");
  figure(device.active_watt, "the power of active programs");
  figure(device.velocity_window, "the velocity window");
  figure(device.velocity_noise_counts, "the velocity's noise");
  figure(device.patch_width, "the patch's width");
  figure(device.patch_height, "the patch's height");
  figure(device.patch_rim, "the patch's rim");
  figure(device.mass, "the mass");
  figure(device.damping, "the damping");
  figure(device.friction, "the friction");
  figure(device.delay_x, "the delay along x");
  figure(device.delay_y, "the delay along y");
  figure(device.bandwidth_x, "the bandwidth along x");
  figure(device.bandwidth_y, "the bandwidth along y");
  device.damping_known = in.boolean("whether the damping is known");
  device.friction_known = in.boolean("whether the friction is known");
  return device;
}

Shaker read_shaker(ByteReader& in) {
  Shaker vibration;
  const std::uint8_t position = in.u8();
  if (position > static_cast<std::uint8_t>(PositionSource::touch)) {
    in.damaged(" has position source ", int{position}, ", which this Wale does not know");
  }
  vibration.position = static_cast<PositionSource>(position);
  for (double* figure : {&vibration.frequency_low, &vibration.frequency_high, &vibration.command_steps,
                         &vibration.spin_up, &vibration.exploring_speed}) {
    *figure = in.finite_f64("a figure of the vibration");
  }
  vibration.response.resize(in.count(12, "frequencies"));
  for (Shaker::Response& response : vibration.response) {
    response.frequency = in.finite_f64("a frequency of the response");
    response.points.resize(in.count(16, "points of the response"));
    for (auto& point : response.points) {
      point.command = in.finite_f64("a command");
      point.acceleration = in.finite_f64("an acceleration");
    }
  }
  return vibration;
}

}  // namespace wale::patch_program_format
