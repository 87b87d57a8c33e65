#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/check/check_statements.hpp"

namespace wale {

/// Superposes materials. Forces add by weight. Textures with an open amplitude become one texture, each
/// scaled by its own steepest slope, and the amplitude is solved for the blend.
class Blender {
 public:
  Blender(CheckedMaterial& material, ExpressionChecker& checker, const Surroundings& surroundings, Span span)
      : material_(material), checker_(checker), surroundings_(surroundings), span_(span) {}

  /// The components' levels that make up the level of each blended percept, by the percept's name.
  using Levels = std::map<std::string, std::vector<LevelShare>>;

  /// The force of a material with all its components; none if it has no force. `own` checks its own statements. Each
  /// weight becomes a parameter of the material.
  std::optional<Value> compose(const AssembledMaterial& assembled, StatementChecker& own);

  /// The levels of the last composition.
  const Levels& levels() const { return levels_; }

 private:
  /// An open texture of a component.
  struct Texture {
    TermId weight;
    Carrier carrier;
    std::string component;  ///< its material's name
  };
  struct Superposition {
    std::optional<Value> force;
    std::vector<Texture> textures;
    std::vector<std::size_t> taken;  ///< the indices of the carriers of the current component's textures, ascending
    std::vector<TermId> weighed;     ///< the weights by which a force of a known size is multiplied
    Levels levels;
  };

  void superpose(const AssembledMaterial::Component& component, TermId weight, TermId share, Superposition& sum);
  void add_levels(const AssembledMaterial::Component& component, TermId share, Superposition& sum);
  /// Warns of weights that the author wrote and that change neither a force nor a level.
  void warn_of_idle_weights(const AssembledMaterial& assembled, const std::vector<TermId>& weights,
                            const Superposition& sum);
  TermId add_weight(const AssembledMaterial::Component& component);
  TermId whole_of(const std::vector<TermId>& weights);
  void add_leaves(const Value& force, TermId weight, const std::string& name, std::size_t first_carrier,
                  Superposition& sum);
  /// The indices of the carriers with a force, ascending.
  using CarriersByForce = std::map<std::pair<TermId, TermId>, std::vector<std::size_t>>;
  void add_leaf(TermId weight, const std::string& name, const Value& leaf, CarriersByForce& by_force,
                Superposition& sum);
  bool can_be_one(const std::vector<Texture>& textures);
  void add_textures(Superposition& sum);
  std::optional<Value> blended_height(const std::vector<Texture>& textures);
  /// Takes operations from the budget before they are done; false if it is spent, which has been reported.
  bool charge(std::size_t operations);
  Value scaled(const Value& vector, TermId weight);
  Value add(const std::optional<Value>& left, const Value& right);

  CheckedMaterial& material_;
  ExpressionChecker& checker_;
  const Surroundings& surroundings_;
  Span span_;
  Levels levels_;
};

}  // namespace wale
