#include "compiler/read/only_direction.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr std::size_t places_on_lines = 97;
constexpr double farthest_across = 0.25;  // of the patch's smaller side
constexpr double first_window = 0.12;     // rad to each side
constexpr double first_shift = 0.5;       // of a grain
constexpr double times_farther = 3;       // from one look to the next
constexpr int angles_aside = 4;           // tried at each look, to each side
constexpr double finest_window = 1e-5;    // rad

/// What of a relief changes along lines that cross this direction, of its mean square.
class ChangeAcross {
 public:
  ChangeAcross(const StillField& field, const StillForces& whole, const LinearForce& trend, double rms)
      : field_(field), trend_(trend), mean_square_(rms * rms) {
    const double inner = 1 - 2 * farthest_across;
    const std::size_t every = std::max<std::size_t>(1, whole.places.size() / places_on_lines);
    for (std::size_t i = every / 2; i < whole.places.size(); i += every)
      places_.push_back(whole.centre + inner * (whole.places[i] - whole.centre));
    before_ = relief_at(places_);
  }

  double operator()(double angle, double shift) const {
    const glm::dvec2 across(-std::sin(angle), std::cos(angle));
    double changes = 0;
    std::vector<glm::dvec2> shifted = places_;
    // By unlike parts of the shift, so that no period fits into all of them.
    for (std::size_t i = 0; i < shifted.size(); ++i) {
      const double part = (i % 2 == 0 ? 1 : -1) * (0.4 + 0.6 * std::fmod(0.618034 * static_cast<double>(i), 1.0));
      shifted[i] += part * shift * across;
    }
    const std::vector<glm::dvec2> after = relief_at(shifted);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const glm::dvec2 change = after[i] - before_[i];
      changes += glm::dot(change, change);
    }
    return changes / (2 * mean_square_ * static_cast<double>(after.size()));
  }

 private:
  std::vector<glm::dvec2> relief_at(const std::vector<glm::dvec2>& places) const {
    std::vector<glm::dvec2> forces = field_(places);
    for (std::size_t i = 0; i < forces.size(); ++i) forces[i] -= trend_.at(places[i]);
    return forces;
  }

  const StillField& field_;
  LinearForce trend_;
  double mean_square_;  // N^2
  std::vector<glm::dvec2> places_, before_;
};

}  // namespace

std::optional<double> only_direction(const StillField& field, const StillForces& whole, const LinearForce& trend,
                                     double near, double rms, double grain) {
  if (!(rms > 0) || !(grain > 0)) return std::nullopt;
  const ChangeAcross change(field, whole, trend, rms);
  const double most = farthest_across * std::min(whole.size.x, whole.size.y);
  double shift = std::min(first_shift * grain, most), window = first_window, angle = near;
  // What lies farther across tells the direction more finely, once it is known so well that no period is mistaken.
  while (true) {
    double best = angle, least = HUGE_VAL;
    // From the middle outwards: of those that are as good, the nearest is kept.
    for (int step = 0; step <= 2 * angles_aside; ++step) {
      const int aside = step % 2 == 0 ? step / 2 : -(step + 1) / 2;
      const double tried = angle + window * aside / angles_aside, changed = change(tried, shift);
      if (changed < least) least = changed, best = tried;
    }
    angle = best;
    if (shift == most && (least == 0 || window < finest_window * angles_aside))
      return least <= least_of_relief * least_of_relief ? std::optional(angle) : std::nullopt;
    shift = std::min(times_farther * shift, most), window /= times_farther;
  }
}

}  // namespace wale
