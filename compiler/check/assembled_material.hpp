#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
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
  std::optional<Span> made_at{};  ///< the `between` that computed it; none if it is written as it stands
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

/// Counts its `size` and `work` from its statements and from those of its components, which have been counted.
void measure(AssembledMaterial& material);

/// The names of its parameters and of its weights, with those of its components; a name may stand there twice.
std::vector<std::string> parameters_of(const AssembledMaterial& material);
/// Those, and the percepts that it asks for: all that can be given in brackets behind its name.
std::vector<std::string> arguments_of(const AssembledMaterial& material);

/// Gives a parameter another default; in a blend, in every component that has the parameter. False if none has it.
bool set_default(AssembledMaterial& material, std::string_view parameter, const Mixture& value);

/// What an argument changes in a blend: the weight of a component, or the level of a percept that a component asks for.
enum class Dial { none, weight, level };

/// The dial of that name, in the material or in one of its components.
Dial dial_named(const AssembledMaterial& material, std::string_view name);

/// Gives all dials of that name the value, and computes the levels of the blends around them anew.
void turn(AssembledMaterial& material, std::string_view dial, double value);

/// Takes each parameter, level and weight of `a` the `share` (0 .. 1) of the way to that of `b`, which has the same
/// structure. `made_at` is the `between` that asks for it: diagnostics of the computed values point there.
void mix(AssembledMaterial& a, const AssembledMaterial& b, double share, Span made_at);

/// Gives the weight of each component a name that no other has.
void name_weights(std::vector<AssembledMaterial::Component>& components);

/// Computes the levels of a blend from those of its components, for all percepts that the blend does not ask for.
void blend_levels(AssembledMaterial& material);

}  // namespace wale
