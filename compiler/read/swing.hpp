#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "compiler/read/at_rest.hpp"
#include "wale/program.hpp"

namespace wale {

/// How a swing dies away, or grows, while a hand holds still.
struct SwingCourse {
  bool grows = false;      ///< it grows; otherwise it dies away
  double greatest = 0;     ///< N: its size at first, or in the end
  double half_after = 0;   ///< s: half of that is left, or there
  double tenth_after = 0;  ///< s: a tenth is left, or there; 0 if more is at all times
};

/// One of the swings of which a changing force is the sum, with its harmonics.
struct SwingPart {
  double amplitude = 0;  ///< N: as of `Swing`
  double frequency = 0;  ///< Hz
};

/// A changing force on a hand that holds still.
struct Swing {
  double amplitude = 0;  ///< N: the 99th percentile of its size, as the amplitude of a relief is defined
  double frequency = 0;  ///< Hz: of its strongest component; 0 if the force does not swing, or no one stands out
  bool noise = false;    ///< it changes without a rate
  double middle = 0;     ///< Hz: of a noise, whose power is half below
  /// rad in [0, pi): along which it swings; nothing if it swings about as much across
  std::optional<double> axis{};
  /// N: about the amplitude at the place where it is least; nothing if that is more than half of the greatest
  std::optional<double> least{};
  std::optional<SwingCourse> course{};  ///< nothing of one that stays as it is, or comes and goes
  /// 1/s: of the size of one that dies away (negative) or grows by an exponential and is all that changes; otherwise 0.
  double rate_of_change = 0;
  /// The swings of which it is the sum, the strongest first; none if it is one, or a sum of too many.
  std::vector<SwingPart> parts{};

  /// N: of all parts but the strongest together, as one of so much power; 0 without parts.
  double beside_strongest() const;
  /// Hz: of the second strongest part; 0 without parts.
  double next_rate() const { return parts.size() > 1 ? parts[1].frequency : 0; }
  /// N: the greatest size of one that dies away, with the other sign of one that grows; 0 if it stays as it is.
  double change() const { return !course ? 0 : course->grows ? -course->greatest : course->greatest; }
};

/// Below this frequency (Hz) a swing is a sway, which the hand follows; above it is a vibration.
inline constexpr double slowest_vibration = 10;

/// Tells the swings of the forces on resting hands (`felt_at_rest`), at the place where they change most, be it another
/// one. A force that only rises or falls does not swing.
void tell_swings(const Bank& bank, const std::vector<std::vector<Force>>& at_rest, Swing& sway, Swing& vibration);

}  // namespace wale
