#include "compiler/read/obstacle_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "compiler/read/bend.hpp"
#include "compiler/read/logistic.hpp"

namespace wale {
namespace {

constexpr double most_turn = 0.1;       // rad, in one step
constexpr double most_shift = 10e-3;    // m, in one step
constexpr double most_widening = 0.7;   // of the logarithm of a width, in one step
constexpr double hardly_wide = 0.1e-3;  // m: a step that narrow jumps
constexpr double least_gain = 1e-4;     // of what is left, by a step worth going on
constexpr int tries = 5;
constexpr double least_pivot = 1e-6;
constexpr std::size_t rough_places = 300;  // of a jump, that are tried
constexpr double about_a_jump = 2e-3;      // m on either side of where it was fitted
constexpr double hardly_off = 5e-6;        // m, at the ends of its line
constexpr std::size_t fewest_about_a_jump = 32;

glm::dvec2 turned(glm::dvec2 way, double by) {
  by = std::clamp(by, -most_turn, most_turn);
  return glm::normalize(way + by * glm::dvec2(-way.y, way.x));
}
double shift(double by) { return std::clamp(by, -most_shift, most_shift); }

/// How far a step has risen at some distance beyond its line, as a hyperbolic tangent does.
double risen(double distance, double width) {
  if (!(width > 0)) return distance > 0 ? 1 : 0;
  return logistic_of(2 / width * distance);
}

/// Takes a step off some forces.
void take_off(const StaticStep& step, std::span<const glm::dvec2> places, std::vector<glm::dvec2>& forces) {
  constexpr std::size_t at_once = 256;
  std::array<double, at_once> up;
  for (std::size_t first = 0; first < places.size(); first += at_once) {
    const std::size_t count = std::min(at_once, places.size() - first);
    for (std::size_t i = 0; i < count; ++i) up[i] = glm::dot(places[first + i], step.way) - step.offset;
    if (step.width > 0) {
      for (std::size_t i = 0; i < count; ++i) up[i] *= 2 / step.width;
      logistic_of(up.data(), count, up.data());
    } else {
      for (std::size_t i = 0; i < count; ++i) up[i] = up[i] > 0 ? 1 : 0;
    }
    for (std::size_t i = 0; i < count; ++i) forces[first + i] -= up[i] * step.change;
  }
}

}  // namespace

double Wall::depth(glm::dvec2 place) const {
  if (!round()) return glm::dot(place, inward) - offset;
  const double far = glm::length(place - centre);
  return fills ? offset - far : far - offset;
}

glm::dvec2 Wall::into(glm::dvec2 place) const {
  if (!round()) return inward;
  const glm::dvec2 off = place - centre;
  const double far = glm::length(off);
  return far > 0 ? (fills ? -1.0 : 1.0) / far * off : glm::dvec2(0);
}

glm::dvec2 Wall::at(glm::dvec2 place) const {
  const double deep = depth(place);
  return deep > 0 ? -(preload + stiffness * deep) * into(place) : glm::dvec2(0);
}

glm::dvec2 Hill::at(glm::dvec2 place) const {
  const glm::dvec2 off = place - top;
  const double far = glm::length(off), along = far / spacing();
  if (!(far > 0) || !(far < reach)) return glm::dvec2(0);
  const auto first = std::min(static_cast<std::size_t>(along), push.size() - 1);
  const double part = along - static_cast<double>(first), next = first + 1 < push.size() ? push[first + 1] : 0;
  return ((1 - part) * push[first] + part * next) / far * off;
}

Wall wall_of(const HalfPlane& face) {
  return {.inward = face.inward, .offset = face.offset, .stiffness = face.stiffness, .preload = face.preload};
}

glm::dvec2 StaticStep::at(glm::dvec2 place) const { return risen(glm::dot(place, way) - offset, width) * change; }

glm::dvec2 ObstacleFit::at(glm::dvec2 place) const {
  glm::dvec2 force = even.at(place);
  for (const Wall& each : found.walls) force += each.at(place);
  for (const StaticStep& each : found.steps) force += each.at(place);
  if (found.hill) force += found.hill->at(place);
  for (const Wave& wave : waves) {
    const double turn = 2 * std::numbers::pi * glm::dot(wave.waves, place);
    for (std::size_t i = 0; i < wave.parts.size(); ++i) {
      const double angle = static_cast<double>(i + 1) * turn;
      force += std::cos(angle) * wave.parts[i][0] + std::sin(angle) * wave.parts[i][1];
    }
  }
  return force;
}

std::vector<glm::dvec2> ObstacleFit::rest(std::span<const glm::dvec2> places,
                                          std::span<const glm::dvec2> forces) const {
  std::vector<glm::dvec2> left(forces.begin(), forces.end());
  ObstacleFit others = *this;
  others.found.steps.clear();
  for (std::size_t i = 0; i < left.size(); ++i) left[i] -= others.at(places[i]);
  for (const StaticStep& each : found.steps) take_off(each, places, left);
  return left;
}

bool ObstacleFit::fills_its_circles(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) const {
  constexpr double nearly_all = 0.75;     // of what the law asks for
  constexpr double in_the_middle = 0.15;  // of the radius
  constexpr std::size_t fewest = 4;       // places that tell
  return std::ranges::all_of(found.walls, [&](const Wall& each) {
    if (!each.round() || !each.fills) return true;
    double asked = 0, felt = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (each.depth(places[i]) < (1 - in_the_middle) * each.offset) continue;
      const glm::dvec2 out = -each.into(places[i]);
      asked += glm::dot(each.at(places[i]), out), felt += glm::dot(forces[i] - even.at(places[i]), out), ++count;
    }
    return count < fewest || felt >= nearly_all * asked;
  });
}

// The order of the unknowns: the even force, walls, steps, a hill, waves.
std::size_t ObstacleFit::columns() const {
  std::size_t count = 6;
  for (const Wall& each : found.walls) count += each.round() ? 4 : 3;
  for (const StaticStep& each : found.steps) count += each.width > 0 ? 5 : 2;
  if (found.hill) count += 2 + found.hill->push.size();
  for (const Wave& each : waves) count += 2 + 4 * each.parts.size();
  return count;
}

void ObstacleFit::fill(glm::dvec2 place, std::span<glm::dvec2> by) const {
  std::ranges::fill(by, glm::dvec2(0));
  const glm::dvec2 x(1, 0), y(0, 1);
  by[0] = x, by[1] = y, by[2] = place.x * x, by[3] = place.x * y, by[4] = place.y * x, by[5] = place.y * y;
  std::size_t next = 6;
  for (const Wall& each : found.walls) {
    const std::size_t first = next;
    next += each.round() ? 4 : 3;
    const double deep = each.depth(place);
    if (!(deep > 0)) continue;
    const glm::dvec2 in = each.into(place);
    const double push = each.preload + each.stiffness * deep;
    by[first] = -deep * in;
    // A face with a preload stays where it jumps; another one pushes less if it stands further in.
    by[first + 1] = each.preload != 0 ? -in : (each.round() && each.fills ? -each.stiffness : each.stiffness) * in;
    if (!each.round()) {
      const glm::dvec2 across(-in.y, in.x);
      by[first + 2] = -each.stiffness * glm::dot(place, across) * in - push * across;
      continue;
    }
    const double far = glm::length(place - each.centre);
    for (const int axis : {0, 1}) {
      const glm::dvec2 moved = axis == 0 ? x : y;
      const double along = glm::dot(moved, in);
      // Into a wall around its circle the depth falls as the circle moves along; the way in turns with it.
      const double turn = each.fills ? -1 : 1;
      by[first + 2 + static_cast<std::size_t>(axis)] =
          each.stiffness * along * in + turn * push / far * (moved - along * in);
    }
  }
  for (const StaticStep& each : found.steps) {
    const double distance = glm::dot(place, each.way) - each.offset, up = risen(distance, each.width);
    by[next] = up * x, by[next + 1] = up * y;
    if (each.width > 0) {
      const double slope = 2 * up * (1 - up) / each.width;
      by[next + 2] = -slope * each.change;
      by[next + 3] = slope * glm::dot(place, glm::dvec2(-each.way.y, each.way.x)) * each.change;
      by[next + 4] = -slope * distance * each.change;  // by the logarithm of the width
    }
    next += each.width > 0 ? 5 : 2;
  }
  if (found.hill) {
    const Hill& hill = *found.hill;
    const glm::dvec2 off = place - hill.top;
    const double far = glm::length(off), along = far / hill.spacing();
    if (far > 0 && far < hill.reach) {
      const glm::dvec2 out = off / far;
      const auto first = std::min(static_cast<std::size_t>(along), hill.push.size() - 1);
      const double part = along - static_cast<double>(first);
      const bool last = first + 1 == hill.push.size();
      const double beyond = last ? 0 : hill.push[first + 1];
      const double here = (1 - part) * hill.push[first] + part * beyond;
      const double slope = (beyond - hill.push[first]) / hill.spacing();
      // A top that moves changes the distance, and the way out.
      for (const int axis : {0, 1}) {
        const glm::dvec2 moved = axis == 0 ? x : y;
        const double towards = glm::dot(moved, out);
        by[next + static_cast<std::size_t>(axis)] = -slope * towards * out - here / far * (moved - towards * out);
      }
      by[next + 2 + first] = (1 - part) * out;
      if (!last) by[next + 3 + first] = part * out;
    }
    next += 2 + hill.push.size();
  }
  for (const Wave& wave : waves) {
    const double turn = 2 * std::numbers::pi * glm::dot(wave.waves, place);
    const std::size_t first = next;
    next += 2;
    glm::dvec2 by_turn{0};
    for (std::size_t i = 0; i < wave.parts.size(); ++i, next += 4) {
      const auto number = static_cast<double>(i + 1);
      const double cosine = std::cos(number * turn), sine = std::sin(number * turn);
      by[next] = cosine * x, by[next + 1] = cosine * y, by[next + 2] = sine * x, by[next + 3] = sine * y;
      by_turn += number * (cosine * wave.parts[i][1] - sine * wave.parts[i][0]);
    }
    by[first] = 2 * std::numbers::pi * place.x * by_turn, by[first + 1] = 2 * std::numbers::pi * place.y * by_turn;
  }
}

void ObstacleFit::move(std::span<const double> by) {
  even.mean += glm::dvec2(by[0], by[1]);
  even.by_x += glm::dvec2(by[2], by[3]);
  even.by_y += glm::dvec2(by[4], by[5]);
  std::size_t next = 6;
  for (Wall& each : found.walls) {
    each.stiffness += by[next];
    (each.preload != 0 ? each.preload : each.offset) += each.preload != 0 ? by[next + 1] : shift(by[next + 1]);
    if (each.round())
      each.centre += glm::dvec2(shift(by[next + 2]), shift(by[next + 3]));
    else
      each.inward = turned(each.inward, by[next + 2]);
    next += each.round() ? 4 : 3;
  }
  for (StaticStep& each : found.steps) {
    each.change += glm::dvec2(by[next], by[next + 1]);
    next += 2;
    if (!(each.width > 0)) continue;
    each.offset += shift(by[next]);
    each.way = turned(each.way, by[next + 1]);
    each.width *= std::exp(std::clamp(by[next + 2], -most_widening, most_widening));
    next += 3;
  }
  if (found.hill) {
    found.hill->top += glm::dvec2(shift(by[next]), shift(by[next + 1]));
    next += 2;
    for (double& each : found.hill->push) each += by[next++];
  }
  for (Wave& wave : waves) {
    wave.waves += glm::dvec2(by[next], by[next + 1]);
    next += 2;
    for (auto& part : wave.parts)
      for (glm::dvec2& each : part) each += glm::dvec2(by[next], by[next + 1]), next += 2;
  }
}

void ObstacleFit::move_jumps(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  const std::size_t rough = std::max<std::size_t>(1, places.size() / rough_places);
  const auto best_along = [&](const std::vector<glm::dvec2>& without, glm::dvec2 way, glm::dvec2 of, BendKind kind,
                              std::size_t every) {
    std::vector<PlaceOnLine> line(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) line[i] = {glm::dot(places[i], way), glm::dot(without[i], of)};
    return best_bend(line, kind, every);
  };
  for (StaticStep& each : found.steps) {
    if (each.width > 0 || each.change == glm::dvec2(0)) continue;
    std::vector<glm::dvec2> without = rest(places, forces);
    for (std::size_t i = 0; i < places.size(); ++i) without[i] += each.at(places[i]);
    const glm::dvec2 of = glm::normalize(each.change);
    Bend best = best_along(without, each.way, of, BendKind::jumps, rough);
    for (double step = 0.02; step > 5e-4; step *= 0.5)
      for (const double by : {step, -step}) {
        const glm::dvec2 way = turned(each.way, by);
        const Bend other = best_along(without, way, of, BendKind::jumps, rough);
        if (other.left < best.left) best = other, each.way = way;
      }
    best = best_along(without, each.way, of, BendKind::jumps, 1);
    if (best.left < HUGE_VAL) each.offset = best.at;
  }
  for (Wall& each : found.walls) {
    if (each.preload == 0) continue;
    const std::vector<glm::dvec2> left = rest(places, forces);
    std::vector<PlaceOnLine> line(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      line[i] = {each.depth(places[i]), glm::dot(left[i] + each.at(places[i]), each.into(places[i]))};
    const Bend best = best_bend(line, BendKind::bends_and_jumps, 1);
    if (best.left < HUGE_VAL) each.begin_deeper(best.at);
  }
}

void ObstacleFit::seat_jumps(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  for (Wall& each : found.walls) {
    if (!(each.preload > 0)) continue;
    // On which side of the face a place lies tells half of the push that is behind it.
    std::vector<std::pair<double, bool>> line;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double deep = each.depth(places[i]), push = each.preload + each.stiffness * deep;
      if (std::abs(deep) > about_a_jump || !(push > 0.2 * each.preload)) continue;
      const glm::dvec2 without = forces[i] - at(places[i]) + each.at(places[i]);
      line.emplace_back(deep, -glm::dot(without, each.into(places[i])) > 0.5 * push);
      wrong += !line.back().second;
    }
    if (line.size() < fewest_about_a_jump) continue;
    std::ranges::sort(line);
    std::size_t least = wrong;
    double by = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      wrong = line[i].second ? wrong + 1 : wrong - 1;
      if (wrong < least) least = wrong, by = 0.5 * (line[i].first + line[i + 1].first);
    }
    each.begin_deeper(by), each.preload += each.stiffness * by;
  }
  for (StaticStep& each : found.steps) {
    if (each.width > 0 || each.change == glm::dvec2(0)) continue;
    std::vector<glm::dvec2> near, there;
    double farthest = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (std::abs(glm::dot(places[i], each.way) - each.offset) > about_a_jump) continue;
      near.push_back(places[i]), there.push_back(forces[i]);
      farthest = std::max(farthest, std::abs(glm::dot(places[i], glm::dvec2(-each.way.y, each.way.x))));
    }
    if (near.size() < fewest_about_a_jump) continue;
    // Of a jump alone: on which side of the middle between both forces a place lies.
    const glm::dvec2 of = each.change / glm::dot(each.change, each.change);
    const std::vector<glm::dvec2> left = rest(near, there);
    std::vector<double> risen_there;
    for (std::size_t i = 0; i < near.size(); ++i) risen_there.push_back(glm::dot(left[i] + each.at(near[i]), of));
    const auto seat = [&](glm::dvec2 way) {
      // The place at which the fewest lie on the wrong side.
      std::vector<std::pair<double, bool>> line;
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < near.size(); ++i) {
        line.emplace_back(glm::dot(near[i], way), risen_there[i] > 0.5);
        wrong += !line.back().second;
      }
      std::ranges::sort(line);
      std::size_t least = wrong;
      double at = each.offset;
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        wrong = line[i].second ? wrong + 1 : wrong - 1;
        if (wrong < least) least = wrong, at = 0.5 * (line[i].first + line[i + 1].first);
      }
      return std::pair(least, at);
    };
    glm::dvec2 way = each.way;
    auto best = seat(way);
    for (double step = about_a_jump / farthest; best.first > 0 && step * farthest > hardly_off; step *= 0.5)
      for (const double by : {step, -step}) {
        const glm::dvec2 other = turned(way, by);
        if (const auto here = seat(other); here.first < best.first) best = here, way = other;
      }
    each.way = way, each.offset = best.second;
  }
}

double ObstacleFit::improve(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, int steps) {
  double left = improve_once(places, forces, steps);
  // A wall that jumps turns with its push, and then jumps elsewhere.
  const auto jumps = [](const Wall& each) { return each.preload != 0; };
  for (int turn = 0; turn < 2 && std::ranges::any_of(found.walls, jumps); ++turn) {
    ObstacleFit other = *this;
    const double here = other.improve_once(places, forces, steps);
    if (!(here < left)) break;
    const bool hardly = here > (1 - 1e-3) * left;
    left = here, *this = std::move(other);
    if (hardly) break;
  }
  return left;
}

double ObstacleFit::improve_once(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, int steps) {
  double damping = 1e-6;
  move_jumps(places, forces);
  std::vector<glm::dvec2> left = rest(places, forces);
  double least = mean_square(left);
  // Two rows of a place, for the axes of its force; a column for each unknown.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by;
  std::vector<glm::dvec2> here_by;
  for (int step = 0; step < steps; ++step) {
    const auto n = static_cast<Eigen::Index>(columns());
    by.resize(2 * static_cast<Eigen::Index>(places.size()), n);
    here_by.resize(columns());
    for (std::size_t i = 0; i < places.size(); ++i) {
      fill(places[i], here_by);
      const auto row = 2 * static_cast<Eigen::Index>(i);
      for (Eigen::Index k = 0; k < n; ++k) {
        const glm::dvec2& each = here_by[static_cast<std::size_t>(k)];
        by(row, k) = each.x, by(row + 1, k) = each.y;
      }
    }
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(by.transpose());
    const Eigen::VectorXd size = matrix.diagonal().cwiseMax(1e-30).cwiseSqrt();
    const Eigen::VectorXd right =
        (by.transpose() * Eigen::Map<const Eigen::VectorXd>(&left.front().x, by.rows())).cwiseQuotient(size);
    for (Eigen::Index k = 0; k < n; ++k) matrix.col(k) = matrix.col(k).cwiseQuotient(size) / size[k];
    bool better = false;
    const double before = least;
    for (int turn = 0; turn < tries && !better; ++turn) {
      matrix.diagonal().setConstant(1 + damping);
      damping *= 30;
      const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factors(matrix);
      if (factors.info() != Eigen::Success || !(factors.matrixLLT().diagonal().minCoeff() > least_pivot)) continue;
      const Eigen::VectorXd moved = factors.solve(right).cwiseQuotient(size);
      ObstacleFit other = *this;
      other.move({moved.data(), static_cast<std::size_t>(n)});
      for (StaticStep& each : other.found.steps)
        if (each.width < hardly_wide) each.width = 0;
      std::vector<glm::dvec2> now = other.rest(places, forces);
      const double here = mean_square(now);
      if (!(here < least)) continue;
      better = true, least = here, left = std::move(now), *this = std::move(other);
      damping = std::max(1e-8, damping / 900);
    }
    if (!better || before - least < least_gain * before) break;
  }
  return least;
}

}  // namespace wale
