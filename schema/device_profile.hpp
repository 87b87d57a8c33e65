#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wale {

/// The source of the hand's position on a vibrating pad.
enum class PositionSource : std::uint8_t {
  none = 0,     ///< no position: a material's differences from place to place are lost
  pointer = 1,  ///< a mouse or another pointer, in the hand or beside it
  touch = 2,    ///< the finger on it
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
  double frequency_low = 0, frequency_high = 0;  ///< Hz; it shakes at no others
  double command_steps = 0;                      ///< from no command to the full one; 0: continuous
  double spin_up = 0;                            ///< s, in which it makes up 63 % of the difference to a command
  double exploring_speed = 0;                    ///< m/s, the assumed speed of the hand where there is no position
  std::vector<Response> response;                ///< frequencies rising

  /// The greatest acceleration at any frequency, m/s^2.
  double peak() const;
  /// The acceleration (m/s^2) of a command (0 .. 1) at a frequency (Hz), and the command of an acceleration, at most 1.
  /// Linear between the declared points; beyond the first or last frequency, that of the first or last. Real-time.
  double acceleration(double command, double frequency) const noexcept;
  double command(double acceleration, double frequency) const noexcept;

  friend bool operator==(const Shaker&, const Shaker&) = default;
};

/// A two-axis joystick, or a pad that only vibrates, as its `device` declaration describes it; SI units throughout.
/// Zero means "not declared" where a zero makes no sense.
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
  /// N/s, of a pad m/s^3: how fast the output may move after a change of program, bank or patch.
  double slew = 0;
  /// N per axis, which its motor bears indefinitely without overheating, and s, the time constant of its heating, which
  /// follows the square of the force; 0: not declared.
  double continuous_newton = 0, heating_seconds = 0;
  double active_watt = 0;            ///< W, the most that a program may give to the hand by itself
  double velocity_window = 0;        ///< ticks; the longest window of the velocity filter
  double velocity_noise_counts = 0;  ///< counts; the band that the velocity filter treats as noise
  double patch_width = 0;            ///< m; the patch of a material that declares none
  double patch_height = 0;           ///< m
  double patch_rim = 0;              ///< m; over which a patch fades at its edge
  double mass = 0;                   ///< kg, moving mass at the handle
  double damping = 0;                ///< N s/m
  double friction = 0;               ///< N, Coulomb
  double delay_x = 0, delay_y = 0;   ///< s, from a sample to the force that answers it, beyond the period it is held
  /// Hz, of each axis: where the actuator, modelled as a first-order low-pass, has lost 3 dB of force; 0: no limit.
  double bandwidth_x = 0, bandwidth_y = 0;
  bool damping_known = false;   ///< it was measured; otherwise it is assumed, and no grade rests on it
  bool friction_known = false;  ///< the same for the friction
  /// Set for a device that vibrates: it has no force and, without a position, neither workspace nor counts.
  std::optional<Shaker> shaker;

  /// Metres per encoder count; 0 without a position.
  double position_step() const { return position_counts > 0 ? workspace_diameter / position_counts : 0; }
  /// The widest side of a patch, and the farthest place from its centre, m; without a position that of a picture.
  double widest_patch() const { return has_position() ? workspace_diameter : 10; }
  bool has_position() const { return !shaker || shaker->position != PositionSource::none; }
  /// Its peak output: N per axis, of a pad m/s^2.
  double most() const { return shaker ? shaker->peak() : force_newton; }
  /// Newtons per command step.
  double force_step() const { return force_newton / force_counts; }

  friend bool operator==(const DeviceProfile&, const DeviceProfile&) = default;
};

}  // namespace wale
