#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "compiler/read/read.hpp"

namespace wale {

/// The cues by which two materials may be told apart (read/cue.def).
enum class CueKind {
#define CUE(kind, name, unit, extractor, threshold, exerts, least, value) kind,
#include "compiler/read/cue.def"
#undef CUE
};

struct CueFacts {
  CueKind kind;
  const char* name;       ///< "wall stiffness"
  const char* unit;       ///< SI; empty for a plain number
  Extractor extractor;    ///< of the percepts whose carrier it is
  const char* threshold;  ///< the cue of the `threshold` declarations for it; empty if nothing is published
  bool exerts;            ///< a difference of this cue is a difference of force
};

#define CUE(kind, name, unit, extractor, threshold, exerts, least, value) +1
inline constexpr std::size_t cue_count = 0
#include "compiler/read/cue.def"
    ;
#undef CUE

/// In the order of `CueKind`.
const std::array<CueFacts, cue_count>& cue_table();

/// The cues of one material on one device; no value for those that it does not have, such as a period without a relief.
struct Cues {
  std::string material;
  std::string device;
  std::array<std::optional<double>, cue_count> values;
  std::size_t coarseness = 1;  ///< of how many places one was sampled
  /// A hash of what is executed, of materials with a force whose course no cue tells: of such a force only the same
  /// program is surely the same. 0: not known.
  std::uint64_t executed = 0;

  std::optional<double>& operator[](CueKind kind) { return values[static_cast<std::size_t>(kind)]; }
  const std::optional<double>& operator[](CueKind kind) const { return values[static_cast<std::size_t>(kind)]; }
};

/// The cue that a material has too if it has this one: a period is a texture's. Nothing for a cue of its own.
std::optional<CueKind> whole_of(CueKind kind);

/// Whether a cue is a direction, rad in [0, 2 pi), and half a turn of it is another one.
constexpr bool is_full_direction(CueKind kind) { return kind == CueKind::travel || kind == CueKind::wall_direction; }

/// The name that a condition of a map or a threshold has for a cue: "wall_stiffness", and "rate" for a vibration's
/// frequency.
std::string condition_name(const CueFacts& facts);
/// What such conditions may ask of a material: its cues, and the speed of the hand on it, m/s.
Sizes sizes_of(const Cues& cues, const std::optional<double>& speed);
/// The mean speed of the hand `normal` as it strokes, m/s; nothing if it is not declared.
std::optional<double> speed_of_strokes(const Declarations& declarations);

/// The cues of a reading, without those that are below the least that counts.
Cues cues_of(const Bank& bank, const ForceReading& reading);
Cues cues_of(const Bank& bank, const Declarations& declarations);

}  // namespace wale
