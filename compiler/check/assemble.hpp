#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// A number as a weighted sum of expressions: one of weight 1, unless materials were mixed by `between`.
struct Mixture {
  struct Part {
    double weight = 1;
    const SyntaxTree* tree = nullptr;
    ExprId value = 0;
    const Declarations* home = nullptr;
  };
  std::vector<Part> parts;
};

/// A statement of a material's physics and where it is read.
struct AssembledStatement {
  const PhysicalStatement* statement = nullptr;
  const SyntaxTree* tree = nullptr;
  const Declarations* home = nullptr;
  std::optional<Mixture> value;  ///< instead of a parameter's own default
};

/// All parts of a material: its own statements and those it takes over, or the materials that it blends.
struct AssembledMaterial {
  struct Component {
    double weight = 1;  ///< the default of the parameter that it is
    std::string name;
    std::string weight_name;  ///< of that parameter; no other component beside this one has it
    Span span;
    std::shared_ptr<const AssembledMaterial> material;
  };
  std::vector<AssembledStatement> statements;
  std::vector<AskedPercept> percepts;
  std::vector<Component> components;  ///< of a blend; its own statements come on top
  const Setting* kind = nullptr;      ///< `kind fabric.woven`, its own or taken over
  const SyntaxTree* kind_tree = nullptr;
  bool derived = false;  ///< something is taken over
};

/// Assembles a material from its own statements and from others: `like`, `= other(parameter: value)`, `= 0.7 a + 0.3
/// b`, `= between(a, b, t)`. Null where that makes no sense, which is reported.
std::shared_ptr<const AssembledMaterial> assemble(const Declared<MaterialDecl>& material,
                                                  const Surroundings& surroundings);

}  // namespace wale
