#include "wale/force_response.hpp"

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

/// What the bends make of the gain at s, a share of the device's force.
double bent(const ForceResponse& way, double s) noexcept {
  return 1 + way.quadratic * (s - 1) + way.cubic * (s * s - 1);
}

}  // namespace

const char* in_words(Way way) {
  switch (way) {
    case Way::right: return "right";
    case Way::left: return "left";
    case Way::away: return "away";
    case Way::toward: return "toward";
  }
  return "";
}

/// The slope is 1 - quadratic - cubic + 2 quadratic s + 3 cubic s^2, a parabola of s.
double ForceResponse::least_slope_of_bends() const noexcept {
  const auto slope = [this](double s) { return 1 - quadratic - cubic + 2 * quadratic * s + 3 * cubic * s * s; };
  double least = std::min(slope(0), slope(1));
  if (cubic != 0) {
    const double turn = -quadratic / (3 * cubic);
    if (turn > 0 && turn < 1) least = std::min(least, slope(turn));
  }
  return least;
}

AxisResponse::AxisResponse(double gain, const ForceResponse& forward, const ForceResponse& backward, double offset,
                           double peak)
    : gain_(gain),
      offset_(offset),
      peak_(peak),
      forward_(forward),
      backward_(backward),
      is_plain_(offset == 0 && forward == ForceResponse{} && backward == ForceResponse{}) {}

double AxisResponse::push(const ForceResponse& way, double command) const noexcept {
  const double u = std::max(0.0, std::min(command, peak_) - way.dead_band);
  const double force = gain_ * way.gain * u * bent(way, u / peak_);
  return way.most > 0 ? std::min(way.most, force) : force;
}

double AxisResponse::force(double command) const noexcept {
  if (is_plain_) return gain_ * command;
  return (command < 0 ? -push(backward_, -command) : push(forward_, command)) + offset_;
}

/// Halves the commands that remain: the force grows with the command wherever it can still be reached.
double AxisResponse::command_of(const ForceResponse& way, double force) const noexcept {
  if (!(force > 0)) return 0;
  if (force >= push(way, peak_)) {
    if (!(way.most > 0)) return peak_;
    force = std::min(force, way.most);  // no more command than saturates it
    if (force > push(way, peak_)) return peak_;
  }
  double low = way.dead_band, high = peak_;
  constexpr int halvings = 40;  // to 1e-12 of the peak, in less than a microsecond
  for (int i = 0; i < halvings; ++i) {
    const double middle = (low + high) / 2;
    (push(way, middle) < force ? low : high) = middle;
  }
  return high;
}

double AxisResponse::command(double force) const noexcept {
  if (is_plain_) return force / gain_;
  if (std::isnan(force) || force == 0) return 0;
  const double share = offset_ == 0 ? 0 : std::min(1.0, std::abs(force) / (2 * std::abs(offset_)));
  const double wanted = force - share * offset_;
  return wanted < 0 ? -command_of(backward_, -wanted) : command_of(forward_, wanted);
}

double AxisResponse::steepest_of(const ForceResponse& way) const noexcept {
  // The parabola of `bent` is greatest at an end or where it turns.
  double greatest = std::max(bent(way, 0), bent(way, 1));
  if (way.cubic != 0) {
    const double turn = -way.quadratic / (2 * way.cubic);
    if (turn > 0 && turn < 1) greatest = std::max(greatest, bent(way, turn));
  }
  const double without_band = gain_ * way.gain * greatest;
  if (!(way.dead_band > 0)) return without_band;
  // With a dead band the force of small commands is less. Between two neighbours of this grid the force is at most that
  // of the upper one, and the command at least the lower one.
  constexpr int steps = 4096;
  double steepest = 0;
  for (int i = 0; i < steps; ++i) {
    const double lower = way.dead_band + (peak_ - way.dead_band) * i / steps;
    const double upper = way.dead_band + (peak_ - way.dead_band) * (i + 1) / steps;
    steepest = std::max(steepest, push(way, upper) / lower);
  }
  return std::min(steepest, without_band);
}

double AxisResponse::steepest() const noexcept {
  return is_plain_ ? gain_ : std::max(steepest_of(forward_), steepest_of(backward_));
}

}  // namespace wale
