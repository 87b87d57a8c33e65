#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations.hpp"
#include "compiler/value.hpp"

namespace wale {

/// A percept that a material asks for.
struct AskedPercept {
  std::string name;
  double level = 0;
  Span span;
};

/// A material whose every expression has a meaning and a dimension. Vectors are pairs of terms, quantities in SI.
struct CheckedMaterial {
  std::string name;
  Span span;
  Terms terms;
  std::vector<HeightTable> tables;
  std::vector<Parameter> parameters;
  std::vector<AskedPercept> percepts;
  std::vector<Carrier> carriers;
  std::vector<Span> open_spans;  ///< one for each open quantity: the call that leaves it open
  std::optional<std::array<TermId, 2>> force;
  std::optional<TermId> relief;  ///< the surface as it looks, when it has one
  Span force_span;
  std::optional<std::array<double, 2>> patch;  ///< width and height in m, when the material says
  Span patch_span;
  Layers layers;
};

/// A file and all that it refers to, checked. The trees stay because declarations point into them.
struct CheckedModule {
  std::vector<std::unique_ptr<SyntaxTree>> trees;
  Declarations declarations;
  std::vector<CheckedMaterial> materials;  ///< of the file itself, in the order written

  /// The material of that name; without a name the file's only or first one; none if there is none.
  const CheckedMaterial* material(const std::string& name) const;
};

}  // namespace wale
