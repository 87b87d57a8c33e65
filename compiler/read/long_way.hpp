#pragma once

#include <array>

#include "compiler/read/room.hpp"
#include "wale/program.hpp"

namespace wale {

/// What holds a hand back that goes a long way from where it came, as a bristle does until it slides.
struct LongWay {
  double path = 0;     ///< m from where it came, on which the force comes to its own size
  double force = 0;    ///< N: that size
  bool grows = false;  ///< the patch ends before: the force is more
  bool cut = false;    ///< the device gives no more
};

/// m of the way on which a force may come to its own size for the usual strokes to read it.
inline constexpr double usual_path = 3e-3;

/// For a way along x, and one along y, through the whole patch. Forces that a hand feels on entering, wherever it does,
/// are none of it, nor what is no more than felt, nor a spring that draws a hand back to where it came: on the way back
/// over the same places that gives all back. Nothing of a program that remembers no more than time.
std::array<LongWay, 2> long_ways(const Bank& bank, const Room& room);

}  // namespace wale
