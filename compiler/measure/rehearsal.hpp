#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "wale/memory.hpp"
#include "wale/picture.hpp"

namespace wale {

/// Whether a program remembers anything from tick to tick, so that entering it says little of it.
bool remembers(const PatchProgram& program);

/// The state of a program after a hand came in at the patch's centre and rubbed to and fro.
struct Rehearsal {
  explicit Rehearsal(const Program& program) : memory(program) {}

  Memory memory;                 ///< as the last tick left it
  Hand hand;                     ///< of the last tick
  std::vector<ShownMark> marks;  ///< as they stand at the end, in the order of drawing
  /// Beside `marks`: where a trajectory's place was in its last seconds, the oldest first; empty for other marks.
  std::vector<std::vector<glm::vec2>> paths;
  double seconds = 0;             ///< how long the hand rubbed; 0 where nothing can change
  std::vector<double> times;      ///< s; of some of the ticks, as many as a picture can show
  std::vector<glm::vec2> places;  ///< beside `times`: of the hand, m
  std::vector<Force> forces;      ///< beside `times`: on the hand, N
};

/// Lets a simulated time pass, for a program that remembers or shows marks: one second, or as long as its longest
/// trajectory, five at most. The hand goes up and down a gently bent stroke, through the program's own ticks, guarded
/// by nothing. The same bank gives the same rehearsal.
Rehearsal rehearse(Bank bank, const HandDeclaration* hand);

}  // namespace wale
