#include "runtime/stage/front_most.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

namespace wale {
namespace {

/// Cells along a side, per square root of the number of patches. Finer cells are no faster (measured with 10 to 100 000
/// patches, moving and random points).
constexpr double cells_a_side_per_root = 2;
constexpr std::uint32_t most_cells_a_side = 512;
/// The most entries of all lists: so many for each patch, plus a constant.
constexpr std::size_t entries_per_patch = 32, more_entries = 4096;

/// A rectangle's extent along one axis, with rounding: a little wider than any point that `contains` accepts, and a
/// little narrower than any that it rejects.
struct Extent {
  Extent(float centre, float size) {
    const double half = static_cast<double>(size) / 2,
                 unsure = 1e-6 * half + 1e-12 * std::abs(static_cast<double>(centre));
    outer_low = centre - half - unsure;
    outer_high = centre + half + unsure;
    inner_low = centre - half + unsure;
    inner_high = centre + half - unsure;
  }
  double outer_low, outer_high, inner_low, inner_high;
};

/// Follows links to the first cell of a row, from `cell` on, whose list is still open.
std::uint32_t open_from(std::vector<std::uint32_t>& next_open, std::size_t row, std::uint32_t cell) {
  std::uint32_t found = cell;
  while (next_open[row + found] != found) found = next_open[row + found];
  while (next_open[row + cell] != found) {
    const std::uint32_t next = next_open[row + cell];
    next_open[row + cell] = found;
    cell = next;
  }
  return found;
}

}  // namespace

/// Of equal outlines, keeps only the front one; the hand can feel no other.
void FrontMost::drop_repeated(std::vector<Entry>& front_first) {
  const auto hash = [](const PatchOutline& each) {
    std::size_t mixed = 0;
    for (const float value : {each.position.x, each.position.y, each.width, each.height})
      mixed = (mixed ^ std::hash<float>()(value)) * 0x9e3779b97f4a7c15u;
    return mixed;
  };
  const auto equal = [](const PatchOutline& one, const PatchOutline& other) {
    return one.position == other.position && one.width == other.width && one.height == other.height &&
           one.shape == other.shape;
  };
  std::unordered_set<PatchOutline, decltype(hash), decltype(equal)> seen(2 * front_first.size(), hash, equal);
  std::erase_if(front_first, [&seen](const Entry& entry) { return !seen.insert(entry.outline).second; });
}

FrontMost::FrontMost(std::span<const PatchOutline> patches, std::span<const std::uint32_t> numbers) {
  std::vector<Entry> front_first;
  front_first.reserve(patches.size());
  for (std::uint32_t index = 0; index < patches.size(); ++index) {
    const PatchOutline& outline = patches[index];
    const std::uint32_t number = numbers.empty() ? index : numbers[index];
    const float sum = outline.position.x + outline.position.y + outline.width + outline.height;
    if (std::isfinite(sum) && outline.width >= 0 && outline.height >= 0) front_first.push_back({outline, number});
  }
  std::sort(front_first.begin(), front_first.end(), [](const Entry& one, const Entry& other) {
    return one.outline.is_before(other.outline, one.number, other.number);
  });
  drop_repeated(front_first);
  glm::dvec2 high(0.0);
  for (std::size_t i = 0; i < front_first.size(); ++i) {
    const PatchOutline& outline = front_first[i].outline;
    const Extent x(outline.position.x, outline.width), y(outline.position.y, outline.height);
    low_.x = i == 0 ? x.outer_low : std::min(low_.x, x.outer_low);
    low_.y = i == 0 ? y.outer_low : std::min(low_.y, y.outer_low);
    high.x = i == 0 ? x.outer_high : std::max(high.x, x.outer_high);
    high.y = i == 0 ? y.outer_high : std::max(high.y, y.outer_high);
  }
  const double root = std::sqrt(static_cast<double>(front_first.size()));
  side_ = std::clamp(static_cast<std::uint32_t>(cells_a_side_per_root * root), 1u, most_cells_a_side);
  for (;; side_ = std::max(side_ / 2, 1u)) {
    for (const int axis : {0, 1})
      cells_per_metre_[axis] = high[axis] > low_[axis] ? side_ / (high[axis] - low_[axis]) : 0.0;
    if (list(front_first) || side_ == 1) return;
  }
}

std::uint32_t FrontMost::cell(double coordinate, int axis) const noexcept {
  const double u = (coordinate - low_[axis]) * cells_per_metre_[axis];
  const double least = u > 0 ? u : 0;  // 0 for not-a-number too
  return least < side_ ? static_cast<std::uint32_t>(least) : side_ - 1;
}

bool FrontMost::list(std::span<const Entry> front_first) {
  const std::size_t cells = std::size_t{side_} * side_;
  const std::size_t most = side_ == 1 ? front_first.size() : entries_per_patch * front_first.size() + more_entries;
  // A patch skips the cells of a row that a patch in front of it covers.
  const std::size_t links = side_ + 1;
  std::vector<std::uint32_t> next_open(side_ * links);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> placed;  // cell, place in front_first
  for (std::size_t row = 0; row < side_; ++row)
    std::iota(next_open.begin() + static_cast<std::ptrdiff_t>(row * links),
              next_open.begin() + static_cast<std::ptrdiff_t>((row + 1) * links), 0u);
  // Whether the interval between two coordinates covers the whole cell: then it reaches into both neighbouring cells.
  const auto covers = [this](double inner_low, double inner_high, std::uint32_t cell_number, int axis) {
    if (!(inner_low < inner_high)) return false;
    const bool from = cell_number == 0 ? inner_low <= low_[axis] : cell(inner_low, axis) < cell_number;
    const bool to = cell(inner_high, axis) > cell_number;
    return from && to;
  };
  const auto shape_covers = [this](const PatchOutline& outline, std::uint32_t column, std::uint32_t row) {
    if (outline.shape.is_rectangle()) return true;
    const glm::dvec2 cell = 1.0 / cells_per_metre_, middle = low_ + (glm::dvec2(column, row) + 0.5) * cell;
    return outline.shape.covers(glm::vec2(middle - glm::dvec2(outline.position)),
                                static_cast<float>(0.5 * std::hypot(cell.x, cell.y)));
  };
  for (std::uint32_t place = 0; place < front_first.size(); ++place) {
    const PatchOutline& outline = front_first[place].outline;
    const Extent x(outline.position.x, outline.width), y(outline.position.y, outline.height);
    const std::uint32_t left = cell(x.outer_low, 0), right = cell(x.outer_high, 0);
    const std::uint32_t lower = cell(y.outer_low, 1), upper = cell(y.outer_high, 1);
    for (std::uint32_t row = lower; row <= upper; ++row) {
      const bool whole_row = covers(y.inner_low, y.inner_high, row, 1);
      for (std::uint32_t column = open_from(next_open, row * links, left); column <= right;
           column = open_from(next_open, row * links, column + 1)) {
        if (placed.size() == most) return false;
        placed.emplace_back(row * side_ + column, place);
        if (whole_row && covers(x.inner_low, x.inner_high, column, 0) && shape_covers(outline, column, row))
          next_open[row * links + column] = column + 1;
      }
    }
  }
  first_.assign(cells + 1, 0);
  for (const auto& [cell_number, place] : placed) ++first_[cell_number + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  entries_.resize(placed.size());
  std::vector<std::uint32_t> end(first_.begin(), first_.end() - 1);
  std::vector<std::uint32_t> shape_of(front_first.size(), none);
  std::unordered_map<const void*, std::uint32_t> number_of;
  shapes_.clear();
  for (std::size_t place = 0; place < front_first.size(); ++place) {
    if (front_first[place].outline.shape.is_rectangle()) continue;
    const Shape shape = front_first[place].outline.shape.unstretched();
    const auto [known, is_new] = number_of.try_emplace(shape.identity(), static_cast<std::uint32_t>(shapes_.size()));
    if (is_new) shapes_.push_back(shape);
    shape_of[place] = known->second;
  }
  for (const auto& [cell_number, place] : placed) {
    const PatchOutline& outline = front_first[place].outline;
    entries_[end[cell_number]++] = {outline.position, outline.width, outline.height, front_first[place].number,
                                    shape_of[place]};
  }
  return true;
}

std::uint32_t FrontMost::at(glm::dvec2 point) const noexcept {
  const std::size_t index = std::size_t{cell(point.y, 1)} * side_ + cell(point.x, 0);
  const Listed* const end = entries_.data() + first_[index + 1];
  for (const Listed* entry = entries_.data() + first_[index]; entry != end; ++entry) {
    const glm::vec2 hand(point - glm::dvec2(entry->position));
    if (PatchOutline::holds(entry->width, entry->height, hand) &&
        (entry->shape == none || shapes_[entry->shape].contains(hand, {entry->width, entry->height})))
      return entry->number;
  }
  return none;
}

}  // namespace wale
