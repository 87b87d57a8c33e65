#include "compiler/preview/spectrum_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/drawing/plot.hpp"
#include "compiler/drawing/style.hpp"

namespace wale {
namespace {

/// The share of the power above the shown frequencies is at most this.
constexpr double unseen_power = 0.002;
constexpr double least_lines = 8;

/// The highest frequency of both panels, Hz.
double highest_shown(const FeltSpectrum& spectrum) {
  double whole = 0, sum = 0;
  for (const double amplitude : spectrum.amplitudes) whole += amplitude * amplitude;
  std::size_t line = 0;
  while (line + 1 < spectrum.frequencies.size() && sum < (1 - unseen_power) * whole) {
    sum += spectrum.amplitudes[line] * spectrum.amplitudes[line];
    ++line;
  }
  const double width = spectrum.frequencies[1];
  return std::min(spectrum.frequencies.back(), std::max(1.15 * spectrum.frequencies[line], least_lines * width));
}

/// Interpolates for a pixel between two windows and two frequencies.
double amplitude_at(const FeltSpectrum& spectrum, double window, double line) {
  const auto between = [](std::size_t count, double at) {
    const double low = std::clamp(std::floor(at), 0.0, static_cast<double>(count - 1));
    return std::pair(static_cast<std::size_t>(low), std::clamp(at - low, 0.0, 1.0));
  };
  const auto [early, later_share] = between(spectrum.windows.size(), window);
  const auto [lower, upper_share] = between(spectrum.frequencies.size(), line);
  const std::size_t late = std::min(early + 1, spectrum.windows.size() - 1);
  const std::size_t upper = std::min(lower + 1, spectrum.frequencies.size() - 1);
  const auto of = [&, lower = lower, share = upper_share](const std::vector<double>& amplitudes) {
    return amplitudes[lower] + share * (amplitudes[upper] - amplitudes[lower]);
  };
  return of(spectrum.windows[early]) + later_share * (of(spectrum.windows[late]) - of(spectrum.windows[early]));
}

/// From paper over the colour of forces to ink.
Colour shade_of(double share) {
  const auto part = static_cast<float>(std::sqrt(std::clamp(share, 0.0, 1.0)));  // so that weak components are visible
  return part < 0.7f ? mixed(style::field_weak, style::force, part / 0.7f)
                     : mixed(style::force, style::ink, (part - 0.7f) / 0.3f);
}

}  // namespace

void draw_spectrum(Canvas& canvas, const PageBox& box, const FeltSpectrum& spectrum, const std::string& way) {
  const double highest = highest_shown(spectrum);
  Plot plot;
  plot.title = fmt::format("Spectrum of the whole force, hand stroking along {}", way);
  plot.x_name = "frequency";
  plot.x_notation = {fmt::format("Hz, in steps of {} Hz", shown_number(spectrum.frequencies[1])), 1};
  Profile profile;
  for (std::size_t i = 0; i < spectrum.frequencies.size() && spectrum.frequencies[i] <= highest; ++i) {
    profile.at.push_back(spectrum.frequencies[i]);
    profile.values.push_back(spectrum.amplitudes[i]);
  }
  plot.y_notation = force_notation(*std::max_element(profile.values.begin(), profile.values.end()));
  plot.curves = {{std::move(profile), style::force, ""}};
  plot.shaded = true;
  draw_plot(canvas, box, plot);
}

void draw_spectrogram(Canvas& canvas, const PageBox& box, const FeltSpectrum& spectrum) {
  const double highest = highest_shown(spectrum);
  double strongest = 0;
  for (const auto& window : spectrum.windows)
    for (const double amplitude : window) strongest = std::max(strongest, amplitude);
  const auto columns = static_cast<std::size_t>(std::lround(box.width() * Canvas::fineness));
  const auto rows = static_cast<std::size_t>(std::lround(box.height() * Canvas::fineness));
  std::vector<Colour> pixels;
  pixels.reserve(columns * rows);
  // The first and the last window reach the ends of the stroke; a window is drawn at its middle.
  const double half_window = 0.5 / spectrum.frequencies[1];
  const double apart = spectrum.windows.size() > 1
                           ? (spectrum.seconds - 2 * half_window) / static_cast<double>(spectrum.windows.size() - 1)
                           : 1;
  for (std::size_t row = 0; row < rows; ++row) {
    const double frequency = (1 - (static_cast<double>(row) + 0.5) / static_cast<double>(rows)) * highest;
    for (std::size_t column = 0; column < columns; ++column) {
      const double time = (static_cast<double>(column) + 0.5) / static_cast<double>(columns) * spectrum.seconds;
      const double amplitude =
          amplitude_at(spectrum, (time - half_window) / apart, frequency / spectrum.frequencies[1]);
      pixels.push_back(shade_of(strongest > 0 ? amplitude / strongest : 0));
    }
  }
  canvas.place(box, pixels);
  canvas.write({box.left, box.top - 16}, "Spectrogram of the whole force", style::heading);
  canvas.write({box.right, box.top - 16},
               fmt::format("darkest {} about its mean", shown_quantity(strongest, force_notation(strongest))), style::label,
               Align::right);
  for (const Tick& tick : round_ticks(0, highest, 5)) {
    const double at = box.bottom - tick.at / highest * box.height();
    canvas.line({box.left - 5, at}, {box.left, at}, {1, style::quiet});
    canvas.write({box.left - 12, at + 5.5}, tick.label, style::label, Align::right);
  }
  canvas.write({box.left - 12, box.top - 16}, "Hz", style::label, Align::right);
  for (const Tick& tick : round_ticks(0, spectrum.seconds, 8)) {
    const double at = box.left + tick.at / spectrum.seconds * box.width();
    canvas.line({at, box.bottom}, {at, box.bottom + 5}, {1, style::quiet});
    canvas.write({at, box.bottom + 24}, tick.label, style::label, Align::centre);
  }
  canvas.write({box.right, box.bottom + 49}, "time, s", style::label, Align::right);
  canvas.outline(box, {1, style::rule});
}

}  // namespace wale
