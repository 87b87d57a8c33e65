#include "compiler/measure/small_feature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/peak.hpp"

namespace wale {
namespace {

constexpr double pushes = 0.05;        // of the amplitude: a smaller force is hardly felt beside it
constexpr double least_held = 0.25;    // of the places where it pushes
constexpr double most_covered = 0.04;  // of the patch; textures cover far more
constexpr double least_steeper = 2;    // half of the greatest slope comes out no weaker than all of it
constexpr double left_out = 1e-4;      // of the places: a single tip tells nothing of the shape

/// The share under peak number `index`.
SlopedShare share_of(const Bank& bank, std::size_t index) {
  const FloatingPointMode mode;
  const Peak& peak = bank.program().description().peaks[index];
  std::vector<float> slopes(peak.points);
  each_under_peak(bank.program().decoded(), index, bank.registers(),
                  [&](std::size_t point, float slope) { slopes[point] = slope; });
  std::ranges::sort(slopes);
  const auto places = static_cast<double>(slopes.size());
  const auto at = [&](double share) {
    return double{slopes[static_cast<std::size_t>(std::clamp(std::ceil(share * places), 1.0, places)) - 1]};
  };
  const auto from = [&](double slope, bool or_at) {
    const auto first = or_at ? std::ranges::lower_bound(slopes, static_cast<float>(slope))
                             : std::ranges::upper_bound(slopes, static_cast<float>(slope));
    return static_cast<double>(slopes.end() - first) / places;
  };
  SlopedShare share;
  const double percentile = at(double{peak.percentile});
  share.covered = from(pushes * percentile, false);
  if (share.covered == 0) return share;
  share.held = from(percentile, true) / share.covered;
  share.steeper = percentile > 0 ? at(1 - left_out) / percentile : std::numeric_limits<double>::infinity();
  return share;
}

/// Whether every height of the program has slopes enough on a bank's patch.
bool has_room_for_features(const Bank& bank) {
  constexpr double surely = 1.25;  // so that it is not on the verge of the warning
  for (std::size_t i = 0; i < bank.program().description().peaks.size(); ++i) {
    const SlopedShare share = share_of(bank, i);
    if (!std::isfinite(share.steeper) || share.covered < surely * most_covered) return false;
  }
  return true;
}

}  // namespace

bool SlopedShare::is_mostly_held() const {
  return std::isfinite(steeper) && covered <= most_covered && held >= least_held && steeper >= least_steeper;
}

std::optional<SlopedShare> sloped_share(const Bank& bank) {
  std::optional<SlopedShare> worst;
  for (std::size_t i = 0; i < bank.program().description().peaks.size(); ++i) {
    const SlopedShare share = share_of(bank, i);
    const bool worse = !worst || (share.is_mostly_held() && !worst->is_mostly_held()) ||
                       (share.is_mostly_held() == worst->is_mostly_held() && share.steeper > worst->steeper);
    if (worse) worst = share;
  }
  return worst;
}

std::optional<PatchSize> patch_for_feature(const Bank& bank) {
  constexpr double smaller = 0.9, least_side = 0.008;  // m: a patch of which half is rim
  const Program& program = bank.program();
  const DeviceProfile& device = program.description().device;
  const auto parameters = program.default_parameters();
  const auto rounded = [](double side) {
    const double step = side >= 0.02 ? 5e-3 : 1e-3;
    return std::floor(side / step + 1e-6) * step;
  };
  PatchSize before = bank.size();
  for (double share = smaller;; share *= smaller) {
    const double width = rounded(share * bank.size().width), height = rounded(share * bank.size().height);
    if (std::min(width, height) < least_side) return std::nullopt;
    const PatchSize size{.width = static_cast<float>(width),
                         .height = static_cast<float>(height),
                         .rim = static_cast<float>(std::min(double{device.patch_rim}, 0.25 * std::min(width, height)))};
    if (size == before) continue;
    before = size;
    if (has_room_for_features(Bank(program, parameters, size))) return size;
  }
}

}  // namespace wale
