#pragma once

#include <atomic>

#include "calibration/feel/blind_comparison.hpp"
#include "calibration/feel/felt_device.hpp"

namespace wale {

/// How long a run must be, s, for a simulated hand to cross the texture often enough: `usual` or longer, as a rehearsal
/// of `usual` seconds in virtual time on `felt`, a simulated device, shows. `usual` if no run of an acceptable length
/// is long enough, if the material needs none, or if the rehearsal fails. `stop` ends the rehearsal.
double seconds_needed(const FeltDevice& felt, const BlindMaterial& material, double usual, double most_newton,
                      const std::atomic<bool>& stop);

}  // namespace wale
