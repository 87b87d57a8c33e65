#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "wale/result.hpp"

namespace wale::analysis {

/// How dissimilarities become the distances that a configuration is fitted to.
enum class ScalingKind {
  ratio,    ///< in proportion
  ordinal,  ///< in their order; equal ones may come apart (the primary approach to ties)
};

struct ScalingOptions {
  ScalingKind kind = ScalingKind::ordinal;
  int dimensions = 2;
  std::size_t random_starts = 100;  ///< besides the classical one, since one start often ends in a side valley
  std::uint64_t seed = 1;
  int most_steps = 5000;
};

/// A map of stimuli.
struct Configuration {
  Eigen::MatrixXd points;       ///< stimuli by dimensions, centred, on their principal axes
  double stress = 0;            ///< stress-1 (Kruskal 1964): 0 for a perfect fit
  double classical_stress = 0;  ///< of the classical start alone, as far as it came
  std::size_t starts = 0, near_best = 0;  ///< starts, and those that ended within 0.001 of the best stress
};

/// Classical scaling (Torgerson 1952): the coordinates along the greatest eigenvalues of the double-centred squares.
Eigen::MatrixXd classical_scaling(const Eigen::MatrixXd& dissimilarities, int dimensions);

/// Multidimensional scaling by majorisation (SMACOF: de Leeuw 1977). The same for the same seed.
///
/// Errors (W0801): a matrix that is not square, not symmetric or has negative or missing entries. W0802: fewer than
/// `dimensions` + 2 stimuli, dissimilarities that are all zero.
Result<Configuration> scale(const Eigen::MatrixXd& dissimilarities, const ScalingOptions& options = {});

/// The values nearest to `values` by least squares that do not fall.
std::vector<double> rising(const std::vector<double>& values);

}  // namespace wale::analysis
