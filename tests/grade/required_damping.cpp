#include "compiler/grade/required_damping.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace wale::required_damping_test {
namespace {

constexpr double pi = 3.14159265358979323846;

DeviceProfile device(double delay = 0, double window = 1) {
  DeviceProfile profile;
  profile.rate = 900;
  profile.delay_x = profile.delay_y = delay;
  profile.velocity_window = window;
  return profile;
}

/// force = -stiffness place - damping velocity, along x.
LinearProgram wall(double stiffness, double damping) {
  LinearProgram program;
  program.direct.place[0][0] = -stiffness;
  program.direct.velocity[0][0] = -damping;
  return program;
}

// Colgate and Schenkel 1997: b > K T / 2 + |B|, for either sign of B, with the velocity of one tick.
TEST(RequiredDamping, IsThatOfTheVirtualWall) {
  const LoopTiming timing(device());
  for (const double stiffness : {0.0, 100.0, 1000.0, 5000.0})
    for (const double damping : {-2.0, -0.3, 0.0, 0.5, 4.0})
      EXPECT_NEAR(required_damping(wall(stiffness, damping), timing), stiffness / 1800 + std::abs(damping),
                  1e-3 * std::abs(damping) + 1e-9)
          << stiffness << " N/m, " << damping << " N s/m";
}

// With a delay, T / 2 becomes T / 2 + d (Diolaiti et al. 2006; tests/reference/closed_loop.md: 2.78, 7.8 and 12.8 N s/m
// for corduroy at 0, 1 and 2 ms).
TEST(RequiredDamping, GrowsByTheDelay) {
  for (const double delay : {0.0, 0.0005, 0.001, 0.002})
    EXPECT_NEAR(required_damping(wall(5010, 0), LoopTiming(device(delay))), 5010 * (1.0 / 1800 + delay), 1e-6);
}

// An actuator's low-pass delays slow signals by its time constant. The expectation is the largest value of the
// condition over a grid of frequencies.
TEST(RequiredDamping, GrowsByTheActuatorsLag) {
  DeviceProfile profile = device(0.0007);
  profile.bandwidth_x = profile.bandwidth_y = 60;
  const double T = 1.0 / 900, d = 0.0007, lag = 1 / (2 * pi * 60);
  double worst = 0;
  for (int i = 1; i <= 100000; ++i) {
    const double a = pi * i / 100000;
    const std::complex<double> late =
        (1.0 - std::polar(1.0, -a)) * std::polar(1.0, -a * d / T) / std::complex<double>(1, a * lag / T);
    worst = std::max(worst, 2000 * T / 2 / (1 - std::cos(a)) * late.real());
  }
  const double needed = required_damping(wall(2000, 0), LoopTiming(profile));
  EXPECT_NEAR(needed, worst, 1e-6 * worst);
  EXPECT_NEAR(needed, 2000 * (T / 2 + d + lag), 1e-9);
}

// A damper along one axis has the delay of that axis. A stiffness may act along either, so it has the larger delay.
TEST(RequiredDamping, EveryAxisHasItsOwnDelay) {
  const double undelayed = required_damping(wall(0, 4), LoopTiming(device()));
  DeviceProfile late_along_y = device();
  late_along_y.delay_y = 0.003;
  late_along_y.bandwidth_y = 30;
  EXPECT_NEAR(required_damping(wall(0, 4), LoopTiming(late_along_y)), undelayed, 1e-9);
  DeviceProfile late_along_x = device();
  late_along_x.delay_x = 0.003;
  LinearProgram along_y;
  along_y.direct.velocity[1][1] = -4;
  EXPECT_NEAR(required_damping(along_y, LoopTiming(late_along_x)), undelayed, 1e-9);
  EXPECT_NEAR(required_damping(wall(500, 0), LoopTiming(late_along_x)), 500 * (1.0 / 1800 + 0.003), 1e-9);
}

TEST(RequiredDamping, CountsTheStiffestDirection) {
  LinearProgram program;
  program.direct.place = {{{-300, 400}, {400, 300}}};  // both singular values are 500
  EXPECT_NEAR(required_damping(program, LoopTiming(device())), 500.0 / 1800, 1e-9);
  program.direct.place = {{{-900, 0}, {0, 100}}};
  EXPECT_NEAR(required_damping(program, LoopTiming(device())), 900.0 / 1800, 1e-9);
}

// The filter's windows include one tick, which is the worst window for a damper.
TEST(RequiredDamping, LetsTheFilterChooseItsWindow) {
  EXPECT_NEAR(required_damping(wall(0, 10), LoopTiming(device(0, 15))), 10, 1e-3);
}

TEST(RequiredDamping, OfTheSecondDifferenceIsItsClosedForm) {
  // H = M ((1 - 1/z) / T)^2, so the condition is M / (2 T) Re (1 - e^-ja)^3 / (1 - cos a). Its maximum is found on a
  // fine grid of angles.
  LinearProgram program;
  program.direct.raw_acceleration[0][0] = -0.01;
  double expected = 0;
  for (int i = 1; i <= 100000; ++i) {
    const double angle = pi * i / 100000;
    const std::complex<double> step = 1.0 - std::polar(1.0, -angle);
    expected = std::max(expected, 0.01 * 900 / 2 * (step * step * step).real() / (1 - std::cos(angle)));
  }
  EXPECT_NEAR(required_damping(program, LoopTiming(device())), expected, 0.02 * expected);
}

/// A mass m with damping b on a spring k to the hand, in SI units, like the brick of LANGUAGE.md: v' before p'
/// (semi-implicit Euler), force = -k (hand - p).
LinearProgram brick(double k, double b, double m, double period) {
  LinearProgram program;
  program.states = 2;  // p, v
  program.direct.place[0][0] = -k;
  program.output = {k, 0, 0, 0};
  const double vp = -k * period / m, vv = 1 - b * period / m;
  program.carry = {1 + period * vp, period * vv, vp, vv};
  program.input.resize(1);
  program.input[0].place[1][0] = k * period / m;
  program.input[0].place[0][0] = period * k * period / m;
  return program;
}

// Against the response of the same recurrence, run under a long sine at each frequency of a grid.
TEST(RequiredDamping, OfStatesIsThatOfTheirResponse) {
  const double period = 1.0 / 900, k = 120, m = 0.3;
  for (const double b : {0.8, 4.0}) {
    const LinearProgram program = brick(k, b, m, period);
    double expected = 0;
    for (int i = 0; i < 400; ++i) {
      const double angle = pi * std::pow(2e-3, 1 - i / 399.0);
      std::complex<double> p = 0, v = 0;
      // Run the recurrence under e^(j a n) until the transient is gone; then force / place is the response.
      std::complex<double> response = 0;
      for (int n = 0; n < 20000; ++n) {
        const std::complex<double> hand = std::polar(1.0, angle * n), pull = k * (hand - p);
        response = -pull / hand;
        v += period * (pull - b * v) / m;
        p += period * v;
      }
      // The condition is T / 2 / (1 - cos a) Re ((1 - e^-ja) H), as for the wall.
      const std::complex<double> late = 1.0 - std::polar(1.0, -angle);
      expected = std::max(expected, period / 2 / (1 - std::cos(angle)) * (late * -response).real());
    }
    EXPECT_NEAR(required_damping(program, LoopTiming(device())), expected, 0.05 * expected + 1e-3) << b;
  }
}

// Friction that slides to the right on a bristle (N = k stretch) and has another limit the other way, so that its pull
// turns a little when the hand turns: next anchor = hand - S pull, pull = hand - anchor, force = -k S pull. It depends on
// no place. Against the recurrence, run under a long sine along each axis, and the largest Re(u* A u) found over many
// directions u.
TEST(RequiredDamping, OfFrictionIsThatOfItsResponse) {
  const double period = 1.0 / 900, k = 400;
  for (const double across : {0.7, 0.95})
    for (const double turned : {0.0, 0.1, 0.3}) {
      const double s[2][2] = {{0, turned}, {0, across}};
      LinearProgram program;
      program.states = 2;
      program.input.resize(1);
      program.output.resize(4), program.carry.resize(4);
      for (std::size_t row = 0; row < 2; ++row)
        for (std::size_t column = 0; column < 2; ++column) {
          program.direct.place[row][column] = -k * s[row][column];
          program.output[2 * row + column] = k * s[row][column];
          program.carry[2 * row + column] = s[row][column];
          program.input[0].place[row][column] = (row == column) - s[row][column];
        }
      double expected = 0;
      for (int i = 0; i < 200; ++i) {
        const double angle = pi * std::pow(2e-3, 1 - i / 199.0);
        std::complex<double> response[2][2];
        for (int along = 0; along < 2; ++along) {
          std::complex<double> anchor[2] = {};
          for (int n = 0; n < 3000; ++n) {
            const std::complex<double> hand = std::polar(1.0, angle * n);
            const std::complex<double> pull[2] = {(along == 0 ? hand : 0.0) - anchor[0],
                                                  (along == 1 ? hand : 0.0) - anchor[1]};
            for (int row = 0; row < 2; ++row) {
              const std::complex<double> stretch = s[row][0] * pull[0] + s[row][1] * pull[1];
              response[row][along] = -k * stretch / hand;
              anchor[row] = (along == row ? hand : 0.0) - stretch;
            }
          }
        }
        const std::complex<double> late = 1.0 - std::polar(1.0, -angle);
        for (int turn = 0; turn < 60; ++turn)
          for (int lag = 0; lag < 60; ++lag) {
            const std::complex<double> u[2] = {std::cos(pi * turn / 60), std::polar(std::sin(pi * turn / 60), 2 * pi * lag / 60)};
            std::complex<double> sum = 0;
            for (int row = 0; row < 2; ++row)
              for (int column = 0; column < 2; ++column)
                sum += std::conj(u[row]) * late * -response[row][column] * u[column];
            expected = std::max(expected, period / 2 / (1 - std::cos(angle)) * sum.real());
          }
      }
      EXPECT_NEAR(required_damping(program, LoopTiming(device())), expected, 0.02 * expected + 1e-3)
          << across << " " << turned;
    }
}

// A texture felt a tick late, force = k place of the tick before: its sign is not known where the hand is next, so one that
// pulls here needs no less than a spring without the tick.
TEST(RequiredDamping, IsThatOfTheStifferSignAlsoThroughAState) {
  LinearProgram program;
  program.states = 2;
  program.output = {300, 0, 0, 300};  // it pulls here: a spring of 300 N/m on the place of the tick before
  program.carry = {0, 0, 0, 0};
  program.input.resize(1);
  program.input[0].place = {{{1, 0}, {0, 1}}};
  // As a spring that pushes: a tick late, b = K (T / 2 + T).
  LinearProgram pushes = program;
  pushes.output = {-300, 0, 0, -300};
  EXPECT_NEAR(required_damping(pushes, LoopTiming(device())), 300 * 1.5 / 900, 1e-3);
  EXPECT_GT(required_damping(program, LoopTiming(device())), 300 * 0.5 / 900 - 1e-6);
}

TEST(RequiredDamping, IsInfiniteWhereStatesGrow) {
  LinearProgram program = brick(120, 0.8, 0.3, 1.0 / 900);
  program.carry = {1, 0, 0, 1};
  program.output = {1e300, 0, 0, 0};
  program.input[0].place[0][0] = 1e300;
  EXPECT_TRUE(std::isinf(required_damping(program, LoopTiming(device()))));
}

}  // namespace
}  // namespace wale::required_damping_test
