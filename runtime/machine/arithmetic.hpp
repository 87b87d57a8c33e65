#pragma once

#include <cstdint>
#include <limits>

#include "runtime/machine/operations.hpp"

/// The functions that `schema/include/wale/instruction.def` names in its column of meanings, on 32-bit floats.
///
/// The same bits on every machine that rounds to nearest, in one lane and in a block: no call of the mathematical
/// library, no fused multiply-add, no branch that lanes would have to share. Not-a-number propagates, except through
/// `limited`. The stated errors hold in the mode that `FloatingPointMode` sets; tests/machine/arithmetic.cpp checks
/// them.
///
/// A product, quotient, sum or difference that may be subnormal, and whose flushing a result could show, is written
/// with the functions of operations.hpp: `wale build --emit cpp` copies this file into headers for processors that do
/// not flush. All other intermediate results may be subnormal there, since they are added to far greater ones.
namespace wale {

namespace arithmetic {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float least_normal = std::numeric_limits<float>::min();

/// Added to a float below 2^22 in size, it leaves the nearest whole number in the low bits of the sum.
inline constexpr float rounder = 12582912.0f;  // 1.5 * 2^23
inline constexpr std::uint32_t rounder_bits = 0x4b400000u;

/// Replaces a subnormal number by the zero of its sign, whatever the thread's mode. All numbers from outside go through
/// this, and `FloatingPointMode` flushes results, so that no register, state or cell is subnormal. Otherwise the bits
/// would depend on the compiler: it may translate an operation that only chooses among its operands to one that
/// flushes or to one that does not.
inline float flushed(float a) {
  const std::uint32_t bits = bits_of(a);
  return (bits & 0x7f800000u) == 0 ? float_of(bits & 0x80000000u) : a;
}

}  // namespace arithmetic

inline float absolute(float a) {
#if defined(__GNUC__)
  return __builtin_fabsf(a);  // the same bits, without a detour through the integer registers
#else
  return arithmetic::float_of(arithmetic::bits_of(a) & 0x7fffffffu);
#endif
}

/// `a` clamped to low .. high; `otherwise` for not-a-number.
inline float held_within(float a, float low, float high, float otherwise) {
  return a >= low ? (a <= high ? a : high) : (a < low ? low : otherwise);
}

/// The largest whole number not above `a`. Exact.
inline float floor_of(float a) {
  using namespace arithmetic;
  const float size = absolute(a);
  const float nearest_size = (size + 0x1p23f) - 0x1p23f;
  const float nearest = float_of(bits_of(nearest_size) | (bits_of(a) & 0x80000000u));
  const float below = nearest - (nearest > a ? 1.0f : 0.0f);
  return size < 0x1p23f ? below : a;  // from 2^23 on every float is whole
}

/// Correctly rounded; not-a-number below zero.
inline float square_root_of(float a) { return arithmetic::root(a); }

namespace arithmetic {

/// Sine of `a` radians or, a quarter turn on, cosine.
///
/// Subtracts the nearest multiple of half a turn (for the cosine, an odd multiple of a quarter turn) in three parts.
/// The first two have 11 bits, so that their multiples are exact for |a| <= 1e4. An odd polynomial of degree 9 follows,
/// minimax within 4.7e-9 on +-1.572, then the sign.
template <bool quarter_turn_on>
float wave(float a) {
  const float half_turns = a * 0.318309886f;
  const float rounded = (quarter_turn_on ? half_turns + 0.5f : half_turns) + rounder;
  const float whole = rounded - rounder;
  const float taken = quarter_turn_on ? whole - 0.5f : whole;
  const float rest = ((a - taken * 3.140625f) - taken * 9.67502593994140625e-4f) - taken * 1.509957990978376e-7f;
  // Far beyond the stated range the remainder is noise; it must not leave the polynomial's range.
  const float least = rest < -1.572f ? -1.572f : rest;
  const float r = least > 1.572f ? 1.572f : least;
  const float z = r * r;
  const float p = ((2.59982262619e-6f * z - 1.98065108419e-4f) * z + 8.33301585653e-3f) * z - 1.66666570384e-1f;
  const float sine = p * (z * r) + r;
  return float_of(bits_of(sine) ^ bits_of(rounded) << 31);
}

}  // namespace arithmetic

/// Absolute error below 1.5e-7 for |a| <= 1e4 rad; beyond, within [-1, 1]; of an infinity, not-a-number.
inline float sine_of(float a) { return arithmetic::wave<false>(a); }
inline float cosine_of(float a) { return arithmetic::wave<true>(a); }

/// Relative error below 2e-7. Infinity from 128 on; 0 below -126, where floats would be subnormal.
inline float exp2_of(float a) {
  using namespace arithmetic;
  const float rounded = a + rounder;
  const float f = a - (rounded - rounder);  // exact, within +-0.5
  const float p = (((((1.535336188319500e-4f * f + 1.339887440266574e-3f) * f + 9.618437357674640e-3f) * f +
                     5.550332471162809e-2f) *
                        f +
                    2.402264791363012e-1f) *
                       f +
                   6.931472028550421e-1f) *
                      f +
                  1.0f;
  const float scaled = float_of(bits_of(p) + ((bits_of(rounded) - rounder_bits) << 23));
  const float above_least = a < -126.0f ? 0.0f : scaled;
  const float below_most = a >= 128.0f ? infinity : above_least;
  return a == a ? below_most : a;
}

/// Error below 2e-7 of the result or, near 1, of a - 1. Minus infinity for zero and subnormals, not-a-number for less,
/// infinity for infinity.
inline float log2_of(float a) {
  using namespace arithmetic;
  const std::uint32_t bits = bits_of(a);
  const auto exponent =
      static_cast<std::int32_t>(bits - 0x3f3504f3u) >> 23;  // the fraction lies in sqrt(1/2) .. sqrt(2)
  const float x = float_of(bits - (static_cast<std::uint32_t>(exponent) << 23)) - 1.0f;
  const float z = x * x;
  const float p = ((((((((7.0376836292e-2f * x - 1.1514610310e-1f) * x + 1.1676998740e-1f) * x - 1.2420140846e-1f) * x +
                       1.4249322787e-1f) *
                          x -
                      1.6668057665e-1f) *
                         x +
                     2.0000714765e-1f) *
                        x -
                    2.4999993993e-1f) *
                       x +
                   3.3333331174e-1f);
  const float y = p * x * z - 0.5f * z;  // ln(1 + x) = x + y
  constexpr float log2_e_less_1 = 0.44269504088896340736f;
  const float finite = (((y * log2_e_less_1 + x * log2_e_less_1) + y) + x) + static_cast<float>(exponent);
  const float positive = a < infinity ? finite : a;  // infinity and not-a-number
  const float not_negative = a < 0.0f ? not_a_number : positive;
  return absolute(a) < least_normal ? -infinity : not_negative;
}

/// The cumulative normal distribution, absolute error below 2e-7; 0.5 at 0, 0 and 1 far out, and
/// normal(-a) = 1 - normal(a) as far as floats go.
///
/// The tail is exp(-a^2 / 2) times a polynomial in u = 1 / (1 + 0.27 |a|): the form of Abramowitz and Stegun 26.2.17
/// with one term more, fitted to 1.3e-8, and written in v = 1 - u, which keeps the precision near 0.
inline float normal_of(float a) {
  const float all = absolute(a);
  const float size = all > 40.0f ? 40.0f : all;  // where the tail has long been 0
  const float s = 0.27f * size;
  const float v = s / (1.0f + s);
  const float r = (((((-0.1218434115331f * v + 0.22001913471f) * v + 0.3029416714478f) * v - 1.375390699187f) * v +
                    1.951838746172f) *
                       v -
                   1.47756544161f) *
                      v +
                  0.5f;
  const float tail = arithmetic::product(exp2_of(size * size * -0.72134752044f), r);
  return a > 0.0f ? 1.0f - tail : tail;
}

/// `a` clamped to +-`ceiling`. Not-a-number gives 0, and so does a ceiling that is negative or not a number.
inline float limited(float a, float ceiling) {
  const float below = ceiling < a ? ceiling : a;
  const float within = below < -ceiling ? -ceiling : below;
  const float usable = ceiling >= 0.0f ? within : 0.0f;
  return a == a ? usable : 0.0f;
}

/// The angle of the vector (`b`, `a`) within [-pi, pi]; error below 3e-7 absolute, 2e-7 relative. The angle of (0, 0)
/// is 0. Signed zeros count as 0: the angle of (-1, -0) is pi. Two infinities count as equal: the angle of (infinity,
/// infinity) is pi / 4.
///
/// The quotient of the smaller side by the larger, then an odd polynomial on [0, 1] (minimax, 7.4e-9), then the octant.
inline float arctangent_of(float a, float b) {
  using namespace arithmetic;
  const float y = absolute(a), x = absolute(b);
  const bool steep = y > x;
  const float smaller = steep ? x : y, larger = steep ? y : x;
  const float ratio = smaller == larger ? 1.0f : quotient(smaller, larger);
  const float t = larger == 0.0f ? smaller : ratio;  // 0 or not-a-number
  const float z = t * t;
  const float p =
      (((((((2.6222448e-3f * z - 1.5132537e-2f) * z + 4.1121862e-2f) * z - 7.3667063e-2f) * z + 1.0573932e-1f) * z -
         1.4185975e-1f) *
            z +
        1.9990397e-1f) *
           z -
       3.3332987e-1f) *
          z * t +
      t;
  // A quarter and half a turn are added in two parts each, because their rounding would be most of the error.
  const float eighth = steep ? 1.57079637f - (p + 4.37113883e-8f) : p;
  const float half = b < 0.0f ? 3.14159274f - (eighth + 8.74227766e-8f) : eighth;
  return a < 0.0f ? -half : half;
}

namespace arithmetic {

/// All bits if it holds, or none.
inline std::uint32_t bits_if(bool holds) { return 0u - static_cast<std::uint32_t>(holds); }

/// floor(a) as a 32-bit integer, clamped to +-(2^31 - 128); 0 for not-a-number. In masks, since a compiler that sees what
/// becomes of the constants goes separate ways for them, and then has no vectors.
inline std::uint32_t lattice_index(float a) {
  constexpr float most = 2147483520.0f;
  const float held = float_of(bits_of(a) & bits_if(a >= -most) & bits_if(a <= most));
  const auto towards_zero = static_cast<std::int32_t>(held);
  const std::uint32_t down = bits_if(static_cast<float>(towards_zero) > held);
  return (static_cast<std::uint32_t>(towards_zero) + down) | (bits_if(a > most) & 0x7fffff80u) |
         (bits_if(a < -most) & 0x80000080u);
}

/// A permutation of the 32-bit integers in which each bit of the argument flips each bit of the result with a
/// probability near a half (C. Wellons' lowbias32).
inline std::uint32_t mixed(std::uint32_t h) {
  h = (h ^ h >> 16) * 0x7feb352du;
  h = (h ^ h >> 15) * 0x846ca68bu;
  return h ^ h >> 16;
}

}  // namespace arithmetic

/// A number in [0, 1) of 24 bits that depends on floor(a), floor(b) and floor(c) only. Neighbouring arguments, and the
/// same ones in another order, give unrelated numbers. Not-a-number counts as 0; all numbers beyond 2^31 count as one.
inline float hash_of(float a, float b, float c) {
  using namespace arithmetic;
  const std::uint32_t first = mixed(lattice_index(a) + 0x9e3779b9u);
  const std::uint32_t second = mixed(first + lattice_index(b));
  const std::uint32_t third = mixed(second + lattice_index(c));
  return static_cast<float>(static_cast<std::int32_t>(third >> 8)) * 0x1p-24f;
}

}  // namespace wale
