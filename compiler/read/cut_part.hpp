#pragma once

#include <optional>
#include <vector>

#include "compiler/read/still_forces.hpp"
#include "compiler/read/unlimited.hpp"

namespace wale {

/// The forces that the formulas of a program ask for, N. The field is of this law, which must outlive it.
StillField field_of(const Unlimited& law);

/// A part of a force that the author limits, where it does so.
struct CutPart {
  PartLimit limit;
  double newton = 0;  ///< with which it pushes there
};

/// The part that a limit cuts, if without that the force would be greater: what is left of a number beyond its ends
/// (x - clamp(x, -d, d)) grows there, and is no part that ends. `asked` are the forces at some places, N.
std::optional<CutPart> cut_part(const Bank& bank, const PartLimit& part, const std::vector<glm::dvec2>& places,
                                const std::vector<glm::dvec2>& asked);

}  // namespace wale
