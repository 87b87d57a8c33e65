#include "calibration/analysis/mixed_likelihood.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>

namespace wale::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Matrices over the varying terms, without memory of their own.
constexpr Index most_varying = 6;
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_varying, most_varying>;

const double log_two_pi = std::log(2 * std::numbers::pi);

}  // namespace

MixedLikelihood::MixedLikelihood(const MixedData& data) {
  fixed_ = data.fixed.columns.cols();
  trials_ = static_cast<double>(data.y.size());
  shift_ = data.y.mean();
  for (const std::size_t each : data.varying) varying_.push_back(static_cast<Index>(each));
  products_.assign(data.observers, MatrixXd::Zero(fixed_ + 1, fixed_ + 1));
  // Rows of one observer that follow each other are multiplied at once.
  constexpr Index most = 4096;
  MatrixXd block(most, fixed_ + 1);
  for (Index begin = 0; begin < data.y.size();) {
    const std::uint32_t observer = data.observer[static_cast<std::size_t>(begin)];
    Index end = begin;
    while (end < data.y.size() && end - begin < most && data.observer[static_cast<std::size_t>(end)] == observer) ++end;
    const Index rows = end - begin;
    if (rows == 1) {  // answers of several observers in turn
      VectorXd row(fixed_ + 1);
      row.head(fixed_) = data.fixed.columns.row(begin).transpose();
      row(fixed_) = data.y(begin) - shift_;
      products_[observer].noalias() += row * row.transpose();
    } else {
      block.topLeftCorner(rows, fixed_) = data.fixed.columns.middleRows(begin, rows);
      block.col(fixed_).head(rows) = data.y.segment(begin, rows).array() - shift_;
      products_[observer].noalias() += block.topRows(rows).transpose() * block.topRows(rows);
    }
    begin = end;
  }
  scales_ = VectorXd::Ones(varying());
  for (Index i = 0; i < varying(); ++i) {
    double squares = 0;
    for (const MatrixXd& each : products_) squares += each(varying_[static_cast<std::size_t>(i)], varying_[static_cast<std::size_t>(i)]);
    scales_(i) = std::sqrt(squares / trials_);
  }
  group_alike();
}

void MixedLikelihood::group_alike() {
  const Index q = varying(), k = fixed_ + 1;
  total_ = MatrixXd::Zero(k, k);
  for (const MatrixXd& each : products_) total_ += each;
  if (q == 0) return;
  // Sums in another order differ in their last digits, so eleven of them count.
  std::map<std::string, std::size_t> known;
  std::vector<std::vector<MatrixXd>> crosses;
  MatrixXd cross(q, k), inner(q, q);
  for (const MatrixXd& each : products_) {
    std::string key;
    for (Index i = 0; i < q; ++i) cross.row(i) = each.row(varying_[static_cast<std::size_t>(i)]);
    for (Index i = 0; i < q; ++i) inner.col(i) = cross.col(varying_[static_cast<std::size_t>(i)]);
    for (Index i = 0; i < q; ++i)
      for (Index j = 0; j <= i; ++j) {
        // What is nothing beside the diagonal is rounding.
        const bool nothing = std::abs(inner(i, j)) < 1e-11 * std::sqrt(inner(i, i) * inner(j, j));
        char text[32];
        std::snprintf(text, sizeof text, "%.10e ", nothing ? 0.0 : inner(i, j));
        key += text;
      }
    const auto [at, is_new] = known.try_emplace(key, alike_.size());
    if (is_new) alike_.push_back({inner, 0, {}, {}}), crosses.emplace_back();
    alike_[at->second].count += 1;
    crosses[at->second].push_back(cross);
  }
  for (std::size_t group = 0; group < alike_.size(); ++group) {
    Alike& each = alike_[group];
    if (crosses[group].size() < static_cast<std::size_t>(4 * q)) {
      each.crosses = std::move(crosses[group]);
      continue;
    }
    each.moments.assign(static_cast<std::size_t>(q * q), MatrixXd::Zero(k, k));
    for (const MatrixXd& own : crosses[group])
      for (Index i = 0; i < q; ++i)
        for (Index j = 0; j < q; ++j)
          each.moments[static_cast<std::size_t>(i * q + j)].noalias() += own.row(i).transpose() * own.row(j);
  }
}

MixedLikelihood::Parts MixedLikelihood::parts(const MatrixXd& factor) const {
  const Index q = varying(), k = fixed_ + 1;
  Parts result;
  result.products = total_;
  Small middle(q, q), weights(q, q);
  MatrixXd half(q, k);
  Eigen::LLT<Small> lower_middle(q);
  for (const Alike& each : alike_) {
    const Small within = each.inner * factor;
    middle.noalias() = factor.transpose() * within;
    middle.diagonal().array() += 1;
    lower_middle.compute(middle);
    if (lower_middle.info() != Eigen::Success) {
      result.log_determinant = HUGE_VAL;
      return result;
    }
    for (Index i = 0; i < q; ++i) result.log_determinant += 2 * each.count * std::log(lower_middle.matrixLLT()(i, i));
    Small way = factor.transpose();
    lower_middle.matrixL().solveInPlace(way);
    for (const MatrixXd& cross : each.crosses) {
      half.noalias() = way * cross;
      result.products.noalias() -= half.transpose() * half;
    }
    if (each.moments.empty()) continue;
    weights.noalias() = way.transpose() * way;
    for (Index i = 0; i < q; ++i)
      for (Index j = 0; j < q; ++j) result.products -= weights(i, j) * each.moments[static_cast<std::size_t>(i * q + j)];
  }
  const Eigen::LLT<MatrixXd> lower(result.products.topLeftCorner(fixed_, fixed_));
  if (lower.info() != Eigen::Success) {
    result.log_determinant = HUGE_VAL;
    return result;
  }
  result.coefficients = lower.solve(result.products.col(fixed_).head(fixed_));
  result.squares = result.products(fixed_, fixed_) - result.products.col(fixed_).head(fixed_).dot(result.coefficients);
  result.log_determinant_of_products = 2 * lower.matrixL().toDenseMatrix().diagonal().array().log().sum();
  return result;
}

double MixedLikelihood::residual(const Parts& parts, Criterion criterion) const {
  const double freedom = criterion == Criterion::restricted ? trials_ - static_cast<double>(fixed_) : trials_;
  return std::sqrt(std::max(parts.squares, 0.0) / freedom);
}

double MixedLikelihood::at(const MatrixXd& factor, double residual, Criterion criterion) const {
  const Parts found = parts(factor);
  if (!std::isfinite(found.log_determinant)) return HUGE_VAL;
  const double variance = residual * residual;
  const double freedom = criterion == Criterion::restricted ? trials_ - static_cast<double>(fixed_) : trials_;
  return found.log_determinant + freedom * (log_two_pi + std::log(variance)) + found.squares / variance +
         (criterion == Criterion::restricted ? found.log_determinant_of_products : 0);
}

double MixedLikelihood::profiled(const MatrixXd& factor, Criterion criterion) const {
  const Parts found = parts(factor);
  if (!std::isfinite(found.log_determinant) || !(found.squares > 0)) return HUGE_VAL;
  const double freedom = criterion == Criterion::restricted ? trials_ - static_cast<double>(fixed_) : trials_;
  return found.log_determinant + freedom * (1 + log_two_pi + std::log(found.squares / freedom)) +
         (criterion == Criterion::restricted ? found.log_determinant_of_products : 0);
}

double MixedLikelihood::with_coefficient(const MatrixXd& factor, std::size_t coefficient, double value) const {
  const Parts found = parts(factor);
  if (!std::isfinite(found.log_determinant)) return HUGE_VAL;
  const auto held = static_cast<Index>(coefficient);
  if (held == 0) value -= shift_;
  // The least squares grow by the square of the distance over the coefficient's own variance.
  const MatrixXd inverse = found.products.topLeftCorner(fixed_, fixed_).llt().solve(MatrixXd::Identity(fixed_, fixed_));
  const double away = value - found.coefficients(held);
  const double squares = found.squares + away * away / inverse(held, held);
  return found.log_determinant + trials_ * (1 + log_two_pi + std::log(squares / trials_));
}

VectorXd MixedLikelihood::observer_terms(std::size_t observer, const MatrixXd& factor, const VectorXd& coefficients) const {
  const Index q = varying();
  const MatrixXd& own = products_[observer];
  MatrixXd inner(q, q);
  VectorXd toward(q);
  for (Index i = 0; i < q; ++i) {
    const Index row = varying_[static_cast<std::size_t>(i)];
    for (Index j = 0; j < q; ++j) inner(i, j) = own(row, varying_[static_cast<std::size_t>(j)]);
    toward(i) = own(row, fixed_) - own.row(row).head(fixed_).dot(coefficients);
  }
  const MatrixXd middle = MatrixXd::Identity(q, q) + factor.transpose() * inner * factor;
  return factor * middle.llt().solve(factor.transpose() * toward);
}

double MixedLikelihood::squares_about(std::size_t observer, const VectorXd& coefficients, const VectorXd& terms) const {
  VectorXd weights(fixed_ + 1);
  weights.head(fixed_) = -coefficients;
  weights(fixed_) = 1;
  for (Index i = 0; i < varying(); ++i) weights(varying_[static_cast<std::size_t>(i)]) -= terms(i);
  return weights.dot(products_[observer] * weights);
}

}  // namespace wale::analysis
