#include "compiler/declarations/discrimination.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace wale {
namespace {

/// The `threshold` declarations for this cue are about forces, in newtons.
constexpr std::string_view force_cue = "amplitude";

/// Visits every threshold, those that every file knows first.
template <typename Visit>
void each_threshold(const Declarations& declarations, const Visit& visit) {
  if (declarations.common) each_threshold(*declarations.common, visit);
  for (const Threshold& threshold : declarations.own_thresholds) visit(threshold);
}

}  // namespace

Discrimination::Discrimination(const Declarations& declarations, std::string_view cue, std::string device,
                               double exerts)
    : device_(std::move(device)) {
  double least_force = 0;
  thresholds_.reserve(8);  // usually enough
  each_threshold(declarations, [&](const Threshold& each) {
    if (each.recognised > 0) return;
    if (each.cue == cue) thresholds_.push_back(&each);
    if (each.cue == force_cue && each.floor > least_force) least_force = each.floor, of_least_ = &each;
  });
  if (exerts > 0) least_ = least_force / exerts;
  std::ranges::stable_sort(thresholds_, {}, [&](const Threshold* each) {
    return std::tuple(each->simulated(), each->device != device_, each->evidence, each->weber);
  });
}

const Threshold* Discrimination::threshold(double a, double b) const {
  if (thresholds_.empty()) return nullptr;
  const bool own = thresholds_.front()->device == device_;
  for (const Threshold* each : thresholds_) {
    if (own && each->device != device_) break;
    if (each->compared(a, b)) return each;
  }
  return thresholds_.front();
}

const Threshold* recognition(const Declarations& declarations, std::string_view cue, const std::string& device) {
  const Threshold* best = nullptr;
  each_threshold(declarations, [&](const Threshold& each) {
    if (!(each.recognised > 0) || each.cue != cue) return;
    const auto rank = [&](const Threshold& of) {
      return std::tuple(of.simulated(), of.device != device, of.evidence, of.recognised);
    };
    if (!best || rank(each) < rank(*best)) best = &each;
  });
  return best;
}

Evidence Discrimination::evidence(const Threshold& threshold) const {
  return std::max(
      {threshold.evidence, threshold.handle, threshold.device == device_ ? Evidence::measured : Evidence::transferred});
}

double Discrimination::floor(const Threshold& threshold) const { return std::max(threshold.floor, least_); }

const Threshold* Discrimination::floor_between(double a, double b) const {
  const Threshold* found = a == b ? nullptr : threshold(a, b);
  if (!found || !(floor(*found) > 0)) return nullptr;
  const double large = std::max(std::abs(a), std::abs(b)), small = std::min(std::abs(a), std::abs(b));
  if (a * b > 0 && std::log(large / small) / std::log1p(found->weber) <= std::abs(a - b) / floor(*found)) return nullptr;
  return found->floor >= least_ ? found : of_least_;
}

std::optional<double> Discrimination::distance(double a, double b) const {
  if (a == b) return 0;
  const Threshold* found = threshold(a, b);
  if (!found) return std::nullopt;
  // Sizes of opposite signs, one pushing and one resisting, have no meaningful ratio.
  const double by_ratio =
      a * b > 0 ? found->distance(std::abs(a), std::abs(b)) : std::numeric_limits<double>::infinity();
  const double least = floor(*found);
  const double distance = std::min(by_ratio, least > 0 ? std::abs(a - b) / least : by_ratio);
  return std::isfinite(distance) ? std::optional(distance) : std::nullopt;
}

SizeRange Discrimination::within(double size, double most) const {
  constexpr double infinite = std::numeric_limits<double>::infinity(), rounding = 1e-6;
  SizeRange range{-infinite, infinite};
  double weber = 0, greatest = 0, smallest = infinite;
  for (const Threshold* each : thresholds_) {
    weber = std::max(weber, each->weber);
    greatest = std::max(greatest, floor(*each)), smallest = std::min(smallest, floor(*each));
  }
  if (thresholds_.empty() || !std::isfinite(size) || !std::isfinite(most)) return range;
  // Without a floor, the distance from 0 or from the other sign is unknown.
  const double times = std::exp(most * std::log1p(weber)) * (1 + rounding);
  const double beside = most * greatest * (1 + rounding) + rounding * std::abs(size);
  if (smallest > 0 || size > 0) range.high = std::max(size + beside, size > 0 ? size * times : size / times);
  if (smallest > 0 || size < 0) range.low = std::min(size - beside, size > 0 ? size / times : size * times);
  return range;
}

}  // namespace wale
