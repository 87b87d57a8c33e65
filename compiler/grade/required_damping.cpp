#include "compiler/grade/required_damping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace wale {
namespace {

using Complex = std::complex<double>;
using Matrix2 = std::array<std::array<Complex, 2>, 2>;

using std::numbers::pi;
constexpr double lowest_frequency = 0.05;  // Hz
constexpr int frequencies = 128;
constexpr long long most_parabola = 64;  // ticks; the acceleration filter's own bound

/// The frequency responses from the hand's place to its other quantities, at one frequency and for one choice of
/// windows.
struct HandResponse {
  Complex velocity, raw_velocity, acceleration, raw_acceleration;
};

/// Response of the slope of a line from the newest sample to the one `window` ticks before.
Complex line_response(Complex back, int window, double period) {
  return (1.0 - std::pow(back, window)) / (window * period);
}

/// Response of the second derivative of the least-squares parabola through the newest `window` + 1 samples. With t
/// counted from the middle, it is 2 sum(w(t) place(t)) with w = (t^2 - mean t^2) / sum((t^2 - mean t^2)^2).
Complex parabola_response(Complex back, int window, double period) {
  const int n = window + 1;
  const double middle = window / 2.0;
  double mean = 0;
  for (int i = 0; i < n; ++i) mean += (i - middle) * (i - middle) / n;
  double squares = 0;
  Complex sum = 0, shift = 1;
  for (int i = 0; i < n; ++i, shift *= back) {
    const double weight = (i - middle) * (i - middle) - mean;
    squares += weight * weight;
    sum += weight * shift;
  }
  return 2.0 * sum / (squares * period * period);
}

Matrix2 respond(const HandSlopes& slopes, const HandResponse& response, bool with_place) {
  Matrix2 sum{};
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 2; ++column)
      sum[row][column] = (with_place ? slopes.place[row][column] : 0.0) +
                         slopes.velocity[row][column] * response.velocity +
                         slopes.raw_velocity[row][column] * response.raw_velocity +
                         slopes.acceleration[row][column] * response.acceleration +
                         slopes.raw_acceleration[row][column] * response.raw_acceleration;
  return sum;
}

/// Solves (z - carry) state = input for both columns of the input, in place; false if there is no unique solution.
bool solve_states(const LinearProgram& program, Complex z, std::vector<std::array<Complex, 2>>& right) {
  const std::size_t n = program.states;
  std::vector<Complex> left(n * n);
  for (std::size_t row = 0; row < n; ++row)
    for (std::size_t column = 0; column < n; ++column)
      left[row * n + column] = (row == column ? z : 0.0) - program.carry[row * n + column];
  for (std::size_t pivot = 0; pivot < n; ++pivot) {
    std::size_t best = pivot;
    for (std::size_t row = pivot + 1; row < n; ++row)
      if (std::abs(left[row * n + pivot]) > std::abs(left[best * n + pivot])) best = row;
    if (!(std::abs(left[best * n + pivot]) > 1e-300)) return false;
    for (std::size_t column = 0; column < n; ++column) std::swap(left[best * n + column], left[pivot * n + column]);
    std::swap(right[best], right[pivot]);
    for (std::size_t row = pivot + 1; row < n; ++row) {
      const Complex factor = left[row * n + pivot] / left[pivot * n + pivot];
      if (factor == 0.0) continue;
      for (std::size_t column = pivot; column < n; ++column)
        left[row * n + column] -= factor * left[pivot * n + column];
      for (std::size_t column = 0; column < 2; ++column) right[row][column] -= factor * right[pivot][column];
    }
  }
  for (std::size_t row = n; row-- > 0;)
    for (std::size_t column = 0; column < 2; ++column) {
      for (std::size_t other = row + 1; other < n; ++other)
        right[row][column] -= left[row * n + other] * right[other][column];
      right[row][column] /= left[row * n + row];
    }
  return true;
}

/// The response from place to force, without the direct dependence on place; empty if the states have no response.
std::optional<Matrix2> transfer(const LinearProgram& program, const HandResponse& response, Complex z) {
  Matrix2 sum = respond(program.direct, response, false);
  if (program.states == 0) return sum;
  std::vector<std::array<Complex, 2>> states(program.states + 1);
  for (std::size_t pair = 0; pair < program.input.size(); ++pair) {
    const Matrix2 two = respond(program.input[pair], response, true);
    states[2 * pair] = two[0], states[2 * pair + 1] = two[1];
  }
  states.resize(program.states);
  if (!solve_states(program, z, states)) return std::nullopt;
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 2; ++column)
      for (std::size_t state = 0; state < program.states; ++state)
        sum[row][column] += program.output[row * program.states + state] * states[state][column];
  return sum;
}

/// The greatest eigenvalue of the Hermitian part of a matrix.
double greatest_eigenvalue(const Matrix2& m) {
  const double a = m[0][0].real(), d = m[1][1].real();
  const Complex c = 0.5 * (m[0][1] + std::conj(m[1][0]));
  return (a + d) / 2 + std::sqrt((a - d) * (a - d) / 4 + std::norm(c));
}

bool all_zero(const Slopes& slopes) {
  return std::ranges::all_of(slopes, [](const auto& row) { return row[0] == 0 && row[1] == 0; });
}

}  // namespace

LoopTiming::LoopTiming(const DeviceProfile& device) : period(1 / device.rate), delay{device.delay_x, device.delay_y} {
  const auto time_constant = [](double bandwidth) { return bandwidth > 0 ? 1 / (2 * pi * bandwidth) : 0.0; };
  lag = {time_constant(device.bandwidth_x), time_constant(device.bandwidth_y)};
  const int longest = std::max(1, static_cast<int>(std::lround(device.velocity_window)));
  for (int window = 1; window < longest; window *= 2) windows.push_back(window);
  windows.push_back(longest);
  const auto shortest_parabola = std::clamp(std::llround(device.velocity_window / 2), 2LL, most_parabola);
  const auto longest_parabola = std::clamp(std::llround(device.velocity_window * 2), shortest_parabola, most_parabola);
  for (auto window = shortest_parabola; window < longest_parabola; window *= 2)
    parabolas.push_back(static_cast<int>(window));
  parabolas.push_back(static_cast<int>(longest_parabola));
}

double spectral_norm(const Slopes& s) {
  const double squares = s[0][0] * s[0][0] + s[0][1] * s[0][1] + s[1][0] * s[1][0] + s[1][1] * s[1][1];
  const double determinant = s[0][0] * s[1][1] - s[0][1] * s[1][0];
  return std::sqrt((squares + std::sqrt(std::max(0.0, squares * squares - 4 * determinant * determinant))) / 2);
}

double required_damping(const LinearProgram& program, const LoopTiming& timing) {
  double stiffness = spectral_norm(program.direct.place);
  const auto uses = [&](Slopes HandSlopes::*quantity) {
    return !all_zero(program.direct.*quantity) ||
           std::ranges::any_of(program.input, [&](const HandSlopes& input) { return !all_zero(input.*quantity); });
  };
  const bool static_only = program.states == 0 && !uses(&HandSlopes::velocity) && !uses(&HandSlopes::raw_velocity) &&
                           !uses(&HandSlopes::acceleration) && !uses(&HandSlopes::raw_acceleration);
  // If the force depends on the place only, the supremum is the limit at frequency 0.
  if (static_only) return stiffness * (timing.period / 2 + timing.latest());

  const std::vector<int> one{1};
  const auto& windows = uses(&HandSlopes::velocity) ? timing.windows : one;
  const auto& parabolas = uses(&HandSlopes::acceleration) ? timing.parabolas : one;
  const double lowest = std::min(1.0, 2 * lowest_frequency * timing.period);  // of the Nyquist frequency
  // What a hand that stays feels through the states: all of a brick's spring, which follows it, and of friction.
  Slopes in_the_end{};
  if (program.states > 0) {
    const Complex z = std::polar(1.0, pi * lowest), raw = line_response(std::conj(z), 1, timing.period);
    const auto slow = transfer(program, {raw, raw, raw * raw, raw * raw}, z);
    if (!slow) return std::numeric_limits<double>::infinity();
    Slopes at_rest = program.direct.place;
    for (std::size_t row = 0; row < 2; ++row)
      for (std::size_t column = 0; column < 2; ++column)
        at_rest[row][column] += in_the_end[row][column] = (*slow)[row][column].real();
    stiffness = spectral_norm(at_rest);
  }
  double needed = 0;
  for (int i = 0; i < frequencies; ++i) {
    const double angle = pi * std::pow(lowest, 1 - static_cast<double>(i) / (frequencies - 1));
    const Complex z = std::polar(1.0, angle), back = std::conj(z);
    std::array<Complex, 2> late;
    for (std::size_t axis = 0; axis < 2; ++axis)
      late[axis] = (1.0 - back) * std::polar(1.0, -angle * timing.delay[axis] / timing.period) /
                   Complex(1, angle * timing.lag[axis] / timing.period);
    const double scale = timing.period / 2 / (1 - std::cos(angle));
    for (const int window : windows)
      for (const int parabola : parabolas) {
        const Complex raw = line_response(back, 1, timing.period);
        const HandResponse response{line_response(back, window, timing.period), raw,
                                    parabola_response(back, std::max(2, parabola), timing.period), raw * raw};
        const auto moving = transfer(program, response, z);
        if (!moving) return std::numeric_limits<double>::infinity();
        Matrix2 sum{};
        for (std::size_t row = 0; row < 2; ++row)
          for (std::size_t column = 0; column < 2; ++column)
            sum[row][column] =
                late[row] * ((row == column ? stiffness : 0.0) + in_the_end[row][column] - (*moving)[row][column]);
        const double here = scale * greatest_eigenvalue(sum);
        if (std::isnan(here)) return std::numeric_limits<double>::infinity();
        needed = std::max(needed, here);
      }
  }
  return needed;
}

}  // namespace wale
