#include "runtime/stage/felt_response.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <vector>

namespace wale {
namespace {

constexpr double sliding_speed = 0.02;    // m/s: from there on a drag has its own size
constexpr double enough_sliding = 0.2;    // s
constexpr double enough_pressing = 0.05;  // s
constexpr double enough_way = 2e-3;       // m, standard deviation of the place
constexpr double enough_change = 0.01;    // m/s, over a window
constexpr double window_seconds = 0.05;   // of an impulse; the filtered velocity lags by a few milliseconds
constexpr float plainly_pressed = 0.1f;   // of the 99th percentile of the force
constexpr float cut = 0.98f;              // of the largest force, which may be a limit

/// The sums of a line through points: force over place.
struct Line {
  double count = 0, x = 0, y = 0, xx = 0, xy = 0;

  void add(double at, double value) { count += 1, x += at, y += value, xx += at * at, xy += at * value; }
  double spread() const { return count > 0 ? std::sqrt(std::max(0.0, xx / count - x * x / (count * count))) : 0; }
  double slope() const { return (xy - x * y / count) / (xx - x * x / count); }
};

void find_resistance(std::span<const TickRecord> inside, double seconds_per_tick, FeltResponse& found) {
  std::vector<double> against;
  double products = 0, squares = 0;
  for (const TickRecord& tick : inside) {
    const glm::dvec2 force(tick.force), velocity(tick.velocity);
    const double speed = glm::length(velocity);
    if (speed < sliding_speed) continue;
    against.push_back(-glm::dot(force, velocity) / speed);
    products -= glm::dot(force, velocity), squares += speed * speed;
  }
  if (static_cast<double>(against.size()) * seconds_per_tick < enough_sliding) return;
  const auto middle = against.begin() + static_cast<std::ptrdiff_t>(against.size() / 2);
  std::nth_element(against.begin(), middle, against.end());
  found.drag = static_cast<float>(*middle);
  found.viscosity = static_cast<float>(products / squares);
}

void find_stiffness(std::span<const TickRecord> inside, FeltResponse& found) {
  Line line[2];
  for (const TickRecord& tick : inside)
    for (int axis = 0; axis < 2; ++axis) line[axis].add(tick.position[axis], tick.force[axis]);
  // Along the axis on which the hand moves more.
  const Line& longer = line[line[1].spread() > line[0].spread() ? 1 : 0];
  if (longer.spread() >= enough_way) found.stiffness = static_cast<float>(-longer.slope());
}

/// A wall pushes one way and is felt only while the hand is in it.
void find_wall(std::span<const TickRecord> inside, double seconds_per_tick, float p99, FeltResponse& found) {
  std::vector<const TickRecord*> pressed;
  glm::dvec2 push(0);
  float most = 0;
  for (const TickRecord& tick : inside) most = std::max(most, glm::length(tick.force));
  for (const TickRecord& tick : inside) {
    const float size = glm::length(tick.force);
    if (!(size > plainly_pressed * p99) || size > cut * most) continue;
    pressed.push_back(&tick);
    push += glm::dvec2(tick.force);
  }
  if (static_cast<double>(pressed.size()) * seconds_per_tick < enough_pressing || glm::length(push) == 0) return;
  const glm::dvec2 outward = glm::normalize(push);
  Line depth;
  double products = 0, squares = 0;
  for (const TickRecord* tick : pressed) {
    const double force = glm::dot(glm::dvec2(tick->force), outward);
    const double inward_speed = -glm::dot(glm::dvec2(tick->velocity), outward);
    depth.add(-glm::dot(glm::dvec2(tick->position), outward), force);
    if (inward_speed > 0) products += force * inward_speed, squares += inward_speed * inward_speed;
  }
  if (depth.spread() > 0) found.wall_stiffness = static_cast<float>(depth.slope());
  if (squares > 0) found.wall_damping = static_cast<float>(products / squares);
}

/// The impulse over a window against the change of velocity in it.
void find_mass(std::span<const TickRecord> record, double seconds_per_tick, FeltResponse& found) {
  const auto length = static_cast<std::size_t>(std::max(1.0, std::round(window_seconds / seconds_per_tick)));
  double products = 0, squares = 0, windows = 0;
  for (std::size_t first = 0; first + length < record.size(); first += length) {
    glm::dvec2 impulse(0);
    bool whole = true;
    for (std::size_t i = first; i < first + length; ++i) {
      impulse += seconds_per_tick * glm::dvec2(record[i].force);
      whole = whole && record[i].inside;
    }
    if (!whole) continue;
    const glm::dvec2 change = glm::dvec2(record[first + length].velocity) - glm::dvec2(record[first].velocity);
    products -= glm::dot(impulse, change), squares += glm::dot(change, change), windows += 1;
  }
  if (windows > 0 && std::sqrt(squares / windows) >= enough_change) found.mass = static_cast<float>(products / squares);
}

void find_shaking(std::span<const TickRecord> inside, double seconds_per_tick, FeltResponse& found) {
  const auto count = static_cast<double>(inside.size());
  if (count * seconds_per_tick < enough_sliding) return;
  glm::dvec2 mean(0);
  double squares = 0;
  for (const TickRecord& tick : inside) mean += glm::dvec2(tick.force) / count;
  for (const TickRecord& tick : inside) {
    const glm::dvec2 off = glm::dvec2(tick.force) - mean;
    squares += glm::dot(off, off) / count;
  }
  found.shaking = static_cast<float>(std::numbers::sqrt2 * std::sqrt(squares));
}

}  // namespace

FeltResponse response_of(std::span<const TickRecord> record, double seconds_per_tick) {
  std::vector<TickRecord> inside;
  std::vector<float> sizes;
  for (const TickRecord& tick : record)
    if (tick.inside) inside.push_back(tick), sizes.push_back(glm::length(tick.force));
  FeltResponse found;
  if (inside.empty()) return found;
  const auto high = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sizes.size()));
  std::nth_element(sizes.begin(), high, sizes.end());
  find_resistance(inside, seconds_per_tick, found);
  find_stiffness(inside, found);
  find_wall(inside, seconds_per_tick, *high, found);
  find_mass(record, seconds_per_tick, found);
  find_shaking(inside, seconds_per_tick, found);
  return found;
}

}  // namespace wale
