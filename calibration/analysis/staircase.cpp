#include "calibration/analysis/staircase.hpp"

#include <algorithm>
#include <cmath>

namespace wale::analysis {

void Staircase::update(bool right) {
  ++trials_;
  if (right) {
    wrong_ = 0;
    if (++right_ >= rule_.down) move(-1);
  } else {
    right_ = 0;
    if (++wrong_ >= rule_.up) move(1);
  }
}

void Staircase::move(int direction) {
  right_ = wrong_ = 0;
  if (direction_ != 0 && direction != direction_) reversals_.push_back(size_);
  direction_ = direction;
  const double factor =
      rule_.factors.empty() ? 1 : rule_.factors[std::min(reversals_.size(), rule_.factors.size() - 1)];
  size_ = direction > 0 ? size_ * factor : size_ / factor;
  if (rule_.least > 0) size_ = std::max(size_, rule_.least);
  if (rule_.most > 0) size_ = std::min(size_, rule_.most);
}

std::optional<double> Staircase::estimate() const {
  if (reversals_.size() < rule_.discarded + 2) return std::nullopt;
  const std::size_t count = (reversals_.size() - rule_.discarded) / 2 * 2;
  double sum = 0;
  for (std::size_t i = reversals_.size() - count; i < reversals_.size(); ++i) sum += std::log(reversals_[i]);
  return std::exp(sum / static_cast<double>(count));
}

double Staircase::converges_to(int down) { return std::pow(0.5, 1.0 / down); }

}  // namespace wale::analysis
