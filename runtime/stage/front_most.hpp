#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "wale/shape.hpp"

namespace wale {

/// What a patch covers on the workspace, in m from its centre, and its layer.
struct PatchOutline {
  glm::vec2 position{0.0f};  ///< of the patch's centre
  float width = 0, height = 0;
  float layer = 0;          ///< a greater one lies in front; among equals, the one with the greater `order` does
  std::uint64_t order = 0;  ///< of the patch's arrival in its layer; among equals, the greater number lies in front
  Shape shape = {};         ///< the part of the rectangle that it covers, of the rectangle's size

  /// Whether this patch, of number `number`, lies in front of another one.
  bool is_before(const PatchOutline& other, std::uint32_t number, std::uint32_t other_number) const noexcept {
    if (layer != other.layer) return layer > other.layer;
    if (order != other.order) return order > other.order;
    return number > other_number;
  }
  friend bool operator==(const PatchOutline&, const PatchOutline&) = default;

  /// Whether a hand at this position, m from the patch's centre, is within. The edge counts as within.
  bool contains(glm::vec2 hand) const noexcept { return holds(width, height, hand) && shape.contains(hand); }
  /// Whether it is within a rectangle.
  static bool holds(float width, float height, glm::vec2 hand) noexcept {
    return (hand.x < 0 ? -hand.x : hand.x) <= width / 2 && (hand.y < 0 ? -hand.y : hand.y) <= height / 2;
  }
};

/// Finds the front-most of many patches under a point: a uniform grid over all patches. Each cell lists the outlines
/// that reach into it, from front to back, down to the first that covers the cell. Immutable; a control thread
/// builds it.
class FrontMost {
 public:
  static constexpr std::uint32_t none = 0xffffffff;

  /// `numbers` has the number of each patch; without them it is its index. Time and memory are proportional to the
  /// number of patches: where many cross many cells, the cells become larger. Allocates.
  explicit FrontMost(std::span<const PatchOutline> patches, std::span<const std::uint32_t> numbers = {});
  FrontMost() : FrontMost(std::span<const PatchOutline>()) {}

  /// The number of the front-most patch at `point` (m from the workspace's centre), or `none`.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  std::uint32_t at(glm::dvec2 point) const noexcept;

  /// Cells along a side.
  std::uint32_t side() const { return side_; }
  /// The number of outlines in all lists.
  std::size_t entries() const { return entries_.size(); }

 private:
  struct Entry {
    PatchOutline outline;
    std::uint32_t number;
  };

  /// What the search reads of an entry.
  struct Listed {
    glm::vec2 position;
    float width, height;
    std::uint32_t number;
    std::uint32_t shape;  ///< its place in `shapes_`, or `none` for a rectangle
  };

  /// The column or row of a coordinate along `axis`, clamped to the grid; it never falls as the coordinate rises.
  std::uint32_t cell(double coordinate, int axis) const noexcept;
  static void drop_repeated(std::vector<Entry>& front_first);
  /// Fills the lists for `side_` cells along a side; false when they would have too many entries.
  bool list(std::span<const Entry> front_first);

  std::uint32_t side_ = 1;
  glm::dvec2 low_{0.0}, cells_per_metre_{0.0};
  std::vector<std::uint32_t> first_;  ///< each cell's first entry, row by row, and then the number of entries
  std::vector<Listed> entries_;
  std::vector<Shape> shapes_;  ///< unstretched, each once: the same few stay in the processor's caches
};

}  // namespace wale
