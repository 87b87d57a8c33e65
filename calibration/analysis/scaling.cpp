#include "calibration/analysis/scaling.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "calibration/analysis/random.hpp"
#include "calibration/analysis/refusal.hpp"

namespace wale::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// The pairs of a symmetric matrix, one after the other.
struct Pair {
  Index a = 0, b = 0;
  double dissimilarity = 0;
};

MatrixXd distances_of(const MatrixXd& points) {
  const Index n = points.rows();
  MatrixXd distances = MatrixXd::Zero(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = i + 1; j < n; ++j) distances(i, j) = distances(j, i) = (points.row(i) - points.row(j)).norm();
  return distances;
}

/// Fits configurations to one set of dissimilarities.
class Scaler {
 public:
  Scaler(const MatrixXd& dissimilarities, const ScalingOptions& options) : options_(options), n_(dissimilarities.rows()) {
    for (Index i = 0; i < n_; ++i)
      for (Index j = i + 1; j < n_; ++j) pairs_.push_back({i, j, dissimilarities(i, j)});
    std::ranges::stable_sort(pairs_, {}, &Pair::dissimilarity);
  }

  /// Majorises from a start. Returns stress-1.
  double descend(MatrixXd& points) const {
    double before = 2;
    double stress = 1;
    for (int step = 0; step < options_.most_steps; ++step) {
      const MatrixXd distances = distances_of(points);
      const std::vector<double> targets = targets_of(distances);
      double squares = 0, product = 0, target_squares = 0;
      for (std::size_t k = 0; k < pairs_.size(); ++k) {
        const double d = distances(pairs_[k].a, pairs_[k].b);
        squares += d * d, product += d * targets[k], target_squares += targets[k] * targets[k];
      }
      if (!(squares > 0) || !(target_squares > 0)) return 1;
      // With the best size of the distances for the targets, 1 - (d t)^2 / (d d t t) is the square of stress-1.
      stress = std::sqrt(std::max(0.0, 1 - product * product / (squares * target_squares)));
      if (before - stress < 1e-10) break;
      before = stress;
      // The Guttman transform.
      MatrixXd weights = MatrixXd::Zero(n_, n_);
      for (std::size_t k = 0; k < pairs_.size(); ++k) {
        const auto& [a, b, ignored] = pairs_[k];
        const double d = distances(a, b);
        const double ratio = d > 1e-12 ? targets[k] / d : 0;
        weights(a, b) = weights(b, a) = -ratio;
        weights(a, a) += ratio, weights(b, b) += ratio;
      }
      points = weights * points / static_cast<double>(n_);
    }
    return stress;
  }

  MatrixXd random_start(Random& random) const {
    MatrixXd points(n_, options_.dimensions);
    for (Index i = 0; i < n_; ++i)
      for (Index j = 0; j < points.cols(); ++j) points(i, j) = random.normal();
    return points;
  }

 private:
  /// The distances that the pairs should have, in the order of `pairs_`; the sum of their squares is the number of pairs.
  std::vector<double> targets_of(const MatrixXd& distances) const {
    std::vector<double> targets;
    if (options_.kind == ScalingKind::ratio) {
      for (const Pair& each : pairs_) targets.push_back(each.dissimilarity);
    } else {
      // Equal dissimilarities take the order of their distances.
      std::vector<std::size_t> order(pairs_.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        if (pairs_[a].dissimilarity != pairs_[b].dissimilarity) return pairs_[a].dissimilarity < pairs_[b].dissimilarity;
        return distances(pairs_[a].a, pairs_[a].b) < distances(pairs_[b].a, pairs_[b].b);
      });
      std::vector<double> in_order;
      for (const std::size_t k : order) in_order.push_back(distances(pairs_[k].a, pairs_[k].b));
      const std::vector<double> fitted = rising(in_order);
      targets.resize(pairs_.size());
      for (std::size_t k = 0; k < order.size(); ++k) targets[order[k]] = fitted[k];
    }
    double squares = 0;
    for (const double each : targets) squares += each * each;
    const double factor = squares > 0 ? std::sqrt(static_cast<double>(targets.size()) / squares) : 0;
    for (double& each : targets) each *= factor;
    return targets;
  }

  const ScalingOptions& options_;
  Index n_;
  std::vector<Pair> pairs_;  // dissimilarities rising
};

/// Centred, along its principal axes; the first stimulus lies on the positive side of each.
MatrixXd on_axes(MatrixXd points) {
  points.rowwise() -= points.colwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(points.transpose() * points);
  points = points * axes.eigenvectors().rowwise().reverse();
  for (Index j = 0; j < points.cols(); ++j)
    if (points(0, j) < 0) points.col(j) *= -1;
  return points;
}

}  // namespace

std::vector<double> rising(const std::vector<double>& values) {
  // Pools neighbours that fall (Ayer et al. 1955).
  std::vector<std::pair<double, std::size_t>> blocks;  // mean, count
  for (const double value : values) {
    blocks.push_back({value, 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].first > blocks.back().first) {
      const auto [mean, count] = blocks.back();
      blocks.pop_back();
      auto& [before, of] = blocks.back();
      before = (before * static_cast<double>(of) + mean * static_cast<double>(count)) / static_cast<double>(of + count);
      of += count;
    }
  }
  std::vector<double> result;
  result.reserve(values.size());
  for (const auto& [mean, count] : blocks) result.insert(result.end(), count, mean);
  return result;
}

MatrixXd classical_scaling(const MatrixXd& dissimilarities, int dimensions) {
  const Index n = dissimilarities.rows();
  MatrixXd products = -0.5 * dissimilarities.array().square().matrix();
  const Eigen::RowVectorXd columns = products.colwise().mean();
  const double whole = products.mean();
  products = (products.rowwise() - columns).colwise() - columns.transpose();
  products.array() += whole;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(products);
  MatrixXd points(n, dimensions);
  for (int i = 0; i < dimensions; ++i) {
    const Index at = n - 1 - i;
    points.col(i) = solver.eigenvectors().col(at) * std::sqrt(std::max(solver.eigenvalues()(at), 0.0));
  }
  return points;
}

Result<Configuration> scale(const MatrixXd& dissimilarities, const ScalingOptions& options) {
  const Index n = dissimilarities.rows();
  if (n != dissimilarities.cols()) return refusal(Code::malformed_value, "the dissimilarities are no square matrix", "");
  if (!dissimilarities.allFinite() || (dissimilarities.array() < 0).any())
    return refusal(Code::malformed_value, "a dissimilarity is negative or missing", "");
  if (!dissimilarities.isApprox(dissimilarities.transpose(), 1e-9) && dissimilarities.norm() > 0)
    return refusal(Code::malformed_value, "the dissimilarities differ with the order of a pair", "take the mean of both");
  if (n < options.dimensions + 2)
    return refusal(Code::not_measured, std::to_string(n) + " stimuli fit into " + std::to_string(options.dimensions) + " dimensions in any way", "use fewer dimensions");
  if (!(dissimilarities.maxCoeff() > 0)) return refusal(Code::not_measured, "all dissimilarities are zero", "");
  const Scaler scaler(dissimilarities, options);
  Configuration best;
  Random random(options.seed);
  std::vector<double> stresses;
  for (std::size_t start = 0; start <= options.random_starts; ++start) {
    MatrixXd points = start == 0 ? classical_scaling(dissimilarities, options.dimensions) : scaler.random_start(random);
    const double stress = scaler.descend(points);
    if (start == 0) best.classical_stress = stress;
    if (start == 0 || stress < best.stress) best.stress = stress, best.points = points;
    stresses.push_back(stress);
  }
  best.points = on_axes(best.points);
  best.starts = stresses.size();
  best.near_best = static_cast<std::size_t>(std::ranges::count_if(stresses, [&](double each) { return each < best.stress + 0.001; }));
  return best;
}

}  // namespace wale::analysis
