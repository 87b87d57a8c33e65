#include "calibration/analysis/sorting.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace wale::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// How many stimuli lie in each pair of groups of two groupings.
std::vector<std::vector<std::size_t>> shared_counts(const Grouping& a, const Grouping& b) {
  std::map<std::size_t, std::size_t> of_a, of_b;
  for (const std::size_t each : a) of_a.try_emplace(each, of_a.size());
  for (const std::size_t each : b) of_b.try_emplace(each, of_b.size());
  std::vector<std::vector<std::size_t>> counts(of_a.size(), std::vector<std::size_t>(of_b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) ++counts[of_a[a[i]]][of_b[b[i]]];
  return counts;
}

/// The least sum of a one to one assignment of rows to columns of a square matrix (Kuhn 1955, by shortest paths).
long least_assignment(const std::vector<std::vector<long>>& costs) {
  const std::size_t n = costs.size();
  constexpr long infinity = std::numeric_limits<long>::max() / 4;
  std::vector<long> of_row(n + 1), of_column(n + 1);
  std::vector<std::size_t> row_of(n + 1), before(n + 1);
  for (std::size_t row = 1; row <= n; ++row) {
    row_of[0] = row;
    std::size_t column = 0;
    std::vector<long> least(n + 1, infinity);
    std::vector<bool> used(n + 1);
    do {
      used[column] = true;
      const std::size_t at = row_of[column];
      long step = infinity;
      std::size_t next = 0;
      for (std::size_t j = 1; j <= n; ++j) {
        if (used[j]) continue;
        const long reduced = costs[at - 1][j - 1] - of_row[at] - of_column[j];
        if (reduced < least[j]) least[j] = reduced, before[j] = column;
        if (least[j] < step) step = least[j], next = j;
      }
      for (std::size_t j = 0; j <= n; ++j)
        if (used[j]) of_row[row_of[j]] += step, of_column[j] -= step;
        else least[j] -= step;
      column = next;
    } while (row_of[column] != 0);
    while (column != 0) {
      row_of[column] = row_of[before[column]];
      column = before[column];
    }
  }
  return -of_column[0];
}

double pairs(std::size_t count) { return 0.5 * static_cast<double>(count) * (static_cast<double>(count) - 1); }

}  // namespace

MatrixXd co_occurrence(const std::vector<Grouping>& groupings) {
  const auto n = static_cast<Index>(groupings.empty() ? 0 : groupings.front().size());
  MatrixXd counts = MatrixXd::Zero(n, n);
  for (const Grouping& each : groupings)
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j)
        counts(i, j) += each[static_cast<std::size_t>(i)] == each[static_cast<std::size_t>(j)] ? 1 : 0;
  return counts;
}

MatrixXd times_apart(const std::vector<Grouping>& groupings) {
  return (static_cast<double>(groupings.size()) - co_occurrence(groupings).array()).matrix();
}

std::vector<Merge> cluster(const MatrixXd& distances, Linkage linkage) {
  const auto n = static_cast<std::size_t>(distances.rows());
  MatrixXd apart = distances;
  std::vector<std::size_t> names(n), sizes(n, 1);  // of the clusters in the rows of `apart`
  std::iota(names.begin(), names.end(), std::size_t{0});
  std::vector<Merge> merges;
  while (names.size() > 1) {
    std::size_t a = 0, b = 1;
    for (std::size_t i = 0; i < names.size(); ++i)
      for (std::size_t j = i + 1; j < names.size(); ++j)
        if (apart(static_cast<Index>(i), static_cast<Index>(j)) < apart(static_cast<Index>(a), static_cast<Index>(b))) a = i, b = j;
    const auto row = static_cast<Index>(a), other = static_cast<Index>(b);
    merges.push_back({std::min(names[a], names[b]), std::max(names[a], names[b]), apart(row, other), sizes[a] + sizes[b]});
    const auto of_a = static_cast<double>(sizes[a]), of_b = static_cast<double>(sizes[b]);
    for (Index k = 0; k < apart.rows(); ++k) {
      const double one = apart(row, k), two = apart(other, k);
      apart(row, k) = linkage == Linkage::single     ? std::min(one, two)
                      : linkage == Linkage::complete ? std::max(one, two)
                                                     : (of_a * one + of_b * two) / (of_a + of_b);
      apart(k, row) = apart(row, k);
    }
    apart(row, row) = 0;
    names[a] = n + merges.size() - 1, sizes[a] += sizes[b];
    // The row of the second cluster goes; those behind it move up, so that the order by first stimuli stays.
    const Index last = apart.rows() - 1;
    for (Index k = other; k < last; ++k) apart.row(k) = apart.row(k + 1).eval();
    for (Index k = other; k < last; ++k) apart.col(k) = apart.col(k + 1).eval();
    apart.conservativeResize(last, last);
    names.erase(names.begin() + static_cast<std::ptrdiff_t>(b)), sizes.erase(sizes.begin() + static_cast<std::ptrdiff_t>(b));
  }
  return merges;
}

Grouping cut(const std::vector<Merge>& merges, std::size_t clusters) {
  const std::size_t n = merges.size() + 1;
  std::vector<std::size_t> above(2 * n - 1);
  std::iota(above.begin(), above.end(), std::size_t{0});
  const std::size_t steps = n - std::clamp<std::size_t>(clusters, 1, n);
  for (std::size_t i = 0; i < steps; ++i) above[merges[i].first] = above[merges[i].second] = n + i;
  Grouping result;
  std::map<std::size_t, std::size_t> numbers;
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t at = i;
    while (above[at] != at) at = above[at];
    result.push_back(numbers.try_emplace(at, numbers.size()).first->second);
  }
  return result;
}

std::vector<std::size_t> leaves_in_order(const std::vector<Merge>& merges) {
  const std::size_t n = merges.size() + 1;
  std::vector<std::vector<std::size_t>> below(n + merges.size());
  for (std::size_t i = 0; i < n; ++i) below[i] = {i};
  for (std::size_t i = 0; i < merges.size(); ++i) {
    below[n + i] = std::move(below[merges[i].first]);
    const auto& more = below[merges[i].second];
    below[n + i].insert(below[n + i].end(), more.begin(), more.end());
  }
  return below.back();
}

std::size_t distance_from_prototype(const Grouping& grouping, const Grouping& prototype) {
  const auto counts = shared_counts(grouping, prototype);
  const std::size_t rows = counts.size(), columns = rows == 0 ? 0 : counts.front().size(), n = std::max(rows, columns);
  std::vector<std::vector<long>> costs(n, std::vector<long>(n));
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) costs[i][j] = -static_cast<long>(counts[i][j]);
  return n == 0 ? 0 : static_cast<std::size_t>(static_cast<long>(grouping.size()) + least_assignment(costs));
}

double adjusted_rand_index(const Grouping& a, const Grouping& b) {
  const auto counts = shared_counts(a, b);
  if (counts.empty()) return 1;
  double together = 0, in_a = 0, in_b = 0;
  std::vector<std::size_t> columns(counts.front().size());
  for (const auto& row : counts) {
    std::size_t sum = 0;
    for (std::size_t j = 0; j < row.size(); ++j) together += pairs(row[j]), sum += row[j], columns[j] += row[j];
    in_a += pairs(sum);
  }
  for (const std::size_t each : columns) in_b += pairs(each);
  const double all = pairs(a.size());
  const double expected = all > 0 ? in_a * in_b / all : 0, most = (in_a + in_b) / 2;
  return most == expected ? 1 : (together - expected) / (most - expected);
}

}  // namespace wale::analysis
