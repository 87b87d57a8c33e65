#include "compiler/read/obstacles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <utility>

#include "compiler/read/bend.hpp"
#include "compiler/read/obstacle_fit.hpp"
#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr std::size_t most_obstacles = 5;
constexpr int ways_tried = 12;              // in half a turn
constexpr double worth_an_obstacle = 0.07;  // of what is left, at least, explained by one more
constexpr double all_explained = 3e-4;      // of what a line leaves: nothing more is looked for
constexpr double left_unexplained = 4e-3;   // of what a line leaves, by obstacles that explain it, beside noise ...
constexpr double times_noise = 1.7;         // ... and so many times that
constexpr double coarser_noise = 5;         // times what a texture finer than the cells leaves in means over them
constexpr double places_a_mean = 16;
constexpr double far_from_all = 0.3;                     // of what a line leaves, in means over cells that steps cross
constexpr int steps_at_means = 8, steps_at_places = 12;  // of a fit, at most
constexpr double most_noise = 0.2;                       // of what a line leaves
constexpr double least_beside = 0.012;                   // of the places, on either side of an obstacle
constexpr double least_push_of_wall = 0.02;              // N, at its deepest
constexpr double more_than_all = 1.3;                    // times: a change of a fit and that of all forces
constexpr double mended = 0.2;                           // of a wall's stiffness
constexpr double alike_ways = 0.94;                      // cosine: two walls that stand so may be a curve ...
constexpr double left_by_a_curve = 1e-5;                 // ... which leaves more than this of what a line leaves ...
constexpr double hidden_curve = 1e-4;                    // ... unless there is so much noise
constexpr double alone = 0.12, nearly_alone = 0.1;       // of what is left: explained by one more, and left by it then
constexpr double less_than_others = 0.9;                 // of what other kinds leave
constexpr double widest_step = 5e-3;                     // m
constexpr double apart_at_least = 4e-3;                  // m between two steps
constexpr double opposed_ways = -0.9;                    // cosine
constexpr std::size_t places_fitted_at = 3000, places_fitted_roughly = 1500;
constexpr double times_too_much = 3;         // times what may be left, where obstacles are fitted at few places
constexpr std::size_t every_bend = 6;        // that is tried, before it is fitted
constexpr double first_width = 1.5e-3;       // m: of a step, before it is fitted
constexpr double first_period_share = 0.25;  // of half the patch: between the centres that are tried for round walls
constexpr int centres_aside = 2;
constexpr std::size_t blocks = 8;  // along each side, in which a force without a bend is a plane
constexpr double times_left = 3;   // what obstacles may leave, in a block: about a round wall no force is a plane
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

/// What is looked for.
struct Kinds {
  bool straight = false, round = false, steps = false;
};
// A box looks a little like a round room, and a step like two walls: what one kind explains is of that kind.
constexpr std::array<Kinds, 4> all_kinds = {
    {{true, false, false}, {false, true, false}, {false, false, true}, {true, false, true}}};

/// One more obstacle, and what it explains of a mean square, N^2.
struct Candidate {
  Obstacles one;
  double explained = 0;
};

/// Places in their order along each way that is tried: they are sorted once for all obstacles.
class SortedWays {
 public:
  explicit SortedWays(std::span<const glm::dvec2> places) {
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      const double angle = static_cast<double>(i) * std::numbers::pi / ways_tried;
      ways_[i] = Way(places, {std::cos(angle), std::sin(angle)});
    }
  }

  struct Way {
    Way() = default;
    Way(std::span<const glm::dvec2> places, glm::dvec2 way) : along(way) {
      for (std::size_t k = 0; k < places.size(); ++k) order.emplace_back(glm::dot(places[k], along), k);
      std::ranges::sort(order);
    }
    glm::dvec2 along{0};
    std::vector<std::pair<double, std::size_t>> order;  // m along it, and which place
  };
  std::span<const Way> all() const { return ways_; }

 private:
  std::array<Way, ways_tried> ways_;
};

/// The best obstacle for what a model leaves.
class NextObstacle {
 public:
  NextObstacle(const SortedWays& ways, std::span<const glm::dvec2> places, std::span<const glm::dvec2> rest)
      : ways_(ways), places_(places), rest_(rest) {
    for (const glm::dvec2& place : places) half_ = glm::max(half_, glm::abs(place));
  }

  /// A wall often faces as another one does, between the ways that are tried.
  Candidate found(const Kinds& kinds, const std::vector<Wall>& beside = {}) {
    for (const Wall& each : beside)
      if (kinds.straight && !each.round()) try_straight({places_, each.inward});
    if (kinds.round) {
      try_round();
      return std::move(best_);
    }
    const glm::dvec2 push = axis_of_rest();
    for (const SortedWays::Way& way : ways_.all()) {
      if (kinds.straight) try_straight(way);
      if (!kinds.steps) continue;
      try_step(way, push);
      try_step(way, glm::dvec2(-push.y, push.x));
    }
    return std::move(best_);
  }

 private:
  /// The axis along which the rest pushes most.
  glm::dvec2 axis_of_rest() const {
    double xx = 0, xy = 0, yy = 0;
    for (const glm::dvec2& each : rest_) xx += each.x * each.x, xy += each.x * each.y, yy += each.y * each.y;
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    return {std::cos(angle), std::sin(angle)};
  }

  /// What a bend explains of the parts of the rest along `push`, over the places along a way.
  std::pair<Bend, double> bend_along(const SortedWays::Way& way, glm::dvec2 push, BendKind kind) const {
    std::vector<PlaceOnLine> line;
    line.reserve(places_.size());
    double squares = 0;
    for (const auto& [at, place] : way.order) {
      line.push_back({at, glm::dot(rest_[place], push)});
      squares += line.back().value * line.back().value;
    }
    const Bend best = best_bend_of_sorted(std::move(line), kind, every_bend);
    return {best, squares / static_cast<double>(places_.size()) - best.left};
  }

  void try_straight(const SortedWays::Way& way) {
    const auto [best, explained] = bend_along(way, way.along, BendKind::bends);
    if (!(explained > best_.explained)) return;
    // Where it is less steep beyond the bend, the wall is on the other side.
    const double side = best.slope > 0 ? -1 : 1;
    best_ = {{{{.inward = side * way.along, .offset = side * best.at, .stiffness = std::abs(best.slope)}}, {}},
             explained};
  }

  void try_step(const SortedWays::Way& way, glm::dvec2 push) {
    const auto [best, explained] = bend_along(way, push, BendKind::jumps);
    if (explained > best_.explained) best_ = {{{}, {{way.along, best.at, first_width, best.jump * push}}}, explained};
  }

  /// A round wall about a point; returns what it explains.
  double try_round(glm::dvec2 centre) {
    std::vector<PlaceOnLine> line(places_.size());
    double squares = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const glm::dvec2 off = places_[i] - centre;
      const double far = glm::length(off);
      line[i] = {far, far > 0 ? glm::dot(rest_[i], off / far) : 0};
      squares += line[i].value * line[i].value;
    }
    const Bend best = best_bend(line, BendKind::bends, every_bend);
    const double explained = squares / static_cast<double>(places_.size()) - best.left;
    // Outwards ever less: a wall around. Inwards ever more: within it, and the even force is that outside.
    if (explained > best_.explained && best.at > 0)
      best_ = {
          {{{.centre = centre, .offset = best.at, .fills = best.slope > 0, .stiffness = std::abs(best.slope)}}, {}},
          explained};
    return explained;
  }

  void try_round() {
    glm::dvec2 best{0};
    double most = -1;
    const auto look = [&](glm::dvec2 centre) {
      const double here = try_round(centre);
      if (here > most) most = here, best = centre;
    };
    for (int row = -centres_aside; row <= centres_aside; ++row)
      for (int column = -centres_aside; column <= centres_aside; ++column)
        look(first_period_share * half_ * glm::dvec2(column, row));
    for (double step = 0.5 * first_period_share; step > 0.05; step *= 0.5) {
      const glm::dvec2 middle = best;
      for (const glm::dvec2 aside : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
        look(middle + step * aside * half_);
    }
  }

  const SortedWays& ways_;
  std::span<const glm::dvec2> places_, rest_;
  glm::dvec2 half_{0};
  Candidate best_;
};

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

/// N: between the least and the greatest of some forces along an axis of length 1.
double range_along(std::span<const glm::dvec2> forces, glm::dvec2 axis) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const glm::dvec2& force : forces) {
    const double along = glm::dot(force, axis);
    least = std::min(least, along), most = std::max(most, along);
  }
  return most - least;
}

/// Whether some change of a force along an axis is more than the forces ever differ by. Parts of a model that cancel
/// each other are none of the force.
bool is_more_than_all(glm::dvec2 change, std::span<const glm::dvec2> forces) {
  const double size = glm::length(change);
  return size > 0 && size > least_force + more_than_all * range_along(forces, change / size);
}

/// Whether walls and steps are such as stand in a patch: none that is hardly there, no two in the same place, none that
/// changes the force by more than the force changes.
bool is_sound(const ObstacleFit& fit, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  const auto count = static_cast<double>(places.size());
  const auto share = [&](const auto& beyond) {
    return static_cast<double>(std::ranges::count_if(places, beyond)) / count;
  };
  const auto& [walls, steps] = fit.found;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Wall& wall = walls[i];
    double deepest = 0;
    for (const glm::dvec2& place : places) deepest = std::max(deepest, wall.depth(place));
    const double inside = share([&](glm::dvec2 place) { return wall.depth(place) > 0; });
    const double rise = wall.stiffness * deepest;
    if (inside < least_beside || inside > 1 - least_beside || wall.stiffness < least_stiffness ||
        rise < least_push_of_wall || wall.preload < -least_force || wall.preload > rise)
      return false;
    if (!wall.round() && is_more_than_all((wall.preload + rise) * wall.inward, forces)) return false;
    // A wall that mends what the even force pushes away is no wall.
    const glm::dvec2 in = wall.round() ? glm::dvec2(1, 0) : wall.inward;
    if (glm::dot(in, in.x * fit.even.by_x + in.y * fit.even.by_y) > mended * wall.stiffness) return false;
    for (std::size_t k = 0; k < i; ++k) {
      const Wall& other = walls[k];
      if (wall.round() || other.round()) return false;
      const double cosine = glm::dot(wall.inward, other.inward);
      // One wall that bends a little, and a spring that ends.
      if ((cosine > alike_ways && std::abs(wall.offset - other.offset) < apart_at_least) ||
          (cosine < opposed_ways && wall.offset + other.offset < 0))
        return false;
    }
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const StaticStep& step = steps[i];
    // Two in one place are no two.
    for (std::size_t k = 0; k < i; ++k) {
      const double cosine = glm::dot(step.way, steps[k].way);
      if (std::abs(cosine) > alike_ways &&
          std::abs(step.offset - std::copysign(1.0, cosine) * steps[k].offset) < apart_at_least)
        return false;
    }
    if (step.width > widest_step || is_more_than_all(step.change, forces)) return false;
    const double beyond = share([&](glm::dvec2 place) { return glm::dot(place, step.way) > step.offset; });
    if (beyond < least_beside || beyond > 1 - least_beside || glm::length(step.change) < 2 * least_force) return false;
  }
  return true;
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

  bool is_bent() const { return by_line_ >= least_force * least_force; }
  double by_line() const { return by_line_; }

  /// Whether what a model leaves is no more than a texture.
  bool explains(const ObstacleFit& fit) const { return unexplained(fit) <= left_unexplained * by_line_; }

  /// A wall, and the even force beside it.
  ObstacleFit beside(const Wall& wall) const {
    ObstacleFit fit;
    fit.found.walls.push_back(wall);
    fit.even = linear_force(whole_.places, fit.rest(whole_.places, forces_));
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
        const double here = all ? unexplained(*all) : HUGE_VAL;
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

 private:
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
    if (unexplained(fit) > times_too_much * left_unexplained * by_line_ ||
        !is_sound(fit, whole_.places, forces_))
      return {};
    if (all_jump && !std::ranges::all_of(fit.found.steps, jumps)) return {};
    fit_exactly(fit, places_fitted_at);
    fit.seat_jumps(whole_.places, forces_);
    if (!explains(fit) || !is_sound(fit, whole_.places, forces_) || !fit.fills_its_circles(whole_.places, forces_)) return {};
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

std::optional<Obstacles> find_obstacles(const StillForces& whole, std::span<const glm::dvec2> forces) {
  ObstacleSearch search(whole, forces);
  if (!search.is_bent() || !search.is_even_between_bends()) return std::nullopt;
  const auto face =
      find_half_plane(cell_means(whole.side, whole.places), cell_means(whole.side, forces), whole.places, forces);
  // What explains all but rounding is it; a texture leaves more, and then what leaves least.
  std::optional<ObstacleFit> best;
  double least = HUGE_VAL;
  if (face) {
    ObstacleFit fit = search.with_more(search.beside(wall_of(*face)));
    if (search.explains(fit)) return std::move(fit.found);
  }
  for (const Kinds& kinds : all_kinds) {
    auto fit = search.found(kinds);
    if (!fit) continue;
    const double left = mean_square(fit->rest(whole.places, forces));
    if (left < all_explained * search.by_line()) return search.with_more(*std::move(fit)).found;
    if (left < less_than_others * least) least = left, best = std::move(fit);
  }
  if (best) return search.with_more(*std::move(best)).found;
  return face ? std::optional(Obstacles{{wall_of(*face)}, {}}) : std::nullopt;
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
  fit.seat_jumps(places, forces);
  return is_sound(fit, places, forces) ? fit.found : found;
}

}  // namespace wale
