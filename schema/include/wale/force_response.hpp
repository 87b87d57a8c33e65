#pragma once

#include <array>

namespace wale {

/// The four ways in which a handle is pushed: along x to the right and to the left, along y away from the user and
/// toward them.
enum class Way { right, left, away, toward };

inline constexpr std::array all_ways{Way::right, Way::left, Way::away, Way::toward};

/// "right"
const char* in_words(Way way);
/// 0 for right and left, 1 for away and toward; and +1 for right and away, -1 for left and toward.
constexpr int axis_of(Way way) noexcept { return static_cast<int>(way) / 2; }
constexpr int sign_of(Way way) noexcept { return static_cast<int>(way) % 2 == 0 ? 1 : -1; }

/// How the force at the handle follows the command in one way, besides the axis's gain. A command of c newtons, less
/// the dead band, is u = max(0, c - dead_band) or, as a share of the device's force F, s = u / F. It gives
///
///     gain of the axis * gain * u * (1 + quadratic (s - 1) + cubic (s^2 - 1))
///
/// and no more than `most`. The bends are none at s = 0 and s = 1, so gains are those of the whole range.
struct ForceResponse {
  static constexpr double most_dead_band = 0.25;  ///< of the device's force
  static constexpr double most_bend = 1;          ///< size of `quadratic`, and of `cubic`
  static constexpr double least_slope = 0.1;      ///< of the gain, anywhere: every more in command gives more force
  static constexpr double least_most = 0.05;      ///< of the device's force

  double gain = 1;
  double dead_band = 0;  ///< N of command, 0 .. most_dead_band * F
  double quadratic = 0, cubic = 0;
  double most = 0;  ///< N at the handle; 0: the motor saturates nowhere

  /// The smallest slope of the bends within the device's force, as a share of the gain.
  double least_slope_of_bends() const noexcept;
  friend bool operator==(const ForceResponse&, const ForceResponse&) = default;
};

/// The force of one axis by its command, both ways. Real-time: no function allocates, locks, throws or makes a system
/// call.
class AxisResponse {
 public:
  static constexpr double most_offset = 0.1;  ///< of the device's force

  AxisResponse() = default;
  /// `gain`, N at the handle for each commanded N, and `peak`, N, the device's force and largest command, must be above
  /// zero. `offset`, N, is the force that the handle gets without any command.
  AxisResponse(double gain, const ForceResponse& forward, const ForceResponse& backward, double offset, double peak);

  /// Whether the force is the gain times the command and nothing else.
  bool is_plain() const noexcept { return is_plain_; }
  double gain() const noexcept { return gain_; }
  /// N at the handle for a command of any sign, N. Commands beyond the peak count as the peak.
  double force(double command) const noexcept;
  /// The command, N, for a force at the handle: none for none, and at most the peak. The offset is taken away in full
  /// from forces of at least twice its size, and in proportion from smaller ones, so that the command has no jump
  /// there. No-number gives no command.
  double command(double force) const noexcept;
  /// No force beside the offset exceeds this many N at the handle for each N of its command.
  double steepest() const noexcept;

 private:
  /// The force of a command from 0 to the peak, one way.
  double push(const ForceResponse& way, double command) const noexcept;
  double command_of(const ForceResponse& way, double force) const noexcept;
  double steepest_of(const ForceResponse& way) const noexcept;

  double gain_ = 1, offset_ = 0, peak_ = 1;
  ForceResponse forward_, backward_;
  bool is_plain_ = true;
};

}  // namespace wale
