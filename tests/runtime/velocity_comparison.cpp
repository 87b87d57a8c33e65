// Compares the profile's velocity filter with plain differences and with Kalman filters, on the known motion of the
// simulated hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "runtime/stage/velocity_filter.hpp"
#include "tests/runtime/figures.hpp"

namespace wale::velocity_comparison_test {
namespace {

/// Estimates position and velocity, in counts and ticks. It assumes a random acceleration of variance `q` per tick, and
/// an encoder whose error is uniform over one count.
class Kalman {
 public:
  explicit Kalman(double q) : q_(q) {}

  double operator()(double counts) {
    if (!begun_) {
      begun_ = true;
      position_ = counts;
      return 0;
    }
    position_ += velocity_;
    const double a = a_ + 2 * b_ + c_ + q_ / 4, b = b_ + c_ + q_ / 2, c = c_ + q_;
    const double of_position = a / (a + 1.0 / 12), of_velocity = b / (a + 1.0 / 12), off = counts - position_;
    position_ += of_position * off;
    velocity_ += of_velocity * off;
    a_ = (1 - of_position) * a, b_ = (1 - of_position) * b, c_ = c - of_velocity * b;
    return velocity_;
  }

 private:
  double q_;
  bool begun_ = false;
  double position_ = 0, velocity_ = 0;
  double a_ = 1e6, b_ = 0, c_ = 1e6;  ///< covariance
};

using Filter = std::function<double(int counts)>;  ///< counts a tick

struct Quality {
  double error = 0;  ///< m/s, root mean square
  long delay = 0;    ///< ticks; the shift at which the true velocity fits best
  double noise = 0;  ///< m/s, root mean square of the error after that shift
};

Quality quality(const Motion& motion, const Filter& filter) {
  constexpr long settling = 900, ticks = 9000, longest = 30;
  SimulatedJoystick joystick(sandpaper(), normal_hand(), motion);
  std::vector<double> told, truth;
  for (long n = 0; n < ticks; ++n) {
    joystick.elapse(1);
    told.push_back(filter(joystick.sample().counts.x) * sandpaper().position_step() * sandpaper().rate);
    truth.push_back(joystick.velocity().x);
  }
  const auto off_by = [&](long delay) {
    double squares = 0;
    for (long n = settling; n < ticks; ++n) squares += (told[n] - truth[n - delay]) * (told[n] - truth[n - delay]);
    return std::sqrt(squares / (ticks - settling));
  };
  Quality quality{.error = off_by(0), .noise = off_by(0)};
  for (long delay = 1; delay < longest; ++delay)
    if (const double noise = off_by(delay); noise < quality.noise) quality.delay = delay, quality.noise = noise;
  return quality;
}

const std::vector<Motion> paces{Lateral{0.04, 0.05}, Lateral{0.04, 1}, Lateral{0.03, 3}};

TEST(VelocityFilter, IsAThirdAsNoisyAsPlainDifferencesAndHalfItsWindowLateAtMost) {
  for (const Motion& pace : paces) {
    VelocityFilter filter(sandpaper());
    const Quality ours = quality(pace, [&](int counts) { return filter(counts, 1); });
    int last = 0;
    const Quality plain = quality(pace, [&](int counts) { return counts - std::exchange(last, counts); });
    SCOPED_TRACE(std::get<Lateral>(pace).frequency);
    EXPECT_LT(ours.noise, plain.noise / 3);
    EXPECT_LE(ours.delay, 8);
    EXPECT_LE(plain.delay, 1);
  }
}

/// A Kalman filter is tuned for one speed: a filter that beats the profile's at one speed loses at another.
TEST(VelocityFilter, NoKalmanFilterIsBetterAtEveryPace) {
  std::vector<double> ours;
  for (const Motion& pace : paces) {
    VelocityFilter filter(sandpaper());
    ours.push_back(quality(pace, [&](int counts) { return filter(counts, 1); }).error);
  }
  int better_somewhere = 0;
  for (double exponent = -7; exponent <= 0; exponent += 1) {
    bool everywhere = true, somewhere = false;
    for (std::size_t i = 0; i < paces.size(); ++i) {
      Kalman kalman(std::pow(10, exponent));
      const bool better = quality(paces[i], [&](int counts) { return kalman(counts); }).error < ours[i];
      everywhere = everywhere && better;
      somewhere = somewhere || better;
    }
    EXPECT_FALSE(everywhere) << "of acceleration variance 1e" << exponent;
    better_somewhere += somewhere;
  }
  EXPECT_GT(better_somewhere, 2) << "these are Kalman filters worth comparing with";
}

}  // namespace
}  // namespace wale::velocity_comparison_test
