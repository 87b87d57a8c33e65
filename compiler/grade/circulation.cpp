#include "compiler/grade/circulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <vector>

#include "compiler/grade/exploring_place.hpp"
#include "compiler/read/dependence.hpp"

namespace wale {
namespace {

using std::numbers::pi;
constexpr std::size_t tiles = 4;         // per side of the patch, over which the mean of the curl is taken
constexpr double significant = 4;        // in standard errors of a mean
constexpr double share_of_slope = 0.02;  // of the usual slope; smaller curl is rounding and clipping
constexpr std::size_t circled = 8;       // places of each kind around which a hand circles
constexpr double share_with_curl =
    0.02;  // of the places; on fewer, only circles around the places of most curl are tried
constexpr double fewest_counts_of_radius = 8;
constexpr std::size_t first_points = 64, most_points = 4096;  // on a circle
constexpr std::size_t checked_circles = 12;
constexpr double share_of_path = 0.2;  // of the work done on the way in both directions
constexpr double settled = 0.05;       // of an integral, between two numbers of points

struct Circle {
  glm::dvec2 centre;
  double radius;
  bool button = false;              ///< held on the way
  double joule = 0, both_ways = 0;  ///< gained, and the sum of its sizes
};

/// Integrates the force along the circle by the rule of midpoints, which is exact for few waves. The hand goes along it
/// at `speed`, m/s; below 0 the other way round.
void integrate(const Bank& bank, std::span<Circle> circles, std::size_t points, double speed = 0) {
  std::vector<Hand> hands;
  std::vector<glm::dvec2> steps;
  for (const Circle& circle : circles)
    for (std::size_t i = 0; i < points; ++i) {
      const double angle = 2 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(points);
      Hand& hand = hands.emplace_back();
      hand.position = hand.workspace =
          glm::vec2(circle.centre + circle.radius * glm::dvec2(std::cos(angle), std::sin(angle)));
      hand.button = circle.button;
      hand.velocity = hand.raw_velocity = glm::vec2(speed * glm::dvec2(-std::sin(angle), std::cos(angle)));
      steps.push_back(circle.radius * 2 * pi / static_cast<double>(points) *
                      glm::dvec2(-std::sin(angle), std::cos(angle)));
    }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  for (std::size_t circle = 0; circle < circles.size(); ++circle) {
    circles[circle].joule = circles[circle].both_ways = 0;
    for (std::size_t i = circle * points; i < (circle + 1) * points; ++i) {
      circles[circle].joule += glm::dot(glm::dvec2(forces[i]), steps[i]);
      circles[circle].both_ways += std::abs(glm::dot(glm::dvec2(forces[i]), steps[i]));
    }
  }
}

/// The power, W, that is left of `watt`, which a hand gains on the circle at `speed` (m/s) without drag, when it goes
/// at the pace at which drag leaves most. A force that pushes along the motion is no matter of the curl.
double less_drag(const Bank& bank, const Circle& circle, double watt, double speed) {
  if (!depends_on_motion(bank.program().description())) return watt;
  const double way_round = circle.joule < 0 ? -1 : 1;
  Circle still = circle;
  integrate(bank, {&still, 1}, first_points);
  double most = 0;
  for (const double pace : slower_paces) {
    Circle moving = circle;
    integrate(bank, {&moving, 1}, first_points, way_round * pace * speed);
    const double drag = way_round * (still.joule - moving.joule) * pace * speed / (2 * pi * circle.radius);
    most = std::max(most, pace * watt - std::max(0.0, drag));
  }
  return most;
}

/// Half the sides of the patch less its rim, m. In the rim heights fade, and limits at their amplitude give a curl
/// there that no author means.
glm::vec2 inside(const Bank& bank) {
  return 0.5f * glm::vec2(bank.size().width, bank.size().height) - glm::vec2(bank.size().rim);
}

/// The most power, W, that a circle around one of `centres` gives after drag; nothing if none gives any without.
std::optional<double> strongest_circle(const Bank& bank, std::span<const Hand> centres, const GradingHand& hand,
                                       double least_watt) {
  const glm::dvec2 half(inside(bank));
  const double least = fewest_counts_of_radius * bank.program().description().device.position_step();
  std::vector<Circle> circles;
  for (const Hand& at : centres) {
    const glm::vec2 centre = at.position;
    const double room = std::min(half.x - std::abs(centre.x), half.y - std::abs(centre.y));
    for (double radius = hand.radius; radius >= least; radius /= std::numbers::sqrt2)
      if (radius <= room) circles.push_back({centre, radius, at.button});
  }
  const auto watt = [&](const Circle& circle) {
    return std::abs(circle.joule) * hand.speed() / (2 * pi * circle.radius);
  };
  const auto counts = [&](const Circle& circle) {
    return watt(circle) > least_watt && std::abs(circle.joule) > share_of_path * circle.both_ways;
  };
  integrate(bank, circles, first_points);
  std::erase_if(circles, [&](const Circle& circle) { return !counts(circle); });
  std::ranges::stable_sort(circles, [&](const Circle& a, const Circle& b) { return watt(a) > watt(b); });
  circles.resize(std::min(circles.size(), checked_circles));
  std::optional<double> best;
  for (Circle& circle : circles) {
    if (watt(circle) <= best.value_or(0)) continue;
    // A detail between two points may look like a gain, so the points are doubled until the integral stays.
    double before = circle.joule;
    for (std::size_t points = 2 * first_points; points <= most_points; points *= 2) {
      integrate(bank, {&circle, 1}, points);
      if (!counts(circle)) break;
      if (std::abs(circle.joule - before) <= settled * std::abs(circle.joule)) {
        best = std::max(best.value_or(0), less_drag(bank, circle, watt(circle), hand.speed()));
        break;
      }
      before = circle.joule;
    }
  }
  return best;
}

/// The curl of hands at rest, and the usual slope of their force.
struct Curls {
  std::vector<double> sizes;  ///< N/m, of each hand; 0 if it does not count
  double over_blocks = 0;     ///< N, the most of: half of a mean over a block of tiles, times a circle's radius in it
  std::size_t counted = 0;    ///< hands whose curl counts
  double largest = 0;         ///< N, of their forces
};

/// `radius`: m, of the largest circle of a hand.
Curls curls_of(const LookedAt& looked_at, bool button, glm::vec2 extent, glm::vec2 less_rim, double radius) {
  struct Sum {
    double count = 0, sum = 0, squares = 0;
  };
  std::array<Sum, tiles * tiles> sums;
  Curls found;
  found.sizes.resize(looked_at.hands.size());
  double squares = 0, hands = 0;
  for (std::size_t i = 0; i < looked_at.hands.size(); ++i) {
    const Hand& hand = looked_at.hands[i];
    const auto& place = looked_at.at[i].place;
    const double curl = place[1][0] - place[0][1];
    if (hand.velocity != glm::vec2(0.0f) || hand.button != button || !std::isfinite(curl)) continue;
    const auto tile = [](float along, float half) {
      const double share = (along / half + 1) / 2 * tiles;
      return static_cast<std::size_t>(std::clamp(share, 0.0, static_cast<double>(tiles - 1)));
    };
    // In the rim there is a curl that no author means.
    const bool counts = std::abs(hand.position.x) < less_rim.x && std::abs(hand.position.y) < less_rim.y;
    Sum& sum = sums[tile(hand.position.y, extent.y) * tiles + tile(hand.position.x, extent.x)];
    if (counts) sum.count += 1, sum.sum += curl, sum.squares += curl * curl;
    found.largest = std::max(found.largest, glm::length(looked_at.at[i].force));
    const double steep = steepness(place);
    squares += steep * steep, hands += 1;
    if (counts) found.sizes[i] = std::abs(curl);
  }
  const double least = share_of_slope * (hands > 0 ? std::sqrt(squares / hands) : 0);
  // What has a curl in one tile alone is circled in that tile.
  const double half_tile = std::min(extent.x, extent.y) / static_cast<double>(tiles);
  const auto look_at_block = [&](std::size_t row, std::size_t column, std::size_t side) {
    Sum all;
    for (std::size_t r = row; r < row + side; ++r)
      for (std::size_t c = column; c < column + side; ++c) {
        const Sum& sum = sums[r * tiles + c];
        all.count += sum.count, all.sum += sum.sum, all.squares += sum.squares;
      }
    if (all.count < 8) return;
    const double mean = all.sum / all.count;
    const double error = std::sqrt(std::max(0.0, all.squares / all.count - mean * mean) / all.count);
    if (std::abs(mean) > significant * error && std::abs(mean) > least)
      found.over_blocks =
          std::max(found.over_blocks, 0.5 * std::abs(mean) * std::min(radius, static_cast<double>(side) * half_tile));
  };
  for (std::size_t side = 1; side <= tiles; ++side)
    for (std::size_t row = 0; row + side <= tiles; ++row)
      for (std::size_t column = 0; column + side <= tiles; ++column) look_at_block(row, column, side);
  for (double& size : found.sizes)
    if (size > least)
      ++found.counted;
    else
      size = 0;
  return found;
}

/// The power of the curl while the button is up, or held.
double curl_with_button(const Bank& bank, const LookedAt& looked_at, bool button, std::span<const ForceStep> jumps,
                        const GradingHand& hand, double least_watt) {
  const glm::vec2 extent = 0.5f * glm::vec2(bank.size().width, bank.size().height);
  const glm::vec2 room = inside(bank);
  // A hand circles where there is room, and gains no more than the force gives all along its way.
  const Curls curls =
      curls_of(looked_at, button, extent, room, std::min(hand.radius, double{std::min(room.x, room.y)}));
  const double on_tiles = std::min(curls.over_blocks, curls.largest) * hand.speed();
  std::vector<Hand> centres;
  const auto circle_at = [&](const Hand& at) { centres.emplace_back(at).button = button; };
  if (curls.counted > 0)
    for (const std::size_t i : greatest_of(curls.sizes, circled)) circle_at(looked_at.hands[i]);
  if (static_cast<double>(curls.counted) > share_with_curl * static_cast<double>(looked_at.hands.size()))
    for (std::size_t i = 0; i < circled; ++i) circle_at(looked_at.hands[i]);
  for (const ForceStep& step : jumps)
    if (step.jumps()) circle_at(step.hand);
  if (on_tiles > 0) circle_at(Hand{});
  if (centres.empty()) return 0;
  // The mean over a tile tells less than a circle, but finds a weak curl under a strong texture.
  if (const auto on_circles = strongest_circle(bank, centres, hand, least_watt)) return *on_circles;
  const Circle largest{glm::dvec2(0), std::min(hand.radius, double{std::min(room.x, room.y)}), button};
  return on_tiles > 0 ? less_drag(bank, largest, on_tiles, hand.speed()) : 0;
}

}  // namespace

double curl_watt(const Bank& bank, const LookedAt& looked_at, std::span<const ForceStep> jumps, const GradingHand& hand,
                 double least_watt) {
  const double watt = curl_with_button(bank, looked_at, false, jumps, hand, least_watt);
  const auto held = [](const Hand& at) { return at.button && at.velocity == glm::vec2(0.0f); };
  if (std::ranges::none_of(looked_at.hands, held)) return watt;
  return std::max(watt, curl_with_button(bank, looked_at, true, jumps, hand, least_watt));
}

}  // namespace wale
