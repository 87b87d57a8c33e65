#include "compiler/read/slow_change.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr double longest_window = 4;  // s: long enough that no sway has a mean in it
// Of a swing that is known: in many of them its beginning or end leaves little, and few tell best how far a force goes.
constexpr double many_swings = 20, few_swings = 5;
constexpr std::size_t fewest_ticks = 16;  // of a window
constexpr double left_of_a_swing = 0.03;  // of its amplitude, in a mean over that window
constexpr double left_of_noise = 0.3;     // likewise of a noise, whose means differ by chance
constexpr double alike_everywhere = 0.8;  // of the largest change, in the mean over the places
constexpr double still_changing = 0.02;   // of the whole change, within the last part of the time
constexpr double last_part = 0.25;
constexpr double plainly_remains = 0.5;  // of the whole change
constexpr std::size_t steps_a_window = 8;
constexpr double moves_a_swing = 0.02, bends = 0.02;  // of the swing's amplitude
constexpr double most_left_out = 0.25;                // of the time

/// The means of a force over windows, one after the other; the window is Hann's, so that a swing has none in it.
/// Without a swing the force itself.
std::vector<glm::dvec2> course_of(const std::vector<Force>& forces, std::size_t width) {
  std::vector<glm::dvec2> means;
  if (width <= 1) {
    for (const Force& force : forces) means.emplace_back(force);
    return means;
  }
  std::vector<double> window(width);
  for (std::size_t i = 0; i < width; ++i)
    window[i] = (1 - std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(width))) /
                static_cast<double>(width);
  const std::size_t step = std::max<std::size_t>(1, width / steps_a_window);
  for (std::size_t first = 0; first + width <= forces.size(); first += step) {
    glm::dvec2 sum{0};
    for (std::size_t i = 0; i < width; ++i) sum += window[i] * glm::dvec2(forces[first + i]);
    means.push_back(sum);
  }
  return means;
}

/// How many ticks a window of some swings has, in which they have no mean.
std::size_t window_for(double swings, const Swing& sway, const Swing& vibration, double rate, std::size_t ticks) {
  if (std::max(sway.amplitude, vibration.amplitude) < least_force) return 1;
  const Swing& slower = sway.amplitude >= least_force ? sway : vibration;
  double slowest = slower.frequency;
  for (const SwingPart& each : slower.parts) slowest = std::min(slowest, each.frequency);
  const double seconds = slowest > 0 ? std::min(longest_window, swings / slowest) : longest_window;
  return std::min(ticks, std::max(fewest_ticks, static_cast<std::size_t>(seconds * rate)));
}

/// The largest change at any place, the mean of all places' own, and their mean course.
struct Course {
  double newton = 0;
  glm::dvec2 push{0};
  std::vector<glm::dvec2> mean;
};
Course course_over_places(const std::vector<std::vector<Force>>& felt, std::size_t width) {
  const auto places = static_cast<double>(felt.size());
  Course found;
  for (const std::vector<Force>& forces : felt) {
    const std::vector<glm::dvec2> course = course_of(forces, width);
    glm::dvec2 change{0};
    found.mean.resize(course.size());
    for (std::size_t i = 0; i < course.size(); ++i) {
      found.mean[i] += course[i] / places;
      const glm::dvec2 now = course[i] - course.front();
      if (glm::length(now) > glm::length(change)) change = now;
    }
    found.newton = std::max(found.newton, glm::length(change));
    found.push += change / places;
  }
  return found;
}

}  // namespace

glm::dvec2 SlowChange::remaining(glm::dvec2 push_at_first) const {
  glm::dvec2 left = push_at_first;
  for (const int axis : {0, 1}) {
    const double low = push_at_first[axis] + lower[axis], high = push_at_first[axis] + higher[axis];
    left[axis] = low > 0 ? low : high < 0 ? high : 0;
    if (!settles && std::abs(left[axis]) < plainly_remains * (higher[axis] - lower[axis])) left[axis] = 0;
  }
  return left;
}

SlowChange slow_change(const Bank& bank, const std::vector<std::vector<Force>>& felt, const Swing& sway,
                       const Swing& vibration) {
  if (felt.empty()) return {};
  const double rate = bank.program().description().device.rate;
  const auto over = [&](double swings) {
    return course_over_places(felt, window_for(swings, sway, vibration, rate, felt.front().size()));
  };
  const double swing = std::max(sway.amplitude, vibration.amplitude);
  if (over(many_swings).newton < std::max(least_force, (vibration.noise || sway.course ? left_of_noise : left_of_a_swing) * swing))
    return {};
  const Course course = over(few_swings);
  SlowChange found{.newton = course.newton, .push = course.push};
  if (glm::length(found.push) < alike_everywhere * found.newton) return found;
  found.at_first = course.mean.front();
  const auto last = static_cast<std::size_t>((1 - last_part) * static_cast<double>(course.mean.size()));
  glm::dvec2 lowest(HUGE_VAL), highest(-HUGE_VAL);
  for (std::size_t i = 0; i < course.mean.size(); ++i) {
    const glm::dvec2 change = course.mean[i] - found.at_first;
    found.lower = glm::min(found.lower, change), found.higher = glm::max(found.higher, change);
    if (i >= last) lowest = glm::min(lowest, change), highest = glm::max(highest, change);
  }
  found.settles = glm::length(highest - lowest) < still_changing * found.newton;
  return found;
}

namespace {

/// Where the course of a force bends within half of a window, as at a jump, which the window smears.
std::vector<bool> bends_of(const std::vector<glm::dvec2>& course, double least) {
  constexpr std::size_t half = steps_a_window / 2;
  std::vector<bool> found(course.size());
  for (std::size_t i = half; i + half < course.size(); ++i)
    if (glm::length(course[i - half] - 2.0 * course[i] + course[i + half]) > least)
      std::fill(found.begin() + static_cast<std::ptrdiff_t>(i - half),
                found.begin() + static_cast<std::ptrdiff_t>(i + half + 1), true);
  return found;
}

}  // namespace

std::optional<std::vector<std::vector<Force>>> without_slow_change(const Bank& bank,
                                                                   const std::vector<std::vector<Force>>& felt,
                                                                   const Swing& swing) {
  const std::size_t ticks = felt.front().size();
  const std::size_t width = window_for(few_swings, {}, swing, bank.program().description().device.rate, ticks);
  const std::size_t step = std::max<std::size_t>(1, width / steps_a_window);
  const Course course = course_over_places(felt, width);
  if (course.newton < std::max(least_force, moves_a_swing * swing.amplitude)) return std::nullopt;
  std::vector<std::vector<Force>> left = felt;
  for (std::vector<Force>& forces : left) {
    const std::vector<glm::dvec2> means = course_of(forces, width);
    const std::vector<bool> bent = bends_of(means, bends * swing.amplitude);
    std::size_t left_out = 0;
    for (std::size_t i = 0; i < ticks; ++i) {
      // The first mean is that of half a window later.
      const double at = (static_cast<double>(i) - 0.5 * static_cast<double>(width)) / static_cast<double>(step);
      const double inside = std::clamp(at, 0.0, static_cast<double>(means.size() - 1));
      const auto before = static_cast<std::size_t>(inside), after = std::min(before + 1, means.size() - 1);
      const glm::dvec2 mean = glm::mix(means[before], means[after], inside - static_cast<double>(before));
      if (bent[before]) ++left_out;
      forces[i] = bent[before] ? Force(0) : forces[i] - Force(mean);
    }
    if (static_cast<double>(left_out) > most_left_out * static_cast<double>(ticks)) return std::nullopt;
  }
  return left;
}

}  // namespace wale
