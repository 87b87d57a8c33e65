#include "compiler/extract/extract.hpp"

namespace wale {

Extraction extract(const Bank& bank, const PeriodBand& textures, const PeriodBand& bumps) {
  const StaticForce force(bank);
  Extraction found;
  found.texture = texture_force(bank, force, textures);
  found.bumps = texture_force(bank, force, bumps);
  found.wall = wall_face(bank);
  if (!found.wall) found.stiffness = force.slope.stiffness();
  found.opposing = opposing_force(bank);
  found.inertia = inertia(bank);
  found.vibration = vibration(bank);
  return found;
}

}  // namespace wale
