#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/check/check_statements.hpp"

namespace wale {

/// Superposes materials: forces add by weight, and the textures whose amplitude is open become one texture, each
/// weighed by its own steepest slope, whose amplitude is solved for the blend.
class Blender {
 public:
  Blender(CheckedMaterial& material, ExpressionChecker& checker, const Surroundings& surroundings, Span span)
      : material_(material), checker_(checker), surroundings_(surroundings), span_(span) {}

  /// The force of a material with all its components, none when nothing pushes. `own` checks its own statements.
  std::optional<Value> compose(const AssembledMaterial& assembled, StatementChecker& own);

 private:
  /// An open texture of a component.
  struct Texture {
    double weight;
    Carrier carrier;
  };
  struct Superposition {
    std::optional<Value> force;
    std::vector<Texture> textures;
  };

  void superpose(const AssembledMaterial::Component& component, Superposition& sum);
  void add_leaf(double weight, const std::string& name, const Value& leaf, std::size_t first_carrier,
                Superposition& sum);
  void add_textures(Superposition& sum);
  std::optional<Value> blended_height(const std::vector<Texture>& textures);
  Value scaled(const Value& vector, double weight);
  Value add(const std::optional<Value>& left, const Value& right);

  CheckedMaterial& material_;
  ExpressionChecker& checker_;
  const Surroundings& surroundings_;
  Span span_;
};

}  // namespace wale
