#pragma once

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/expression/value.hpp"

namespace wale {

/// A part of a blend's level: that of one component, by its share in the whole.
struct LevelShare {
  std::string component;
  double level = 0;  ///< what the component asks for
  TermId share = 0;  ///< plain, in setup; those of one percept come to 1 or, where a component does not ask, less
};

/// A percept that a material asks for. They stand in the order of the author's text: the first matters most.
struct AskedPercept {
  std::string name;
  double level = 0;
  double tolerance = 0;  ///< to either side of the level
  Span span;
  std::string by{};        ///< the map that the author chose; empty where none was
  bool essential = false;  ///< a device that cannot render it will not do
  /// A blend that says no level of its own has the mixture of its components', which follows the weights; `level` is
  /// the mixture at their defaults.
  bool blended = false;
  std::vector<LevelShare> shares{};  ///< of a blended one
};

/// One number that is remembered from tick to tick; a vector is two of them.
struct CheckedState {
  std::string name;
  double low = 0, high = 0;  ///< SI
  TermId initial = 0;        ///< as the hand enters
  TermId next = 0;           ///< after the tick
  std::string si_unit;       ///< of its dimension
  Span span;
};

/// What the cell nearest to (u, v) becomes, in cells from the centre of the first one.
struct CheckedWrite {
  TermId u = 0, v = 0, value = 0;
};

/// A field over the patch that is remembered.
struct CheckedMemory {
  std::string name;
  Dimension dimension;
  double initial = 0, low = 0, high = 0;  ///< SI
  double cell = 0;                        ///< width of a cell, m
  std::optional<CheckedWrite> next;       ///< where the hand is
  std::string si_unit;                    ///< of its dimension
  Span span;
};

/// A shape in the picture.
struct CheckedMark {
  MarkKind kind = MarkKind::point;
  std::vector<TermId> operands;
  std::uint32_t colour = 0;
};

/// A length that repeats, to hold against the device's encoder.
struct CheckedPeriod {
  TermId length = 0;
  Span span;
};

/// A material whose every expression has a meaning and a dimension. Vectors are pairs of terms, quantities in SI.
struct CheckedMaterial {
  std::string name;
  Span span;
  Terms terms;
  std::vector<HeightTable> tables;
  std::vector<Parameter> parameters;
  std::vector<Span> parameter_spans;  ///< where each was declared
  std::vector<AskedPercept> percepts;
  std::vector<Carrier> carriers;
  std::vector<Span> open_spans;           ///< one for each open quantity: the call that leaves it open
  std::set<std::uint32_t> blended_opens;  ///< open quantities that went into a blend's one
  std::vector<CheckedState> states;
  std::vector<CheckedMemory> memories;
  std::vector<CheckedPeriod> periods;
  std::optional<std::array<TermId, 2>> force;
  std::optional<TermId> relief;  ///< the surface as it looks, when it has one
  bool relief_is_length = false;
  std::optional<std::array<TermId, 3>> colour;  ///< red, green and blue in 0 .. 1, where the author says
  std::vector<CheckedMark> marks;
  Span force_span;
  std::optional<std::array<double, 2>> patch;  ///< width and height in m, when the material says
  Span patch_span;
  double active_watt = 0;  ///< that the author lets it give; 0 where nothing is said
  Span active_span;
  Layers layers;
};

/// A file and all that it refers to, checked. The modules stay because declarations point into them.
struct CheckedModule {
  ModuleSet modules;
  std::vector<CheckedMaterial> materials;  ///< of the file itself, in the order written

  const Declarations& declarations() const { return modules.declarations(); }
  /// The material of that name; without a name the file's only or first one; none if there is none.
  const CheckedMaterial* material(const std::string& name) const;
};

}  // namespace wale
