#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/fundamental.hpp"
#include "compiler/read/waves.hpp"

namespace wale {
namespace {

constexpr double counts_as_wave = 0.02;  // of a wave's mean square, in a wave of its own and its harmonics
constexpr std::size_t far_off = 4;       // the first harmonic that a waveform hardly has without those between
constexpr double much_of_family = 0.25;  // of its strongest harmonic: the first one of a wave
constexpr double more_than_beside = 4;   // times the harmonics next to it
constexpr double much_more_than_beside = 8, much_of_first = 0.5;  // the third one, which many a waveform has

/// Whether a harmonic is so much more than those next to it that no waveform has it, but a finer wave does. Waveforms
/// fade from one harmonic to the next; those that have every other one have that beyond it too.
bool stands_alone(const std::vector<double>& powers, std::size_t fine) {
  const auto power = [&](std::size_t number) { return number <= powers.size() ? powers[number - 1] : 0; };
  const auto above_others = [&](std::size_t number, double times) {
    for (std::size_t each = number - std::min<std::size_t>(number - 2, 2); each <= number + 2; ++each)
      if (each % fine != 0 && power(number) < times * power(each)) return false;
    return true;
  };
  double family = 0;
  for (std::size_t i = fine; i <= powers.size(); i += fine) family += power(i);
  if (family < counts_as_wave) return false;
  if (fine >= far_off) return above_others(fine, more_than_beside);
  if (fine == 3) return power(3) >= much_of_first * power(1) && above_others(3, much_more_than_beside);
  // An octave is told from a lopsided waveform by a harmonic of its own.
  return above_others(2, more_than_beside) && power(6) >= weak_part && above_others(6, more_than_beside);
}

}  // namespace

std::size_t fine_wave(const std::vector<double>& powers) {
  if (powers.empty() || powers[0] < weak_part) return 0;
  std::size_t below = 0;  // the highest harmonic of the coarse wave
  for (std::size_t fine = 1; fine <= powers.size(); ++fine) {
    if (powers[fine - 1] < weak_part) continue;
    if (fine > 1 && stands_alone(powers, fine)) return fine;
    if (below > 0 && fine >= 2 * below) {
      double family = 0, strongest = 0;
      bool others = false;
      for (std::size_t i = fine; i <= powers.size(); ++i) {
        if (i % fine == 0)
          family += powers[i - 1], strongest = std::max(strongest, powers[i - 1]);
        else
          others = others || powers[i - 1] >= weak_part;
      }
      const bool apart = fine >= far_off && fine > 2 * below;
      // Otherwise it is the coarse wave's, and one of its multiples is the fine one.
      const bool leads = powers[fine - 1] >= much_of_family * strongest;
      if (!others && leads && (family > 0.5 || (apart && family >= counts_as_wave))) return fine;
    }
    below = fine;
  }
  return 0;
}

std::vector<WavePart> parts_of(const FoundWave& wave) {
  const std::vector<double> powers = harmonics_of(wave.wave, wave.wave.profile.size() / 2);
  std::vector<WavePart> parts;
  if (wave.parts != std::vector<std::size_t>{1}) {
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

SharedHarmonic shared_harmonic(const FoundWave& one, const FoundWave& other, glm::dvec2 size) {
  constexpr int most_of_one = 40, most_of_other = 6;
  if (one.parts.size() > 1 || other.parts.size() > 1) return {};
  for (int of_one = 2; of_one <= most_of_one; ++of_one) {
    const int of_other = std::abs(whole_periods(other.wave.waves, static_cast<double>(of_one) * one.wave.waves, size));
    if (of_other >= 1 && of_other <= most_of_other && of_other != of_one)
      return {static_cast<std::size_t>(of_one), static_cast<std::size_t>(of_other)};
  }
  return {};
}

bool belongs_to_other(const FoundWave& one, const FoundWave& other, SharedHarmonic shared) {
  // Some waveforms have only odd harmonics.
  const auto has_neighbour = [](const FoundWave& wave, std::size_t number, std::size_t least) {
    const std::vector<double> powers = harmonics_of(wave.wave, number + 2);
    for (std::size_t each = std::max(least, number - std::min<std::size_t>(number, 2)); each <= number + 2; ++each)
      if (each != number && powers[each - 1] >= weak_part) return true;
    return false;
  };
  return harmonics_of(one.wave, shared.of_one).back() > 0 && !has_neighbour(one, shared.of_one, 2) &&
         (shared.of_other == 1 || has_neighbour(other, shared.of_other, 1));
}

void take_harmonic_off(FoldedWave& wave, std::size_t number) {
  const std::size_t parts = wave.profile.size();
  const std::vector<glm::dvec2> before = wave.profile;
  for (std::size_t multiple = number; 2 * multiple < parts; multiple += number) {
    glm::dvec2 cosine{0}, sine{0};
    const auto turn = [&](std::size_t i) {
      return 2 * std::numbers::pi * static_cast<double>(i * multiple % parts) / static_cast<double>(parts);
    };
    for (std::size_t i = 0; i < parts; ++i)
      cosine += std::cos(turn(i)) * before[i], sine += std::sin(turn(i)) * before[i];
    const double scale = 2 / static_cast<double>(parts);
    for (std::size_t i = 0; i < parts; ++i)
      wave.profile[i] -= scale * (std::cos(turn(i)) * cosine + std::sin(turn(i)) * sine);
  }
}

std::vector<glm::dvec2> FoundWaves::without_waves(const std::vector<glm::dvec2>& places) const {
  std::vector<glm::dvec2> forces = rest;
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += trend.at(places[i]);
  return forces;
}

double FoundWaves::period(glm::dvec2 size) const {
  const glm::dvec2 strongest = waves.front().felt();
  constexpr int most = 5;
  for (int number = 1; number <= most; ++number) {
    const glm::dvec2 common = strongest / static_cast<double>(number);
    const bool fits = std::ranges::all_of(waves, [&](const FoundWave& each) {
      const glm::dvec2 other = each.felt();
      const glm::dvec2 across = other - glm::dot(other, common) / glm::dot(common, common) * common;
      if (glm::length(across * size) > out_of_place) return true;  // along another direction
      const int whole = std::abs(whole_periods(common, other, size));
      return whole >= 1 && whole <= most;
    });
    if (fits) return 1 / glm::length(common);
  }
  return 1 / glm::length(strongest);
}

double Lattice::period() const {
  // The steps from crest to crest of one wave along the crests of the other, and shorter ones made of both.
  const double area = one.x * other.y - one.y * other.x;
  glm::dvec2 a = glm::dvec2(other.y, -other.x) / area, b = glm::dvec2(-one.y, one.x) / area;
  if (glm::length(a) > glm::length(b)) std::swap(a, b);
  for (int turn = 0; turn < 8; ++turn) {  // Gauss's reduction
    b -= std::round(glm::dot(a, b) / glm::dot(a, a)) * a;
    if (glm::length(a) <= glm::length(b)) break;
    std::swap(a, b);
  }
  return glm::length(a);
}

glm::dvec2 busiest_place(const StillForces& window, const std::vector<glm::dvec2>& forces) {
  constexpr std::size_t blocks = 8;
  const std::size_t block = window.side / blocks;
  double most = -1;
  glm::dvec2 found = window.centre;
  for (std::size_t top = 0; top + block <= window.side; top += block)
    for (std::size_t left = 0; left + block <= window.side; left += block) {
      double change = 0;
      for (std::size_t row = top; row < top + block; ++row)
        for (std::size_t column = left; column + 1 < left + block; ++column) {
          const glm::dvec2 step = forces[row * window.side + column + 1] - forces[row * window.side + column];
          change += glm::dot(step, step);
        }
      const glm::dvec2 middle = window.centre - 0.5 * window.size +
                                window.cell() * (glm::dvec2(left, top) + 0.5 * static_cast<double>(block));
      // The middle is preferred to blocks that are hardly stronger.
      const double aside = glm::length((middle - window.centre) / (0.5 * window.size)) / std::numbers::sqrt2;
      if (change * (1 - 0.1 * aside) > most) most = change * (1 - 0.1 * aside), found = middle;
    }
  return found;
}

}  // namespace wale
