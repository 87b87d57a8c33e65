#include "compiler/read/swing.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/fading_swing.hpp"
#include "compiler/read/fourier.hpp"
#include "compiler/read/relief_figures.hpp"
#include "compiler/read/slow_change.hpp"
#include "compiler/read/swing_course.hpp"
#include "compiler/read/tones.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/window_spectrum.hpp"

namespace wale {
namespace {

constexpr std::size_t fewest_swings = 3;  // over that time; slower changes are a drift
constexpr std::size_t most_harmonic = 8;
constexpr double of_the_strongest = 0.2;  // line's power, in a fundamental
constexpr double above_the_usual = 10;    // times the median line of a band
constexpr double stands_out = 0.25;       // of a peak's power, at most this is three lines before it
constexpr double most_of_power = 0.7;
constexpr std::size_t most_lines = 24;   // of the spectrum, three for each rate, in what has rates
constexpr std::size_t fewest_apart = 8;  // lines between the harmonics of what is no noise
constexpr double no_swing = 1e-5;        // N
constexpr double same_rate = 0.02;
constexpr double plainly_less = 0.5;     // of the greatest, where it is least
constexpr double beats_of_ticks = 0.05;  // of a vibration's power, below its band: the rate of the ticks is no multiple
constexpr double pure = 0.995;           // of the power: a sine has as much in the lines around its own
constexpr double missed = 1.2;           // most that the ticks of a sine may miss of its peak: at three a period, 1.155

/// Forces as changes, without their mean and their drift: a parabola in time.
std::vector<std::complex<float>> without_drift(const std::vector<Force>& forces) {
  const auto count = static_cast<double>(forces.size());
  // Legendre's polynomials are nearly orthogonal on so many ticks.
  const auto at = [&](std::size_t i, int order) {
    const double u = 2 * (static_cast<double>(i) + 0.5) / count - 1;
    return order == 0 ? 1.0 : order == 1 ? u : 1.5 * u * u - 0.5;
  };
  glm::dvec2 parts[3] = {};
  for (std::size_t i = 0; i < forces.size(); ++i)
    for (int order : {0, 1, 2}) parts[order] += (2 * order + 1) / count * at(i, order) * glm::dvec2(forces[i]);
  std::vector<std::complex<float>> changes(forces.size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    glm::dvec2 left(forces[i]);
    for (int order : {0, 1, 2}) left -= at(i, order) * parts[order];
    changes[i] = {static_cast<float>(left.x), static_cast<float>(left.y)};
  }
  return changes;
}

/// N: the 99th percentile of the size of a changing force within some lines of its spectrum, as the amplitude of a
/// relief is defined. `fade` is the window under which it was transformed; near its ends, which are so much of the time
/// on either side, it may leave too little.
template <typename Chosen>
double size_of_lines(const Spectrum& spectrum, const std::vector<float>& fade, std::size_t first, std::size_t end,
                     Chosen chosen, double ends = 0.25) {
  const std::size_t count = spectrum.size();
  Spectrum within(count);
  // The transform back is that of the conjugate.
  for (std::size_t i = first; i < end; ++i)
    if (chosen(i)) within[i] = std::conj(spectrum[i]), within[count - i] = std::conj(spectrum[count - i]);
  const Spectrum back = fourier_of_line(within);
  const auto left_out = static_cast<std::size_t>(ends * static_cast<double>(count));
  std::vector<float> sizes;
  for (std::size_t i = left_out; i < count - left_out; ++i)
    sizes.push_back(std::abs(back[i]) / (fade[i] * static_cast<float>(count)));
  const auto rank = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sizes.size()));
  std::nth_element(sizes.begin(), rank, sizes.end());
  return *rank;
}

double size_within(const Spectrum& spectrum, const std::vector<float>& fade, std::size_t first, std::size_t end) {
  return size_of_lines(spectrum, fade, first, end, [](std::size_t) { return true; });
}

/// rad in [0, pi): the axis of the part of a force that some lines of its spectrum hold, if it has one.
std::optional<double> axis_within(const Spectrum& spectrum, std::size_t first, std::size_t end) {
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = std::max<std::size_t>(first, 1); i < end; ++i) {
    const std::complex<double> line(spectrum[i]), mirror(std::conj(spectrum[spectrum.size() - i]));
    const std::complex<double> x = line + mirror, y = std::complex<double>(0, -1) * (line - mirror);
    xx += std::norm(x), yy += std::norm(y), xy += (x * std::conj(y)).real();
  }
  constexpr double plainly = 0.5, nearly_whole = 1e-3;
  if (std::hypot(xx - yy, 2 * xy) < plainly * (xx + yy) || !(xx + yy > 0)) return std::nullopt;
  const double angle = std::fmod(0.5 * std::atan2(2 * xy, xx - yy) + std::numbers::pi, std::numbers::pi);
  return std::numbers::pi - angle < nearly_whole ? 0 : angle;
}

/// N: the farthest that some forces go from the middle between the extremes along each axis. No even swing is larger.
double farthest_from_middle(const std::vector<Force>& forces) {
  glm::dvec2 least(HUGE_VAL), most(-HUGE_VAL);
  for (const Force& force : forces)
    least = glm::min(least, glm::dvec2(force)), most = glm::max(most, glm::dvec2(force));
  double farthest = 0;
  for (const Force& force : forces)
    farthest = std::max(farthest, glm::length(glm::dvec2(force) - 0.5 * (least + most)));
  return farthest;
}

/// N: the 99th percentile of the size of a force that repeats with a period (s), about its mean over whole periods;
/// nothing if it does not repeat.
std::optional<double> size_of_repeating(const std::vector<Force>& forces, double period, double rate) {
  const auto apart = static_cast<std::size_t>(std::lround(period * rate));
  // Of the mean size: what jumps falls on another tick in some periods.
  const double beside = 0.03 + 8 / static_cast<double>(std::max<std::size_t>(apart, 1));
  const auto whole = static_cast<std::size_t>(
      std::lround(std::floor(static_cast<double>(forces.size()) / rate / period + 1e-3) * period * rate));
  if (apart == 0 || whole < 2 * apart) return std::nullopt;
  const std::size_t counted = std::min(whole, forces.size());
  glm::dvec2 mean{0};
  for (std::size_t i = 0; i < counted; ++i) mean += glm::dvec2(forces[i]) / static_cast<double>(counted);
  std::vector<double> sizes;
  double sum = 0, differs = 0;
  for (std::size_t i = 0; i < counted; ++i) {
    sizes.push_back(glm::length(glm::dvec2(forces[i]) - mean)), sum += sizes.back();
    if (i >= apart) differs += glm::length(forces[i] - forces[i - apart]);
  }
  if (differs > beside * sum) return std::nullopt;
  return percentile(sizes, percentile_of_amplitude);
}

/// Whether a changing force has no rate: it takes many lines of its spectrum to hold most of its power, and they are no
/// multiples of one.
bool is_noise(const std::vector<double>& powers) {
  std::vector<double> sorted = powers;
  std::ranges::sort(sorted, std::greater());
  double whole = 0, sum = 0;
  for (const double power : sorted) whole += power;
  std::size_t needed = 0;
  while (needed < sorted.size() && sum < most_of_power * whole) sum += sorted[needed++];
  if (needed <= most_lines) return false;
  // The fundamental of a train of pulses is hardly stronger than its harmonics.
  double best = 0;
  for (std::size_t apart = fewest_apart; apart < powers.size() / 4; ++apart) {
    double within = 0;
    for (std::size_t i = apart; i + 1 < powers.size(); i += apart) within += powers[i - 1] + powers[i] + powers[i + 1];
    best = std::max(best, within / whole);
    if (best > most_of_power) return false;
  }
  return true;
}

/// The line below which half of the power lies.
double middle_of(const std::vector<double>& powers) {
  double whole = 0, below = 0;
  for (const double power : powers) whole += power;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    below += powers[i];
    if (2 * below >= whole) return static_cast<double>(i);
  }
  return 0;
}

/// A size (N) that counts from the mean of the forces, or half of the way between those farthest apart if that is
/// hardly less: ticks that fall unequally on the halves of a wave move its mean, and no force is larger for that.
double without_unequal_halves(double size, const std::vector<Force>& forces) {
  constexpr double hardly_less = 0.85;
  glm::dvec2 least(HUGE_VAL), most(-HUGE_VAL);
  for (const Force& force : forces)
    least = glm::min(least, glm::dvec2(force)), most = glm::max(most, glm::dvec2(force));
  const double half = 0.5 * std::max(most.x - least.x, most.y - least.y);
  const bool along_one = std::min(most.x - least.x, most.y - least.y) < no_swing;
  return along_one && half > hardly_less * size ? std::min(half, size) : size;
}

/// The swing within some lines of a power spectrum; none if its strongest line does not stand out, as those of a drift.
Swing swing_in(const std::vector<double>& powers, std::size_t first, std::size_t end, double seconds) {
  if (first >= end) return {};
  const auto peak = std::max_element(powers.begin() + static_cast<std::ptrdiff_t>(first),
                                     powers.begin() + static_cast<std::ptrdiff_t>(end));
  auto at = static_cast<std::size_t>(peak - powers.begin());
  // A beat's strongest line may be a harmonic. Its fundamental is the slowest of the lines below of which it is a
  // multiple.
  for (std::size_t times = most_harmonic; times >= 2; --times) {
    const std::size_t slow = (at + times / 2) / times;
    if (slow < first + 1) continue;
    const auto line = std::max_element(powers.begin() + static_cast<std::ptrdiff_t>(slow - 1),
                                       powers.begin() + static_cast<std::ptrdiff_t>(slow + 2));
    if (*line < of_the_strongest * *peak) continue;
    at = static_cast<std::size_t>(line - powers.begin());
    break;
  }
  double sum = 0;
  for (std::size_t i = first; i < end; ++i) sum += powers[i];
  const double before = at > 0 ? powers[at - 1] : 0, after = at + 1 < powers.size() ? powers[at + 1] : 0;
  const double slower = at >= 3 ? powers[at - 3] : HUGE_VAL;
  // What begins or ends leaves as much in all lines.
  std::vector<double> all(powers.begin() + static_cast<std::ptrdiff_t>(first),
                          powers.begin() + static_cast<std::ptrdiff_t>(end));
  std::ranges::nth_element(all, all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2));
  if (powers[at] < above_the_usual * all[all.size() / 2]) return {};
  // A neighbour in a slower band may be the foot of a stronger peak there.
  if (powers[at] <= 0 || slower > stands_out * powers[at] || before > powers[at] || after > powers[at]) return {};
  // Under Hann's window, let r be the ratio in amplitude of the larger neighbour to the strongest line. The swing then
  // lies (2 r - 1) / (1 + r) lines further on: Grandke 1983, IEEE Trans. Instrum. Meas. 32(2).
  const double ratio = std::sqrt(std::max(before, after) / powers[at]);
  const double off = std::clamp((2 * ratio - 1) / (1 + ratio), 0.0, 0.5) * (after > before ? 1 : -1);
  return {std::sqrt(2 * sum), (static_cast<double>(at) + off) / seconds};
}

}  // namespace

double Swing::beside_strongest() const {
  double squares = 0;
  for (std::size_t i = 1; i < parts.size(); ++i) squares += parts[i].amplitude * parts[i].amplitude;
  return std::sqrt(squares);
}

namespace {

/// What swings at one place, as its spectrum shows it.
struct SwingingForce {
  const std::vector<Force>& forces;
  const Spectrum& spectrum;
  const std::vector<float>& fade;
  const std::vector<double>& powers;
  double seconds = 0, rate = 0;
};

/// The size of a fundamental with its harmonics, but for the lines of others.
double size_of_tone(const SwingingForce& felt, const std::vector<Tone>& tones, const Tone& tone) {
  constexpr double foot = 2.5;  // lines
  const auto near_one = [&](const Tone& each, std::size_t line) {
    const double at = static_cast<double>(line), apart = each.frequency * felt.seconds;
    const double times = each.shaped ? std::max(1.0, std::round(at / apart)) : 1;
    return std::abs(at - times * apart) <= foot;
  };
  return size_of_lines(felt.spectrum, felt.fade, 1, felt.powers.size() - 1, [&](std::size_t line) {
    if (!near_one(tone, line)) return false;
    // What both may be is the faster one's, of which it is the fundamental.
    return std::ranges::none_of(tones, [&](const Tone& other) {
      return other.frequency != tone.frequency && near_one(other, line) &&
             std::abs(other.frequency * felt.seconds - static_cast<double>(line)) <= foot;
    });
  });
}

/// Tells of steady swings what each of them is: one that is the sum of several by its parts, and one with corners, whose
/// harmonics are faster than it, by its whole size.
void tell_tones(const SwingingForce& felt, const std::vector<Tone>& tones, double fastest_sway, Swing& sway,
                Swing& vibration) {
  if (tones.empty()) return;
  const auto is_slow = [&](const Tone& each) { return each.frequency < fastest_sway; };
  const bool any_fast = !std::ranges::all_of(tones, is_slow);
  for (const bool slow : {true, false}) {
    Swing& swing = slow ? sway : vibration;
    if (!(swing.frequency > 0)) continue;
    for (const Tone& each : tones)
      if (is_slow(each) == slow)
        swing.parts.push_back({tones.size() > 1 ? size_of_tone(felt, tones, each) : each.amplitude, each.frequency});
    std::ranges::sort(swing.parts, std::greater(), &SwingPart::amplitude);
    std::erase_if(swing.parts, [](const SwingPart& part) { return part.amplitude < least_force; });
    if (swing.parts.size() > 1) swing.frequency = swing.parts.front().frequency;
  }
  const auto shaped = std::ranges::find_if(tones, [&](const Tone& each) { return is_slow(each) && each.shaped; });
  const bool corners = shaped != tones.end();
  if (tones.size() == 1 && corners) {
    if (const auto size = size_of_repeating(felt.forces, 1 / tones.front().frequency, felt.rate))
      sway.amplitude = *size;
  } else if (corners && sway.parts.size() == 1 && any_fast) {
    // Its harmonics are not of the vibration beside it.
    sway.amplitude = sway.parts.front().amplitude;
    if (vibration.parts.size() == 1) vibration.amplitude = vibration.parts.front().amplitude;
  }
  for (Swing* const swing : {&sway, &vibration})
    if (swing->parts.size() < 2) swing->parts.clear();
}

/// Tells the swings at the place where the forces change most. Returns the part of that change at the place where they
/// change least.
double tell_greatest_swings(const Bank& bank, const std::vector<std::vector<Force>>& felt, Swing& sway,
                            Swing& vibration) {
  std::vector<std::complex<float>> busiest;
  const std::vector<Force>* at_busiest = nullptr;
  double most = 0, least = HUGE_VAL;
  for (const std::vector<Force>& forces : felt) {
    const std::vector<std::complex<float>> changes = without_drift(forces);
    double squares = 0;
    for (const auto& each : changes) squares += std::norm(each);
    least = std::min(least, squares);
    if (squares > most) most = squares, busiest = changes, at_busiest = &forces;
  }
  const auto ticks = static_cast<double>(busiest.size());
  if (busiest.empty() || std::sqrt(2 * most / ticks) <= no_swing) return 1;
  const double share = std::sqrt(least / most);
  const double rate = bank.program().description().device.rate, seconds = ticks / rate;
  const std::vector<float> fade = hann_window(busiest.size());
  for (std::size_t i = 0; i < busiest.size(); ++i) busiest[i] *= fade[i];
  const Spectrum spectrum = fourier_of_line(busiest);
  // The transform of x + i y holds one of theirs in a coefficient and the other in its mirror image. Hann's window lets
  // three eighths of the power through.
  std::vector<double> powers(spectrum.size() / 2 + 1, 0.0);
  for (std::size_t i = 1; i < powers.size(); ++i) {
    const std::size_t mirror = spectrum.size() - i;
    powers[i] = (std::norm(spectrum[i]) + (mirror == i ? 0 : std::norm(spectrum[mirror]))) / (0.375 * ticks * ticks);
  }
  if (is_noise(powers)) {
    vibration = {std::min(size_within(spectrum, fade, 1, powers.size() - 1), farthest_from_middle(*at_busiest)), 0,
                 true, middle_of(powers) / seconds, axis_within(spectrum, 1, powers.size() - 1)};
    return share;
  }
  // A swing at the border belongs to the faster ones with all of its lines, which are three under this window.
  auto first_fast = static_cast<std::size_t>(slowest_vibration * seconds);
  const auto foot = powers.begin() + static_cast<std::ptrdiff_t>(first_fast) - 2;
  if (std::max_element(foot, foot + 5) - foot >= 2) first_fast -= 2;
  sway = swing_in(powers, fewest_swings, first_fast, seconds);
  vibration = swing_in(powers, first_fast, powers.size(), seconds);
  // The harmonics of a sway count with it.
  const double times = sway.frequency > 0 ? vibration.frequency / sway.frequency : 0;
  const std::vector<Tone> tones = fundamentals_of(powers, seconds, rate);
  const double fastest_sway = (static_cast<double>(first_fast) - 0.5) / seconds;
  const auto of = [&](double frequency) {
    return std::ranges::any_of(tones, [&](const Tone& each) {
      return std::abs(each.frequency - frequency) < same_rate * frequency;
    });
  };
  // The fundamentals of a steady sum tell which of them have harmonics; otherwise a weak multiple is one.
  const bool told_by_tones = !(sway.frequency > 0) || of(sway.frequency), resolved = times > 0 && told_by_tones;
  const bool any_fast = std::ranges::any_of(tones, [&](const Tone& each) { return each.frequency > fastest_sway; });
  const bool harmonic = resolved ? !any_fast
                                 : times > 0 && vibration.amplitude < 0.5 * sway.amplitude &&
                                       std::abs(times - std::round(times)) < 0.05;
  if (harmonic) vibration = {};
  double slowest = sway.frequency;
  for (const Tone& each : tones) slowest = std::min(slowest, each.frequency);
  if (sway.frequency > 0)
    sway.amplitude =
        size_within(spectrum, fade, std::max<std::size_t>(3, static_cast<std::size_t>(slowest * seconds)) - 2,
                    harmonic ? powers.size() : first_fast);
  if (sway.frequency > 0) sway.axis = axis_within(spectrum, fewest_swings, first_fast);
  sway.amplitude = std::min(sway.amplitude, farthest_from_middle(*at_busiest));
  const auto tell_sum = [&] {
    if (told_by_tones)
      tell_tones({*at_busiest, spectrum, fade, powers, seconds, rate}, tones, fastest_sway, sway, vibration);
  };
  if (!(vibration.frequency > 0)) {
    tell_sum();
    return share;
  }
  vibration.axis = axis_within(spectrum, first_fast, powers.size());
  double slower = 0, faster = 0;
  for (std::size_t i = 1; i < powers.size(); ++i) (i < first_fast ? slower : faster) += powers[i];
  const bool alone = !(sway.frequency > 0) && slower < beats_of_ticks * faster;
  vibration.amplitude = size_within(spectrum, fade, alone ? 1 : first_fast, powers.size());
  if (slower < beats_of_ticks * faster) vibration.amplitude = without_unequal_halves(vibration.amplitude, *at_busiest);
  vibration.amplitude = std::min(vibration.amplitude, farthest_from_middle(*at_busiest));
  // Few ticks of a sine fall on its peaks: what those miss is not of the wave.
  const auto line = static_cast<std::size_t>(std::lround(vibration.frequency * seconds));
  double tone = 0;
  for (std::size_t i = std::max<std::size_t>(line, 3) - 2; i < std::min(line + 3, powers.size()); ++i)
    tone += powers[i];
  const double peak = std::sqrt(2 * tone);
  if (tone >= pure * (slower + faster) && peak > vibration.amplitude && peak < missed * vibration.amplitude)
    vibration.amplitude = peak;
  tell_sum();
  return share;
}

double changing_square_of(const std::vector<Force>& forces) {
  double squares = 0;
  glm::dvec2 mean{0};
  for (const Force& force : forces) mean += glm::dvec2(force) / static_cast<double>(forces.size());
  for (const Force& force : forces) squares += glm::dot(glm::dvec2(force) - mean, glm::dvec2(force) - mean);
  return squares;
}

/// Tells a swing that is all that changes, and does so by an exponential. Whether there is one.
bool tell_fading(const Bank& bank, const std::vector<std::vector<Force>>& felt, Swing& sway, Swing& vibration) {
  if (felt.empty() || vibration.noise) return false;
  const std::vector<Force>& busiest = *std::ranges::max_element(felt, {}, changing_square_of);
  const std::optional<Swing> fading = fading_swing(busiest, bank.program().description().device.rate);
  if (!fading || fading->course->greatest < least_force) return false;
  sway = vibration = {};
  (fading->frequency < slowest_vibration ? sway : vibration) = *fading;
  return true;
}

/// Tells of a swing that dies away or grows how it does so, its size over all of the time, and its rate while it is
/// there. A sway is one only if it was found; a vibration may be over too soon for that.
void tell_course(const Bank& bank, const std::vector<std::vector<Force>>& felt, bool fast, Swing& swing) {
  if (swing.noise || (!fast && !(swing.frequency > 0))) return;
  if (felt.empty()) return;
  const auto busiest = std::ranges::max_element(felt, {}, changing_square_of);
  const double rate = bank.program().description().device.rate;
  const double slowest = fast ? slowest_vibration : 0;
  const auto unsteady =
      unsteady_swing(without_drift(*busiest), rate, slowest, fast ? 0.5 * rate : slowest_vibration);
  if (!unsteady || unsteady->course.greatest < least_force) return;
  Swing even, other;
  if (!unsteady->even.empty())
    tell_greatest_swings(bank, {unsteady->even}, fast ? other : even, fast ? even : other);
  if (even.noise || (!(even.frequency > 0) && !(swing.frequency > 0))) return;
  if (even.frequency > 0) swing.frequency = even.frequency, swing.axis = even.axis;
  swing.amplitude = unsteady->amplitude, swing.course = unsteady->course;
  if (!swing.course->grows) return;
  // One that has grown to its size is fitted a little larger.
  const double farthest = farthest_from_middle(*busiest);
  swing.amplitude = std::min(swing.amplitude, farthest);
  swing.course->greatest = std::min(swing.course->greatest, farthest);
}

}  // namespace

void tell_swings(const Bank& bank, const std::vector<std::vector<Force>>& at_rest, Swing& sway, Swing& vibration) {
  std::vector<std::vector<Force>> felt = at_rest;
  // What swings in a part of the patch may be elsewhere.
  if (auto busiest = felt_where_busiest(bank)) felt.push_back(*std::move(busiest));
  const double share = tell_greatest_swings(bank, felt, sway, vibration);
  if (vibration.frequency > 0 && sway.amplitude < least_force) {
    // What comes or goes beside it is in its spectrum too.
    if (const auto left = without_slow_change(bank, felt, vibration)) {
      Swing no_sway, alone;
      tell_greatest_swings(bank, *left, no_sway, alone);
      if (std::abs(alone.frequency - vibration.frequency) < same_rate * vibration.frequency) vibration = alone;
    }
  }
  const bool fading = tell_fading(bank, felt, sway, vibration);
  if (!fading) tell_course(bank, felt, true, vibration);
  if (!fading && sway.amplitude >= least_force) tell_course(bank, felt, false, sway);
  // Of two swings nobody knows which one differs.
  if (share > plainly_less || std::min(sway.amplitude, vibration.amplitude) >= least_force) return;
  Swing& swing = sway.amplitude > vibration.amplitude ? sway : vibration;
  if (swing.amplitude < least_force) return;
  swing.least = share * swing.amplitude < least_force ? 0 : share * swing.amplitude;
}

}  // namespace wale
