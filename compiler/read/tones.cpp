#include "compiler/read/tones.hpp"

#include <algorithm>
#include <cmath>

#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr std::size_t foot_lines = 2;           // lines on either side that a sine fills under Hann's window
constexpr std::size_t slowest_line = 4;   // slower lines may be what is left of a drift
constexpr double plainly_a_tone = 0.25;   // of a line's power, at most this is three lines beside it
// Of its amplitude: weaker ones are feet, rounding, and what ticks make of jumps.
constexpr double of_the_loudest = 0.05;
constexpr std::size_t most_fundamentals = 4;
constexpr std::size_t most_multiple = 64;
constexpr double lines_off = 0.3, lines_off_a_multiple = 0.02;
constexpr double as_jumps = 1.5;  // the harmonics of jumps fall with their number, or begin to a little later

/// What stands out of a spectrum, the slowest first.
std::vector<Tone> tones_of(const std::vector<double>& powers, double seconds) {
  std::vector<Tone> tones;
  for (std::size_t i = slowest_line; i + foot_lines + 1 < powers.size(); ++i) {
    if (!(powers[i] > powers[i - 1] && powers[i] >= powers[i + 1])) continue;
    if (std::max(powers[i - 3], powers[i + 3]) > plainly_a_tone * powers[i]) continue;
    double sum = 0;
    for (std::size_t k = i - foot_lines; k <= i + foot_lines; ++k) sum += powers[k];
    const bool above = powers[i + 1] > powers[i - 1];
    // Grandke's interpolation, as in `swing_in`.
    const double ratio = std::sqrt(std::max(powers[i - 1], powers[i + 1]) / powers[i]);
    const double off = std::clamp((2 * ratio - 1) / (1 + ratio), 0.0, 0.5) * (above ? 1 : -1);
    tones.push_back({std::sqrt(2 * sum), (static_cast<double>(i) + off) / seconds});
  }
  double loudest = 0;
  for (const Tone& each : tones) loudest = std::max(loudest, each.amplitude);
  std::erase_if(tones, [&](const Tone& each) {
    return each.amplitude < std::max(least_force, of_the_loudest * loudest);
  });
  return tones;
}

}  // namespace

std::size_t multiple_of(double fundamental, double frequency, double seconds, double rate) {
  for (std::size_t times = 1; times <= most_multiple; ++times) {
    const double wanted = static_cast<double>(times) * fundamental;
    // Beyond half of the ticks' rate it comes back down.
    const double shown = std::abs(wanted - rate * std::round(wanted / rate));
    if (std::abs(shown - frequency) * seconds <= lines_off + static_cast<double>(times) * lines_off_a_multiple)
      return times;
  }
  return 0;
}

std::vector<Tone> fundamentals_of(const std::vector<double>& powers, double seconds, double rate) {
  struct Group {
    Tone tone;
    double strongest = 0;  // N: of its lines, each times its number
    double last_times = 1, last = 0;  // of its fastest line: the number, and N
  };
  std::vector<Group> groups;
  for (const Tone& each : tones_of(powers, seconds)) {
    bool taken = false;
    for (Group& group : groups) {
      const auto times = static_cast<double>(multiple_of(group.tone.frequency, each.frequency, seconds, rate));
      // Those of narrow pulses hardly fall, but each is there.
      const bool next = times == group.last_times + 1 && each.amplitude <= group.last;
      if (times == 0 || (each.amplitude * times > as_jumps * group.strongest && !next)) continue;
      if (times > group.last_times) group.last_times = times, group.last = each.amplitude;
      group.strongest = std::max(group.strongest, each.amplitude * times);
      group.tone.shaped = taken = true;
      break;
    }
    if (!taken) groups.push_back({each, each.amplitude, 1, each.amplitude});
    if (groups.size() > most_fundamentals) return {};
  }
  std::vector<Tone> found;
  for (const Group& group : groups) found.push_back(group.tone);
  return found;
}

}  // namespace wale
