#include "compiler/read/harmonic_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/fold_kernels.hpp"

namespace wale {
namespace {

constexpr int turns = 10;
constexpr double farthest = 0.3;       // periods over the window, that a wave moves at once
constexpr double nearly_there = 1e-4;  // ... and that no longer count
constexpr double same_place = 0.6;     // periods over the window: two harmonics are one

/// One column for the cosine and one for the sine of each.
struct Harmonic {
  std::size_t wave = 0;
  int number = 1;
};

/// The harmonics that are fitted: where two waves have the same, it is the one with the lower number.
std::vector<Harmonic> harmonics_apart(std::span<const glm::dvec2> waves, glm::dvec2 size, int most) {
  std::vector<Harmonic> chosen;
  const auto at = [&](const Harmonic& each) { return static_cast<double>(each.number) * waves[each.wave]; };
  for (int number = 1; number <= most; ++number)
    for (std::size_t wave = 0; wave < waves.size(); ++wave) {
      const Harmonic here{wave, number};
      const bool taken = std::ranges::any_of(chosen, [&](const Harmonic& other) {
        return glm::length((at(here) - at(other)) * size) < same_place ||
               glm::length((at(here) + at(other)) * size) < same_place;
      });
      if (!taken) chosen.push_back(here);
    }
  return chosen;
}

/// The forces, and what is fitted to them at one choice of waves.
class HarmonicFitter {
 public:
  HarmonicFitter(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                 std::span<const glm::dvec2> waves, glm::dvec2 size, int most_harmonics)
      : places_(places),
        harmonics_(harmonics_apart(waves, size, most_harmonics)),
        size_(size),
        forces_(count(places), 2) {
    for (Eigen::Index i = 0; i < forces_.rows(); ++i) {
      const glm::dvec2 force = forces[static_cast<std::size_t>(i)];
      forces_(i, 0) = force.x, forces_(i, 1) = force.y;
    }
  }

  /// Fits the line and the harmonics of these waves.
  void fit(std::span<const glm::dvec2> waves) {
    columns_.resize(forces_.rows(), static_cast<Eigen::Index>(3 + 2 * harmonics_.size()));
    columns_.col(0).setOnes();
    for (Eigen::Index i = 0; i < forces_.rows(); ++i) {
      const glm::dvec2 place = places_[static_cast<std::size_t>(i)];
      columns_(i, 1) = place.x / size_.x, columns_(i, 2) = place.y / size_.y;
    }
    Eigen::ArrayXd cosine(forces_.rows()), sine(forces_.rows()), real, imaginary, real_before;
    for (std::size_t wave = 0; wave < waves.size(); ++wave) {
      cosines_and_sines(places_, waves[wave], {cosine.data(), places_.size()}, {sine.data(), places_.size()});
      // The harmonics are powers of the first one.
      int number = 0;
      for (std::size_t each = 0; each < harmonics_.size(); ++each) {
        if (harmonics_[each].wave != wave) continue;
        for (; number < harmonics_[each].number; ++number) {
          if (number == 0) {
            real = cosine, imaginary = sine;
            continue;
          }
          real_before = real;
          real = real * cosine - imaginary * sine;
          imaginary = real_before * sine + imaginary * cosine;
        }
        columns_.col(column(each)) = real, columns_.col(column(each) + 1) = imaginary;
      }
    }
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols());
    products.selfadjointView<Eigen::Lower>().rankUpdate(columns_.transpose());
    products_.compute(products);
    factors_ = products_.solve(columns_.transpose() * forces_);
    rest_ = forces_ - columns_ * factors_;
  }
  double left() const { return rest_.squaredNorm() / static_cast<double>(forces_.rows()); }

  /// How far the waves of the last fit should move, in periods over a metre.
  std::vector<glm::dvec2> step(std::size_t waves) const {
    // What the forces change with a wave's periods over a metre along each axis.
    const auto unknown = static_cast<Eigen::Index>(2 * waves);
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(unknown, unknown);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknown);
    for (Eigen::Index part = 0; part < 2; ++part) {
      Eigen::MatrixXd change = Eigen::MatrixXd::Zero(forces_.rows(), unknown);
      for (std::size_t each = 0; each < harmonics_.size(); ++each) {
        const Eigen::Index at = column(each), of_wave = static_cast<Eigen::Index>(2 * harmonics_[each].wave);
        const double turn = 2 * std::numbers::pi * harmonics_[each].number;
        const Eigen::VectorXd slope =
            turn * (factors_(at + 1, part) * columns_.col(at) - factors_(at, part) * columns_.col(at + 1));
        change.col(of_wave) += slope.cwiseProduct(columns_.col(1));
        change.col(of_wave + 1) += slope.cwiseProduct(columns_.col(2));
      }
      right += change.transpose() * rest_.col(part);
      const Eigen::MatrixXd fitted = columns_.transpose() * change;
      square += change.transpose() * change - fitted.transpose() * products_.solve(fitted);
    }
    square.diagonal().array() += 1e-9 * square.diagonal().maxCoeff();
    const Eigen::VectorXd moved = square.ldlt().solve(right);
    std::vector<glm::dvec2> steps(waves);
    for (std::size_t wave = 0; wave < waves; ++wave) {
      const auto at = static_cast<Eigen::Index>(2 * wave);
      const glm::dvec2 periods(moved(at), moved(at + 1));
      const double length = glm::length(periods);
      steps[wave] = std::isfinite(length) ? std::min(1.0, farthest / length) * periods / size_ : glm::dvec2(0);
      if (length == 0) steps[wave] = glm::dvec2(0);
    }
    return steps;
  }

  LinearForce line() const {
    const auto row = [&](Eigen::Index at) { return glm::dvec2(factors_(at, 0), factors_(at, 1)); };
    return {row(0), row(1) / size_.x, row(2) / size_.y};
  }
  FoldedWave wave(std::size_t number, glm::dvec2 waves, std::size_t bins) const {
    FoldedWave wave{waves, std::vector<glm::dvec2>(bins, glm::dvec2(0)), glm::dvec2(0), 0};
    for (std::size_t each = 0; each < harmonics_.size(); ++each) {
      if (harmonics_[each].wave != number) continue;
      const Eigen::Index at = column(each);
      for (std::size_t i = 0; i < bins; ++i) {
        const double angle =
            2 * std::numbers::pi * harmonics_[each].number * (static_cast<double>(i) + 0.5) / static_cast<double>(bins);
        wave.profile[i] += std::cos(angle) * glm::dvec2(factors_(at, 0), factors_(at, 1)) +
                           std::sin(angle) * glm::dvec2(factors_(at + 1, 0), factors_(at + 1, 1));
      }
    }
    return wave;
  }

 private:
  static Eigen::Index count(std::span<const glm::dvec2> places) { return static_cast<Eigen::Index>(places.size()); }
  static Eigen::Index column(std::size_t harmonic) { return static_cast<Eigen::Index>(3 + 2 * harmonic); }

  std::span<const glm::dvec2> places_;
  std::vector<Harmonic> harmonics_;
  glm::dvec2 size_;
  Eigen::MatrixXd forces_, columns_, factors_, rest_;
  Eigen::LDLT<Eigen::MatrixXd> products_;
};

/// Moves the waves until the fit is as good as it gets near them, and gives what is left, N^2.
double improve(HarmonicFitter& fitter, std::vector<glm::dvec2>& waves, glm::dvec2 size) {
  fitter.fit(waves);
  double left = fitter.left(), share = 1;  // of a step, which may go too far
  std::vector<glm::dvec2> steps = fitter.step(waves.size());
  for (int turn = 0; turn < turns; ++turn) {
    std::vector<glm::dvec2> there = waves;
    double moved = 0;
    for (std::size_t i = 0; i < there.size(); ++i) {
      there[i] += share * steps[i];
      moved = std::max(moved, share * glm::length(steps[i] * size));
    }
    if (moved < nearly_there) break;
    fitter.fit(there);
    if (fitter.left() < left)
      waves = there, left = fitter.left(), share = 1, steps = fitter.step(waves.size());
    else
      share *= 0.5;
  }
  fitter.fit(waves);
  return left;
}

}  // namespace

HarmonicFit fit_harmonics(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                          std::span<const glm::dvec2> waves, glm::dvec2 size, std::size_t bins) {
  HarmonicFitter all(places, forces, waves, size, static_cast<int>(harmonics_beside));
  HarmonicFit found;
  all.fit(waves);
  found.left_there = all.left();
  std::vector<glm::dvec2> best(waves.begin(), waves.end()), other = best;
  // The finer harmonics of a wave of few periods fill what its wrong period leaves, and hold it there.
  HarmonicFitter first(places, forces, waves, size, 1);
  improve(first, other, size);
  found.left = improve(all, best, size);
  const double left_from_other = improve(all, other, size);
  if (left_from_other < found.left)
    best = other, found.left = left_from_other;
  else
    all.fit(best);
  found.line = all.line();
  for (std::size_t i = 0; i < best.size(); ++i) found.waves.push_back(all.wave(i, best[i], bins));
  return found;
}

LinearForce line_beside_waves(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                              std::span<const glm::dvec2> waves, glm::dvec2 size) {
  HarmonicFitter all(places, forces, waves, size, static_cast<int>(harmonics_beside));
  all.fit(waves);
  return all.line();
}

}  // namespace wale
