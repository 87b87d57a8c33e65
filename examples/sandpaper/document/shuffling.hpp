#pragma once

#include <optional>

#include "document/arranging.hpp"

namespace sandpaper {

/// Contents whose patches were put to other places.
struct Shuffled {
  Contents contents;
  int moved = 0;
  /// m², the area that the rectangles around what two patches cover share, in the sum over all pairs; nothing for so
  /// many patches that it was not sought.
  std::optional<double> overlap;
};

/// Puts the chosen patches, or all if fewer than two are chosen, to random places with the least overlap that is found,
/// and into a random order from back to front, as the thesis's Shuffle Patches. All corners lie within a disc of that
/// diameter (m) around the centre; a patch that is too large for it lies in its middle. Locked patches and those that
/// cannot be changed stay where they are. Places are multiples of 0.1 mm. The same seed gives the same places
/// everywhere. Fewer than two patches are not moved. Takes up to some tenths of a second.
Shuffled shuffle(const Contents& contents, const std::set<std::uint64_t>& chosen, std::uint32_t seed, double diameter,
                 const SizeOf& size_of);

}  // namespace sandpaper
