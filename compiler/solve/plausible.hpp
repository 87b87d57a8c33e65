#pragma once

#include "compiler/check/check.hpp"
#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// The place of the first jump that a search along a few lines of the patch found in a height, and its size.
struct Jump {
  double x = 0, y = 0;  ///< m from the patch's centre
  double size = 0;      ///< in the height's unit, SI
  double share = 0;     ///< of the height's range on these lines
  int changes = 0;      ///< how often the height changed along that line between two of the places looked at
  bool one_way = true;  ///< whether all of these changes were upwards, or all downwards
};

/// A jump in one of the heights of a material's `lateral` or `bumps`, and the carrier that it belongs to. Empty if
/// there is none, or if the heights depend on pictures, tables or slopes, which the compiler does not evaluate.
struct JumpingHeight {
  Jump jump;
  Span span;
  std::string function;
};
std::optional<JumpingHeight> find_jump(const CheckedMaterial& material, const DeviceProfile& device);

/// The carrier of a height that is the same all over the patch, apart from rounding, though its formula has the place
/// in it. Empty if there is none, or where it cannot be told.
std::optional<Span> find_level(const CheckedMaterial& material, const DeviceProfile& device);

/// Warns of sizes and forces that no declared device comes near to (W0431): a carrier's size, and a force at rest that
/// is beyond every device nearly everywhere it acts.
void warn_of_huge_forces(const CheckedMaterial& material, const Declarations& declarations, const DeviceProfile& device,
                         Diagnostics& diagnostics);

}  // namespace wale
