#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/truth/chance.hpp"

namespace wale::truth {

/// One period of a force or a height, over `t` in periods. The force is 0 in the mean and reaches 1.
struct Waveform {
  std::string name;
  std::function<std::string(const std::string& t)> force_text;
  std::function<double(double t)> force;
  /// A height whose slope is of the same kind, and that slope by turns.
  std::function<std::string(const std::string& t)> height_text;
  std::function<double(double t)> slope;
  /// A wave of which this one is the sum, if it has no fundamental of its own.
  struct Part {
    int number = 1;  ///< of its periods in one of the sum's
    std::function<double(double t)> force, slope;
  };
  std::vector<Part> parts = {};
};

Waveform sine();
Waveform square();
Waveform triangle();
Waveform sawtooth();
/// A narrow ridge of a raised cosine in `duty` of the period, flat ground between.
Waveform ridge(double duty);
/// The second and third harmonic without the first: it repeats after a period in which no sine fits once.
Waveform missing_fundamental(double third);
/// Gaussian bumps with a standard deviation of `width` periods, at most 0.1.
Waveform smooth_bumps(double width);
/// A sine with a quarter of its third harmonic, as the slope of `grating` has it.
Waveform smooth_ribs();
/// Any of those above, but the last.
Waveform any_waveform(Chance& chance);

/// The slope of `grating` by turns: Gaussians at its edges.
double grating_slope(double t, double duty, double smooth);

}  // namespace wale::truth
