#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wale {

/// The device for which a program is built unless another is named.
inline constexpr const char* default_device = "sandpaper";

/// The source of the hand's position on a vibrating pad.
enum class PositionSource : std::uint8_t {
  none = 0,     ///< the pad has no position, so a material feels the same everywhere
  pointer = 1,  ///< a mouse or another pointer, in the hand or beside it
  touch = 2,    ///< the finger on the pad's surface
};

/// How a pad or gamepad shakes: along one axis, with an amplitude and a frequency.
struct Shaker {
  /// The accelerations that commands give at one frequency, all above 0; a command of 0 gives none.
  struct Response {
    double frequency = 0;  ///< Hz
    struct Point {
      double command = 0;       ///< 0 .. 1, rising from point to point
      double acceleration = 0;  ///< m/s^2, amplitude, rising from point to point

      friend bool operator==(const Point&, const Point&) = default;
    };
    std::vector<Point> points;

    friend bool operator==(const Response&, const Response&) = default;
  };

  PositionSource position = PositionSource::none;
  double frequency_low = 0, frequency_high = 0;  ///< Hz, the range in which it shakes
  double command_steps = 0;                      ///< number of steps from no command to the full one; 0: continuous
  double spin_up = 0;                            ///< s, the time constant of its approach to a new command
  double exploring_speed = 0;                    ///< m/s, the assumed speed of the hand on a pad without a position
  std::vector<Response> response;                ///< in rising order of frequency

  /// The greatest acceleration at any frequency, m/s^2.
  double peak() const;
  /// The acceleration (m/s^2) of a command (0 .. 1) at a frequency (Hz), and the command for an acceleration, at most
  /// 1. Linear between the declared points; a frequency beyond the first or last one counts as that one. Real-time.
  double acceleration(double command, double frequency) const noexcept;
  double command(double acceleration, double frequency) const noexcept;

  friend bool operator==(const Shaker&, const Shaker&) = default;
};

/// A two-axis joystick, or a pad that only vibrates, as its `device` declaration describes it. All figures are in SI
/// units. Zero means "not declared" in each figure that cannot be zero.
struct DeviceProfile {
  static constexpr double least_rate = 100, most_rate = 10000;  ///< Hz, of any device's control ticks
  static constexpr double least_heating_seconds = 1e-3;         ///< s; no motor heats faster

  std::string name;
  double workspace_diameter = 0;  ///< m
  double position_counts = 0;     ///< encoder counts over the workspace's diameter, per axis
  double force_newton = 0;        ///< peak force per axis, N
  double force_counts = 0;        ///< command steps from zero to peak force
  double rate = 0;                ///< control ticks per second, Hz, least_rate .. most_rate
  double speed_limit = 0;         ///< m/s; the runtime's limit of velocity, and the fastest that measuring explores
  /// N/s, on a pad m/s^3: how fast the output may move after an entry or a change. Above 0, but for a pad (`Stage::run`).
  double slew = 0;
  /// N per axis, the force that its motor bears indefinitely without overheating, and s, the time constant of its
  /// heating. Heating is proportional to the square of the force. 0: not declared.
  double continuous_newton = 0, heating_seconds = 0;
  double active_watt = 0;            ///< W, the most that a program may give to the hand by itself; 0: what it declares
  double velocity_window = 0;        ///< ticks; the longest window of the velocity filter
  double velocity_noise_counts = 0;  ///< counts; the band that the velocity filter treats as noise
  double patch_width = 0;            ///< m; the patch of a material that declares none
  double patch_height = 0;           ///< m
  double patch_rim = 0;              ///< m; the width over which a patch fades at its edge
  double mass = 0;                   ///< kg, moving mass at the handle; at 0 `GuardCounts::passivity` does not act
  double damping = 0;                ///< N s/m
  double friction = 0;               ///< N, Coulomb
  double delay_x = 0, delay_y = 0;   ///< s, from a sample to the force that answers it, besides the hold of one period
  /// Hz, per axis: the frequency at which the actuator, a first-order low-pass, has lost 3 dB of force; 0: no limit.
  double bandwidth_x = 0, bandwidth_y = 0;
  bool damping_known = false;   ///< it was measured; otherwise it is assumed, and no grade of evidence rests on it
  bool friction_known = false;  ///< the same for the friction
  /// Set for a device that vibrates: it has no force and, without a position, neither workspace nor counts.
  std::optional<Shaker> shaker;

  /// Metres per encoder count; 0 without a position.
  double position_step() const { return position_counts > 0 ? workspace_diameter / position_counts : 0; }
  /// The greatest side of a patch, and the greatest distance from its centre, m. Without a position, that of a picture.
  double widest_patch() const { return has_position() ? workspace_diameter : 10; }
  bool has_position() const { return !shaker || shaker->position != PositionSource::none; }
  /// Its peak output: N per axis, on a pad m/s^2.
  double most() const { return shaker ? shaker->peak() : force_newton; }
  /// Newtons per command step.
  double force_step() const { return force_newton / force_counts; }

  friend bool operator==(const DeviceProfile&, const DeviceProfile&) = default;
};

}  // namespace wale
