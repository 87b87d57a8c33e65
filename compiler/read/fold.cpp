#include "compiler/read/fold.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "runtime/machine/arithmetic.hpp"

namespace wale {
namespace {

/// The part of a period, of `count`, at a number of periods.
inline std::size_t part_of(double periods, int count) {
  const auto part = static_cast<int>((periods - std::floor(periods)) * count);
  return static_cast<std::size_t>(part < count ? part : count - 1);
}

/// The forces in each part of a period or of a lattice's cell.
class Bins {
 public:
  explicit Bins(std::size_t count) : bins_(count) {}

  void add(std::size_t bin, glm::dvec2 force) {
    bins_[bin].sum += force, bins_[bin].count += 1;
    sum_ += force, whole_ += glm::dot(force, force), count_ += 1;
  }
  glm::dvec2 mean() const { return count_ > 0 ? sum_ / count_ : glm::dvec2(0); }
  /// The mean force of a part; that of all forces in a part that has none.
  glm::dvec2 mean(std::size_t bin) const { return bins_[bin].count > 0 ? bins_[bin].sum / bins_[bin].count : mean(); }

  /// The share explained, less what the bins explain of noise.
  double explained() const {
    double kept = 0, used = 0;
    for (const Bin& bin : bins_)
      if (bin.count > 0) kept += glm::dot(bin.sum, bin.sum) / bin.count, used += 1;
    const double of_mean = count_ > 0 ? glm::dot(sum_, sum_) / count_ : 0, whole = whole_ - of_mean;
    if (!(whole > 0) || used + 1 >= count_) return 0;
    return 1 - (whole_ - kept) / (count_ - used) / (whole / (count_ - 1));
  }

 private:
  struct Bin {
    glm::dvec2 sum{0};
    double count = 0;
  };
  std::vector<Bin> bins_;
  glm::dvec2 sum_{0};
  double whole_ = 0, count_ = 0;
};

Bins bins_of(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
             std::size_t count) {
  Bins bins(count);
  const auto parts = static_cast<int>(count);
  for (std::size_t i = 0; i < places.size(); ++i) bins.add(part_of(glm::dot(waves, places[i]), parts), forces[i]);
  return bins;
}

/// The cosines and minus the sines of some phases, in periods; 2e-7 of 1 are lost.
void turn_back(std::span<const double> periods, std::span<float> cosines, std::span<float> sines) {
  for (std::size_t i = 0; i < periods.size(); ++i) {
    const auto angle = static_cast<float>(2 * std::numbers::pi * (periods[i] - std::floor(periods[i])));
    cosines[i] = cosine_of(angle), sines[i] = -sine_of(angle);
  }
}
constexpr std::size_t at_once = 256;  // phases

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

glm::dvec2 FoldedWave::at(glm::dvec2 place) const {
  const double periods = glm::dot(waves, place);
  const auto count = static_cast<int>(profile.size());
  const double at = (periods - std::floor(periods)) * count + 0.5;  // after the middle of the last part
  const auto next = static_cast<int>(at);
  const double part = at - next;
  const glm::dvec2 &before = profile[next > 0 ? next - 1 : count - 1], &after = profile[next < count ? next : 0];
  return (1 - part) * before + part * after;
}

double explained_by(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                    std::size_t count) {
  return bins_of(places, forces, waves, count).explained();
}

FoldedWave folded(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                  std::size_t count) {
  const Bins bins = bins_of(places, forces, waves, count);
  FoldedWave wave{waves, std::vector<glm::dvec2>(count), glm::dvec2(0), bins.explained()};
  // An incomplete period has a mean over the places, which is none of the wave's.
  for (std::size_t i = 0; i < count; ++i)
    wave.profile[i] = bins.mean(i), wave.mean += wave.profile[i] / static_cast<double>(count);
  for (glm::dvec2& each : wave.profile) each -= wave.mean;
  return wave;
}

glm::dvec2 in_phase(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 centre,
                    glm::dvec2 size, glm::dvec2 waves) {
  using Complex = std::complex<double>;
  std::array<double, at_once> periods;
  std::array<float, at_once> cosines, sines;
  const glm::dvec2 scale = 1.0 / size;
  for (int turn = 0; turn < 2; ++turn) {
    glm::dvec2 real[4] = {}, imaginary[4] = {};  // by quarter: half along y, and twice half along x
    for (std::size_t first = 0; first < places.size(); first += at_once) {
      const std::size_t count = std::min(at_once, places.size() - first);
      for (std::size_t i = 0; i < count; ++i) periods[i] = glm::dot(waves, places[first + i] - centre);
      turn_back(std::span(periods).first(count), cosines, sines);
      for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec2 twice = 2.0 * ((places[first + i] - centre) * scale + 0.5);  // 0 .. 2
        const glm::dvec2 far(twice.x < 1 ? 0 : 1, twice.y < 1 ? 0 : 1), half = twice - far;
        // A window in each quarter, nearly Hann's, keeps the ends of incomplete periods out.
        const glm::dvec2 window = 4.0 * half * (1.0 - half);
        const glm::dvec2 force = window.x * window.x * window.y * window.y * forces[first + i];
        const auto quarter = static_cast<std::size_t>(2 * far.x + far.y);
        real[quarter] += double{cosines[i]} * force, imaginary[quarter] += double{sines[i]} * force;
      }
    }
    Complex along_x = 0, along_y = 0;
    const auto sum = [&](int x, int y, int part) { return Complex(real[2 * x + y][part], imaginary[2 * x + y][part]); };
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
  const auto parts = static_cast<int>(bins);
  std::vector<glm::dvec2> slope(bins);  // N per period
  for (std::size_t i = 0; i < bins; ++i)
    slope[i] = 0.5 * static_cast<double>(bins) * (wave.profile[(i + 1) % bins] - wave.profile[(i + bins - 1) % bins]);
  // Least squares of what the waveform leaves against its slope times the place; the phase is free.
  double weights = 0, sum = 0, xx = 0, xy = 0, yy = 0;
  glm::dvec2 middle{0}, sums{0};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 place = places[i], steep = slope[part_of(glm::dot(waves, place), parts)];
    const double weight = glm::dot(steep, steep), off = glm::dot(steep, forces[i] - wave.mean - wave.at(place));
    const glm::dvec2 weighted = weight * place;
    weights += weight, middle += weighted;
    sum += off, sums += off * place;
    xx += weighted.x * place.x, xy += weighted.x * place.y, yy += weighted.y * place.y;
  }
  if (!(weights > 0)) return waves;
  middle /= weights;
  xx -= weights * middle.x * middle.x, xy -= weights * middle.x * middle.y, yy -= weights * middle.y * middle.y;
  sums -= sum * middle;
  const double area = xx * yy - xy * xy;
  return area > 0 ? waves + glm::dvec2(yy * sums.x - xy * sums.y, xx * sums.y - xy * sums.x) / area : waves;
}

LinearForce linear_beside(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                          std::span<const glm::dvec2> waves) {
  constexpr std::size_t harmonics = harmonics_beside;
  constexpr double metre = 0.05;  // so that all columns are about 1
  const std::size_t columns = 3 + 2 * harmonics * waves.size();
  // The normal equations, with two right sides, which are the last columns: their products by blocks of places.
  const std::size_t all = columns + 2;
  std::vector<double> block(all * at_once), products(all * all, 0.0);
  std::array<double, at_once> periods;
  std::array<float, at_once> cosines, sines;
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
      for (std::size_t i = 0; i < count; ++i) periods[i] = glm::dot(waves[wave], places[first + i]);
      turn_back(std::span(periods).first(count), cosines, sines);
      for (std::size_t harmonic = 0; harmonic < harmonics; ++harmonic) {
        double* const real = column(3 + 2 * (wave * harmonics + harmonic));
        double* const imaginary = real + at_once;
        const double *const real_before = real - 2 * at_once, *const imaginary_before = real - at_once;
        for (std::size_t i = 0; i < count; ++i) {
          const double cosine = cosines[i], sine = -double{sines[i]};
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
  Bins bins(count * count);
  const auto parts = static_cast<int>(count);
  for (std::size_t i = 0; i < places.size(); ++i)
    bins.add(part_of(glm::dot(one, places[i]), parts) * count + part_of(glm::dot(other, places[i]), parts), forces[i]);
  return bins.explained();
}

}  // namespace wale
