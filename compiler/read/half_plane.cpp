#include "compiler/read/half_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "compiler/read/bend.hpp"
#include "compiler/read/still_forces.hpp"
#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr double unexplained = 0.03;         // of what a line leaves, by a face that explains nearly all
constexpr double hardly_unexplained = 2e-3;  // of what a line leaves: no step is hidden in it
constexpr double of_one_axis = 0.8;          // of what a line leaves: a face pushes along one axis only
constexpr double least_inside = 0.012;       // of the places
constexpr std::size_t places_fitted = 6400;
constexpr int rounds = 4;
constexpr double turned_enough = 1e-5;   // rad: smaller turns end the rounds
constexpr double worth_a_preload = 0.3;  // of what a face without a preload leaves, at most

/// A face, the even force beside it, and the mean square that both leave, N^2.
struct FaceFit {
  HalfPlane face;
  LinearForce even;
  double left = HUGE_VAL;
};

/// The axis along which what a line leaves pushes; nothing if it pushes along both.
std::optional<glm::dvec2> axis_of(std::span<const glm::dvec2> rest) {
  double xx = 0, xy = 0, yy = 0;
  for (const glm::dvec2& each : rest) xx += each.x * each.x, xy += each.x * each.y, yy += each.y * each.y;
  const double apart = std::hypot(0.5 * (xx - yy), xy), larger = 0.5 * (xx + yy) + apart;
  if (!(larger > of_one_axis * (xx + yy))) return std::nullopt;
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return glm::dvec2(std::cos(angle), std::sin(angle));
}

/// Fits the even force, the stiffness and the direction together about a fit.
void turn_better(FaceFit& fit, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  constexpr std::size_t unknown = 9;  // mean, by_x, by_y, stiffness, angle, and where it begins or its preload
  std::array<std::array<double, unknown + 1>, unknown> rows{};
  const glm::dvec2 in = fit.face.inward, across(-in.y, in.x);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 off = forces[i] - fit.even.at(places[i]) - fit.face.at(places[i]);
    const double depth = glm::dot(places[i], in) - fit.face.offset;
    glm::dvec2 by_stiffness{0}, by_angle{0}, by_push{0};
    if (depth > 0) {
      by_push = -in;
      by_stiffness = -depth * in;
      by_angle = -fit.face.stiffness * glm::dot(places[i], across) * in -
                 (fit.face.preload + fit.face.stiffness * depth) * across;
    }
    for (const int axis : {0, 1}) {
      const double one = axis == 0 ? 1.0 : 0.0, other = 1 - one;
      // Lengths in decimetres and stiffness in the fit's own, so that all columns are of like sizes.
      const std::array<double, unknown> columns = {one,
                                                   other,
                                                   10 * one * places[i].x,
                                                   10 * other * places[i].x,
                                                   10 * one * places[i].y,
                                                   10 * other * places[i].y,
                                                   10 * by_stiffness[axis],
                                                   by_angle[axis] / std::max(1.0, 0.1 * fit.face.stiffness),
                                                   by_push[axis]};
      for (std::size_t row = 0; row < unknown; ++row) {
        for (std::size_t column = 0; column < unknown; ++column) rows[row][column] += columns[row] * columns[column];
        rows[row][unknown] += columns[row] * off[axis];
      }
    }
  }
  if (!solve<unknown>(rows)) return;
  const auto step = [&](std::size_t i) { return rows[i][unknown]; };
  fit.even.mean += glm::dvec2(step(0), step(1));
  fit.even.by_x += 10.0 * glm::dvec2(step(2), step(3));
  fit.even.by_y += 10.0 * glm::dvec2(step(4), step(5));
  // A face with a preload begins where it jumps; without one, a larger push is an earlier beginning.
  if (fit.face.preload != 0)
    fit.face.preload += step(8);
  else
    fit.face.offset -= step(8) / fit.face.stiffness;
  fit.face.stiffness += 10 * step(6);
  const double turn = std::clamp(step(7) / std::max(1.0, 0.1 * fit.face.stiffness), -0.1, 0.1);
  fit.face.inward = glm::normalize(in + turn * across);
}

double left_by(const FaceFit& fit, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  double sum = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 off = forces[i] - fit.even.at(places[i]) - fit.face.at(places[i]);
    sum += glm::dot(off, off);
  }
  return sum / static_cast<double>(places.size());
}

/// Fits a face along an axis, whose direction may turn.
FaceFit fit_face(glm::dvec2 axis, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                 bool may_jump) {
  FaceFit fit;
  fit.face.inward = axis;
  double aside = 0;  // N/m: by how much the push along the axis changes across it
  for (int round = 0; round < rounds; ++round) {
    std::vector<PlaceOnLine> line(places.size());
    const glm::dvec2 in = fit.face.inward, across(-in.y, in.x);
    for (std::size_t i = 0; i < places.size(); ++i)
      line[i] = {glm::dot(places[i], in), glm::dot(forces[i], in) - aside * glm::dot(places[i], across)};
    const Bend bend = best_bend(line, may_jump ? BendKind::bends_and_jumps : BendKind::bends);
    if (!(bend.left < HUGE_VAL) || bend.slope == 0) return {};
    fit.face = {in, bend.at, -bend.slope, -bend.jump};
    // If it is less steep beyond the bend, the face is on the other side, and the steep side is the even one.
    if (bend.slope > 0) fit.face = {-in, -bend.at, bend.slope, -bend.jump};
    std::vector<glm::dvec2> beside(forces.begin(), forces.end());
    for (std::size_t i = 0; i < places.size(); ++i) beside[i] -= fit.face.at(places[i]);
    fit.even = linear_force(places, beside);
    turn_better(fit, places, forces);
    const glm::dvec2 now = fit.face.inward, by_across = -now.y * fit.even.by_x + now.x * fit.even.by_y;
    aside = glm::dot(by_across, now);
    if (round > 0 && std::abs(now.x * in.y - now.y * in.x) < turned_enough) break;
  }
  fit.left = left_by(fit, places, forces);
  return fit;
}

/// N^2: the part of a mean square that changes from one of these means to the next, as a texture's.
double jitter_of(std::span<const glm::dvec2> even) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < even.size(); ++i) {
    const glm::dvec2 off = even[i - 1] - 2.0 * even[i] + even[i + 1];
    sum += std::min(glm::dot(off, off) / 6, 1e6);
  }
  return even.size() > 2 ? sum / static_cast<double>(even.size() - 2) : 0;
}

}  // namespace

std::optional<HalfPlane> find_half_plane(std::span<const glm::dvec2> even_places, std::span<const glm::dvec2> even,
                                         std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  const LinearForce line = linear_force(even_places, even);
  std::vector<glm::dvec2> rest(even.begin(), even.end());
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= line.at(even_places[i]);
  const double by_line = mean_square(rest);
  if (by_line < least_force * least_force) return std::nullopt;
  const auto axis = axis_of(rest);
  if (!axis) return std::nullopt;
  const FaceFit coarse = fit_face(*axis, even_places, even, false);
  const FaceFit jumping = fit_face(*axis, even_places, even, true);
  const double jitter = std::min(jitter_of(rest), 0.1 * by_line);
  const double most_left = unexplained * by_line + 1.5 * jitter;
  if (std::min(coarse.left, jumping.left) > most_left) return std::nullopt;
  const std::vector<glm::dvec2> some_places = some_of(places, places_fitted), some = some_of(forces, places_fitted);
  FaceFit fine = fit_face(coarse.left < HUGE_VAL ? coarse.face.inward : *axis, some_places, some, false);
  const FaceFit with_jump = fit_face(fine.left < HUGE_VAL ? fine.face.inward : *axis, some_places, some, true);
  // What jumps otherwise than against a hand that goes in is an edge.
  if (with_jump.left < worth_a_preload * fine.left) {
    if (with_jump.face.preload > least_force)
      fine = with_jump;
    else if (fine.left > hardly_unexplained * by_line)
      return std::nullopt;
  } else if (coarse.left > most_left) {
    return std::nullopt;
  }
  if (!(fine.left < HUGE_VAL)) return std::nullopt;
  std::size_t inside = 0;
  double deepest = 0;
  for (const glm::dvec2& place : places) {
    const double depth = glm::dot(place, fine.face.inward) - fine.face.offset;
    inside += depth > 0, deepest = std::max(deepest, depth);
  }
  const double share = static_cast<double>(inside) / static_cast<double>(places.size());
  if (share < least_inside || share > 1 - least_inside) return std::nullopt;
  // A step that hardly rises behind is an edge.
  const double rise = fine.face.stiffness * deepest;
  if (fine.face.stiffness < least_stiffness || rise < 0.02 || std::abs(fine.face.preload) > rise) return std::nullopt;
  return fine.face;
}

}  // namespace wale
