#pragma once

#include "compiler/grade/grade.hpp"

namespace wale {

/// The power (W) that a hand gains which strokes to and fro at its pace, and holds the button on the ways back alone:
/// that of the difference between the forces with the button and without. The largest over strokes of the hand's length
/// and shorter ones in the same time, along x, y and the diagonals, at places all over the patch, less what drag takes
/// on the way. 0 of a program that reads no button, or remembers more than the time: what such a one gives is found by
/// hands that explore it.
double switching_watt(const Bank& bank, const GradingHand& hand);

}  // namespace wale
