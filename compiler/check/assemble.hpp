#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// A number as a weighted sum of expressions: a single one of weight 1, unless `between` mixed two materials.
struct Mixture {
  struct Part {
    double weight = 1;
    const SyntaxTree* tree = nullptr;
    ExprId value = 0;
    const Declarations* home = nullptr;
  };
  std::vector<Part> parts;
};

/// A statement of a material's physics, with the declaration whose names it uses.
struct AssembledStatement {
  const PhysicalStatement* statement = nullptr;
  const SyntaxTree* tree = nullptr;
  const Declarations* home = nullptr;
  std::optional<Mixture> value;  ///< replaces a parameter's own default
};

/// All parts of a material: its own statements and those from other materials, or the materials that it blends.
struct AssembledMaterial {
  struct Component {
    double weight = 1;  ///< default of the weight's parameter
    std::string name;
    std::string weight_name;  ///< name of that parameter; unique among the components
    Span span;
    std::shared_ptr<const AssembledMaterial> material;
  };
  std::vector<AssembledStatement> statements;
  std::vector<AskedPercept> percepts;
  std::vector<Component> components;  ///< of a blend; the blend's own statements are added to theirs
  const Setting* kind = nullptr;      ///< `kind fabric.woven`, its own or that of the material after `like`
  const SyntaxTree* kind_tree = nullptr;
  bool derived = false;   ///< some parts come from other materials
  std::size_t size = 0;   ///< statements and components of it, of its components, and so on
  std::size_t work = 0;   ///< operations of a walk through all of them, with the levels of each
  std::size_t depth = 0;  ///< of the materials that it is made from, one from another
};

/// Assembles a material from its own statements and from others: `like`, `= other(parameter: value)`, `= 0.7 a + 0.3
/// b`, `= between(a, b, t)`. Null if there was an error, which is reported.
std::shared_ptr<const AssembledMaterial> assemble(const Declared<MaterialDecl>& material,
                                                  const Surroundings& surroundings);

}  // namespace wale
