#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "compiler/prove/interval.hpp"

namespace wale::prove_test {

/// Random floats and intervals, with many near the places where arithmetic is irregular.
class Values {
 public:
  explicit Values(unsigned seed) : random_(seed) {}

  std::mt19937& random() { return random_; }

  /// Any float but not-a-number: edges, small whole numbers, numbers near the smallest normal one, ordinary numbers,
  /// and random bits.
  float any() {
    static constexpr float edges[] = {0.0f,   -0.0f, 1e-45f,     -1e-40f,    least_normal, -least_normal, 1.0f,
                                      -1.0f,  0.5f,  1e4f,       -1e4f,      126.0f,       -126.0f,       128.0f,
                                      1e-20f, 1e20f, 127.99999f, most,       -most,        inf,           -inf,
                                      2.5f,   -2.5f, 1.5707964f, 3.1415927f, 8388608.0f};
    switch (random_() % 6) {
      case 0: return edges[random_() % std::size(edges)];
      case 1: {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random_()));
        return value == value ? value : 0.0f;
      }
      case 2: return static_cast<float>(static_cast<int>(random_() % 21)) - 10;
      case 3: return std::uniform_real_distribution<float>(-1.2e-38f, 1.2e-38f)(random_) * 2;
      default: {
        const float size = std::exp2(std::uniform_real_distribution<float>(-15, 15)(random_));
        return random_() % 2 == 0 ? size : -size;
      }
    }
  }

  Interval interval() {
    const float first = any();
    float second = first;
    switch (random_() % 4) {
      case 0: break;  // a point
      case 1: second = any(); break;
      case 2: second = first + std::abs(first) * std::exp2(-static_cast<float>(random_() % 24)); break;
      default: second = first + static_cast<float>(random_() % 100) * 0.1f;
    }
    if (second != second) second = first;
    return Interval::between(std::min(first, second), std::max(first, second), random_() % 5 == 0);
  }

  /// An interval within another, often a point or the whole.
  Interval within(const Interval& whole) {
    float first = of(whole), second = of(whole);
    if (first != first || second != second || random_() % 4 == 0) return whole;
    if (random_() % 4 == 0) second = first;
    return Interval::between(std::min(first, second), std::max(first, second));
  }

  /// A value in the interval: its ends, their neighbours, zeros of both signs, subnormals, or a value in between.
  float of(const Interval& interval) {
    if (interval.maybe_nan && random_() % 4 == 0) return std::numeric_limits<float>::quiet_NaN();
    const auto held = [&](float value) { return std::clamp(value, interval.low, interval.high); };
    switch (random_() % 8) {
      case 0: return interval.low;
      case 1: return interval.high;
      case 2: return held(std::nextafter(interval.low, inf));
      case 3: return held(std::nextafter(interval.high, -inf));
      case 4: {
        static constexpr float zeros[] = {0.0f, -0.0f, 1e-45f, -1e-45f, 1e-38f, -1e-38f};
        return interval.has_zero() ? zeros[random_() % std::size(zeros)] : interval.low;
      }
      case 5: return held(any());
      default: {
        const double share = std::uniform_real_distribution<double>(0, 1)(random_);
        const double low = std::clamp(interval.low, -most, most), high = std::clamp(interval.high, -most, most);
        return held(static_cast<float>(low + share * (high - low)));
      }
    }
  }

 private:
  static constexpr float inf = std::numeric_limits<float>::infinity();
  static constexpr float most = std::numeric_limits<float>::max();
  static constexpr float least_normal = std::numeric_limits<float>::min();
  std::mt19937 random_;
};

}  // namespace wale::prove_test
