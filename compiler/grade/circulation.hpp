#pragma once

#include <span>

#include "compiler/grade/grade.hpp"
#include "compiler/grade/steep_places.hpp"
#include "compiler/grade/steps.hpp"

namespace wale {

/// The power, in W, that the curl of a force gives to a hand on circles, as far as it counts.
///
/// A closed path gains the integral of the curl over its area. Over the hand's own circle it is the mean of the curl
/// over a tile of the patch, since clipped textures have a little curl of both signs everywhere, which cancels in an
/// integral. A curl of short waves cancels there too, and a jump has none beside it; therefore the force is also
/// integrated along circles, from the hand's own down to a few encoder counts wide, around the places of most curl and
/// around `jumps`. At the hand's speed, a circle counts from `least_watt` on, if it gains a good part of the work done
/// on the way, inside the patch's rim. What drag takes on the way is subtracted, at the pace at which most is left,
/// which is the hand's or a slower one. Of `looked_at`, the hands at rest are used. Deterministic.
double curl_watt(const Bank& bank, const LookedAt& looked_at, std::span<const ForceStep> jumps, const GradingHand& hand,
                 double least_watt);

}  // namespace wale
