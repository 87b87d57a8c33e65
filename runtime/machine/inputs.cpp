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

/// Where in a hand an input is, and its bound; empty for time and button, which are not floats.
struct Place {
  std::size_t offset;  ///< bytes from the hand's beginning
  float bound;

  float in(const Hand& hand) const {
    return *reinterpret_cast<const float*>(reinterpret_cast<const std::byte*>(&hand) + offset);
  }
};

std::optional<Place> place_of(Input input, const Envelope& envelope) {
  const auto [reach, speed, acceleration] = envelope;
  constexpr std::size_t x = 0, y = sizeof(float);
  switch (input) {
    case Input::x: return Place{offsetof(Hand, position) + x, reach};
    case Input::y: return Place{offsetof(Hand, position) + y, reach};
    case Input::velocity_x: return Place{offsetof(Hand, velocity) + x, speed};
    case Input::velocity_y: return Place{offsetof(Hand, velocity) + y, speed};
    case Input::acceleration_x: return Place{offsetof(Hand, acceleration) + x, acceleration};
    case Input::acceleration_y: return Place{offsetof(Hand, acceleration) + y, acceleration};
    case Input::raw_velocity_x: return Place{offsetof(Hand, raw_velocity) + x, speed};
    case Input::raw_velocity_y: return Place{offsetof(Hand, raw_velocity) + y, speed};
    case Input::raw_acceleration_x: return Place{offsetof(Hand, raw_acceleration) + x, acceleration};
    case Input::raw_acceleration_y: return Place{offsetof(Hand, raw_acceleration) + y, acceleration};
    case Input::workspace_x: return Place{offsetof(Hand, workspace) + x, reach};
    case Input::workspace_y: return Place{offsetof(Hand, workspace) + y, reach};
    case Input::shape_edge: return Place{offsetof(Hand, edge), reach};
    case Input::shape_edge_x: return Place{offsetof(Hand, edge_slope) + x, 1};
    case Input::shape_edge_y: return Place{offsetof(Hand, edge_slope) + y, 1};
    default: return std::nullopt;
  }
}

float pressed(bool button) { return button ? 1.0f : 0.0f; }

}  // namespace

void place_input(Input input, std::span<const Hand> hands, const Envelope& envelope, float* values) noexcept {
  if (const auto place = place_of(input, envelope)) {
    for (const Hand& hand : hands) *values++ = within(place->in(hand), place->bound);
  } else if (input == Input::time) {
    for (const Hand& hand : hands) *values++ = seconds(hand.time);
  } else {
    for (const Hand& hand : hands) *values++ = pressed(hand.button);
  }
}

HandReader::HandReader(std::span<const Input> inputs, const Envelope& envelope) {
  for (const Input input : inputs) {
    if (const auto place = place_of(input, envelope)) {
      components_.push_back(
          {static_cast<std::uint16_t>(place->offset), static_cast<RegisterNumber>(input), place->bound});
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
