#pragma once

#include <cmath>
#include <optional>

#include "compiler/check/check.hpp"

namespace wale {

/// Whether a force, given by its components, depends on a parameter that may be negative, so that it may be turned
/// round.
bool may_turn(const CheckedMaterial& material, TermId x, TermId y);

/// The force that drives a hand away from where it rests, as a spring or a wall does whose minus is missing: along x or
/// along y it never falls, rises over some millimetres, and does not push one way from one edge to the other. A height,
/// which may be a hill, a force that begins with a sign and a parameter that may be negative are meant so. Nothing
/// where the formulas cannot be evaluated.
std::optional<Span> driving_away(const CheckedMaterial& material, const DeviceProfile& device);

/// What of a force gives a hand energy.
enum class GivenBy { velocity, acceleration, place };

/// Of the forces that the material's author wrote, that which gives a hand most energy by itself: on hands in even
/// motion along what `velocity` or `acceleration` (m/s or m/s^2 of size `most`) adds to it, or around circles at rest.
/// Nothing if none gives any, or where the formulas cannot be evaluated.
const WrittenForce* giving_energy(const CheckedMaterial& material, const DeviceProfile& device, GivenBy what,
                                  double most);

/// Whether the force that the formulas give a hand at rest is known to have no curl, however far above the device's
/// force it is. False where it has one or cannot be evaluated. `limit` (N) is that of a `limit` behind the whole force.
bool has_no_curl(const CheckedMaterial& material, const DeviceProfile& device, double limit = HUGE_VAL);

}  // namespace wale
