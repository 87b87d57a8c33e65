#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/expression/checked.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// A percept of a solved material: what the program carries of it, and the terms that the program computes.
struct SolvedPercept {
  PerceptRecord record;             ///< all but its code and registers
  std::optional<double> asked;      ///< the level that the author wrote
  TermId amplitude = 0;             ///< the carrier's size
  TermId magnitude = 0, level = 0;  ///< of a carrier of the size in the `probe` input
};

/// The new value of the cell of a memory that is nearest to (u, v), in cells from the centre of its first one.
struct SolvedWrite {
  std::uint16_t memory = 0;
  TermId u = 0, v = 0, value = 0;
};

/// A material with nothing left open, for one device.
struct SolvedMaterial {
  std::string name;
  Span span;
  /// First what was solved for; from `solutions_end` on what the author wrote, as it was checked, then what the
  /// percepts' maps tell.
  Terms terms;
  TermId solutions_end = 0;
  std::vector<HeightTable> tables;
  std::vector<Parameter> parameters;  ///< the author's, then one for each solved percept
  std::array<TermId, 2> force{};      ///< N along x and y; on a device that vibrates its amplitude and its frequency
  Span force_span;
  std::optional<TermId> relief;
  bool relief_is_length = false;
  std::optional<std::array<TermId, 3>> colour;
  std::vector<CheckedState> states;
  std::vector<Grid> memories;
  std::vector<SolvedWrite> writes;
  std::vector<CheckedMark> marks;
  std::vector<SolvedPercept> percepts;
  std::vector<FateRecord> fates;  ///< of the percepts asked for, in their order, then of the physics
  DeviceProfile device;
  double patch_width = 0, patch_height = 0, patch_rim = 0;  ///< m
  double active_watt = 0;                                   ///< that the program may give by itself, W
  Layers layers;
};

/// Chooses maps for the device and puts their inverse laws, as expressions in a live level, where quantities were left
/// open; a material that says only what it feels like gets the device's own realisation, and so does one whose force
/// the device cannot exert, since it only vibrates. Purely symbolic but for warnings about the level asked for. The
/// result is fit for `lower` only when no error was reported.
SolvedMaterial solve(const CheckedMaterial& material, const CheckedModule& module, const std::string& device,
                     const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);

}  // namespace wale
