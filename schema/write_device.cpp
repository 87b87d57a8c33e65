#include "schema/write_device.hpp"

namespace wale::patch_program_format {

void write_device(ByteWriter& out, const DeviceProfile& device) {
  out.text(device.name);
  for (const double figure : {device.workspace_diameter,
                              device.position_counts,
                              device.force_newton,
                              device.force_counts,
                              device.rate,
                              device.speed_limit,
                              device.slew,
                              device.continuous_newton,
                              device.heating_seconds,
                              device.active_watt,
                              device.velocity_window,
                              device.velocity_noise_counts,
                              device.patch_width,
                              device.patch_height,
                              device.patch_rim,
                              device.mass,
                              device.damping,
                              device.friction,
                              device.delay_x,
                              device.delay_y,
                              device.bandwidth_x,
                              device.bandwidth_y}) {
    out.f64(figure);
  }
  out.u8(device.damping_known);
  out.u8(device.friction_known);
}

void write_shaker(ByteWriter& out, const Shaker& vibration) {
  out.u8(static_cast<std::uint8_t>(vibration.position));
  for (const double figure : {vibration.frequency_low, vibration.frequency_high, vibration.command_steps,
                              vibration.spin_up, vibration.exploring_speed})
    out.f64(figure);
  out.u32(vibration.response.size());
  for (const Shaker::Response& response : vibration.response) {
    out.f64(response.frequency);
    out.u32(response.points.size());
    for (const auto& point : response.points) {
      out.f64(point.command);
      out.f64(point.acceleration);
    }
  }
}

}  // namespace wale::patch_program_format
