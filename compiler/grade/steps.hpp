#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "compiler/grade/field.hpp"
#include "compiler/grade/lift.hpp"
#include "compiler/grade/slopes.hpp"

namespace wale {

/// A quantity of the hand with two axes, which a device tells apart in steps.
struct SteppedQuantity {
  Slopes HandSlopes::*slopes;   ///< the derivatives by it
  glm::vec2 Hand::*value;       ///< where a hand has it
  std::array<Input, 2> inputs;  ///< of a program, for its two axes
  double step = 0;              ///< the smallest change that the device tells: m or m/s
  glm::vec2 reach{0.0f};        ///< its largest size along each axis that is searched
};

/// The place, velocity and raw velocity of hands on a patch with half extents `extent` (m), which move at up to `speed`
/// (m/s). The filtered velocity changes by one count over the filter's longest window, the raw one by one count a tick.
std::array<SteppedQuantity, 3> stepped_quantities(const DeviceProfile& device, glm::vec2 extent, double speed);

/// The change of the force over one step of a quantity, beginning wherever it is largest: a count may be anywhere.
struct ForceStep {
  Hand hand;                  ///< in the middle of the step
  std::vector<float> states;  ///< of the program, for that hand
  std::size_t axis = 0;
  std::size_t which = 0;   ///< the number of the switch on whose line it was found; 0 for others
  glm::dvec2 change{0.0};  ///< N
  double both_ways = 0;    ///< N: the sizes of its changes over both halves
  double largest = 0;      ///< N: the largest force in its neighbourhood
  double at_once = 0;      ///< N: its change within a twentieth of the step, where it is largest

  double newton() const;
  /// Whether most of it happens within a small part of the step.
  bool jumps() const;
};

/// Searches for the places and motions at which a program's force changes most over one step of the device.
///
/// The force may jump where a comparison changes, at whole numbers of a floor or a hash, at the pole of a quotient and
/// at the cut of an angle, and may be steep where the smaller of two numbers, a size, a root, an exponential or a
/// normal distribution bends. The derivatives of such a switch lead from hands all over the patch to the line where it
/// changes. Lines across the patch also show changes that the slopes at both ends of an interval do not explain, as
/// those of a steep smooth step. A feature that is smaller than the distance between hands and whose switch is level
/// around it may be missed. Deterministic.
class StepSearch {
 public:
  StepSearch(const Bank& bank, ProgramSlopes& slopes);

  /// The largest steps of this quantity, the largest first. It starts at the hands, all of whom have `states` of the
  /// program, hand by hand.
  std::vector<ForceStep> largest(const SteppedQuantity& quantity, std::span<const Hand> hands,
                                 std::span<const float> states);

  /// Around each of these hands, the change over one step to both sides along each axis.
  std::vector<ForceStep> around(const SteppedQuantity& quantity, std::span<const Hand> hands,
                                std::span<const float> states);

 private:
  /// Hands with the states of a program and the axis along which each is stepped.
  struct Hands {
    std::vector<Hand> hands;
    std::vector<float> states;
    std::vector<std::size_t> axes;
    std::vector<std::size_t> switches;  ///< that each is led to

    void add(const Hand& hand, std::span<const float> of_it, std::size_t axis, std::size_t which = 0);
  };

  std::span<const float> states_of(std::span<const float> states, std::size_t hand) const;
  bool find_switches(const SteppedQuantity& quantity);
  double approach_from(const SteppedQuantity& quantity) const;
  std::optional<glm::dvec2> way(std::size_t which, std::size_t hand, std::size_t count) const;
  Hands near_switches(const SteppedQuantity& quantity, std::span<const Hand> hands, std::span<const float> states);
  Hands on_lines_of_switches(const SteppedQuantity& quantity, Hands seeds);
  std::vector<ForceStep> at_switches(const SteppedQuantity& quantity, std::span<const Hand> hands,
                                     std::span<const float> states);
  Hands on_lines(const SteppedQuantity& quantity, std::span<const Hand> hands);
  Hands bisected(const SteppedQuantity& quantity, Hands low, float width);
  std::vector<ForceStep> measured(const SteppedQuantity& quantity, const Hands& middles);
  std::vector<glm::dvec2> forces(std::span<const Hand> hands, std::span<const float> states);

  Bank bank_;
  ProgramSlopes& slopes_;
  std::size_t state_count_;
  LiftedTick lifted_;
  std::optional<LiftedField> force_;
  /// Functions that are 0 where a switch of the program changes, each with its two derivatives by the quantity.
  std::optional<LiftedField> switches_;
  std::size_t switch_count_ = 0;
  std::vector<float> values_;
};

}  // namespace wale
