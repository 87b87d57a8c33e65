#include "compiler/extract/extract.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace wale {
namespace {

constexpr double alike = 0.15;           // of a stiffness, here and there
constexpr double least_of_field = 0.03;  // of the whole force: a texture that counts
constexpr double longest_bump = 0.4;     // of the patch

}  // namespace

Extraction extract(const Bank& bank, const PeriodBand& textures, const PeriodBand& bumps) {
  if (bank.program().description().vibrates()) return {};  // it has no force to read
  const StaticForce force(bank);
  Extraction found;
  found.texture = texture_force(bank, force, textures);
  found.bumps = texture_force(bank, force, bumps);
  found.wall = wall_face(bank);
  const double everywhere = force.slope.stiffness(), within = linear_part(middle_of(force.whole)).stiffness();
  if (!found.wall && std::abs(within - everywhere) <= alike * std::abs(everywhere)) found.stiffness = everywhere;
  // Where a strong field bends, its transform rings.
  std::vector<float> sizes;
  for (const Force& each : force.whole.forces) sizes.push_back(std::hypot(each.x, each.y));
  if (found.texture.amplitude < least_of_field * quantile(std::move(sizes), 0.99)) found.texture = {};
  // A hill that the patch does not hold twice is not told from a spring that gives way.
  const double extent = force.whole.spacing.x * static_cast<double>(force.whole.side);
  if (found.bumps.period > longest_bump * extent) found.bumps = {};
  found.opposing = opposing_force(bank);
  found.inertia = inertia(bank);
  found.vibration = vibration(bank);
  return found;
}

}  // namespace wale
