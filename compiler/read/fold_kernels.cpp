#include "compiler/read/fold_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "compiler/read/wide_vectors.hpp"
#include "runtime/machine/arithmetic.hpp"

namespace wale {
namespace {

constexpr std::size_t places_at_once = 256;  // places, whose intermediate values stay in the fastest cache
constexpr std::size_t sums_at_once = 4;      // that a machine may keep side by side
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

[[gnu::always_inline]] inline Pair pair_at(const glm::dvec2& from) {
  Pair pair;
  std::memcpy(&pair, &from, sizeof pair);
  return pair;
}
[[gnu::always_inline]] inline void store(Pair pair, glm::dvec2& to) { std::memcpy(&to, &pair, sizeof pair); }

/// The places in a period, in 0 .. 1, of a block of places.
[[gnu::always_inline]] inline void phases_of(const glm::dvec2* places, std::size_t count, glm::dvec2 waves,
                                             double* phases) {
  for (std::size_t i = 0; i < count; ++i) {
    const double periods = waves.x * places[i].x + waves.y * places[i].y;
    phases[i] = periods - std::floor(periods);
  }
}

/// The part of a period in which each phase lies.
[[gnu::always_inline]] inline void parts_of_phases(const double* phases, std::size_t count, double parts,
                                                   std::int32_t* found) {
  const auto last = static_cast<std::int32_t>(parts) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto part = static_cast<std::int32_t>(phases[i] * parts);
    found[i] = part < last ? part : last;
  }
}

/// Between which of a profile's values each phase lies, the last value standing before the first, and how far.
[[gnu::always_inline]] inline void between_values(const double* phases, std::size_t count, double parts,
                                                  std::int32_t* before, double* far) {
  for (std::size_t i = 0; i < count; ++i) {
    const double at = phases[i] * parts + 0.5;
    before[i] = static_cast<std::int32_t>(at);
    far[i] = at - before[i];
  }
}

/// With the last value before the first and the first after the last.
std::vector<glm::dvec2> closed(std::span<const glm::dvec2> profile, double times) {
  std::vector<glm::dvec2> values;
  values.reserve(profile.size() + 2);
  values.push_back(times * profile.back());
  for (const glm::dvec2& each : profile) values.push_back(times * each);
  values.push_back(times * profile.front());
  return values;
}

struct Fold {
  [[gnu::always_inline]] static void run(const glm::dvec2* places, const glm::dvec2* forces, std::size_t all,
                                         glm::dvec2 waves, FoldedSums* found) {
    double phases[places_at_once];
    std::int32_t parts[places_at_once];
    const auto number = static_cast<double>(found->sums.size());
    glm::dvec2* const sums = found->sums.data();
    std::uint32_t* const counts = found->counts.data();
    Pair sum = {0, 0}, squares = {0, 0};
    for (std::size_t first = 0; first < all; first += places_at_once) {
      const std::size_t count = std::min(places_at_once, all - first);
      phases_of(places + first, count, waves, phases);
      parts_of_phases(phases, count, number, parts);
      for (std::size_t i = 0; i < count; ++i) {
        const Pair force = pair_at(forces[first + i]);
        glm::dvec2& part = sums[parts[i]];
        store(pair_at(part) + force, part);
        ++counts[parts[i]];
        sum += force, squares += force * force;
      }
    }
    found->sum = {sum[0], sum[1]}, found->squares = squares[0] + squares[1];
  }
};

struct AddWaveform {
  [[gnu::always_inline]] static void run(const glm::dvec2* values, std::size_t parts, glm::dvec2 waves,
                                         const glm::dvec2* places, std::size_t all, glm::dvec2* forces) {
    double phases[places_at_once], far[places_at_once];
    std::int32_t before[places_at_once];
    for (std::size_t first = 0; first < all; first += places_at_once) {
      const std::size_t count = std::min(places_at_once, all - first);
      phases_of(places + first, count, waves, phases);
      between_values(phases, count, static_cast<double>(parts), before, far);
      for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec2* const value = values + before[i];
        const Pair here = (1 - far[i]) * pair_at(value[0]) + far[i] * pair_at(value[1]);
        store(pair_at(forces[first + i]) + here, forces[first + i]);
      }
    }
  }
};

struct SumSlopes {
  [[gnu::always_inline]] static SlopeSums run(const glm::dvec2* values, const glm::dvec2* slopes, std::size_t parts,
                                              glm::dvec2 mean, glm::dvec2 waves, const glm::dvec2* places,
                                              const glm::dvec2* forces, std::size_t all) {
    double phases[places_at_once], far[places_at_once], weights[places_at_once], offs[places_at_once];
    std::int32_t part[places_at_once], before[places_at_once];
    double sums[9][sums_at_once] = {};
    const Pair mean_force = pair_at(mean);
    for (std::size_t first = 0; first < all; first += places_at_once) {
      const std::size_t count = std::min(places_at_once, all - first);
      phases_of(places + first, count, waves, phases);
      parts_of_phases(phases, count, static_cast<double>(parts), part);
      between_values(phases, count, static_cast<double>(parts), before, far);
      for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec2* const value = values + before[i];
        const Pair here = (1 - far[i]) * pair_at(value[0]) + far[i] * pair_at(value[1]);
        const Pair slope = pair_at(slopes[part[i]]);
        const Pair square = slope * slope, off = slope * (pair_at(forces[first + i]) - mean_force - here);
        weights[i] = square[0] + square[1], offs[i] = off[0] + off[1];
      }
      // What lies behind the last place weighs nothing.
      for (std::size_t i = count; i % sums_at_once != 0; ++i) weights[i] = offs[i] = 0;
      for (std::size_t i = 0; i < count; i += sums_at_once)
        for (std::size_t lane = 0; lane < sums_at_once; ++lane) {
          const glm::dvec2 place = places[std::min(first + i + lane, all - 1)];
          const double weight = weights[i + lane], off = offs[i + lane];
          const double weight_x = weight * place.x, weight_y = weight * place.y;
          sums[0][lane] += weight, sums[1][lane] += weight_x, sums[2][lane] += weight_y;
          sums[3][lane] += off, sums[4][lane] += off * place.x, sums[5][lane] += off * place.y;
          sums[6][lane] += weight_x * place.x, sums[7][lane] += weight_x * place.y, sums[8][lane] += weight_y * place.y;
        }
    }
    const auto sum = [&](int number) {
      return (sums[number][0] + sums[number][1]) + (sums[number][2] + sums[number][3]);
    };
    return {.weights = sum(0),
            .off = sum(3),
            .xx = sum(6),
            .xy = sum(7),
            .yy = sum(8),
            .places = {sum(1), sum(2)},
            .offs = {sum(4), sum(5)}};
  }
};

struct SumQuarters {
  [[gnu::always_inline]] static QuarterSums run(const glm::dvec2* places, const glm::dvec2* forces, std::size_t all,
                                                glm::dvec2 centre, glm::dvec2 scale, glm::dvec2 waves) {
    double fades[places_at_once];
    float angles[places_at_once], cosines[places_at_once], sines[places_at_once];
    std::int32_t quarters[places_at_once];
    Pair real[4] = {}, imaginary[4] = {};
    for (std::size_t first = 0; first < all; first += places_at_once) {
      const std::size_t count = std::min(places_at_once, all - first);
      for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec2& place = places[first + i];
        const double x = place.x - centre.x, y = place.y - centre.y, periods = waves.x * x + waves.y * y;
        angles[i] = static_cast<float>(2 * std::numbers::pi * (periods - std::floor(periods)));
        const double twice_x = 2 * (x * scale.x + 0.5), twice_y = 2 * (y * scale.y + 0.5);  // 0 .. 2
        const double far_x = twice_x < 1 ? 0 : 1, far_y = twice_y < 1 ? 0 : 1;
        const double half_x = twice_x - far_x, half_y = twice_y - far_y;
        const double window_x = 4 * half_x * (1 - half_x), window_y = 4 * half_y * (1 - half_y);
        fades[i] = window_x * window_x * window_y * window_y;
        quarters[i] = static_cast<std::int32_t>(2 * far_x + far_y);
      }
      for (std::size_t i = 0; i < count; ++i) cosines[i] = cosine_of(angles[i]), sines[i] = -sine_of(angles[i]);
      for (std::size_t i = 0; i < count; ++i) {
        const Pair force = fades[i] * pair_at(forces[first + i]);
        real[quarters[i]] += double{cosines[i]} * force, imaginary[quarters[i]] += double{sines[i]} * force;
      }
    }
    QuarterSums found;
    for (int i = 0; i < 4; ++i) store(real[i], found.real[i]), store(imaginary[i], found.imaginary[i]);
    return found;
  }
};

struct CosinesAndSines {
  [[gnu::always_inline]] static void run(const glm::dvec2* places, std::size_t all, glm::dvec2 waves, double* cosines,
                                         double* sines) {
    double phases[places_at_once];
    float angles[places_at_once];
    for (std::size_t first = 0; first < all; first += places_at_once) {
      const std::size_t count = std::min(places_at_once, all - first);
      phases_of(places + first, count, waves, phases);
      for (std::size_t i = 0; i < count; ++i) angles[i] = static_cast<float>(2 * std::numbers::pi * phases[i]);
      for (std::size_t i = 0; i < count; ++i)
        cosines[first + i] = cosine_of(angles[i]), sines[first + i] = sine_of(angles[i]);
    }
  }
};

}  // namespace

void cosines_and_sines(std::span<const glm::dvec2> places, glm::dvec2 waves, std::span<double> cosines,
                       std::span<double> sines) {
  run_wide<CosinesAndSines>(places.data(), places.size(), waves, cosines.data(), sines.data());
}

FoldedSums fold_up(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                   std::size_t parts) {
  FoldedSums found{std::vector<glm::dvec2>(parts, glm::dvec2(0)), std::vector<std::uint32_t>(parts), {}, 0};
  run_wide<Fold>(places.data(), forces.data(), places.size(), waves, &found);
  return found;
}

void add_waveform(std::span<const glm::dvec2> profile, glm::dvec2 waves, double times,
                  std::span<const glm::dvec2> places, std::span<glm::dvec2> forces) {
  const std::vector<glm::dvec2> values = closed(profile, times);
  run_wide<AddWaveform>(values.data(), profile.size(), waves, places.data(), places.size(), forces.data());
}

SlopeSums sum_slopes(std::span<const glm::dvec2> profile, std::span<const glm::dvec2> slope, glm::dvec2 mean,
                     glm::dvec2 waves, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  const std::vector<glm::dvec2> values = closed(profile, 1);
  return run_wide<SumSlopes>(values.data(), slope.data(), profile.size(), mean, waves, places.data(), forces.data(),
                             places.size());
}

QuarterSums sum_quarters(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 centre,
                         glm::dvec2 size, glm::dvec2 waves) {
  return run_wide<SumQuarters>(places.data(), forces.data(), places.size(), centre, 1.0 / size, waves);
}

}  // namespace wale
