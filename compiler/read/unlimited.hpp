#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "wale/program.hpp"

namespace wale {

/// A program as if its device gave any force, so that a law shows whole where the device cuts it off.
struct Unlimited {
  Bank bank;         ///< at the same parameters; its forces are smaller
  double scale = 1;  ///< the forces of `bank` times this are those that the formulas ask for, N
};

/// Nothing if the program has no such form, which does not happen to a program of the compiler.
std::optional<Unlimited> without_limit(const Bank& bank);

/// Whether a force is at the device's limit `most` (N) along x or y, so that its law may ask for more.
bool at_limit(glm::dvec2 force, double most);

}  // namespace wale
