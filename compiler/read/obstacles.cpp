#include "compiler/read/obstacles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <utility>

#include "compiler/read/bend.hpp"
#include "compiler/read/hill.hpp"
#include "compiler/read/next_obstacle.hpp"
#include "compiler/read/obstacle_fit.hpp"
#include "compiler/read/sound_obstacles.hpp"
#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr std::size_t most_obstacles = 5;
constexpr double worth_an_obstacle = 0.07;  // of what is left, at least, explained by one more
constexpr double all_explained = 3e-4;      // of what a line leaves: nothing more is looked for
constexpr double left_unexplained = 4e-3;   // of what a line leaves, by obstacles that explain it, beside noise ...
constexpr double times_noise = 1.7;         // ... and so many times that
constexpr double coarser_noise = 5;         // times what a texture finer than the cells leaves in means over them
constexpr double places_a_mean = 16;
constexpr double far_from_all = 0.3;                     // of what a line leaves, in means over cells that steps cross
constexpr int steps_at_means = 8, steps_at_places = 12;  // of a fit, at most
constexpr double most_noise = 0.2;                       // of what a line leaves
constexpr double alike_ways = 0.94;                      // cosine: two walls that stand so may be a curve ...
constexpr double left_by_a_curve = 1e-5;                 // ... which leaves more than this of what a line leaves ...
constexpr double hidden_curve = 1e-4;                    // ... unless there is so much noise
constexpr double alone = 0.12, nearly_alone = 0.1;       // of what is left: explained by one more, and left by it then
constexpr double less_than_others = 0.9;                 // of what other kinds leave
constexpr std::size_t places_fitted_at = 3000, places_fitted_roughly = 1500;
constexpr double times_too_much = 3;           // times what may be left, where obstacles are fitted at few places
constexpr std::size_t blocks = 8;              // along each side, in which a force without a bend is a plane
constexpr double hardly_left = 0.01;           // of the square of the least force: nothing is hidden in it
constexpr double gained_beside_noise = 0.015;  // of what is left, by a jump: beside a texture that is found later ...
constexpr double gained_by_a_jump = 0.3;       // ... and where it is taken off
constexpr std::size_t every_jump = 3;          // place that is tried, before it is fitted
constexpr double shape_of_a_step = 4;          // widths of a soft step: a small one nearer to it is its shape ...
constexpr double small_beside_a_step = 0.3;    // ... if it is less than so much of it
constexpr std::size_t most_beside_a_hill = 2;
constexpr double left_by_a_hill = 0.03;  // of its mean square
constexpr double beside_a_hill = 0.02;   // of its largest push: a smaller even force is none
constexpr double times_left = 3;         // what obstacles may leave, in a block: about a round wall no force is a plane
constexpr double blocks_with_bends = 0.6;  // at most

/// N^2: the part of a mean square that changes from one of these means to the next, as a texture's.
double noise_of(std::span<const glm::dvec2> even) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < even.size(); ++i) {
    const glm::dvec2 off = even[i - 1] - 2.0 * even[i] + even[i + 1];
    sum += glm::dot(off, off) / 6;
  }
  return even.size() > 2 ? sum / static_cast<double>(even.size() - 2) : 0;
}

// A box looks a little like a round room, and a step like two walls: what one kind explains is of that kind.
constexpr std::array<Kinds, 5> all_kinds = {{{.straight = true},
                                             {.round = true},
                                             {.steps = true},
                                             {.straight = true, .steps = true},
                                             {.straight = true, .jumps = true}}};
constexpr std::array<Kinds, 3> kinds_beside_a_hill = {
    {{.straight = true}, {.steps = true}, {.straight = true, .jumps = true}}};

/// Joins a step along a wall's face to the wall: with so much it begins to push.
void join_preloads(Obstacles& found) {
  for (Wall& wall : found.walls) {
    if (wall.round() || wall.preload != 0) continue;
    const auto along = std::ranges::find_if(found.steps, [&](const StaticStep& step) {
      const double cosine = glm::dot(step.way, wall.inward);
      return std::abs(cosine) > 0.999 && std::abs(std::copysign(1.0, cosine) * step.offset - wall.offset) < 1.5e-3 &&
             std::copysign(1.0, cosine) * glm::dot(step.change, wall.inward) < 0;
    });
    if (along == found.steps.end()) continue;
    wall.preload = glm::length(along->change);
    found.steps.erase(along);
  }
}

/// Whether a profile bends twice the same way: two walls that face alike, or a curve.
bool bends_twice(const Obstacles& found) {
  for (std::size_t i = 0; i < found.walls.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (glm::dot(found.walls[i].inward, found.walls[k].inward) > alike_ways) return true;
  return false;
}

/// Whether one of the steps is what the shape of another one, which is soft, differs by from a hyperbolic tangent.
bool is_shape_of_a_step(const ObstacleFit& fit) {
  const std::vector<StaticStep>& steps = fit.found.steps;
  return std::ranges::any_of(steps, [&](const StaticStep& small) {
    return std::ranges::any_of(steps, [&](const StaticStep& soft) {
      const double cosine = glm::dot(soft.way, small.way);
      return soft.width > 0 && std::abs(cosine) > alike_ways &&
             glm::length(small.change) < small_beside_a_step * glm::length(soft.change) &&
             std::abs(std::copysign(1.0, cosine) * small.offset - soft.offset) < shape_of_a_step * soft.width;
    });
  });
}

/// Lets walls that begin evenly begin with a jump, where that leaves less by a share of `gained`: a jump looks like a
/// face a little further out.
void try_jumps(ObstacleFit& fit, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
               double gained) {
  std::vector<glm::dvec2> left = fit.rest(places, forces);
  double least = mean_square(left);
  if (least < hardly_left * least_force * least_force) return;
  // What one leaves out may be little beside what another does: twice.
  const std::size_t walls = fit.found.walls.size();
  for (std::size_t turn = 0; turn < 2 * walls; ++turn) {
    const std::size_t i = turn % walls;
    const Wall wall = fit.found.walls[i];
    if (wall.preload != 0) continue;
    std::vector<PlaceOnLine> line;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const glm::dvec2 against = left[k] + wall.at(places[k]);
      line.push_back({wall.depth(places[k]), glm::dot(against, wall.into(places[k]))});
    }
    const Bend bend = best_bend(line, BendKind::bends_and_jumps, every_jump);
    const double without = best_bend(line, BendKind::bends, every_jump).left;
    // Of the forces along the wall, which a texture may not push.
    if (!(without - bend.left > 0.5 * gained * least) || !(-bend.jump > least_force) || !(bend.slope < 0)) continue;
    ObstacleFit other = fit;
    other.found.walls[i].preload = -bend.jump, other.found.walls[i].begin_deeper(bend.at);
    other.found.walls[i].stiffness = -bend.slope;
    const double here = other.improve(places, forces, steps_at_places);
    if (!(here < (1 - gained) * least) || !(other.found.walls[i].preload > least_force)) continue;
    least = here, fit = std::move(other), left = fit.rest(places, forces);
  }
}

/// Finds obstacles of some kinds, one after another.
class ObstacleSearch {
 public:
  ObstacleSearch(const StillForces& whole, std::span<const glm::dvec2> forces)
      : whole_(whole),
        forces_(forces),
        places_(cell_means(whole.side, whole.places)),
        even_(cell_means(whole.side, forces)),
        line_(linear_force(places_, even_)) {
    by_line_ = mean_square(rest_of(line_));
  }

  /// Whether the forces are even between bends, as those of walls and steps are. Nearly all slow reliefs are not, and
  /// are left at once.
  bool is_even_between_bends() const {
    const std::size_t side = whole_.side / blocks;
    std::vector<glm::dvec2> places(side * side), forces(side * side);
    std::size_t uneven = 0;
    for (std::size_t block = 0; block < blocks * blocks; ++block) {
      const std::size_t top = block / blocks * side, left = block % blocks * side;
      for (std::size_t i = 0; i < forces.size(); ++i) {
        const std::size_t at = (top + i / side) * whole_.side + left + i % side;
        places[i] = whole_.places[at], forces[i] = forces_[at];
      }
      const LinearForce plane = linear_force(places, forces);
      for (std::size_t i = 0; i < forces.size(); ++i) forces[i] -= plane.at(places[i]);
      const double even = mean_square(cell_means(side, forces)), within = (mean_square(forces) - even) / places_a_mean;
      const double noise = std::min(coarser_noise * within, most_noise * by_line_);
      uneven += even > times_left * left_unexplained * by_line_ + times_noise * noise;
    }
    return static_cast<double>(uneven) <= blocks_with_bends * blocks * blocks;
  }

  /// N^2: what a model leaves, beyond a texture's noise.
  double left_by(const ObstacleFit& fit) const { return unexplained(fit); }

  bool is_bent() const { return by_line_ >= least_force * least_force; }
  double by_line() const { return by_line_; }

  /// Whether what a model leaves is no more than a texture.
  bool explains(const ObstacleFit& fit) const { return unexplained(fit) <= left_unexplained * by_line_; }

  /// A wall, and the even force beside it.
  ObstacleFit beside(const Wall& wall) const {
    ObstacleFit fit;
    fit.found.walls.push_back(wall);
    fit.even = linear_force(whole_.places, fit.rest(whole_.places, forces_));
    fit.seat_jumps(whole_.places, forces_);
    return fit;
  }

  /// Obstacles and more of them. What a small one adds beside a large one is little of what a line leaves, so it is
  /// looked for by itself in what is left.
  ObstacleFit with_more(ObstacleFit fit) {
    while (fit.found.walls.size() + fit.found.steps.size() < most_obstacles) {
      const double left = unexplained(fit);
      if (left < least_force * least_force) break;
      if (!ways_) ways_.emplace(places_);
      const std::vector<glm::dvec2> rest = fit.rest(places_, even_);
      std::optional<ObstacleFit> best;
      double least = nearly_alone * left;
      for (const Kinds& kinds : {Kinds{.steps = true}, Kinds{.straight = true}}) {
        if (NextObstacle(*ways_, places_, rest).found(kinds).explained < alone * mean_square(rest)) continue;
        ObstacleFit more = fit;
        add(more, kinds, left);
        auto all = accepted(std::move(more));
        const double here = all && !is_shape_of_a_step(*all) ? unexplained(*all) : HUGE_VAL;
        if (here < least) least = std::max(here, 0.0), best = std::move(all);
      }
      if (!best) break;
      fit = *std::move(best);
    }
    return fit;
  }

  std::optional<ObstacleFit> found(const Kinds& kinds) {
    if (!ways_) ways_.emplace(places_);
    ObstacleFit fit;
    fit.even = line_;
    double left = by_line_;
    const std::size_t most = kinds.round ? 1 : most_obstacles;
    std::vector<ObstacleFit> fewer;
    for (std::size_t number = 0; number < most && left > all_explained * by_line_; ++number) {
      ObstacleFit more = fit;
      const double here = add(more, kinds, left);
      if (!(here < (1 - worth_an_obstacle) * left) || (number >= 2 && here > 0.5 * by_line_)) break;
      if (number > 0 && left < far_from_all * by_line_) fewer.push_back(fit);
      fit = std::move(more), left = here;
    }
    if (fit.found.walls.size() + fit.found.steps.size() > 1 && left > all_explained * by_line_ &&
        left < 0.15 * by_line_)
      left = seat_anew(fit, kinds, left);
    if (fit.found.empty() || left > far_from_all * by_line_) return std::nullopt;
    auto all = accepted(std::move(fit));
    // In the means over cells that a step crosses, some of it is left, where one more seems to be.
    for (; !all && !fewer.empty(); fewer.pop_back()) all = accepted(std::move(fewer.back()), true);
    return all;
  }

  /// Two walls, one behind the other, in place of one: where a line along the way into it bends twice. Nothing if they
  /// leave more.
  std::optional<ObstacleFit> nested(const ObstacleFit& single) const {
    const double left = unexplained(single);
    if (left < least_force * least_force || single.found.walls.size() != 1) return std::nullopt;
    const Wall wall = single.found.walls.front();
    std::vector<PlaceOnLine> line;
    const std::vector<glm::dvec2> rest = single.rest(places_, even_);
    for (std::size_t i = 0; i < places_.size(); ++i)
      line.push_back({glm::dot(places_[i], wall.inward), glm::dot(rest[i] + wall.at(places_[i]), wall.inward)});
    const auto bends = best_two_bends(line);
    if (!bends || !((*bends)[0].slope < 0) || !((*bends)[1].slope < 0)) return std::nullopt;
    ObstacleFit fit = single;
    fit.found.walls.clear(), fit.found.steps.clear();
    for (const Bend& each : *bends)
      fit.found.walls.push_back({.inward = wall.inward, .offset = each.at, .stiffness = -each.slope});
    fit.improve(places_, even_, steps_at_means);
    auto both = accepted(std::move(fit));
    if (!both || !(unexplained(*both) < nearly_alone * left)) return std::nullopt;
    return both;
  }

  /// A round hill, with what is beside it: found where the hill does not push, then fitted together with it. Nothing if
  /// nothing is beside it.
  std::optional<ObstacleFit> beside_hill() const {
    const auto hill = likely_hill(places_, even_);
    if (!hill) return std::nullopt;
    std::vector<glm::dvec2> places, forces;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (glm::distance(places_[i], hill->top) > hill->reach) places.push_back(places_[i]), forces.push_back(even_[i]);
    ObstacleFit alone;
    alone.even = linear_force(places, forces);
    const std::vector<glm::dvec2> outside = alone.rest(places, forces);
    const double by_line = mean_square(outside);
    std::vector<ObstacleFit> tried = {alone};
    if (by_line > least_force * least_force) {
      const SortedWays ways(places);
      for (const Kinds& kinds : kinds_beside_a_hill) {
        ObstacleFit fit = alone;
        double left = by_line;
        for (std::size_t number = 0; number < most_beside_a_hill && left > all_explained * by_line; ++number) {
          ObstacleFit more = fit;
          const Candidate next = NextObstacle(ways, places, more.rest(places, forces)).found(kinds, more.found.walls);
          if (!(next.explained > 0)) break;
          for (const Wall& each : next.one.walls) more.found.walls.push_back(each);
          for (const StaticStep& each : next.one.steps) more.found.steps.push_back(each);
          const double here = more.improve(places, forces, steps_at_means);
          if (!(here < (1 - worth_an_obstacle) * left)) break;
          fit = std::move(more), left = here;
        }
        if (!fit.found.empty()) tried.push_back(std::move(fit));
      }
    }
    std::optional<ObstacleFit> best;
    double least = HUGE_VAL;
    for (ObstacleFit& each : tried) {
      each.found.hill = hill;
      each.improve(places_, even_, steps_at_means);
      auto all = accepted(std::move(each));
      if (!all || !is_beside_hill(*all)) continue;
      const double left = mean_square(all->rest(whole_.places, forces_));
      if (left < less_than_others * least) least = left, best = std::move(all);
    }
    return best;
  }

 private:
  /// Whether a hill explains nearly all of what it is fitted to, and something else is there.
  bool is_beside_hill(const ObstacleFit& fit) const {
    double squares = 0, most = 0;
    for (const glm::dvec2& place : places_) {
      const glm::dvec2 force = fit.found.hill->at(place);
      squares += glm::dot(force, force), most = std::max(most, glm::length(force));
    }
    squares /= static_cast<double>(places_.size());
    if (most < 2 * least_force || unexplained(fit) > left_by_a_hill * squares) return false;
    const glm::dvec2 half = 0.5 * whole_.size;
    const double even =
        glm::length(fit.even.mean) + glm::length(fit.even.by_x) * half.x + glm::length(fit.even.by_y) * half.y;
    return !fit.found.walls.empty() || !fit.found.steps.empty() || even > beside_a_hill * most;
  }

  std::vector<glm::dvec2> rest_of(const LinearForce& line) const {
    std::vector<glm::dvec2> rest = even_;
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= line.at(places_[i]);
    return rest;
  }

  /// Adds the obstacle that explains most, and returns what is left, N^2.
  double add(ObstacleFit& fit, const Kinds& kinds, double left) const {
    const std::vector<glm::dvec2> rest = fit.rest(places_, even_);
    const Candidate next = NextObstacle(*ways_, places_, rest).found(kinds, fit.found.walls);
    if (!(next.explained > 0)) return left;
    for (const Wall& each : next.one.walls) fit.found.walls.push_back(each);
    for (const StaticStep& each : next.one.steps) fit.found.steps.push_back(each);
    return fit.improve(places_, even_, steps_at_means);
  }

  /// The first obstacles were found where there seemed to be no others. Each is taken away and looked for again.
  double seat_anew(ObstacleFit& fit, const Kinds& kinds, double left) const {
    const std::size_t all = fit.found.walls.size() + fit.found.steps.size();
    for (std::size_t i = 0; i < all; ++i) {
      const std::size_t walls = fit.found.walls.size();
      ObstacleFit other = fit;
      if (i < walls)
        other.found.walls.erase(other.found.walls.begin() + static_cast<std::ptrdiff_t>(i));
      else
        other.found.steps.erase(other.found.steps.begin() + static_cast<std::ptrdiff_t>(i - walls));
      other.improve(places_, even_, steps_at_means);
      const double here = add(other, kinds, left);
      if (other.found.walls.size() + other.found.steps.size() == all && here < left)
        left = here, fit = std::move(other);
    }
    return left;
  }

  static bool jumps(const StaticStep& step) { return step.width < first_width; }

  /// Fits obstacles exactly; nothing if they leave too much, or are none, or one of the steps does not jump that
  /// should.
  std::optional<ObstacleFit> accepted(ObstacleFit fit, bool all_jump = false) const {
    join_preloads(fit.found);
    // What leaves far too much at few places does so at more.
    fit_exactly(fit, places_fitted_roughly);
    if (unexplained(fit) > times_too_much * left_unexplained * by_line_ || !is_sound(fit, whole_.places, forces_))
      return {};
    if (all_jump && !std::ranges::all_of(fit.found.steps, jumps)) return {};
    join_preloads(fit.found);
    fit_exactly(fit, places_fitted_at);
    try_jumps(fit, some_of(whole_.places, places_fitted_at), some_of(forces_, places_fitted_at), gained_beside_noise);
    fit.seat_jumps(whole_.places, forces_);
    if (!explains(fit) || !is_sound(fit, whole_.places, forces_) || !fit.fills_its_circles(whole_.places, forces_))
      return {};
    if (bends_twice(fit.found) && unexplained(fit, hidden_curve) > left_by_a_curve * by_line_) return {};
    return fit;
  }

  /// Moves obstacles to where they fit best at so many places, and makes steps jump if that is better.
  void fit_exactly(ObstacleFit& fit, std::size_t most) const {
    const std::vector<glm::dvec2> places = some_of(whole_.places, most), forces = some_of(forces_, most);
    double left = fit.improve(places, forces, steps_at_places);
    // How much is left tells two walls from a curve.
    if (bends_twice(fit.found)) left = fit.improve(places, forces, steps_at_places);
    const auto may_jump = [](const StaticStep& each) { return each.width > 0 && jumps(each); };
    if (std::ranges::none_of(fit.found.steps, may_jump)) return;
    ObstacleFit sharp = fit;
    for (StaticStep& each : sharp.found.steps) each.width = 0;
    // What jumps is put in its place with all else.
    double left_sharp = HUGE_VAL;
    for (int turn = 0; turn < 2; ++turn) left_sharp = sharp.improve(places, forces, steps_at_places);
    if (left_sharp < left) fit = std::move(sharp);
  }

  /// N^2: what a model leaves beyond a texture's noise, which counts up to some share of what a line leaves.
  double unexplained(const ObstacleFit& fit, double noise_at_most = most_noise) const {
    // At the places themselves: a mean over a cell that a step crosses is neither force.
    const std::vector<glm::dvec2> fine = fit.rest(whole_.places, forces_), rest = cell_means(whole_.side, fine);
    const double within = (mean_square(fine) - mean_square(rest)) / places_a_mean;
    const double noise = std::min({noise_of(rest), coarser_noise * within, noise_at_most * by_line_});
    return mean_square(rest) - times_noise * noise;
  }

  const StillForces& whole_;
  std::span<const glm::dvec2> forces_;
  std::vector<glm::dvec2> places_, even_;  // of means over small cells
  std::optional<SortedWays> ways_;         // from when something is looked for
  LinearForce line_;
  double by_line_ = 0;  // N^2: what a line leaves
};

}  // namespace

namespace {

/// Walls and steps where there is no hill.
std::optional<ObstacleFit> find_without_hill(ObstacleSearch& search, const StillForces& whole,
                                             std::span<const glm::dvec2> forces) {
  const auto face =
      find_half_plane(cell_means(whole.side, whole.places), cell_means(whole.side, forces), whole.places, forces);
  // What explains all but rounding is it; a texture leaves more, and then what leaves least.
  std::optional<ObstacleFit> best;
  double least = HUGE_VAL;
  if (face) {
    const ObstacleFit single = search.beside(wall_of(*face));
    if (auto both = search.nested(single)) return search.with_more(*std::move(both));
    ObstacleFit fit = search.with_more(single);
    if (search.explains(fit)) return fit;
  }
  for (const Kinds& kinds : all_kinds) {
    auto fit = search.found(kinds);
    if (!fit) continue;
    const double left = mean_square(fit->rest(whole.places, forces));
    if (left < all_explained * search.by_line()) return search.with_more(*std::move(fit));
    if (left < less_than_others * least) least = left, best = std::move(fit);
  }
  if (best) return search.with_more(*std::move(best));
  return face ? std::optional(search.beside(wall_of(*face))) : std::nullopt;
}

}  // namespace

std::optional<Obstacles> find_obstacles(const StillForces& whole, std::span<const glm::dvec2> forces) {
  ObstacleSearch search(whole, forces);
  if (!search.is_bent()) return std::nullopt;
  auto found = search.is_even_between_bends() ? find_without_hill(search, whole, forces) : std::nullopt;
  // What they leave may be a hill.
  if (found && search.left_by(*found) < 2 * least_force * least_force) return std::move(found->found);
  auto with_hill = search.beside_hill();
  if (with_hill && (!found || search.left_by(*with_hill) < nearly_alone * search.left_by(*found)))
    found = std::move(with_hill);
  return found ? std::optional(std::move(found->found)) : std::nullopt;
}

Obstacles fitted_beside(const Obstacles& found, std::span<const SlowWave> waves, std::span<const glm::dvec2> places,
                        std::span<const glm::dvec2> forces) {
  ObstacleFit fit;
  fit.found = found;
  for (const SlowWave& each : waves)
    fit.waves.push_back(
        {each.waves, std::vector<std::array<glm::dvec2, 2>>(each.harmonics, {glm::dvec2(0), glm::dvec2(0)})});
  const std::vector<glm::dvec2> some_places = some_of(places, places_fitted_at),
                                some = some_of(forces, places_fitted_at);
  fit.even = linear_force(some_places, fit.rest(some_places, some));
  fit.improve(some_places, some, 10);
  try_jumps(fit, some_places, some, gained_by_a_jump);
  fit.seat_jumps(places, forces);
  return is_sound(fit, places, forces) ? fit.found : found;
}

}  // namespace wale
