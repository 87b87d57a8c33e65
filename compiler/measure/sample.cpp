#include "compiler/measure/sample.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "compiler/text/json_text.hpp"
#include "wale/memory.hpp"

namespace wale {

namespace {

/// The shortest decimal number that reads as this single-precision value: 0.0006, not 0.00060000002849.
double shortest(float value) { return std::strtod(fmt::format("{}", value).c_str(), nullptr); }

/// Computes accelerations and raw figures from a trace of places and velocities.
void complete(std::vector<SampledHand>& hands) {
  for (std::size_t i = 0; i < hands.size(); ++i) {
    Hand& hand = hands[i].hand;
    hand.workspace = hand.position;
    hand.time = hands[i].time;
    if (i == 0 || !(hands[i].time > hands[i - 1].time)) continue;
    const Hand& before = hands[i - 1].hand;
    const auto seconds = static_cast<float>(hands[i].time - hands[i - 1].time);
    hand.acceleration = (hand.velocity - before.velocity) / seconds;
    hand.raw_velocity = (hand.position - before.position) / seconds;
    if (i > 1) hand.raw_acceleration = (hand.raw_velocity - before.raw_velocity) / seconds;
  }
}

}  // namespace

std::vector<SampledHand> sample(Bank bank, std::vector<SampledHand> hands) {
  const glm::vec2 extent = glm::vec2(bank.size().width, bank.size().height) / 2.0f;
  complete(hands);
  Memory memory(bank.program());
  bool was_inside = false;
  for (auto& sampled : hands) {
    const glm::vec2 place = sampled.hand.position;
    const bool inside = std::abs(place.x) <= extent.x && std::abs(place.y) <= extent.y;
    if (inside && !was_inside) memory.enter(bank, sampled.hand);
    sampled.force = inside ? tick(bank, memory, sampled.hand) + Force(0.0f)  // turns -0 into 0
                           : Force(0.0f);
    was_inside = inside;
  }
  return hands;
}

std::string samples_csv(const std::vector<SampledHand>& samples, bool vibrates) {
  std::string text = fmt::format("t (s),x (m),y (m),vx (m/s),vy (m/s),{}\n",
                                 vibrates ? "amplitude (m/s^2),frequency (Hz)" : "fx (N),fy (N)");
  for (const auto& [time, hand, force] : samples)
    text += fmt::format("{},{},{},{},{},{},{}\n", time, hand.position.x, hand.position.y, hand.velocity.x,
                        hand.velocity.y, force.x, force.y);
  return text;
}

std::string samples_json(const std::vector<SampledHand>& samples, bool vibrates) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const auto& [time, hand, force] : samples)
    json.push_back({{"t", time},
                    {"x", shortest(hand.position.x)},
                    {"y", shortest(hand.position.y)},
                    {"vx", shortest(hand.velocity.x)},
                    {"vy", shortest(hand.velocity.y)},
                    {vibrates ? "amplitude" : "fx", shortest(force.x)},
                    {vibrates ? "frequency" : "fy", shortest(force.y)}});
  return json_lines(json);
}

}  // namespace wale
