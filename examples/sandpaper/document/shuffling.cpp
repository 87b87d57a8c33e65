#include "document/shuffling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>
#include <utility>

namespace sandpaper {
namespace {

constexpr double usual_diameter = 0.2;  // m, where the device does not say
constexpr double grain = 1e-4;          // m, places are multiples of it
constexpr int most_tries = 200;         // for a place within the disc
constexpr double work = 2e7;            // pairs of rectangles that are compared at most
constexpr int most_candidates = 64;     // for the place of each patch
constexpr int restarts = 8, sweeps = 200;

struct Box {
  glm::dvec2 at{0}, half{0};
};

/// The box around what a patch covers, from its place: a polygon need not lie around the patch's centre. For a shape
/// that tells only distances it is up to a 64th too large on each side.
Box footprint(const Placed& placed, glm::dvec2 size) {
  const wale::Shape& outline = placed.patch.outline;
  if (outline.is_rectangle() || placed.patch.shape == "ellipse") return {{0, 0}, 0.5 * size};
  constexpr int cells = 64;
  const wale::Shape shape = outline.stretched(glm::vec2(size));
  const glm::dvec2 cell = size / double(cells);
  const double around = 0.5 * std::hypot(cell.x, cell.y);
  glm::dvec2 low = 0.5 * size, high = -low;
  for (int i = 0; i < cells * cells; ++i) {
    const glm::dvec2 at = -0.5 * size + cell * (glm::dvec2(i % cells, i / cells) + 0.5);
    if (shape.edge(glm::vec2(at)).metres < -around) continue;  // no point of the cell belongs to it
    low = {std::min(low.x, at.x - cell.x / 2), std::min(low.y, at.y - cell.y / 2)};
    high = {std::max(high.x, at.x + cell.x / 2), std::max(high.y, at.y + cell.y / 2)};
  }
  if (low.x >= high.x || low.y >= high.y) return {{0, 0}, 0.5 * size};
  // The patch's place is a multiple of the grain as its box's is.
  const glm::dvec2 middle = 0.5 * (low + high),
                   rounded{std::round(middle.x / grain) * grain, std::round(middle.y / grain) * grain};
  return {rounded, 0.5 * (high - low) + 0.5 * grain};
}

/// The boxes of many patches that may have few shapes.
class Footprints {
 public:
  explicit Footprints(const SizeOf& size_of) : size_of_(size_of) {}
  Box of(const Placed& placed) {
    const glm::dvec2 size = size_of_(placed);
    if (placed.patch.outline.is_rectangle()) return {{0, 0}, 0.5 * size};
    const auto [found, is_new] = known_.try_emplace({placed.patch.outline.identity(), size.x, size.y});
    if (is_new) found->second = footprint(placed, size);
    return found->second;
  }

 private:
  const SizeOf& size_of_;
  std::map<std::tuple<const void*, double, double>, Box> known_;
};

double shared(const Box& a, const Box& b) {
  const double x = a.half.x + b.half.x - std::abs(a.at.x - b.at.x), y = a.half.y + b.half.y - std::abs(a.at.y - b.at.y);
  // Of two where one lies within the other, no more than the smaller one is shared. What is less than a picometre is
  // the rounding of edges that touch.
  const double wide = std::min(x, 2 * std::min(a.half.x, b.half.x)),
               high = std::min(y, 2 * std::min(a.half.y, b.half.y));
  return wide <= 1e-12 || high <= 1e-12 ? 0 : wide * high;
}

/// Random numbers that are the same with every library, unlike std::uniform_real_distribution.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  double share() { return engine_() / 4294967296.0; }                     // 0 .. 1
  std::size_t below(std::size_t many) { return engine_() % many; }
  template <class List>
  void shuffle(List& list) {
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[below(i)]);
  }

 private:
  std::mt19937 engine_;
};

/// The places of boxes within a disc, which are moved to lie on each other as little as possible.
class Table {
 public:
  Table(std::vector<Box> boxes, std::vector<std::size_t> movable, double radius, Dice& dice)
      : boxes_(std::move(boxes)), movable_(std::move(movable)), radius_(radius), dice_(dice) {}

  /// Returns the overlap that is left; nothing if there are too many boxes to compare.
  std::optional<double> arrange() {
    const double many = static_cast<double>(boxes_.size());
    const int candidates = static_cast<int>(std::min<double>(most_candidates, work / (many * many)));
    if (candidates < 2) {
      for (const std::size_t each : movable_) boxes_[each].at = anywhere(boxes_[each].half);
      return std::nullopt;
    }
    std::vector<Box> best;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < restarts && least > 0; ++i) {
      place(candidates);
      const double left = improve(candidates, work / restarts / many);
      if (left < least) least = left, best = boxes_;
    }
    boxes_ = std::move(best);
    return least;
  }
  const Box& box(std::size_t index) const { return boxes_[index]; }

 private:
  bool fits(glm::dvec2 at, glm::dvec2 half) const {
    return std::hypot(std::abs(at.x) + half.x, std::abs(at.y) + half.y) <= radius_ + 1e-12;
  }
  static glm::dvec2 rounded(glm::dvec2 at) {
    return {std::round(at.x / grain) * grain, std::round(at.y / grain) * grain};
  }
  glm::dvec2 anywhere(glm::dvec2 half) {
    const glm::dvec2 far{std::max(0.0, radius_ - half.x), std::max(0.0, radius_ - half.y)};
    for (int i = 0; i < most_tries; ++i) {
      const double x = dice_.share(), y = dice_.share();
      const glm::dvec2 at = rounded(far * glm::dvec2(2 * x - 1, 2 * y - 1));
      if (fits(at, half)) return at;
    }
    return {0, 0};
  }
  /// Edge to edge with another box, where packings that are tight have their places.
  glm::dvec2 beside(std::size_t index, const Box& other) {
    const Box& own = boxes_[index];
    const bool is_x = dice_.below(2) == 0, is_positive = dice_.below(2) == 0;
    const double along = 2 * dice_.share() - 1;
    const glm::dvec2 reach = own.half + other.half;
    const double sign = is_positive ? 1 : -1;
    // Away from the other one, so that rounding makes no overlap.
    const auto away = [sign](double x) { return sign * std::ceil(sign * x / grain - 1e-6) * grain; };
    glm::dvec2 at = rounded(other.at + along * reach);
    (is_x ? at.x : at.y) = away(is_x ? other.at.x + sign * reach.x : other.at.y + sign * reach.y);
    return at;
  }
  double overlap_at(std::size_t index, glm::dvec2 at, double enough) const {
    const Box own{at, boxes_[index].half};
    double sum = 0;
    for (std::size_t i = 0; i < boxes_.size() && sum < enough; ++i)
      if (i != index && placed_[i]) sum += shared(own, boxes_[i]);
    return sum;
  }
  void place(int candidates) {
    placed_.assign(boxes_.size(), true);
    for (const std::size_t each : movable_) placed_[each] = false;
    std::vector<std::size_t> order = movable_;
    dice_.shuffle(order);
    // The largest ones first: it is harder to find room for them.
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [this](std::size_t each) { return boxes_[each].half.x * boxes_[each].half.y; });
    for (const std::size_t each : order) {
      double least = std::numeric_limits<double>::infinity();
      glm::dvec2 best{0};
      for (int i = 0; i < candidates && least > 0; ++i) {
        const glm::dvec2 at = anywhere(boxes_[each].half);
        if (const double here = overlap_at(each, at, least); here < least) least = here, best = at;
      }
      boxes_[each].at = best;
      placed_[each] = true;
    }
  }
  /// Moves boxes that lie on others, for so many looks at places at most; returns the overlap that is left.
  double improve(int candidates, double looks) {
    std::vector<std::size_t> order = movable_;
    double reach = radius_;
    for (int sweep = 0; sweep < sweeps && looks > 0; ++sweep, reach = std::max(0.95 * reach, 5 * grain)) {
      dice_.shuffle(order);
      bool lies_on_another = false;
      for (const std::size_t each : order) {
        double least = overlap_at(each, boxes_[each].at, std::numeric_limits<double>::infinity());
        for (int i = 0; i < candidates && least > 0; ++i, --looks) {
          const glm::dvec2 near = boxes_[each].at + reach * glm::dvec2(2 * dice_.share() - 1, 2 * dice_.share() - 1);
          const glm::dvec2 at = i % 3 == 0   ? anywhere(boxes_[each].half)
                                : i % 3 == 1 ? rounded(near)
                                             : beside(each, boxes_[dice_.below(boxes_.size())]);
          if (!fits(at, boxes_[each].half)) continue;
          if (const double here = overlap_at(each, at, least); here < least) least = here, boxes_[each].at = at;
        }
        lies_on_another = lies_on_another || least > 0;
      }
      if (!lies_on_another) return 0;
    }
    double sum = 0;
    for (std::size_t i = 0; i < boxes_.size(); ++i)
      sum += overlap_at(i, boxes_[i].at, std::numeric_limits<double>::infinity()) / 2;
    return sum;
  }

  std::vector<Box> boxes_;
  std::vector<std::size_t> movable_;
  double radius_;
  Dice& dice_;
  std::vector<bool> placed_;
};

}  // namespace

Shuffled shuffle(const Contents& contents, const std::set<std::uint64_t>& chosen, std::uint32_t seed, double diameter,
                 const SizeOf& size_of) {
  Shuffled result{.contents = contents};
  std::vector<std::size_t> spots;  // places in the order of the file
  const auto& all = contents.placed;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i]->is_changeable() && !all[i]->locked && (chosen.size() < 2 || chosen.contains(all[i]->id)))
      spots.push_back(i);
  if (spots.size() < 2) return result;
  Dice dice(seed);
  std::vector<std::size_t> from = spots;
  dice.shuffle(from);
  for (std::size_t i = 0; i < spots.size(); ++i) result.contents.placed[spots[i]] = all[from[i]];
  std::vector<Box> boxes;
  std::vector<std::size_t> movable, of_slot;
  std::vector<glm::dvec2> beside;  // of each that moves, its box from its place
  Footprints footprints(size_of);
  for (std::size_t i = 0, slot = 0; i < all.size(); ++i) {
    const bool moves = slot < spots.size() && spots[slot] == i;
    if (moves) ++slot;
    const Placed& each = *result.contents.placed[i];
    if (!each.is_laid_out()) continue;
    const Box around = footprints.of(each);
    if (moves) movable.push_back(boxes.size()), of_slot.push_back(i), beside.push_back(around.at);
    boxes.push_back({each.patch.at + around.at, around.half});
  }
  Table table(std::move(boxes), movable, (diameter > 0 ? diameter : usual_diameter) / 2, dice);
  result.overlap = table.arrange();
  for (std::size_t i = 0; i < movable.size(); ++i) {
    Placed moved = *result.contents.placed[of_slot[i]];
    moved.patch.at = table.box(movable[i]).at - beside[i];
    result.contents.placed[of_slot[i]] = std::make_shared<const Placed>(std::move(moved));
  }
  result.moved = static_cast<int>(spots.size());
  return result;
}

}  // namespace sandpaper
