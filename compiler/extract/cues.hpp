#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/extract/extract.hpp"

namespace wale {

/// By what two materials may be told apart.
enum class CueKind {
  amplitude,            ///< N, of the texture
  period,               ///< m
  orientation,          ///< rad
  regularity,           ///< 0 .. 1
  bump_amplitude,       ///< N, of what is too long for a texture
  bump_period,          ///< m
  stiffness,            ///< N/m, of what draws back
  wall_stiffness,       ///< N/m
  viscosity,            ///< N s/m
  friction,             ///< N
  mass,                 ///< kg
  vibration,            ///< N
  vibration_frequency,  ///< Hz
  other_force,          ///< N, that none of these reads; below 0 what pushes away
};
inline constexpr std::size_t cue_count = 14;

struct CueFacts {
  CueKind kind;
  const char* name;       ///< "bump amplitude"
  const char* unit;       ///< SI; empty for a plain number
  const char* threshold;  ///< the cue of the `threshold` declarations that tells; empty where no publication does
};
/// In the order of `CueKind`.
const std::array<CueFacts, cue_count>& cue_table();

/// The cues of one material on one device; nothing for those that it does not have, as a period without a texture.
struct Cues {
  std::string material;
  std::string device;
  std::array<std::optional<double>, cue_count> values;

  std::optional<double>& operator[](CueKind kind) { return values[static_cast<std::size_t>(kind)]; }
  const std::optional<double>& operator[](CueKind kind) const { return values[static_cast<std::size_t>(kind)]; }
};

/// Reads what a program is made of at a bank's parameters. The bands of periods are those that the percepts roughness
/// and bumpiness declare.
Extraction extract(const Bank& bank, const Declarations& declarations);

/// The cues in what was read: all but what an extraction leaves of something that is not there.
Cues cues_of(const Bank& bank, const Extraction& found);
Cues cues_of(const Bank& bank, const Declarations& declarations);

}  // namespace wale
