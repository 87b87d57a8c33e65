#pragma once

#include <linux/input.h>

#include <array>
#include <glm/vec2.hpp>
#include <map>
#include <string>
#include <vector>

#include "tests/usb/node_fake.hpp"

namespace wale::test {

/// An event node of a joystick with force feedback, as linux/input.h and Documentation/input/ff.rst describe it.
class EvdevFake final : public NodeFake {
 public:
  struct Features {
    bool makes_constant_force = true, tells_position = true;
    int most_effects = 16;
    int room = 16;  ///< the number of effects that fit; other programs hold the rest
  };
  explicit EvdevFake() : EvdevFake(Features{}) {}
  explicit EvdevFake(const Features& features);
  ~EvdevFake() override { stop(); }

  struct Effect {
    ff_effect said{};
    bool plays = false;
    std::int64_t started = 0;  ///< microseconds
  };

  /// The force as a fraction of full force, along HID's axes (y points to the user).
  glm::dvec2 force();
  void move_to(std::int32_t x, std::int32_t y);
  /// Moves the stick, and reports only that events were dropped.
  void move_unheard(std::int32_t x, std::int32_t y);
  /// Moves the stick while another program has grabbed the node: no event tells of it.
  void move_while_grabbed(std::int32_t x, std::int32_t y);
  /// As a program does that shares the open file, such as the portal that opened it.
  void erase_through_the_same_file(int effect);
  std::map<int, Effect> effects();
  /// "upload 0 level 0 toward 16384", "play 0", "gain 65535", "autocenter 0", "erase 0"
  std::vector<std::string> log();
  std::int32_t fuzz();

 private:
  int answer(unsigned long request, void* argument) override;
  int answer_bits(unsigned type, std::uint8_t* bits, std::size_t size) const;
  int upload(ff_effect& effect);
  void frame() override;
  void tell(const std::vector<input_event>& events) const;

  const Features features_;
  std::map<int, Effect> effects_;
  std::vector<std::string> log_;
  std::array<input_absinfo, 2> axes_{};
};

}  // namespace wale::test
