#include "runtime/machine/inputs.hpp"

#include <limits>

namespace wale {
namespace {

/// `value` held within +-`bound`; not-a-number gives 0.
float within(float value, float bound) {
  return value >= -bound ? (value <= bound ? value : bound) : (value < 0 ? -bound : 0.0f);
}

float seconds(double time) {
  constexpr float most = std::numeric_limits<float>::max();
  return time >= 0 ? (time <= most ? static_cast<float>(time) : most) : 0.0f;
}

template <class Value>
void place(std::span<const Hand> hands, float* values, Value value) {
  for (std::size_t i = 0; i < hands.size(); ++i) values[i] = value(hands[i]);
}

}  // namespace

void place_input(Input input, std::span<const Hand> hands, const Envelope& envelope, float* values) noexcept {
  const auto [reach, speed, acceleration] = envelope;
  const auto components = [&](glm::vec2 Hand::*quantity, float bound, float glm::vec2::*axis) {
    place(hands, values, [=](const Hand& hand) { return within(hand.*quantity.*axis, bound); });
  };
  constexpr auto x = &glm::vec2::x, y = &glm::vec2::y;
  switch (input) {
    case Input::x: return components(&Hand::position, reach, x);
    case Input::y: return components(&Hand::position, reach, y);
    case Input::velocity_x: return components(&Hand::velocity, speed, x);
    case Input::velocity_y: return components(&Hand::velocity, speed, y);
    case Input::acceleration_x: return components(&Hand::acceleration, acceleration, x);
    case Input::acceleration_y: return components(&Hand::acceleration, acceleration, y);
    case Input::raw_velocity_x: return components(&Hand::raw_velocity, speed, x);
    case Input::raw_velocity_y: return components(&Hand::raw_velocity, speed, y);
    case Input::raw_acceleration_x: return components(&Hand::raw_acceleration, acceleration, x);
    case Input::raw_acceleration_y: return components(&Hand::raw_acceleration, acceleration, y);
    case Input::workspace_x: return components(&Hand::workspace, reach, x);
    case Input::workspace_y: return components(&Hand::workspace, reach, y);
    case Input::time: return place(hands, values, [](const Hand& hand) { return seconds(hand.time); });
    case Input::button: return place(hands, values, [](const Hand& hand) { return hand.button ? 1.0f : 0.0f; });
    case Input::patch_half_width:
    case Input::patch_half_height:
    case Input::patch_rim:
    case Input::probe:
    case Input::seconds_per_tick: return;  // the bank's, or whoever predicts
  }
}

}  // namespace wale
