#include "compiler/read/swing_course.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/read/fourier.hpp"
#include "compiler/read/relief_figures.hpp"
#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr double shortest_piece = 1.0 / 32;  // s, and no less than a period
constexpr std::size_t fewest_pieces = 4;
constexpr double at_an_end = 0.06;     // of the time: there is what fades greatest, or what grows
constexpr double not_looked_at = 0.03;  // of the time, at the other end: the transform joins both
constexpr double hardly_back = 1.2, nearly_gone = 0.05;  // of the least before, and of the greatest
constexpr double half_left = 0.5, tenth_left = 0.1;
constexpr double shortest_even = 0.5;  // s
constexpr double nearly_none = 2e-3;   // of the power within a band
constexpr double but_for_ringing = 0.9995;  // of the time: longer than the overshoot of what begins at once
constexpr double hardly_more = 1.2;    // times as strong as at its end: what stays as it is does so, but for ringing

/// A force within a band, and how strong it is about each moment: the size of its analytic signal.
struct Band {
  std::vector<Force> forces;
  std::vector<double> strengths;
  double period = 0;  ///< ticks: of its strongest line
};

Band within_band(const std::vector<std::complex<float>>& changes, std::size_t first, std::size_t end) {
  const std::size_t count = changes.size();
  const Spectrum spectrum = fourier_of_line(changes);
  Spectrum x(count), y(count);
  // Where next to nothing lies outside, a sharp border would only ring.
  double below = 0, inside = 0, above = 0;
  for (std::size_t i = 1; i < (count + 1) / 2; ++i)
    (i < first ? below : i < end ? inside : above) += std::norm(spectrum[i]) + std::norm(spectrum[count - i]);
  if (below < nearly_none * inside) first = 1;
  if (above < nearly_none * inside) end = count;
  double strongest = 0;
  std::size_t line = first;
  for (std::size_t i = std::max<std::size_t>(first, 1); i < std::min(end, (count + 1) / 2); ++i) {
    const std::complex<float> one = spectrum[i], mirror = std::conj(spectrum[count - i]);
    // The transform back is that of the conjugate.
    x[i] = std::conj(one + mirror), y[i] = std::conj(std::complex<float>(0, -1) * (one - mirror));
    if (const double power = std::norm(x[i]) + std::norm(y[i]); power > strongest) strongest = power, line = i;
  }
  const Spectrum along_x = fourier_of_line(x), along_y = fourier_of_line(y);
  Band band;
  const auto scale = 1 / static_cast<float>(count);
  for (std::size_t i = 0; i < count; ++i) {
    band.forces.emplace_back(along_x[i].real() * scale, along_y[i].real() * scale);
    band.strengths.push_back(std::sqrt(std::norm(along_x[i]) + std::norm(along_y[i])) * scale);
  }
  band.period = static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(line, 1));
  return band;
}

/// The moment (in pieces) at which a course falls below a level on its way down; its end if it never does.
double falls_below(const std::vector<double>& course, double level) {
  for (std::size_t i = 0; i < course.size(); ++i) {
    if (course[i] >= level) continue;
    if (i == 0) return 0.5;
    const double above = std::log(std::max(course[i - 1], 1e-12)), below = std::log(std::max(course[i], 1e-12));
    return static_cast<double>(i) - 0.5 + (above - std::log(level)) / std::max(above - below, 1e-12);
  }
  return static_cast<double>(course.size());
}

/// Whether a course is about greatest at its beginning, hardly rises from there on, and is less than half of that in the end.
bool dies_away(const std::vector<double>& course) {
  const auto counted = static_cast<std::size_t>((1 - not_looked_at) * static_cast<double>(course.size()));
  const auto end = course.begin() + static_cast<std::ptrdiff_t>(counted);
  const auto early = static_cast<std::ptrdiff_t>(std::max(2.0, at_an_end * static_cast<double>(counted)));
  const auto greatest = std::max_element(course.begin(), course.begin() + early);
  if (*std::max_element(course.begin(), end) > hardly_more * *greatest) return false;
  double least = *greatest;
  for (auto each = greatest; each != end; ++each) {
    if (*each > hardly_back * least + nearly_gone * *greatest) return false;
    least = std::min(least, *each);
  }
  return *(end - 1) < half_left * *greatest;
}

}  // namespace

std::optional<UnsteadySwing> unsteady_swing(const std::vector<std::complex<float>>& changes, double rate,
                                            double slowest, double fastest) {
  const double seconds = static_cast<double>(changes.size()) / rate;
  const Band band = within_band(changes, static_cast<std::size_t>(std::lround(slowest * seconds)),
                            static_cast<std::size_t>(std::lround(fastest * seconds)));
  const auto piece = static_cast<std::size_t>(std::lround(std::max(band.period, shortest_piece * rate)));
  const std::size_t pieces = changes.size() / std::max<std::size_t>(1, piece);
  if (pieces < fewest_pieces) return std::nullopt;
  std::vector<double> course(pieces, 0.0);
  for (std::size_t i = 0; i < pieces * piece; ++i)
    course[i / piece] += band.strengths[i] / static_cast<double>(piece);
  const bool fades = dies_away(course);
  std::vector<double> turned(course.rbegin(), course.rend());
  if (fades == dies_away(turned)) return std::nullopt;
  UnsteadySwing found;
  std::vector<double> sizes;
  for (const Force& force : band.forces) sizes.push_back(glm::length(force));
  found.amplitude = percentile(sizes, percentile_of_amplitude);
  found.course.grows = !fades;
  // At the other end of the time is the transform's own ringing.
  const auto left_out = static_cast<std::ptrdiff_t>(not_looked_at * static_cast<double>(sizes.size()));
  const auto begin = fades ? sizes.begin() : sizes.begin() + left_out;
  found.course.greatest = percentile({begin, begin + (sizes.end() - sizes.begin() - left_out)}, but_for_ringing);
  const std::vector<double>& down = fades ? course : turned;
  const double most = *std::ranges::max_element(down), length = static_cast<double>(piece) / rate;
  const double half = falls_below(down, half_left * most) * length, tenth = falls_below(down, tenth_left * most);
  const bool ends = tenth < static_cast<double>(pieces);
  found.course.half_after = fades ? half : static_cast<double>(pieces) * length - half;
  found.course.tenth_after = !ends   ? 0
                             : fades ? tenth * length
                                     : (static_cast<double>(pieces) - tenth) * length;
  const auto there = static_cast<std::size_t>(std::min(tenth * static_cast<double>(piece),
                                                       static_cast<double>(pieces * piece)));
  if (static_cast<double>(there) < shortest_even * rate) return found;
  const std::size_t first = fades ? 0 : pieces * piece - there;
  for (std::size_t i = first; i < first + there; ++i) {
    // Between the middles of the pieces, in proportion.
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(piece) - 0.5;
    const double inside = std::clamp(at, 0.0, static_cast<double>(pieces - 1));
    const auto before = static_cast<std::size_t>(inside), after = std::min(before + 1, pieces - 1);
    const double strength = std::lerp(course[before], course[after], inside - static_cast<double>(before));
    found.even.push_back(band.forces[i] * static_cast<float>(most / std::max(strength, nearly_gone * most)));
  }
  return found;
}

}  // namespace wale
