#include "compiler/read/fold.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace wale {
namespace {

/// The sum and number of the forces in each part of a period or of a lattice's cell.
struct Bins {
  std::vector<glm::dvec2> sums;
  std::vector<double> counts;

  explicit Bins(std::size_t count) : sums(count, glm::dvec2(0)), counts(count, 0) {}
  void add(std::size_t bin, glm::dvec2 force) { sums[bin] += force, counts[bin] += 1; }

  /// The share explained, less what the bins explain of noise.
  double explained(std::span<const glm::dvec2> forces) const {
    glm::dvec2 sum{0};
    double whole = 0, kept = 0, used = 0;
    for (const glm::dvec2& force : forces) sum += force, whole += glm::dot(force, force);
    const auto count = static_cast<double>(forces.size());
    const double of_mean = glm::dot(sum, sum) / count;
    for (std::size_t i = 0; i < sums.size(); ++i)
      if (counts[i] > 0) kept += glm::dot(sums[i], sums[i]) / counts[i], used += 1;
    whole -= of_mean, kept -= of_mean;
    if (!(whole > 0) || used + 1 >= count) return 0;
    return 1 - (whole - kept) / (count - used) / (whole / (count - 1));
  }
};

/// The part of a period, of `count`, at a number of periods.
std::size_t part_of(double periods, std::size_t count) {
  const double share = periods - std::floor(periods);
  return std::min(static_cast<std::size_t>(share * static_cast<double>(count)), count - 1);
}

}  // namespace

double FoldedWave::period() const { return 1 / glm::length(waves); }

glm::dvec2 FoldedWave::at(glm::dvec2 place) const {
  const double periods = glm::dot(waves, place);
  const double at = (periods - std::floor(periods)) * static_cast<double>(profile.size()) - 0.5;
  const double low = std::floor(at), part = at - low;
  const auto count = static_cast<std::ptrdiff_t>(profile.size());
  const auto first = static_cast<std::size_t>((static_cast<std::ptrdiff_t>(low) + count) % count);
  return (1 - part) * profile[first] + part * profile[(first + 1) % profile.size()];
}

double explained_by(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                    std::size_t count) {
  Bins bins(count);
  for (std::size_t i = 0; i < places.size(); ++i) bins.add(part_of(glm::dot(waves, places[i]), count), forces[i]);
  return bins.explained(forces);
}

FoldedWave folded(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                  std::size_t count) {
  Bins bins(count);
  glm::dvec2 mean{0};
  for (std::size_t i = 0; i < places.size(); ++i) {
    bins.add(part_of(glm::dot(waves, places[i]), count), forces[i]);
    mean += forces[i] / static_cast<double>(places.size());
  }
  FoldedWave wave{waves, std::vector<glm::dvec2>(count), mean, bins.explained(forces)};
  for (std::size_t i = 0; i < count; ++i)
    wave.profile[i] = bins.counts[i] > 0 ? bins.sums[i] / bins.counts[i] - mean : glm::dvec2(0);
  return wave;
}

glm::dvec2 in_phase(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 centre,
                    glm::dvec2 size, glm::dvec2 waves) {
  using Complex = std::complex<double>;
  for (int turn = 0; turn < 2; ++turn) {
    Complex sums[2][2][2] = {};  // by half along x and y, and by component
    for (std::size_t i = 0; i < places.size(); ++i) {
      const glm::dvec2 share = (places[i] - centre) / size + 0.5;  // 0 .. 1
      // A window in each quarter, nearly Hann's, keeps the ends of incomplete periods out.
      const glm::dvec2 half = 2.0 * share - glm::floor(2.0 * share), window = 4.0 * half * (1.0 - half);
      const double periods = glm::dot(waves, places[i] - centre);
      const Complex turned = std::polar(window.x * window.x * window.y * window.y,
                                        -2 * std::numbers::pi * (periods - std::floor(periods)));
      Complex(&quarter)[2] = sums[share.x < 0.5 ? 0 : 1][share.y < 0.5 ? 0 : 1];
      quarter[0] += forces[i].x * turned, quarter[1] += forces[i].y * turned;
    }
    Complex along_x = 0, along_y = 0;
    for (int half : {0, 1})
      for (int part : {0, 1}) {
        along_x += sums[1][half][part] * std::conj(sums[0][half][part]);
        along_y += sums[half][1][part] * std::conj(sums[half][0][part]);
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
  double weights = 0, sum = 0, xx = 0, xy = 0, yy = 0;
  glm::dvec2 middle{0}, sums{0};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t bin = part_of(glm::dot(waves, places[i]), bins);
    const double weight = glm::dot(slope[bin], slope[bin]);
    const double off = glm::dot(slope[bin], forces[i] - wave.mean - wave.at(places[i]));
    weights += weight, middle += weight * places[i];
    sum += off, sums += off * places[i];
    xx += weight * places[i].x * places[i].x, xy += weight * places[i].x * places[i].y;
    yy += weight * places[i].y * places[i].y;
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
  constexpr std::size_t harmonics = 4;
  constexpr double metre = 0.05;  // so that all columns are about 1
  const std::size_t columns = 3 + 2 * harmonics * waves.size();
  // The normal equations, with two right sides; every third place is enough.
  std::vector<double> row(columns), matrix(columns * columns, 0.0);
  std::vector<glm::dvec2> right(columns, glm::dvec2(0));
  for (std::size_t i = 0; i < places.size(); i += 3) {
    row[0] = 1, row[1] = places[i].x / metre, row[2] = places[i].y / metre;
    for (std::size_t wave = 0, at = 3; wave < waves.size(); ++wave) {
      const auto once = std::polar(1.0, 2 * std::numbers::pi * glm::dot(waves[wave], places[i]));
      auto turned = once;
      for (std::size_t harmonic = 0; harmonic < harmonics; ++harmonic, turned *= once)
        row[at++] = turned.real(), row[at++] = turned.imag();
    }
    for (std::size_t a = 0; a < columns; ++a) {
      right[a] += row[a] * forces[i];
      for (std::size_t b = 0; b <= a; ++b) matrix[a * columns + b] += row[a] * row[b];
    }
  }
  // Cholesky's factors.
  for (std::size_t a = 0; a < columns; ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      double sum = matrix[a * columns + b];
      for (std::size_t k = 0; k < b; ++k) sum -= matrix[a * columns + k] * matrix[b * columns + k];
      if (a == b && !(sum > 0)) return linear_force(places, forces);
      matrix[a * columns + b] = a == b ? std::sqrt(sum) : sum / matrix[b * columns + b];
    }
  for (std::size_t a = 0; a < columns; ++a) {
    for (std::size_t k = 0; k < a; ++k) right[a] -= matrix[a * columns + k] * right[k];
    right[a] /= matrix[a * columns + a];
  }
  for (std::size_t a = columns; a-- > 0;) {
    for (std::size_t k = a + 1; k < columns; ++k) right[a] -= matrix[k * columns + a] * right[k];
    right[a] /= matrix[a * columns + a];
  }
  return {right[0], right[1] / metre, right[2] / metre};
}

double explained_by_lattice(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 one,
                            glm::dvec2 other, std::size_t count) {
  Bins bins(count * count);
  for (std::size_t i = 0; i < places.size(); ++i)
    bins.add(part_of(glm::dot(one, places[i]), count) * count + part_of(glm::dot(other, places[i]), count), forces[i]);
  return bins.explained(forces);
}

}  // namespace wale
