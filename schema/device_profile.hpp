#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wale {

/// Where a vibrating pad knows the hand's place from.
enum class PositionSource : std::uint8_t {
  none = 0,     ///< nowhere: what a material has in places is lost
  pointer = 1,  ///< a mouse or another pointer, in the hand or beside it
  touch = 2,    ///< the finger on it
};

/// What a pad or gamepad does instead of pushing: it shakes along one axis, so strongly and so often a second.
struct Shaker {
  /// At one frequency the acceleration that a command gives, both more than nothing; a command of 0 gives none.
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
  double command_steps = 0;                      ///< from no command to the full one; 0: as fine as one likes
  double spin_up = 0;                            ///< s, in which it comes 63 % nearer to what is commanded
  double exploring_speed = 0;      ///< m/s, of the hand that is taken to explore where there is no position
  std::vector<Response> response;  ///< frequencies rising

  /// The greatest acceleration at any frequency, m/s^2.
  double peak() const;
  /// The acceleration of a command at a frequency and the command of an acceleration, the full one where it would take
  /// more: straight lines between the declared points, and the nearest frequency beyond the first and the last.
  double acceleration(double command, double frequency) const noexcept;
  double command(double acceleration, double frequency) const noexcept;

  friend bool operator==(const Shaker&, const Shaker&) = default;
};

/// A two-axis joystick, or a pad that only vibrates, as its `device` declaration describes it; SI units throughout.
/// Zero means "not declared" where a zero makes no sense.
struct DeviceProfile {
  static constexpr double least_rate = 100, most_rate = 10000;  ///< Hz, of any device's control ticks
  static constexpr double least_heating_seconds = 1e-3;         ///< s; what heats faster is no motor

  std::string name;
  double workspace_diameter = 0;  ///< m
  double position_counts = 0;     ///< encoder counts over the workspace's diameter, per axis
  double force_newton = 0;        ///< peak force per axis, N
  double force_counts = 0;        ///< command steps from zero to peak force
  double rate = 0;                ///< control ticks per second, Hz, least_rate .. most_rate
  double speed_limit = 0;         ///< m/s; what the runtime clamps velocity to and measuring explores up to
  /// N/s, of a pad m/s^3: how fast the output may move after a change of program, bank or patch.
  double slew = 0;
  /// N per axis, what its motor bears for any length of time without growing too hot, and s, the time constant of its
  /// heating, which goes with the square of the force; 0: not declared.
  double continuous_newton = 0, heating_seconds = 0;
  double active_watt = 0;            ///< W, the most that a program may give to the hand by itself
  double velocity_window = 0;        ///< ticks; the longest window of the velocity filter
  double velocity_noise_counts = 0;  ///< counts; the band the velocity filter takes for noise
  double patch_width = 0;            ///< m; the patch a material gets that does not say
  double patch_height = 0;           ///< m
  double patch_rim = 0;              ///< m; over which a patch fades at its edge
  double mass = 0;                   ///< kg, moving mass at the handle
  double damping = 0;                ///< N s/m
  double friction = 0;               ///< N, Coulomb
  double delay_x = 0, delay_y = 0;   ///< s, from a sample to the force that answers it, beyond the period it is held
  /// Hz, of each axis: where the actuator, taken for a first-order low-pass, has 3 dB less force; 0: it has them all.
  double bandwidth_x = 0, bandwidth_y = 0;
  bool damping_known = false;   ///< somebody measured it; otherwise it is assumed and no grade leans on it
  bool friction_known = false;  ///< the same of the friction
  /// Of a device that vibrates and does not push: then it has no force, and without a position neither workspace nor
  /// counts.
  std::optional<Shaker> shaker;

  /// Metres per encoder count; 0 without a position.
  double position_step() const { return position_counts > 0 ? workspace_diameter / position_counts : 0; }
  /// The widest side that a patch may have and how far a place may be from its centre, m: without a position those of a
  /// picture.
  double widest_patch() const { return has_position() ? workspace_diameter : 10; }
  bool has_position() const { return !shaker || shaker->position != PositionSource::none; }
  /// The most that it puts out: N per axis, of a pad m/s^2.
  double most() const { return shaker ? shaker->peak() : force_newton; }
  /// Newtons per command step.
  double force_step() const { return force_newton / force_counts; }

  friend bool operator==(const DeviceProfile&, const DeviceProfile&) = default;
};

}  // namespace wale
