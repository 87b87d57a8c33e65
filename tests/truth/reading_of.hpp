#pragma once

#include <array>
#include <optional>

#include "tests/truth/truth.hpp"
#include "wale/program.hpp"

// The only file here that knows the reader under test and its words.
namespace wale::truth {

/// What the reader says of a program on its device, at its defaults.
Reading reading_of(const Program& program);

/// What is read of the shape of a program's force beyond `Cue`; nothing for a carrier that it does not have. SI.
struct ShapeReading {
  double crest = 0, abruptness = 0, regularity = 0;
  std::optional<double> sharpness, crispness, bumpiness;
};
ShapeReading shape_of(const Program& program);

/// How far `compare` says that two programs are apart, cue by cue, in just noticeable differences; nothing for a cue
/// that neither has or that has no threshold.
std::array<std::optional<double>, cue_count> differences_of(const Program& a, const Program& b);

/// Whether `compare` says that people tell two programs apart.
bool told_apart(const Program& a, const Program& b);

/// How far apart two sizes of a cue are by the same thresholds, if the reading is right; nothing without a threshold.
std::optional<double> difference_of(Cue cue, double a, double b);

/// Whether the description says of a percept that it is outside what was measured, or outside the range assumed for its
/// map.
bool says_outside(const Program& program);

}  // namespace wale::truth
