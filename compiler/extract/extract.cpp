#include "compiler/extract/extract.hpp"

#include <algorithm>
#include <cmath>

#include "compiler/extract/dependence.hpp"
#include "compiler/extract/tolerances.hpp"
#include "compiler/measure/coarseness.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

constexpr double alike = 0.15;         // relative difference at which two stiffnesses count as one
constexpr double longest_bump = 0.4;   // of the patch
constexpr double least_outward = 0.1;  // of the whole force

/// The stiffness that draws the hand back, if it is the same in the middle as on the whole patch.
double even_stiffness(const StaticForce& force) {
  const std::size_t side = force.whole.side;
  const double everywhere = force.slope.stiffness();
  const double more = linear_part(part_of(force.whole, side / 4, side / 4, side / 2)).stiffness();
  return std::abs(more) <= alike * std::abs(everywhere) ? everywhere : 0;
}

/// Whether a fitted plane says that the force points outward, and says more than the incomplete waves at the edges do.
bool pushes_away(const StaticForce& force) {
  const double half = 0.25 * (force.whole.extent().x + force.whole.extent().y);
  return -force.slope.stiffness() * half > least_outward * force.largest;
}

}  // namespace

Extraction extract(const Bank& bank, const PeriodBand& textures, const PeriodBand& bumps) {
  if (bank.program().description().vibrates()) return {};  // such a program has no force
  Extraction found;
  std::optional<StaticForce> still;
  const bool remembers = remembers_anything(bank.program().description());
  const auto read_still = [&] {
    const StaticForce& force = still.emplace(bank);
    found.force = pushes_away(force) ? -force.largest : force.largest;
    found.texture = texture_force(bank, force, textures, least_of_field * force.largest);
    found.bumps = texture_force(bank, force, bumps, std::max(least_force, least_of_texture * found.texture.amplitude));
  };
  const auto read_moving = [&] {
    // A face bends the force, unless the program has memory and yielded to the hands that were placed behind the face.
    if (remembers || still->bent >= least_force) found.wall = wall_face(bank);
    found.opposing = opposing_force(bank);
    found.inertia = inertia(bank);
    found.vibration = vibration(bank);
  };
  const auto read = [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) part == 0 ? read_still() : read_moving();
  };
  // Strokes that run tick by tick take as long as all static measurements together.
  const std::size_t parts = leaves_out_motion(bank.program().description()) ? 1 : 2;
  if (remembers)
    in_parallel(parts, read);
  else
    read(0, parts);
  if (!found.wall) found.stiffness = even_stiffness(*still);
  // A hill that does not fit twice into the patch cannot be distinguished from a spring that weakens.
  if (found.bumps.period > longest_bump * still->whole.extent().x) found.bumps = {};
  return found;
}

}  // namespace wale
