#include "compiler/extract/slow_force.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/extract/period_band.hpp"

namespace wale {
namespace {

constexpr std::size_t every = 4;
constexpr int times = 4;  // how often the mean over four samples is taken
constexpr std::size_t taps = times * (every - 1) + 1, before = taps / 2;

/// The weights of a mean over four samples that is taken four times. It removes everything that would look slow on
/// every fourth sample.
constexpr std::array<float, taps> weights_of_means() {
  std::array<float, taps> weights{};
  weights[0] = 1;
  for (int i = 0; i < times; ++i) {
    std::array<float, taps> wider{};
    for (std::size_t k = 0; k < taps; ++k)
      for (std::size_t shift = 0; shift < every && shift <= k; ++shift) wider[k] += weights[k - shift] / every;
    weights = wider;
  }
  return weights;
}

/// The share of a component that these means pass, at so many periods per sample.
double let_through_by_means(double periods) {
  const double angle = std::numbers::pi * periods;
  return angle == 0 ? 1 : std::pow(std::sin(every * angle) / (every * std::sin(angle)), times);
}

/// Adds an even number of forces, times a weight, to others, two at a time: compilers do not vectorise the plain loop.
void add_weighted(const Force* from, float weight, Force* to, std::size_t count) {
  using TwoForces [[gnu::vector_size(16)]] = float;
  static_assert(sizeof(TwoForces) == 2 * sizeof(Force));
  for (std::size_t i = 0; i < count; i += 2) {
    TwoForces more, sum;
    std::memcpy(&more, from + i, sizeof more);
    std::memcpy(&sum, to + i, sizeof sum);
    sum += weight * more;
    std::memcpy(to + i, &sum, sizeof sum);
  }
}

}  // namespace

SlowForce::SlowForce(const ForceField& field) : side_(field.side), centre_(field.centre), spacing_(field.spacing) {
  static constexpr std::array<float, taps> weights = weights_of_means();
  const std::size_t coarse = side_ / every;
  const auto around = [&](std::size_t index) { return index % side_; };
  // Whole lines first, since the processor adds several positions at once; then along the few lines that are left.
  std::vector<Force> lines(coarse * side_, Force(0)), both(coarse * coarse);
  for (std::size_t row = 0; row < coarse; ++row)
    for (std::size_t k = 0; k < taps; ++k)
      add_weighted(field.forces.data() + around(every * row + k + side_ - before) * side_, weights[k],
                   lines.data() + row * side_, side_);
  for (std::size_t row = 0; row < coarse; ++row)
    for (std::size_t column = 0; column < coarse; ++column) {
      const Force* line = lines.data() + row * side_;
      Force sum(0);
      for (std::size_t k = 0; k < taps; ++k) sum += weights[k] * line[around(every * column + k + side_ - before)];
      both[row * coarse + column] = sum;
    }
  spectrum_ = fourier(coarse, as_complex(both));
}

template <typename Visit>
void SlowForce::each_within(const PeriodBand& band, const Visit& visit) const {
  const std::size_t coarse = side_ / every;
  std::vector<double> means(coarse);
  for (std::size_t i = 0; i < coarse; ++i)
    means[i] = let_through_by_means(periods_over(coarse, i) / static_cast<double>(side_));
  const glm::dvec2 extent = spacing_ * static_cast<double>(side_);
  for (std::size_t row = 0; row < coarse; ++row)
    for (std::size_t column = 0; column < coarse; ++column) {
      const glm::dvec2 waves = glm::dvec2(periods_over(coarse, column), periods_over(coarse, row)) / extent;
      const double share = share_let_through(band, glm::dot(waves, waves));
      if (share > 0) visit(column, row, share / (means[column] * means[row]));
    }
}

ForceField SlowForce::on_lines_of(std::size_t side, const PeriodBand& band) const {
  const std::size_t coarse = side_ / every, apart = side_ / side;
  ForceField slow{
      side, centre_ - 0.5 * static_cast<double>(apart - 1) * spacing_, static_cast<double>(apart) * spacing_, {}};
  Spectrum wide(side * side);
  const auto scale = static_cast<double>(side * side) / static_cast<double>(coarse * coarse);
  const auto widened = [&](std::size_t index) { return index <= coarse / 2 ? index : index + side - coarse; };
  each_within(band, [&](std::size_t column, std::size_t row, double share) {
    wide[widened(row) * side + widened(column)] = spectrum_[row * coarse + column] * static_cast<float>(scale * share);
  });
  slow.forces.reserve(side * side);
  for (const auto& value : inverse_fourier(side, wide)) slow.forces.emplace_back(value.real(), value.imag());
  return slow;
}

double SlowForce::ceiling_within(const PeriodBand& band) const {
  const auto count = static_cast<double>(side_ / every * (side_ / every));
  double squares = 0;  // the mean square, by Parseval's theorem
  each_within(band, [&](std::size_t column, std::size_t row, double share) {
    squares += std::norm(spectrum_[row * (side_ / every) + column]) * share * share / (count * count);
  });
  // By Markov's inequality, a hundredth of two thirds of the positions holds no more than the whole square.
  return std::sqrt(squares / (0.01 * 2 / 3));
}

ForceField refined(const ForceField& field) {
  const std::size_t side = field.side, fine = 2 * side;
  ForceField result{fine, field.centre + 0.25 * field.spacing, 0.5 * field.spacing, std::vector<Force>(fine * fine)};
  const auto halfway = [](Force a, Force b, Force c, Force d) { return (9.0f * (b + c) - (a + d)) / 16.0f; };
  for (std::size_t row = 0; row < side; ++row) {
    const Force* from = field.forces.data() + row * side;
    Force* to = result.forces.data() + 2 * row * fine;
    for (std::size_t i = 0; i < side; ++i) {
      to[2 * i] = from[i];
      to[2 * i + 1] = halfway(from[(i + side - 1) % side], from[i], from[(i + 1) % side], from[(i + 2) % side]);
    }
  }
  const auto line = [&](std::size_t row) { return result.forces.data() + (row % fine) * fine; };
  for (std::size_t row = 0; row < fine; row += 2) {
    const Force *a = line(row + fine - 2), *b = line(row), *c = line(row + 2), *d = line(row + 4);
    Force* to = line(row + 1);
    for (std::size_t i = 0; i < fine; ++i) to[i] = halfway(a[i], b[i], c[i], d[i]);
  }
  return result;
}

}  // namespace wale
