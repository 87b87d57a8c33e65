#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/extract/extract.hpp"

namespace wale {

/// The cues by which two materials may be told apart.
enum class CueKind {
  amplitude,            ///< N, of the texture
  period,               ///< m
  orientation,          ///< rad
  regularity,           ///< 0 .. 1
  bump_amplitude,       ///< N, of features too long for a texture
  bump_period,          ///< m
  stiffness,            ///< N/m, of the force back to a place
  wall_stiffness,       ///< N/m
  viscosity,            ///< N s/m
  friction,             ///< N
  mass,                 ///< kg
  vibration,            ///< N
  vibration_frequency,  ///< Hz
  other_force,          ///< N, read by none of these; negative if it pushes away
};
inline constexpr std::size_t cue_count = 14;

struct CueFacts {
  CueKind kind;
  const char* name;       ///< "bump amplitude"
  const char* unit;       ///< SI; empty for a plain number
  const char* threshold;  ///< the cue of the `threshold` declarations for it; empty if nothing is published
};
/// In the order of `CueKind`.
const std::array<CueFacts, cue_count>& cue_table();

/// The cues of one material on one device; no value for those that it does not have, such as a period without a
/// texture.
struct Cues {
  std::string material;
  std::string device;
  std::array<std::optional<double>, cue_count> values;
  std::size_t coarseness = 1;  ///< of how many places one was sampled

  std::optional<double>& operator[](CueKind kind) { return values[static_cast<std::size_t>(kind)]; }
  const std::optional<double>& operator[](CueKind kind) const { return values[static_cast<std::size_t>(kind)]; }
};

/// Reads the cues of a program at a bank's parameters. The bands of periods are those of the percepts roughness and
/// bumpiness.
Extraction extract(const Bank& bank, const Declarations& declarations);

/// The cues of an extraction, without those that are so small that an extraction leaves them by itself.
Cues cues_of(const Bank& bank, const Extraction& found);
Cues cues_of(const Bank& bank, const Declarations& declarations);

}  // namespace wale
