// The spectrum of the felt force, against sines and strokes with known frequencies.

#include "compiler/preview/felt_spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "compiler/modules/load_modules.hpp"
#include "tests/preview/hand_made.hpp"

namespace wale::felt_spectrum_test {
namespace {

std::vector<float> sine(double amplitude, double frequency, double rate, double seconds, double offset = 0) {
  std::vector<float> signal;
  for (long i = 0; i < std::lround(seconds * rate); ++i)
    signal.push_back(static_cast<float>(
        offset + amplitude * std::sin(2 * std::numbers::pi * frequency * static_cast<double>(i) / rate + 0.3)));
  return signal;
}

std::size_t strongest(const std::vector<double>& amplitudes) {
  return static_cast<std::size_t>(std::max_element(amplitudes.begin(), amplitudes.end()) - amplitudes.begin());
}

TEST(FeltSpectrum, HasASineAtItsFrequencyWithItsAmplitude) {
  for (const double rate : {900.0, 4000.0}) {
    for (const double line : {10.0, 37.0, 10.5}) {
      const double width = spectrum_of(sine(1, 100, rate, 2), rate).frequencies[1];
      const FeltSpectrum spectrum = spectrum_of(sine(1.5, line * width, rate, 2, 3), rate);
      EXPECT_NEAR(spectrum.frequencies.back(), rate / 2, 1e-9);
      EXPECT_NEAR(spectrum.seconds, 2, 1e-9);
      const std::size_t top = strongest(spectrum.amplitudes);
      EXPECT_NEAR(spectrum.frequencies[top], line * width, 0.51 * width);
      // Halfway between two lines Hann's window has 1.42 dB less, a factor of 0.849.
      const double share = line == std::floor(line) ? 1 : 0.849;
      EXPECT_NEAR(spectrum.amplitudes[top], 1.5 * share, 0.003 * 1.5);
      for (std::size_t i = 0; i < spectrum.amplitudes.size(); ++i) {
        if (std::abs(spectrum.frequencies[i] - line * width) < 4 * width) continue;
        EXPECT_LT(spectrum.amplitudes[i], 0.01 * 1.5) << spectrum.frequencies[i];
      }
    }
  }
}

TEST(FeltSpectrum, ShowsWhenAFrequencyOccurs) {
  std::vector<float> signal = sine(1, 100, 900, 1);
  const std::vector<float> after = sine(1, 300, 900, 1);
  signal.insert(signal.end(), after.begin(), after.end());
  const FeltSpectrum spectrum = spectrum_of(signal, 900);
  ASSERT_GT(spectrum.windows.size(), 20u);
  const double width = spectrum.frequencies[1];
  EXPECT_NEAR(spectrum.frequencies[strongest(spectrum.windows.front())], 100, width);
  EXPECT_NEAR(spectrum.frequencies[strongest(spectrum.windows.back())], 300, width);
}

// What is slower than the step between two frequencies has no peak of its own.
TEST(FeltSpectrum, ASlowForceIsInTheFirstLine) {
  for (const double frequency : {0.6, 1.2, 2.4}) {
    const FeltSpectrum spectrum = spectrum_of(sine(1.5, frequency, 900, 5), 900);
    EXPECT_EQ(strongest(spectrum.amplitudes), 0u) << frequency;
    EXPECT_NEAR(spectrum.amplitudes[0], 1.5, 0.3) << frequency;
    EXPECT_TRUE(std::ranges::is_sorted(spectrum.amplitudes.begin(), spectrum.amplitudes.begin() + 5, std::greater()));
  }
}

// A force may push across the way of the hand, or along and across it at different rates.
TEST(FeltSpectrum, OfAStrokeHasTheWholeForce) {
  const auto amplitude = [](const FeltSpectrum& spectrum, double frequency) {
    return spectrum.amplitudes[static_cast<std::size_t>(std::lround(frequency / spectrum.frequencies[1]))];
  };
  const double rate = 900, width = spectrum_of(sine(1, 100, rate, 2), rate).frequencies[1];
  const double slow = 5 * width, quick = 14 * width;
  const std::vector<float> none(1800, 0.0f);
  const FeltSpectrum both = spectrum_of({rate, sine(0.5, slow, rate, 2), sine(0.4, quick, rate, 2)});
  EXPECT_NEAR(amplitude(both, slow), 0.5, 0.01);
  EXPECT_NEAR(amplitude(both, quick), 0.4, 0.01);
  EXPECT_NEAR(amplitude(spectrum_of({rate, none, sine(0.4, quick, rate, 2)}), quick), 0.4, 0.01);
  // Two that are as strong at one rate have twice the power of one.
  const std::vector<float> one = sine(1, slow, rate, 2);
  EXPECT_NEAR(amplitude(spectrum_of({rate, one, one}), slow), std::sqrt(2.0), 0.01);
  const FeltStroke across = felt_along(sine_grating(0.004f, 1), {.through = {0.0005, 0}, .way = {0, 1}},
                                       common_modules()->declarations.hands.find("showing"));
  EXPECT_NEAR(*std::ranges::max_element(across.forces), 0, 1e-6) << "it pushes across a stroke along its ribs";
  EXPECT_GT(std::abs(across.across.front()), 0.001);
}

TEST(FeltSpectrum, OfTooShortASignalIsEmpty) {
  EXPECT_TRUE(spectrum_of({}, 900).windows.empty());
  EXPECT_TRUE(spectrum_of(sine(1, 100, 900, 0.005), 900).windows.empty());
}

// At speed v a grating of period p is felt at v / p. The hand is fastest at the centre of its stroke, with v = 2 pi f
// A.
TEST(FeltSpectrum, AGratingIsFeltAtSpeedOverPeriod) {
  const float period = 0.004f;
  const Bank bank = sine_grating(period, 1);
  const FeltStroke felt = felt_along(bank, exhibit_of(bank), common_modules()->declarations.hands.find("showing"));
  EXPECT_EQ(felt.rate, 900);
  EXPECT_EQ(felt.forces.size(), 1800u);
  const FeltSpectrum spectrum = spectrum_of(felt.forces, felt.rate);
  // `showing` strokes 48 mm at 1.2 Hz, but the patch allows only 0.9 (40 mm - 2 mm).
  const double reach = 0.9 * (0.04 - 0.002), fastest = 2 * std::numbers::pi * 1.2 * reach / period;
  double below = 0, beyond = 0;
  for (std::size_t i = 0; i < spectrum.frequencies.size(); ++i) {
    double& sum = spectrum.frequencies[i] < fastest + 2 * spectrum.frequencies[1] ? below : beyond;
    sum += spectrum.amplitudes[i] * spectrum.amplitudes[i];
  }
  EXPECT_LT(beyond, 0.01 * below);
  const double top = spectrum.frequencies[strongest(spectrum.amplitudes)];
  EXPECT_GT(top, 0.75 * fastest) << "a sinusoidal stroke spends most time near its highest speed";
  EXPECT_LT(top, fastest + spectrum.frequencies[1]);
}

}  // namespace
}  // namespace wale::felt_spectrum_test
