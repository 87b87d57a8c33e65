#pragma once

#include <span>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/preview/exhibit.hpp"
#include "wale/program.hpp"

namespace wale {

/// The force on a simulated hand that goes along the exhibit's section, tick by tick.
struct FeltStroke {
  double rate = 0;            ///< Hz, of the device
  std::vector<float> forces;  ///< N, along the section
  std::vector<float> across;  ///< N, to the left of it
};

/// Moves the hand called `showing` (calibration/hands/hands.wale) to and fro along the section for some seconds and
/// runs the program's ticks, without guards. The path does not depend on the force. A part of a force that is not a
/// number counts as 0.
FeltStroke felt_along(Bank bank, const Exhibit& exhibit, const HandDeclaration* hand, double seconds = 2);

/// The amplitude of a signal about its mean, over frequency and time.
struct FeltSpectrum {
  std::vector<double> frequencies;  ///< Hz, from 0 to half the rate
  /// N, for each frequency: amplitude of a sine of the same power, averaged over all windows. The first has what is
  /// slower than the step from one frequency to the next, so that this makes no peak at a frequency of its own.
  std::vector<double> amplitudes;
  double seconds = 0;  ///< of the whole signal
  /// N: the amplitudes in each window, `frequencies.size()` of them, first window first.
  std::vector<std::vector<double>> windows;
};

/// Uses windows of about a seventh of a second (a power of two samples), each an eighth of its length after the one
/// before, with Hann's fade. A sine in the middle of a line has its own amplitude there; between two lines it has at
/// worst 15 % less (Harris 1978, Proceedings of the IEEE 66(1), table 1: 1.42 dB). The mean of the signal is removed.
FeltSpectrum spectrum_of(std::span<const float> signal, double rate);
/// The same of the whole force of a stroke: the power along the section and across it together.
FeltSpectrum spectrum_of(const FeltStroke& felt);

}  // namespace wale
