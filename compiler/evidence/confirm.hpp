#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/evidence/percept_reading.hpp"
#include "compiler/read/read_again.hpp"
#include "compiler/solve/solve.hpp"

namespace wale {

/// What the solved textures of a finished program have, over the amplitudes of their forces: a relief may hold parts
/// that count for another percept, and several reliefs add up. Empty where all are nearly 1: to 3 %, of an irregular
/// relief to a tenth. The bank's program was solved without them; `first` gets what is measured of it, which is what the
/// shares need and no more. What counts for a percept only by less than a tenth has no share.
BandShares band_shares(const Bank& bank, ReadFirst& first, const SolvedMaterial& solved,
                       const Declarations& declarations);

/// Compares what a material asks for with what its finished program reads. Warns of levels that people would notice to
/// be others (W0425), unless the device limits them, and of quantities outside what their maps were measured with
/// (W0407). The fates of both become *approximated*: nothing if none of them changes. If the material is `doubted`,
/// since a warning says already which value was hardly meant, a level of which nothing is left has no warning of its
/// own.
std::optional<std::vector<FateRecord>> confirm(const Bank& bank, const ForceReading& found,
                                               const SolvedMaterial& solved, const CheckedMaterial& material,
                                               const Declarations& declarations, bool doubted,
                                               Diagnostics& diagnostics);

}  // namespace wale
