#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compiler/grade/field.hpp"
#include "compiler/grade/lift.hpp"
#include "compiler/grade/required_damping.hpp"

namespace wale {

/// A program with more states than this is not graded: its frequency response would take too long.
inline constexpr std::size_t most_graded_states = 32;

/// The derivatives of a program's force and states by all quantities on which they depend, for many hands at once.
class ProgramSlopes {
 public:
  /// `changing`: for each state, whether it was observed to change.
  ProgramSlopes(const Bank& bank, const std::vector<char>& changing);

  /// Whether the machine has enough registers for the derivatives by place; otherwise nothing below may be called.
  bool fits() const { return place_field_ && place_field_->fits(); }

  struct At {
    glm::dvec2 force{0.0};
    LinearProgram linear;
  };
  /// One for each hand; `states` as for `LiftedField::evaluate`. Empty if the machine has too few registers for all
  /// derivatives.
  std::vector<At> at(std::span<const Hand> hands, std::span<const float> states);
  struct ByPlace {
    glm::dvec2 force{0.0};
    Slopes place{};  ///< N/m
  };
  /// Force and slope by place only, which is faster.
  std::vector<ByPlace> by_place(std::span<const Hand> hands, std::span<const float> states);

  bool depends_on_motion() const { return depends_on_motion_; }
  /// Whether the force depends on time, or on states that change without being driven by the hand.
  bool moves_by_itself() const { return moves_by_itself_; }

 private:
  void find_dependences(const std::vector<char>& changing);

  void derive_all();

  Bank bank_;
  LiftedTick lifted_;
  std::size_t states_ = 0;
  bool depends_on_motion_ = false, moves_by_itself_ = false;
  std::vector<Slopes HandSlopes::*> quantities_;  ///< those on which the tick depends
  std::optional<LiftedField> field_, place_field_;
  std::vector<float> values_;
};

}  // namespace wale
