#pragma once

#include <span>
#include <vector>

#include "compiler/preview/exhibit.hpp"
#include "wale/program.hpp"

namespace wale {

/// What a simulated hand feels along the exhibit's section, tick by tick.
struct FeltStroke {
  double rate = 0;            ///< Hz, of the device
  std::vector<float> forces;  ///< N, along the section
};

/// The hand called `showing` (calibration/hands/hands.wale) goes to and fro along the section for two seconds, on its path
/// and whatever the force, through the program's own ticks, guarded by nothing. A force that is no number is none.
FeltStroke felt_along(Bank bank, const Exhibit& exhibit);

/// How strong a signal is at each frequency, and when.
struct FeltSpectrum {
  std::vector<double> frequencies;  ///< Hz, from 0 to half the rate
  std::vector<double> amplitudes;   ///< N, beside them: of a sine that is as strong, in the mean over all windows
  double seconds = 0;               ///< of the whole signal
  /// N: the amplitude in each window, `frequencies.size()` of them for each, the first window first.
  std::vector<std::vector<double>> windows;
};

/// Windows of a seventh of a second or what comes next to it as a power of two, each an eighth of its length after the
/// one before, faded by Hann's window. A sine in the middle of a line has its own amplitude there, and at worst,
/// between two lines, 15 % less (Harris 1978, Proceedings of the IEEE 66(1), table 1: 1.42 dB). The signal's mean is
/// taken away.
FeltSpectrum spectrum_of(std::span<const float> signal, double rate);

}  // namespace wale
