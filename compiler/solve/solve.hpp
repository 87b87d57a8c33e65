#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/expression/checked.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// A percept of a solved material: its record in the program, and the terms that the program computes.
struct SolvedPercept {
  PerceptRecord record;             ///< complete except for its code and registers
  std::optional<double> asked;      ///< the level that the author wrote
  TermId amplitude = 0;             ///< the carrier's size
  TermId magnitude = 0, level = 0;  ///< for a carrier of the size in the `probe` input
  std::array<TermId, 2> force{};    ///< of the carrier alone, along x and y
};

/// By percept: the size of a solved carrier over the amplitude of its force, above 0. It is 1 for those that are not
/// here; less where a part of a relief has periods that count for another percept, more where several reliefs add up.
using BandShares = std::map<std::string, double>;

/// The new value of the memory cell nearest to (u, v), which are in cells from the centre of the first one.
struct SolvedWrite {
  std::uint16_t memory = 0;
  TermId u = 0, v = 0, value = 0;
};

/// The limit of a force that has none, N: every program has one, and none may have a greater one (W0701).
inline constexpr double unlimited_newton = 1000;

/// A material for one device, with no open quantities.
struct SolvedMaterial {
  std::string name;
  Span span;
  /// First the solved terms; from `solutions_end` on the author's terms as they were checked, then those of the
  /// percepts' maps.
  Terms terms;
  TermId solutions_end = 0;
  std::vector<HeightTable> tables;
  std::vector<Parameter> parameters;  ///< the author's, then one for each solved percept
  std::array<TermId, 2> force{};  ///< along x and y, N; for a device that vibrates: amplitude, m/s^2, and frequency, Hz
  Span force_span;
  std::optional<TermId> relief;
  bool relief_is_length = false;
  std::optional<std::array<TermId, 3>> colour;
  std::vector<CheckedState> states;
  std::vector<Grid> memories;
  std::vector<SolvedWrite> writes;
  std::vector<CheckedMark> marks;
  std::vector<SolvedPercept> percepts;
  std::vector<LevelClaim> claims;  ///< of the percepts asked for whose author says how well the level is known
  std::vector<FateRecord> fates;  ///< those of the percepts asked for, in their order, then those of the physics
  DeviceProfile device;
  /// Whether a force ends at the device's limit. Without it the shape of a force is read, and not what the device gives
  /// of it; such a program is for no device.
  bool limited = true;
  double patch_width = 0, patch_height = 0, patch_rim = 0;  ///< m
  double active_watt = 0;  ///< power that the program may give to the hand by itself, W
  Layers layers;
};

/// Chooses maps for the device and replaces open quantities by the inverse laws of these maps, as expressions in the
/// level, which stays a parameter. A material without a force gets the device's own realisations of its percepts; so
/// does one with a force on a device that only vibrates. The solution is symbolic; only warnings use the numbers of the
/// levels. Errors and warnings are reported to `diagnostics`; the result may be passed to `lower` only if there was no
/// error. `shares` are read from the finished program (evidence/confirm.hpp).
SolvedMaterial solve(const CheckedMaterial& material, const CheckedModule& module, const std::string& device,
                     const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics,
                     const BandShares& shares = {});

}  // namespace wale
