#pragma once

#include <cstdint>
#include <cstring>

/// The same motion of a hand on the host and in firmware: C++17, and exact in floats, so that no compiler changes it.
namespace firmware {

inline float float_of(std::uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
inline std::uint32_t bits_of(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// The fourteen inputs of a tick, in the order of `Hand` in the headers.
struct Inputs {
  float value[14];
};

/// Strokes of up to a third of a metre a second that begin at any place, with tiny, subnormal and infinite numbers and
/// not-a-number among them.
class Motion {
 public:
  Inputs next() {
    if (tick_ % 61 == 0)
      for (int axis = 0; axis < 2; ++axis) {
        place_[axis] = within(1 << 17);  // 2^-21 m: 62 mm
        speed_[axis] = within(700);      // of them in a tick
      }
    Inputs inputs{};
    for (int axis = 0; axis < 2; ++axis) {
      place_[axis] += speed_[axis];
      const float place = static_cast<float>(place_[axis]) * 0x1p-21f;
      const float speed = static_cast<float>(speed_[axis]) * 0x1p-11f;
      inputs.value[axis] = place;
      inputs.value[2 + axis] = speed;
      inputs.value[4 + axis] = static_cast<float>(within(1 << 12)) * 0x1p-9f;
      inputs.value[6 + axis] = speed + static_cast<float>(within(1 << 10)) * 0x1p-14f;
      inputs.value[8 + axis] = static_cast<float>(within(1 << 12)) * 0x1p-7f;
      inputs.value[10 + axis] = place + 0x1p-6f;
    }
    inputs.value[12] = static_cast<float>(tick_) * 0x1p-10f;
    inputs.value[13] = (random() >> 30) == 0 ? 1.0f : 0.0f;
    disturb(inputs);
    ++tick_;
    return inputs;
  }

 private:
  std::uint32_t random() { return state_ = state_ * 1664525u + 1013904223u; }
  std::int32_t within(std::int32_t size) {
    return static_cast<std::int32_t>((random() >> 8) % static_cast<std::uint32_t>(2 * size)) - size;
  }

  void disturb(Inputs& inputs) {
    const std::uint32_t sign = random() & 0x80000000u;
    if (tick_ % 17 == 3)
      inputs.value[0] = float_of((random() >> 9) | sign | 0x01000000u);       // near the least normal number
    if (tick_ % 19 == 5) inputs.value[1] = float_of((random() >> 9) | sign);  // subnormal
    if (tick_ % 23 == 7) inputs.value[2] = inputs.value[3] = float_of((random() >> 6) | sign);
    if (tick_ % 29 == 11) inputs.value[0] = inputs.value[1] = static_cast<float>(within(1 << 20)) * 0x1p-90f;
    if (tick_ % 41 == 12) inputs.value[3] = float_of(0x7fc00000u);
    if (tick_ % 43 == 13) inputs.value[1] = float_of(0x7f800000u | sign);
  }

  std::uint32_t state_ = 1995;
  std::uint32_t tick_ = 0;
  std::int32_t place_[2] = {}, speed_[2] = {};
};

/// FNV-1a over the bits of floats, word by word.
class Digest {
 public:
  void add(float value) { hash_ = (hash_ ^ bits_of(value)) * 0x01000193u; }
  std::uint32_t value() const { return hash_; }

 private:
  std::uint32_t hash_ = 0x811c9dc5u;
};

/// A run gives a digest each time after this many ticks, and one of the grids at its end.
inline constexpr int ticks = 4000, ticks_per_digest = 250;

}  // namespace firmware
