#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale::analysis {

/// How one person sorted stimuli: the number of the group of each stimulus, any numbers.
using Grouping = std::vector<std::size_t>;

/// How often each pair of stimuli was put into one group: a symmetric matrix of counts, with the number of groupings on
/// its diagonal. All groupings are of the same stimuli.
Eigen::MatrixXd co_occurrence(const std::vector<Grouping>& groupings);

/// Distances for clusters and scaling: the number of groupings in which a pair was apart.
Eigen::MatrixXd times_apart(const std::vector<Grouping>& groupings);

/// How far a new cluster is from the others.
enum class Linkage {
  single,    ///< as the nearest of its two parts: the thesis (section 6.3.2)
  average,   ///< the mean over all pairs of stimuli
  complete,  ///< as the farthest of its two parts
};

/// A step of clustering: two clusters become one. Stimuli are clusters 0 to n - 1, and the merge of step i is cluster
/// n + i.
struct Merge {
  std::size_t first = 0, second = 0;  ///< first < second
  double distance = 0;
  std::size_t stimuli = 0;            ///< in the new cluster
};

/// Clusters stimuli by their distances, a symmetric matrix; of equal distances the pair with the lowest numbers merges
/// first. n - 1 merges, whose distances do not fall.
std::vector<Merge> cluster(const Eigen::MatrixXd& distances, Linkage linkage);

/// The grouping into `clusters` clusters (1 .. n), numbered by their first stimuli.
Grouping cut(const std::vector<Merge>& merges, std::size_t clusters);

/// The order of the stimuli in a picture of the tree, in which no lines cross.
std::vector<std::size_t> leaves_in_order(const std::vector<Merge>& merges);

/// How many stimuli would have to be moved to turn a grouping into a prototype (Minsky 1995, section 6.3.4): n minus the
/// greatest number that can stay when the groups of both are matched one to one. 0 for the same groups, whatever their
/// numbers.
std::size_t distance_from_prototype(const Grouping& grouping, const Grouping& prototype);

/// The agreement of two groupings beyond chance (Hubert and Arabie 1985): 1 for the same, about 0 for unrelated ones. 1 if
/// both have one group, or both only groups of one.
double adjusted_rand_index(const Grouping& a, const Grouping& b);

}  // namespace wale::analysis
