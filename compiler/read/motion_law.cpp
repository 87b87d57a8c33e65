#include "compiler/read/motion_law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "compiler/read/tolerances.hpp"
#include "compiler/read/unlimited.hpp"

namespace wale {
namespace {

constexpr double nothing = 1e-5;              // N
constexpr double least_below_strokes = 0.25;  // of the strokes: below the device's limit
constexpr double not_told = 0.08;             // of the largest force: a law that leaves more at a speed is none
constexpr double not_told_there = 0.15;       // of the force at a speed: nor is one that leaves more of it
constexpr double usual_speed = 0.195;         // m/s: a drag that still grows with an exploring hand's is a viscosity
constexpr double surely_off = 3;              // standard errors
constexpr double plainly_left = 0.005;        // of the largest force
constexpr double share_left = 0.25;           // of what another law leaves
constexpr double fewest_for_a_power = 3;      // speeds

/// The laws of friction that are tried, simplest first: which of friction and damping there is, and whether the
/// friction rises with the speed until it is whole.
struct FrictionLaw {
  bool friction, damping, rises;
};
constexpr std::array<FrictionLaw, 5> laws = {
    {{false, true, false}, {true, false, false}, {true, true, false}, {true, false, true}, {true, true, true}}};
constexpr double well_fitted = 0.02;  // of the largest force: a law that leaves less is good enough
constexpr int rises_tried = 60;

OpposingForce no_fit() {
  OpposingForce none;
  none.scatter = HUGE_VAL;
  return none;
}

/// One law by least squares, with a friction that is whole from the speed `whole` on.
OpposingForce fitted(const FrictionLaw& law, double whole, const std::vector<Stroke>& strokes,
                     const std::vector<double>& opposed) {
  double ss = 0, sv = 0, vv = 0, sf = 0, vf = 0;
  const auto share = [&](double speed) { return !law.friction ? 0.0 : whole > 0 ? std::min(1.0, speed / whole) : 1.0; };
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double v = law.damping ? strokes[i].speed : 0, s = share(strokes[i].speed), f = opposed[i];
    ss += s * s, sv += s * v, vv += v * v, sf += s * f, vf += v * f;
  }
  OpposingForce found;
  const double area = ss * vv - sv * sv;
  if (law.friction && law.damping) {
    if (area < 1e-6 * ss * vv) return no_fit();
    found.friction = (vv * sf - sv * vf) / area, found.damping = (ss * vf - sv * sf) / area;
  } else if (law.friction) {
    found.friction = sf / ss;
  } else {
    found.damping = vf / vv;
  }
  found.saturation_speed = law.rises ? whole : 0;
  double squares = 0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double v = strokes[i].speed, off = opposed[i] - found.friction * share(v) - found.damping * v;
    squares += off * off;
  }
  found.scatter = std::sqrt(squares / static_cast<double>(strokes.size()));
  return found;
}

/// The mean forces along the strokes of each speed, and their standard errors.
struct MeansBySpeed {
  std::vector<DragAt> means;
  std::vector<double> errors;
};
MeansBySpeed means_by_speed(const std::vector<Stroke>& strokes, const std::vector<double>& opposed) {
  std::map<double, std::vector<double>> by_speed;
  for (std::size_t i = 0; i < strokes.size(); ++i) by_speed[strokes[i].speed].push_back(opposed[i]);
  MeansBySpeed found;
  for (const auto& [speed, forces] : by_speed) {
    const auto count = static_cast<double>(forces.size());
    double mean = 0, squares = 0;
    for (const double force : forces) mean += force / count;
    for (const double force : forces) squares += (force - mean) * (force - mean);
    found.means.push_back({speed, mean});
    found.errors.push_back(std::sqrt(squares) / count);
  }
  return found;
}

}  // namespace

std::vector<DragAt> mean_drags(const std::vector<Stroke>& strokes, const std::vector<double>& opposed) {
  return means_by_speed(strokes, opposed).means;
}

namespace {

/// Whether a law tells the force at each speed, as well as that is known. Three figures come near to any curve, so they
/// must tell it as well as a law is fitted.
bool tells_all_speeds(const OpposingForce& law, const MeansBySpeed& by_speed, double largest) {
  const double share_left_out = law.rise() > 0 && law.damping != 0 ? well_fitted : not_told;
  for (std::size_t i = 0; i < by_speed.means.size(); ++i) {
    const auto [speed, newton] = by_speed.means[i];
    const double share = law.saturation_speed > 0 ? std::min(1.0, speed / law.saturation_speed) : 1;
    const double off = std::abs(newton - law.friction * share - law.damping * speed);
    const double left = std::min(share_left_out * largest, not_told_there * std::abs(newton));
    if (off > std::max(least_force, left) + surely_off * by_speed.errors[i]) return false;
  }
  return true;
}

/// Whether friction and damping push the way that the force does, if that is one way at all speeds.
bool plausible(const OpposingForce& law, const MeansBySpeed& by_speed) {
  const auto [least, most] = std::ranges::minmax_element(by_speed.means, {}, &DragAt::newton);
  const bool opposes = least->newton > -least_force, pushes_on = most->newton < least_force;
  if (opposes && (law.friction <= -least_force || law.damping <= -least_damping)) return false;
  return !pushes_on || (law.friction < least_force && law.damping < least_damping);
}

/// The power of the speed to which a force grows, and what that leaves (N); 0 if it does not.
struct Power {
  double exponent = 0, left = 0;
};
Power power_of(const std::vector<DragAt>& by_speed) {
  double count = 0, x = 0, y = 0, xx = 0, xy = 0;
  const double sign = by_speed.back().newton < 0 ? -1 : 1;
  for (const DragAt& each : by_speed) {
    if (sign * each.newton < least_force) continue;
    const double a = std::log(each.speed), b = std::log(sign * each.newton);
    count += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  if (count < fewest_for_a_power) return {};
  const double power = (count * xy - x * y) / (count * xx - x * x), at_one = std::exp((y - power * x) / count);
  double squares = 0;
  for (const DragAt& each : by_speed) {
    const double told = at_one * std::pow(each.speed, power), off = std::abs(sign * each.newton - told);
    if (off > std::max(least_force, well_fitted * told)) return {};
    squares += off * off / static_cast<double>(by_speed.size());
  }
  return power > 0 ? Power{power, std::sqrt(squares)} : Power{};
}

/// A law whose friction is whole from some speed on: that speed as well as the strokes show it.
OpposingForce rising(const FrictionLaw& law, const std::vector<Stroke>& strokes, const std::vector<double>& opposed) {
  const auto [slow, fast] = std::ranges::minmax_element(strokes, {}, &Stroke::speed);
  const double slowest = slow->speed, times = std::pow(fast->speed / slowest, 1.0 / rises_tried);
  OpposingForce found = no_fit();
  double at = 0;
  for (int i = 0; i < rises_tried; ++i) {
    const double whole = slowest * std::pow(times, i + 0.5);
    const OpposingForce other = fitted(law, whole, strokes, opposed);
    if (other.scatter < found.scatter) found = other, at = whole;
  }
  if (!(at > 0)) return found;
  for (double step = std::sqrt(times); step > 1 + 1e-4; step = std::sqrt(step))
    for (const double whole : {at / step, at * step}) {
      const OpposingForce other = fitted(law, whole, strokes, opposed);
      if (other.scatter < found.scatter) found = other, at = whole;
    }
  return found;
}

}  // namespace

OpposingForce law_of(std::vector<Stroke> strokes, std::vector<double> opposed, double most) {
  std::vector<Stroke> below;
  std::vector<double> opposed_below;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (!at_limit({opposed[i], 0}, most)) below.push_back(strokes[i]), opposed_below.push_back(opposed[i]);
  if (below.size() >= least_below_strokes * static_cast<double>(strokes.size()))
    strokes = std::move(below), opposed = std::move(opposed_below);
  double largest = 0;
  for (const double force : opposed) largest = std::max(largest, std::abs(force));
  if (largest < nothing) return {};
  const MeansBySpeed by_speed = means_by_speed(strokes, opposed);
  OpposingForce best = no_fit();
  for (const FrictionLaw& law : laws) {
    const OpposingForce found = law.rises ? rising(law, strokes, opposed) : fitted(law, 0, strokes, opposed);
    if (!plausible(found, by_speed)) continue;
    // What is nothing beside the force on a fast hand may be most of that on a slow one.
    const bool tells = tells_all_speeds(found, by_speed, largest);
    if (found.scatter < 0.7 * best.scatter || (tells && !tells_all_speeds(best, by_speed, largest))) best = found;
    if (best.scatter < well_fitted * largest && tells) break;
  }
  const Power power = power_of(by_speed.means);
  best.by_speed = by_speed.means, best.exponent = power.exponent;
  if (!std::isfinite(best.scatter)) best.scatter = 0;
  // A power that leaves hardly anything beside two terms that leave more is the law.
  const bool other = power.exponent > 0 && best.friction != 0 && best.damping != 0 &&
                     best.scatter > plainly_left * largest && power.left < share_left * best.scatter;
  best.explained = !other && tells_all_speeds(best, by_speed, largest);
  if (best.explained && best.damping == 0 && best.saturation_speed >= usual_speed) {
    best.damping = best.friction / best.saturation_speed, best.limit = std::abs(best.friction);
    best.friction = best.saturation_speed = 0;
  }
  return best;
}

}  // namespace wale
