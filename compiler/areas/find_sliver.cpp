#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/areas/colour_areas.hpp"
#include "compiler/areas/edge_distances.hpp"

namespace wale {
namespace {

constexpr int unreached = std::numeric_limits<int>::max();

class SliverFinder {
 public:
  /// `count`: only areas below it are looked at. `narrowest` in pixels.
  SliverFinder(const ColourAreas& areas, std::size_t count, double narrowest)
      : areas_(areas),
        count_(count),
        narrowest_(narrowest),
        side_(static_cast<int>(std::ceil(narrowest - 1e-6))),
        width_(static_cast<int>(areas.width)),
        height_(static_cast<int>(areas.height)),
        to_edge_(squared_edge_distances<AreaId>(areas.areas, areas.width, areas.height)) {
    measure_squares();
  }

  std::optional<Sliver> find() {
    walk_from_wide_places();
    // A wide place reaches to the corners of its square, or to the edge of its disc.
    const int longest = static_cast<int>(std::ceil(0.5 * (narrowest_ + 1) + 2 * narrowest_));
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (areas_.areas[i] >= count_ || steps_[i] <= longest) continue;
      return sliver_at(steps_[i] == unreached ? widest_of_island(i) : widest_near(i));
    }
    return std::nullopt;
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int x_of(std::size_t index) const { return static_cast<int>(index % areas_.width); }
  int y_of(std::size_t index) const { return static_cast<int>(index / areas_.width); }

  /// The side of the largest square of one area whose last pixel, to the right and below, is here.
  void measure_squares() {
    squares_.assign(areas_.areas.size(), 1);
    for (int y = 1; y < height_; ++y)
      for (int x = 1; x < width_; ++x) {
        const AreaId own = areas_.areas[index(x, y)];
        const std::size_t beside[] = {index(x - 1, y), index(x, y - 1), index(x - 1, y - 1)};
        if (std::ranges::all_of(beside, [&](std::size_t each) { return areas_.areas[each] == own; }))
          squares_[index(x, y)] = 1 + std::min({squares_[beside[0]], squares_[beside[1]], squares_[beside[2]]});
      }
  }

  template <class Visit>
  void each_neighbour(std::size_t from, const Visit& visit) const {
    const int x = x_of(from), y = y_of(from);
    for (int row = std::max(0, y - 1); row <= std::min(height_ - 1, y + 1); ++row)
      for (int column = std::max(0, x - 1); column <= std::min(width_ - 1, x + 1); ++column)
        if (const std::size_t to = index(column, row); areas_.areas[to] == areas_.areas[from]) visit(to);
  }

  /// Counts the steps within an area from the nearest place that is wide enough: the middle of a square, for what lies
  /// along the rows and columns, or of a disc, for what lies aslant.
  void walk_from_wide_places() {
    steps_.assign(areas_.areas.size(), unreached);
    std::vector<std::uint32_t> front, next;
    const double radius = 0.5 * (narrowest_ + 1), wide = radius * radius * (1 - 1e-9);
    const auto begin = [&](std::size_t at) {
      if (steps_[at] == 0) return;
      steps_[at] = 0;
      front.push_back(static_cast<std::uint32_t>(at));
    };
    for (std::size_t i = 0; i < areas_.areas.size(); ++i) {
      if (areas_.areas[i] >= count_) continue;
      if (to_edge_[i] >= wide) begin(i);
      if (squares_[i] >= side_) begin(index(x_of(i) - side_ / 2, y_of(i) - side_ / 2));
    }
    for (int step = 1; !front.empty(); ++step, front.swap(next)) {
      next.clear();
      for (const std::uint32_t from : front)
        each_neighbour(from, [&](std::size_t to) {
          if (steps_[to] != unreached) return;
          steps_[to] = step;
          next.push_back(static_cast<std::uint32_t>(to));
        });
    }
  }

  std::size_t widest_of_island(std::size_t first) {
    std::size_t widest = first;
    std::vector<std::size_t> open = {first};
    steps_[first] = 0;
    while (!open.empty()) {
      const std::size_t from = open.back();
      open.pop_back();
      if (to_edge_[from] > to_edge_[widest]) widest = from;
      each_neighbour(from, [&](std::size_t to) {
        if (steps_[to] == unreached) steps_[to] = 0, open.push_back(to);
      });
    }
    return widest;
  }

  /// From a pixel at the side of a tongue to its middle.
  std::size_t widest_near(std::size_t at) const {
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      std::size_t best = at;
      each_neighbour(at, [&](std::size_t to) {
        if (to_edge_[to] > to_edge_[best]) best = to;
      });
      goes_on = best != at;
      at = best;
    }
    return at;
  }

  Sliver sliver_at(std::size_t i) const {
    double width = 2 * std::sqrt(to_edge_[i]) - 1;
    for (int y = y_of(i); y < std::min(height_, y_of(i) + side_); ++y)
      for (int x = x_of(i); x < std::min(width_, x_of(i) + side_); ++x)
        if (const int square = squares_[index(x, y)];
            areas_.areas[index(x, y)] == areas_.areas[i] && square > std::max(x - x_of(i), y - y_of(i)))
          width = std::max(width, 1.0 * square);
    return {areas_.areas[i], {static_cast<std::uint32_t>(x_of(i)), static_cast<std::uint32_t>(y_of(i))}, width};
  }

  const ColourAreas& areas_;
  std::size_t count_;
  double narrowest_;
  int side_, width_, height_;
  std::vector<double> to_edge_;  ///< squared
  std::vector<int> squares_, steps_;
};

}  // namespace

std::optional<Sliver> find_sliver(const ColourAreas& areas, std::size_t count, double narrowest) {
  if (!(narrowest > 1)) return std::nullopt;  // nothing is narrower than a pixel
  return SliverFinder(areas, count, std::min<double>(narrowest, 2 * largest_image_side)).find();
}

}  // namespace wale
