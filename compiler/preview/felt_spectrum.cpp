#include "compiler/preview/felt_spectrum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numeric>

#include "compiler/measure/strokes.hpp"
#include "compiler/read/fourier.hpp"
#include "compiler/read/window_spectrum.hpp"

namespace wale {
namespace {

constexpr double window_seconds = 1.0 / 7;
constexpr std::size_t steps_a_window = 8;
constexpr double turn = 6.283185307179586;

}  // namespace

FeltStroke felt_along(Bank bank, const Exhibit& exhibit, const HandDeclaration* hand, double seconds) {
  const DeviceProfile& device = bank.program().description().device;
  FeltStroke felt{.rate = device.rate > 0 ? device.rate : 1000, .forces = {}, .across = {}};
  double reach = room_to_stroke(bank.size()), frequency = 1;
  if (hand) {
    reach = std::min(reach, hand->lateral_amplitude);
    frequency = hand->lateral_frequency;
  }
  const auto place = [&](double time) {
    // It starts at rest at a turning point.
    return exhibit.through - exhibit.way * (reach * std::cos(turn * frequency * time));
  };
  Memory memory(bank.program());
  memory.enter(bank, hand_along(place, 0, 1 / felt.rate));
  const long ticks = std::lround(seconds * felt.rate);
  for (long i = 0; i < ticks; ++i) {
    const Force force = tick(bank, memory, hand_along(place, static_cast<double>(i) / felt.rate, 1 / felt.rate));
    const double along = force.x * exhibit.way.x + force.y * exhibit.way.y;
    const double across = force.y * exhibit.way.x - force.x * exhibit.way.y;
    felt.forces.push_back(std::isfinite(along) ? static_cast<float>(along) : 0);
    felt.across.push_back(std::isfinite(across) ? static_cast<float>(across) : 0);
  }
  return felt;
}

FeltSpectrum spectrum_of(std::span<const float> signal, double rate) {
  FeltSpectrum spectrum;
  spectrum.seconds = static_cast<double>(signal.size()) / rate;
  const auto wanted = static_cast<std::size_t>(std::max(8.0, window_seconds * rate));
  const std::size_t length = std::min(std::bit_floor(wanted), std::bit_floor(std::max<std::size_t>(signal.size(), 1)));
  if (length < 8) return spectrum;
  const std::vector<float> window = hann_window(length);
  const double gain = std::accumulate(window.begin(), window.end(), 0.0);
  const double mean = std::accumulate(signal.begin(), signal.end(), 0.0) / static_cast<double>(signal.size());
  const std::size_t lines = length / 2 + 1;
  for (std::size_t line = 0; line < lines; ++line)
    spectrum.frequencies.push_back(static_cast<double>(line) * rate / static_cast<double>(length));
  std::vector<double> squares(lines, 0.0);
  std::vector<std::complex<float>> part(length);
  for (std::size_t first = 0; first + length <= signal.size(); first += length / steps_a_window) {
    for (std::size_t i = 0; i < length; ++i) part[i] = static_cast<float>((signal[first + i] - mean) * window[i]);
    const Spectrum coefficients = fourier_of_line(part);
    std::vector<double>& amplitudes = spectrum.windows.emplace_back();
    for (std::size_t line = 0; line < lines; ++line) {
      const bool alone = line == 0 || 2 * line == length;  // this line has no mirror image
      amplitudes.push_back((alone ? 1 : 2) * std::abs(coefficients[line]) / gain);
      squares[line] += amplitudes.back() * amplitudes.back();
    }
  }
  // A sine that is slower than a step is in the first line, by as much as it is off its mean in each window.
  squares.front() *= 2;
  for (const double square : squares)
    spectrum.amplitudes.push_back(std::sqrt(square / static_cast<double>(spectrum.windows.size())));
  return spectrum;
}

FeltSpectrum spectrum_of(const FeltStroke& felt) {
  FeltSpectrum whole = spectrum_of(felt.forces, felt.rate);
  const FeltSpectrum across = spectrum_of(felt.across, felt.rate);
  const auto add = [](std::vector<double>& sum, const std::vector<double>& other) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = std::hypot(sum[i], other[i]);
  };
  add(whole.amplitudes, across.amplitudes);
  for (std::size_t i = 0; i < whole.windows.size(); ++i) add(whole.windows[i], across.windows[i]);
  return whole;
}

}  // namespace wale
