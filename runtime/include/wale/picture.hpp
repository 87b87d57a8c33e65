#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "wale/memory.hpp"
#include "wale/program.hpp"

namespace wale {

/// The surface at many positions (m from the patch's centre) as the memory has it: its height, in m or as a plain
/// number (`Picture::relief_is_length`), and its colour: red, green and blue in 0 .. 1, not-a-number 0.
///
/// Without a memory, or with that of another program, states are as after entering at the patch's centre at rest and
/// grids as at the beginning. `heights` is as long as `positions`; `colours` is too, or is empty where nobody asks, and
/// is left alone by a program that says no colours.
void surface_all(const Bank& bank, const Memory* memory, std::span<const glm::vec2> positions, std::span<float> heights,
                 std::span<glm::vec3> colours = {});

/// A shape that the picture shows now: `values` are what `MarkKind` says of its kind, in m, rad and s, the others 0.
/// They may be anything a float can be.
struct ShownMark {
  MarkKind kind = MarkKind::point;
  std::array<float, 5> values{};
  std::uint32_t colour = 0;  ///< 0xRRGGBB

  friend bool operator==(const ShownMark&, const ShownMark&) = default;
};

/// Runs the picture's frame section for a hand and gives its marks in the order of drawing. A memory of another program
/// counts as one just made and entered here.
std::vector<ShownMark> show(const Bank& bank, const Memory& memory, const Hand& hand);

}  // namespace wale
