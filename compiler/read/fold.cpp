#include "compiler/read/fold.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/fold_kernels.hpp"

namespace wale {
namespace {

/// The part of a period, of `count`, at a number of periods.
inline std::size_t part_of(double periods, int count) {
  const auto part = static_cast<int>((periods - std::floor(periods)) * count);
  return static_cast<std::size_t>(part < count ? part : count - 1);
}

/// The share that parts explain, less what they explain of noise.
double explained(const FoldedSums& folded, std::size_t forces) {
  const auto count = static_cast<double>(forces);
  double kept = 0, used = 0;
  for (std::size_t i = 0; i < folded.sums.size(); ++i)
    if (folded.counts[i] > 0) kept += glm::dot(folded.sums[i], folded.sums[i]) / folded.counts[i], used += 1;
  const double whole = folded.squares - (count > 0 ? glm::dot(folded.sum, folded.sum) / count : 0);
  if (!(whole > 0) || used + 1 >= count) return 0;
  return 1 - (folded.squares - kept) / (count - used) / (whole / (count - 1));
}

constexpr std::size_t at_once = 256;  // places

/// The sum over `at_once` products, in lanes that the compiler can keep side by side.
double sum_of_products(const double* one, const double* other) {
  constexpr std::size_t lanes = 8;
  double sums[lanes] = {};
  for (std::size_t i = 0; i < at_once; i += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) sums[lane] += one[i + lane] * other[i + lane];
  double sum = 0;
  for (const double each : sums) sum += each;
  return sum;
}

}  // namespace

double FoldedWave::period() const { return 1 / glm::length(waves); }

void FoldedWave::add_to(std::span<const glm::dvec2> places, std::span<glm::dvec2> forces, double times) const {
  add_waveform(profile, waves, times, places, forces);
}

double explained_by(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                    std::size_t count) {
  return explained(fold_up(places, forces, waves, count), forces.size());
}

FoldedWave folded(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                  std::size_t count) {
  const FoldedSums sums = fold_up(places, forces, waves, count);
  FoldedWave wave{waves, std::vector<glm::dvec2>(count), glm::dvec2(0), explained(sums, forces.size())};
  // A part without a force has the mean of all.
  const glm::dvec2 mean = forces.empty() ? glm::dvec2(0) : sums.sum / static_cast<double>(forces.size());
  // An incomplete period has a mean over the places, which is none of the wave's.
  for (std::size_t i = 0; i < count; ++i) {
    wave.profile[i] = sums.counts[i] > 0 ? sums.sums[i] / static_cast<double>(sums.counts[i]) : mean;
    wave.mean += wave.profile[i] / static_cast<double>(count);
  }
  for (glm::dvec2& each : wave.profile) each -= wave.mean;
  return wave;
}

glm::dvec2 in_phase(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 centre,
                    glm::dvec2 size, glm::dvec2 waves) {
  using Complex = std::complex<double>;
  for (int turn = 0; turn < 2; ++turn) {
    const QuarterSums sums = sum_quarters(places, forces, centre, size, waves);
    Complex along_x = 0, along_y = 0;
    const auto sum = [&](int x, int y, int part) {
      return Complex(sums.real[2 * x + y][part], sums.imaginary[2 * x + y][part]);
    };
    for (int half : {0, 1})
      for (int part : {0, 1}) {
        along_x += sum(1, half, part) * std::conj(sum(0, half, part));
        along_y += sum(half, 1, part) * std::conj(sum(half, 0, part));
      }
    waves += glm::dvec2(std::arg(along_x), std::arg(along_y)) / (2 * std::numbers::pi) / (0.5 * size);
  }
  return waves;
}

glm::dvec2 better_fitting(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                          std::size_t bins) {
  const FoldedWave wave = folded(places, forces, waves, bins);
  std::vector<glm::dvec2> slope(bins);  // N per period
  for (std::size_t i = 0; i < bins; ++i)
    slope[i] = 0.5 * static_cast<double>(bins) * (wave.profile[(i + 1) % bins] - wave.profile[(i + bins - 1) % bins]);
  // Least squares of what the waveform leaves against its slope times the place; the phase is free.
  SlopeSums all = sum_slopes(wave.profile, slope, wave.mean, waves, places, forces);
  if (!(all.weights > 0)) return waves;
  const glm::dvec2 middle = all.places / all.weights;
  all.xx -= all.weights * middle.x * middle.x, all.xy -= all.weights * middle.x * middle.y;
  all.yy -= all.weights * middle.y * middle.y, all.offs -= all.off * middle;
  const double area = all.xx * all.yy - all.xy * all.xy;
  const glm::dvec2 moved(all.yy * all.offs.x - all.xy * all.offs.y, all.xx * all.offs.y - all.xy * all.offs.x);
  return area > 0 ? waves + moved / area : waves;
}

LinearForce linear_beside(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                          std::span<const glm::dvec2> waves) {
  constexpr std::size_t harmonics = harmonics_beside;
  constexpr double metre = 0.05;  // so that all columns are about 1
  const std::size_t columns = 3 + 2 * harmonics * waves.size();
  // The normal equations, with two right sides, which are the last columns: their products by blocks of places.
  const std::size_t all = columns + 2;
  std::vector<double> block(all * at_once), products(all * all, 0.0);
  std::array<double, at_once> cosines, sines;
  const auto column = [&](std::size_t number) { return block.data() + number * at_once; };
  for (std::size_t first = 0; first < places.size(); first += at_once) {
    const std::size_t count = std::min(at_once, places.size() - first);
    // What lies behind the last place counts as nothing.
    if (count < at_once) std::ranges::fill(block, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec2 place = places[first + i], force = forces[first + i];
      column(0)[i] = 1, column(1)[i] = place.x / metre, column(2)[i] = place.y / metre;
      column(columns)[i] = force.x, column(columns + 1)[i] = force.y;
    }
    for (std::size_t wave = 0; wave < waves.size(); ++wave) {
      cosines_and_sines(places.subspan(first, count), waves[wave], cosines, sines);
      for (std::size_t harmonic = 0; harmonic < harmonics; ++harmonic) {
        double* const real = column(3 + 2 * (wave * harmonics + harmonic));
        double* const imaginary = real + at_once;
        const double *const real_before = real - 2 * at_once, *const imaginary_before = real - at_once;
        for (std::size_t i = 0; i < count; ++i) {
          const double cosine = cosines[i], sine = sines[i];
          real[i] = harmonic == 0 ? cosine : real_before[i] * cosine - imaginary_before[i] * sine;
          imaginary[i] = harmonic == 0 ? sine : real_before[i] * sine + imaginary_before[i] * cosine;
        }
      }
    }
    for (std::size_t a = 0; a < all; ++a)
      for (std::size_t b = 0; b <= std::min(a, columns - 1); ++b)
        products[a * all + b] += sum_of_products(column(a), column(b));
  }
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> sums(
      products.data(), static_cast<Eigen::Index>(all), static_cast<Eigen::Index>(all));
  const auto size = static_cast<Eigen::Index>(columns);
  const Eigen::LLT<Eigen::MatrixXd> factors(sums.topLeftCorner(size, size));  // whose lower half is filled
  if (factors.info() != Eigen::Success) return linear_force(places, forces);
  const Eigen::MatrixXd found = factors.solve(sums.bottomLeftCorner(2, size).transpose());
  const auto row = [&](Eigen::Index at) { return glm::dvec2(found(at, 0), found(at, 1)); };
  return {row(0), row(1) / metre, row(2) / metre};
}

double explained_by_lattice(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 one,
                            glm::dvec2 other, std::size_t count) {
  const auto parts = static_cast<int>(count);
  FoldedSums cells{
      std::vector<glm::dvec2>(count * count, glm::dvec2(0)), std::vector<std::uint32_t>(count * count), {}, 0};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t cell =
        part_of(glm::dot(one, places[i]), parts) * count + part_of(glm::dot(other, places[i]), parts);
    cells.sums[cell] += forces[i], ++cells.counts[cell];
    cells.sum += forces[i], cells.squares += glm::dot(forces[i], forces[i]);
  }
  return explained(cells, forces.size());
}

}  // namespace wale
