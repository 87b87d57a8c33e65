#include <algorithm>

#include "compiler/read/fundamental.hpp"
#include "compiler/read/waves.hpp"

namespace wale {
namespace {

constexpr double counts_as_there = 0.004;  // of a wave's mean square, in one of its harmonics
constexpr double counts_as_wave = 0.01;    // in a wave of its own and its harmonics
constexpr std::size_t far_off = 4;         // the first harmonic that a waveform hardly has without those between

}  // namespace

std::size_t fine_wave(const std::vector<double>& powers) {
  if (powers.empty() || powers[0] < counts_as_there) return 0;
  std::size_t below = 0;  // the highest harmonic of the coarse wave
  for (std::size_t fine = 1; fine <= powers.size(); ++fine) {
    if (powers[fine - 1] < counts_as_there) continue;
    if (below > 0 && fine >= 2 * below) {
      double family = 0;
      bool others = false;
      for (std::size_t i = fine; i <= powers.size(); ++i) {
        if (i % fine == 0)
          family += powers[i - 1];
        else
          others = others || powers[i - 1] >= counts_as_there;
      }
      const bool apart = fine >= far_off && fine > 2 * below;
      if (!others && (family > 0.5 || (apart && family >= counts_as_wave))) return fine;
    }
    below = fine;
  }
  return 0;
}

std::vector<WavePart> parts_of(const FoundWave& wave) {
  const std::vector<double> powers = harmonics_of(wave.wave, wave.wave.profile.size() / 2);
  std::vector<WavePart> parts;
  if (wave.parts.size() > 1) {
    for (const std::size_t number : wave.parts) parts.push_back({number, 0});
  } else if (const std::size_t fine = fine_wave(powers); fine > 0) {
    parts = {{fine, 0}, {1, 0}};
  } else {
    return {{}};
  }
  double sum = 0;
  for (std::size_t harmonic = 1; harmonic <= powers.size(); ++harmonic) {
    const auto part = std::ranges::find_if(parts, [&](const WavePart& each) { return harmonic % each.number == 0; });
    if (part != parts.end()) part->share += powers[harmonic - 1], sum += powers[harmonic - 1];
  }
  for (WavePart& part : parts) part.share = sum > 0 ? part.share / sum : 1 / static_cast<double>(parts.size());
  std::ranges::sort(parts, std::ranges::greater{}, &WavePart::share);
  return parts;
}

}  // namespace wale
