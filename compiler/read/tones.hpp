#pragma once

#include <cstddef>
#include <vector>

namespace wale {

/// A line of a changing force's spectrum that stands out, and what repeats with it.
struct Tone {
  double amplitude = 0;  ///< N: of a sine with as much power as that line
  double frequency = 0;  ///< Hz
  bool shaped = false;   ///< whether other lines are its harmonics
};

/// The fundamentals of which a steady force is the sum, the slowest first; none if they are too many for that, or none
/// stands out. A line is a harmonic of a slower one if it is a multiple, as the ticks show it, and no stronger than
/// jumps or pulses make one. `powers` (N^2) are those of the lines under Hann's window, `rate` (Hz) is that of the
/// ticks.
std::vector<Tone> fundamentals_of(const std::vector<double>& powers, double seconds, double rate);

/// The multiple of a fundamental that a frequency (Hz) is, as ticks show it; 0 if it is none, or 1 if it is the same.
std::size_t multiple_of(double fundamental, double frequency, double seconds, double rate);

}  // namespace wale
