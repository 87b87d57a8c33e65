#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "wale/memory.hpp"
#include "wale/program.hpp"

namespace wale {

/// How coarsely a program is sampled when it is described or compared: only each so-many-th hand is run, and stands for
/// those behind it. 1 (every hand) unless a tick costs more than a tick of any shipped device may; a program for a slow
/// device can cost nine times that, and a description runs it at 200 000 places. A program that remembers counts four
/// times, since its hands cannot be run side by side everywhere.
std::size_t coarseness_of(const PatchProgram& program);

/// Whether the answer of a program to motion is left unmeasured: it remembers, so that its strokes run tick by tick,
/// and it is sampled coarsely.
bool leaves_out_motion(const PatchProgram& program);

/// Of how many parameters at most the ranges are searched for where something changes, which takes many readings each:
/// fewer, the more a program costs and holds.
std::size_t parameters_searched(const PatchProgram& program);

/// As `tick_all`, as coarsely as the program is sampled.
void tick_coarsely(const Bank& bank, std::span<const Hand> hands, std::span<Force> forces);

/// As `surface_all` for the heights alone, at every so-many-th position if the picture's code costs that much.
void surface_coarsely(const Bank& bank, const Memory* memory, std::span<const glm::vec2> positions,
                      std::span<float> heights);

/// The side, in pixels, of the squares that a picture of `side` * `side` pixels is drawn in, each of one value: 1
/// unless the code for one pixel costs so much that the whole would take longer than some seconds.
int pixels_of_a_sample(double cost, int side);

/// What to tell people about a program that is sampled coarsely; `coarseness` is of how many places one was.
std::string coarseness_note(const std::string& material, std::size_t coarseness);

}  // namespace wale
