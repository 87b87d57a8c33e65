#include "runtime/machine/inputs.hpp"

#include <cstddef>
#include <limits>
#include <optional>

#include "runtime/machine/arithmetic.hpp"

namespace wale {
namespace {

/// `value` clamped to +-`bound`; not-a-number gives 0, and a subnormal number the zero of its sign.
float within(float value, float bound) {
  // The processor predicts this branch; the tick would have to wait for the results of a minimum and a maximum.
  const float size = absolute(value);
  if (size >= arithmetic::least_normal && size <= bound) [[likely]]
    return value;
  return held_within(arithmetic::flushed(value), -bound, bound, 0.0f);
}

/// `time` as the nearest float, from 0 on, finite and not subnormal; not-a-number gives 0.
float seconds(double time) {
  constexpr float most = std::numeric_limits<float>::max();
  return time >= arithmetic::least_normal ? (time <= most ? static_cast<float>(time) : most) : 0.0f;
}

/// The field of a hand for an input, and its bound; empty for time and button, which are not components of motion.
struct Place {
  glm::vec2 Hand::*quantity;
  float glm::vec2::*axis;
  float bound;
};

std::optional<Place> place_of(Input input, const Envelope& envelope) {
  const auto [reach, speed, acceleration] = envelope;
  constexpr auto x = &glm::vec2::x, y = &glm::vec2::y;
  switch (input) {
    case Input::x: return Place{&Hand::position, x, reach};
    case Input::y: return Place{&Hand::position, y, reach};
    case Input::velocity_x: return Place{&Hand::velocity, x, speed};
    case Input::velocity_y: return Place{&Hand::velocity, y, speed};
    case Input::acceleration_x: return Place{&Hand::acceleration, x, acceleration};
    case Input::acceleration_y: return Place{&Hand::acceleration, y, acceleration};
    case Input::raw_velocity_x: return Place{&Hand::raw_velocity, x, speed};
    case Input::raw_velocity_y: return Place{&Hand::raw_velocity, y, speed};
    case Input::raw_acceleration_x: return Place{&Hand::raw_acceleration, x, acceleration};
    case Input::raw_acceleration_y: return Place{&Hand::raw_acceleration, y, acceleration};
    case Input::workspace_x: return Place{&Hand::workspace, x, reach};
    case Input::workspace_y: return Place{&Hand::workspace, y, reach};
    default: return std::nullopt;
  }
}

float pressed(bool button) { return button ? 1.0f : 0.0f; }

}  // namespace

void place_input(Input input, std::span<const Hand> hands, const Envelope& envelope, float* values) noexcept {
  if (const auto place = place_of(input, envelope)) {
    for (const Hand& hand : hands) *values++ = within(hand.*place->quantity.*place->axis, place->bound);
  } else if (input == Input::time) {
    for (const Hand& hand : hands) *values++ = seconds(hand.time);
  } else {
    for (const Hand& hand : hands) *values++ = pressed(hand.button);
  }
}

HandReader::HandReader(std::span<const Input> inputs, const Envelope& envelope) {
  const Hand hand;
  for (const Input input : inputs) {
    if (const auto place = place_of(input, envelope)) {
      const auto* component = reinterpret_cast<const std::byte*>(&(hand.*place->quantity.*place->axis));
      components_.push_back({static_cast<std::uint16_t>(component - reinterpret_cast<const std::byte*>(&hand)),
                             static_cast<RegisterNumber>(input), place->bound});
    } else {
      (input == Input::time ? time_ : button_) = true;
    }
  }
}

void HandReader::operator()(const Hand& hand, float* registers) const noexcept {
  const auto* begin = reinterpret_cast<const std::byte*>(&hand);
  for (const auto& [offset, number, bound] : components_)
    registers[number] = within(*reinterpret_cast<const float*>(begin + offset), bound);
  if (time_) registers[static_cast<RegisterNumber>(Input::time)] = seconds(hand.time);
  if (button_) registers[static_cast<RegisterNumber>(Input::button)] = pressed(hand.button);
}

}  // namespace wale
