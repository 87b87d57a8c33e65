#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "wale/memory.hpp"
#include "wale/picture.hpp"

namespace wale {

/// Whether a program has states or memories, so that its behaviour right after entering is not typical.
bool remembers(const PatchProgram& program);

/// The state of a program after a hand came in at the patch's centre and rubbed to and fro.
struct Rehearsal {
  explicit Rehearsal(const Program& program) : memory(program) {}

  glm::dvec2 way{1, 0};          ///< along which it rubs, of length 1
  Memory memory;                 ///< after the last tick
  Hand hand;                     ///< in the last tick
  std::vector<ShownMark> marks;  ///< at the end, in the order of drawing
  /// For each of `marks`: the recent places of a trajectory, the oldest first; empty for other marks.
  std::vector<std::vector<glm::vec2>> paths;
  double seconds = 0;             ///< duration of the rubbing, s; 0 if nothing can change
  std::vector<double> times;      ///< times of some ticks, as many as a picture can show, s
  std::vector<glm::vec2> places;  ///< the hand's place at `times`, m
  std::vector<Force> forces;      ///< the force on the hand at `times`, N
};

/// Runs a program that remembers or shows marks for a simulated time: one second, or as long as its longest trajectory,
/// at most five seconds; or for `seconds`. The hand goes to and fro along a slightly curved stroke, `along` rad to the left
/// of x. The program's ticks run without guards. Deterministic.
Rehearsal rehearse(Bank bank, const HandDeclaration* hand, std::optional<double> seconds = {}, double along = 0);

}  // namespace wale
