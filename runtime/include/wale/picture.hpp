#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "wale/memory.hpp"
#include "wale/program.hpp"
#include "wale/shape.hpp"

namespace wale {

/// The surface at many positions (m from the patch's centre) with the memory's states and grids: its height, in m or as
/// a plain number (`Picture::relief_is_length`), and its colour: red, green and blue in 0 .. 1, 0 for not-a-number.
///
/// Without a memory, or with one of another program, states are those of a hand that has entered at rest at the patch's
/// centre, and grids have their initial values. `heights` is as long as `positions`; `colours` is as long, or empty if
/// colours are not wanted. A program without colours leaves `colours` unchanged.
void surface_all(const Bank& bank, const Memory* memory, std::span<const glm::vec2> positions, std::span<float> heights,
                 std::span<glm::vec3> colours = {});

/// The same of a patch with a shape of the bank's size: where the surface ends with the patch (`patch_fade`), it ends at
/// the shape's own edge. Positions outside it are those of its edge.
void surface_all(const Bank& bank, const Memory* memory, std::span<const glm::vec2> positions, const Shape& shape,
                 std::span<float> heights, std::span<glm::vec3> colours = {});

/// A shape that the picture shows now. `MarkKind` gives the meaning of `values`, in m, rad and s; unused ones are 0.
/// They may be any float, infinities and not-a-number included.
struct ShownMark {
  MarkKind kind = MarkKind::point;
  std::array<float, 5> values{};
  std::uint32_t colour = 0;  ///< 0xRRGGBB

  friend bool operator==(const ShownMark&, const ShownMark&) = default;
};

/// Runs the picture's frame section for a hand and returns its marks in drawing order. With a memory of another
/// program, states and grids are those of a new memory that the hand has just entered.
std::vector<ShownMark> show(const Bank& bank, const Memory& memory, const Hand& hand);

}  // namespace wale
