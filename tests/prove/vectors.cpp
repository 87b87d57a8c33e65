// Proofs about vectors (guarded unit vectors, limited lengths, sums) against the machine: random programs of such
// idioms, with values whose squares are flushed to zero, overflow or are not numbers.

#include <gtest/gtest.h>

#include <cmath>

#include "compiler/prove/force_bound.hpp"
#include "compiler/prove/prove.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "tests/machine/running.hpp"
#include "tests/prove/programs.hpp"
#include "tests/prove/stepping.hpp"
#include "tests/prove/values.hpp"

namespace wale::vectors_test {
namespace {

using enum Operation;
using example::instruction;
using example::loaded;
using prove_test::Values;

/// Writes random programs of two-component vectors. Every result has its own register.
class VectorProgram {
 public:
  struct Vector {
    unsigned x, y;
  };

  explicit VectorProgram(unsigned seed) : random_(seed), program_(example::least()) {
    program_.constants = {0.0f, 10.0f, 1.0f, 1e-12f, 0.5f, 3.0f, -2.0f, 40.0f, 6.0f, 15.0f};
    if (seed % 3 == 0) {
      for (const float wild : {1e-19f, 3e-20f, 1e19f, 1e30f, __builtin_inff(), __builtin_nanf("")}) {
        program_.constants.push_back(wild);
      }
    }
    program_.parameters = {{"amplitude", "", 1, 1.0f, 0.0f, 4.0f, 0.0f, 4.0f, ""},
                           {"tiny", "", 1, 1e-19f, -1e-18f, 1e-18f, 0.0f, 0.0f, ""}};
    program_.states = {{"p", -0.1f, 0.1f, 0, 0}, {"q", -1e30f, 1e30f, 0, 1}, {"r", -2e-19f, 2e-19f, 0, 1}};
    next_ = program_.first_temporary();
    vectors_ = {{0, 1},
                {2, 3},
                {program_.first_state(), program_.first_state() + 1u},
                {program_.first_state() + 2u, 1},
                {any_constant(), any_constant()}};
  }

  PatchProgram make() {
    for (int i = 0; i < 5; ++i) vectors_.push_back(any());
    const Vector force = vectors_.back();
    const unsigned x = write(limit, force.x, 33), y = write(limit, force.y, 33);
    program_.temporaries = static_cast<std::uint16_t>(next_ - program_.first_temporary());
    program_.outputs = {{OutputQuantity::force, 0, static_cast<RegisterNumber>(x), 33},
                        {OutputQuantity::force, 1, static_cast<RegisterNumber>(y), 33}};
    program_.tick = code_;
    return program_;
  }

 private:
  unsigned pick(unsigned count) { return static_cast<unsigned>(random_() % count); }
  unsigned any_constant() { return 32 + pick(static_cast<unsigned>(program_.constants.size())); }
  unsigned any_factor() {
    return pick(3) == 0 ? program_.first_parameter() + pick(2) : pick(4) == 0 ? pick(4) : any_constant();
  }
  Vector any_vector() {
    return vectors_[vectors_.size() - 1 - pick(static_cast<unsigned>(std::min<std::size_t>(vectors_.size(), 6)))];
  }

  unsigned write(Operation operation, unsigned a, unsigned b = 0, unsigned c = 0) {
    code_.push_back(instruction(operation, next_, a, b, c));
    return next_++;
  }

  unsigned length(const Vector& v) {
    return write(square_root, write(add, write(multiply, v.x, v.x), write(multiply, v.y, v.y)));
  }

  /// v, no longer than `most`.
  Vector held(const Vector& v, unsigned most, bool by_component) {
    const unsigned ratio = write(divide, most, length(v));
    const unsigned scale = pick(2) == 0 ? write(minimum, 34, ratio) : write(minimum, ratio, 34);
    const Vector scaled{write(multiply, v.x, scale), write(multiply, scale, v.y)};
    if (!by_component) return scaled;
    return {write(limit, scaled.x, most), write(limit, scaled.y, most)};
  }

  /// A value brought into [0, 1].
  unsigned share(unsigned value) { return write(minimum, write(maximum, value, 32), 34); }

  Vector any() {
    const Vector v = any_vector(), w = any_vector();
    switch (pick(13)) {
      case 0: {  // v / |v|, guarded
        const unsigned r = length(v), bound = pick(2) == 0 ? 32 : pick(4) == 0 ? 38 : 35;
        const unsigned x = write(divide, v.x, r), y = write(divide, v.y, r);
        if (pick(3) == 0) {
          const unsigned within = write(less, r, bound);
          return {write(select, within, 32, x), write(select, within, 32, y)};
        }
        const unsigned outside = write(less, bound, r);
        return {write(select, outside, x, 32), write(select, outside, y, 32)};
      }
      case 1: {  // v / |v|, not guarded
        const unsigned r = length(v);
        return {write(divide, v.x, r), write(divide, v.y, r)};
      }
      case 2:  // |v| limited, sometimes the components too
        return held(v, pick(2) == 0 ? program_.first_parameter() : any_constant(), pick(3) != 0);
      case 3: {
        const unsigned factor = any_factor();
        return {write(multiply, factor, v.x), write(multiply, v.y, factor)};
      }
      case 4: return {write(add, v.x, w.x), write(add, v.y, w.y)};
      case 5: return {write(subtract, v.x, w.x), write(subtract, v.y, w.y)};
      case 6: {
        if (pick(2) == 0) return {write(negate, v.y), write(negate, v.x)};
        const unsigned p = any_factor();  // remainders
        return {write(subtract, v.x, write(multiply, p, write(floor, write(divide, v.x, p)))),
                write(subtract, v.y, write(multiply, write(floor, write(divide, v.y, p)), p))};
      }
      case 7: {
        const unsigned condition = write(less, any_factor(), any_factor());
        return {write(select, condition, v.x, w.x), write(select, condition, v.y, w.y)};
      }
      case 8: {  // a mixture of v and w
        const unsigned t = pick(3) == 0 ? any_factor() : share(w.x);
        return {write(add, v.x, write(multiply, t, write(subtract, w.x, v.x))),
                write(add, write(multiply, write(subtract, w.y, v.y), t), v.y)};
      }
      case 9: {  // v times a smooth step of fifth degree
        const unsigned t = share(w.y), cube = write(multiply, write(multiply, t, t), t);
        const unsigned inner = write(multiply, t, write(subtract, write(multiply, 40, t), 41));
        const unsigned step = write(multiply, cube, pick(2) == 0 ? write(add, inner, 33) : write(add, 33, inner));
        return {write(multiply, v.x, step), write(multiply, step, v.y)};
      }
      case 10: {  // the projection of v on u
        const unsigned angle = any_factor();
        const Vector u = pick(2) == 0 ? any_vector() : Vector{write(cosine, angle), write(sine, angle)};
        const unsigned along = write(add, write(multiply, v.x, u.x), write(multiply, u.y, v.y));
        return {write(multiply, along, u.x), write(multiply, u.y, along)};
      }
      case 11: {  // v limited to C / g, then times g
        const unsigned g = any_factor(), ceiling = write(divide, pick(3) == 0 ? w.x : any_factor(), g);
        const Vector limited = held(v, ceiling, pick(4) != 0);
        const unsigned factor = pick(3) == 0 ? write(negate, g) : g;
        return {write(multiply, limited.x, factor), write(multiply, factor, limited.y)};
      }
      default: {
        const unsigned ceiling = any_constant();
        return {write(limit, v.x, ceiling), write(limit, v.y, ceiling)};
      }
    }
  }

  std::mt19937 random_;
  PatchProgram program_;
  unsigned next_ = 0;
  std::vector<Vector> vectors_;
  std::vector<Instruction> code_;
};

/// Values whose squares are flushed to zero or overflow, and values of `range`.
float delicate(Values& values, const Interval& range) {
  static constexpr float sizes[] = {1.0842e-19f, 1.08420217e-19f, 1.0843e-19f, 1.2e-19f, 9e-20f, 5e-20f, 3e-19f,
                                    1e-15f,      1.8e19f,         1.9e19f,     1e-12f,   2e-12f, 0.01f,  0.2f};
  if (values.random()() % 2 == 0) return values.of(range);
  const float size = sizes[values.random()() % std::size(sizes)];
  return std::clamp(values.random()() % 2 == 0 ? size : -size, range.low, range.high);
}

TEST(Vectors, AreNoLongerThanProved) {
  Values values(9);
  int informative = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    const Program program = loaded(VectorProgram(seed).make());
    const PatchProgram& description = program.description();
    const Domain domain = whole_domain(description);
    const Proof proof = prove(program, domain);
    informative += proof.bound_newton < 14;
    for (int run = 0; run < 40; ++run) {
      stepping::State state{program.decoded(), std::vector<float>(description.register_count()), {}};
      for (std::size_t i = 0; i < first_constant; ++i) state.registers[i] = delicate(values, domain.inputs[i]);
      std::copy(description.constants.begin(), description.constants.end(), state.registers.begin() + first_constant);
      for (std::size_t i = 0; i < domain.parameters.size(); ++i) {
        state.registers[description.first_parameter() + i] = delicate(values, domain.parameters[i]);
      }
      for (std::size_t i = 0; i < domain.states.size(); ++i) {
        state.registers[description.first_state() + i] = delicate(values, domain.states[i]);
      }
      const auto complaint = stepping::run_all(state, proof);
      ASSERT_FALSE(complaint) << "seed " << seed << ": " << *complaint;
    }
  }
  EXPECT_GT(informative, 1000);
}

TEST(Vectors, AreNoLongerThanProvedWhereTheDomainIsSplit) {
  Values values(10);
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Program program = loaded(VectorProgram(seed).make());
    const ForceBound bound = force_bound(program, whole_domain(program.description()), 40000);
    ASSERT_LE(bound.found.newton, bound.newton) << seed;
    Bank bank(program);
    const Interval place = Interval::between(-0.2286f, 0.2286f);
    for (int i = 0; i < 200; ++i) {
      const Force force = tick(bank, {.position = {delicate(values, place), delicate(values, place)},
                                      .velocity = {delicate(values, place), delicate(values, place)}});
      ASSERT_LE(std::hypot(static_cast<double>(force.x), static_cast<double>(force.y)), bound.newton) << seed;
    }
  }
}

/// A program with a central force: 1000 N/m outwards with its length limited to 6 N where `limited`, otherwise 6 N
/// outwards where the distance is above `guard`, in m.
PatchProgram central(float guard, bool limited) {
  PatchProgram p = example::least();
  p.constants = {0.0f, 10.0f, 6.0f, guard, 1000.0f, 1.0f};
  p.temporaries = 16;
  const unsigned t = p.first_temporary();
  p.tick = {instruction(multiply, t, 0, 0), instruction(multiply, t + 1, 1, 1), instruction(add, t, t, t + 1),
            instruction(square_root, t, t)};
  if (limited) {  // 1000 N/m, its length limited to 6 N
    p.tick.insert(p.tick.end(),
                  {instruction(multiply, t + 1, 0, 36), instruction(multiply, t + 2, 1, 36),
                   instruction(multiply, t + 3, t + 1, t + 1), instruction(multiply, t + 4, t + 2, t + 2),
                   instruction(add, t + 3, t + 3, t + 4), instruction(square_root, t + 3, t + 3),
                   instruction(divide, t + 3, 34, t + 3), instruction(minimum, t + 3, 37, t + 3),
                   instruction(multiply, t + 1, t + 1, t + 3), instruction(multiply, t + 2, t + 2, t + 3)});
  } else {  // 6 N away from the middle
    p.tick.insert(p.tick.end(),
                  {instruction(less, t + 1, 35, t), instruction(divide, t + 2, 0, t), instruction(divide, t + 3, 1, t),
                   instruction(select, t + 2, t + 1, t + 2, 32), instruction(select, t + 3, t + 1, t + 3, 32),
                   instruction(multiply, t + 1, t + 2, 34), instruction(multiply, t + 2, t + 3, 34)});
  }
  p.tick.insert(p.tick.end(), {instruction(limit, t + 14, t + 1, 33), instruction(limit, t + 15, t + 2, 33)});
  p.outputs = {{OutputQuantity::force, 0, static_cast<RegisterNumber>(t + 14), 33},
               {OutputQuantity::force, 1, static_cast<RegisterNumber>(t + 15), 33}};
  return p;
}

// x - p floor(x / p), where x / p is near whole numbers of all sizes.
TEST(Vectors, RemaindersAreWithinTheirDivisor) {
  const Parameter period{"period", "", 1, 0.5f, 1e-3f, 0.7f, 0.5f, 0.5f, ""};
  const PatchProgram p = prove_test::pushing({}, {period}, [](unsigned t) {
    return std::vector{instruction(divide, t, 2, 34), instruction(floor, t, t), instruction(multiply, t, 34, t),
                       instruction(subtract, t, 2, t)};
  });
  const Program program = loaded(p);
  Values values(2);
  for (int round = 0; round < 300; ++round) {
    const float size = std::exp2(std::uniform_real_distribution<float>(-9.9f, -0.6f)(values.random()));
    Domain domain = whole_domain(p);
    domain.parameters[0] = Interval::of(size);
    const Proof proof = prove(program, domain);
    EXPECT_NEAR(proof.bound_newton, size, 1e-5);
    Bank bank(program, std::vector<float>{size}, program.default_size());
    for (int i = 0; i < 200; ++i) {
      const float whole = size * static_cast<float>(static_cast<int>(values.random()() % 4000) - 2000);
      const float near = whole * (1 + static_cast<float>(static_cast<int>(values.random()() % 9) - 4) * 0x1p-24f);
      ASSERT_TRUE(proof.force[0].contains(tick(bank, {.velocity = {near, 0}}).x)) << near << " " << size;
    }
  }
}

// A quotient that overflows makes the remainder minus infinity, so no range of the remainder is proved.
TEST(Vectors, RemaindersThatOverflowHaveNoRange) {
  PatchProgram p = prove_test::pushing({1e38f, 1e-10f}, {}, [](unsigned t) {
    return std::vector{instruction(multiply, t + 1, 2, 34), instruction(divide, t, t + 1, 35), instruction(floor, t, t),
                       instruction(multiply, t, 35, t), instruction(subtract, t, t + 1, t)};
  });
  const Program program = loaded(p);
  Bank bank(program);
  const Force force = tick(bank, {.velocity = {1, 0}});
  EXPECT_EQ(force.x, -10);
  EXPECT_TRUE(prove(program).force[0].contains(force.x));
}

// t t (3 - 2 t) for t in 0 .. 1 in steps of 2^-16, in both orders of its factors.
TEST(Vectors, SmoothStepsAreWithinOne) {
  for (const bool swapped : {false, true}) {
    PatchProgram p = prove_test::pushing({1.0f, 2.0f, 3.0f}, {}, [](unsigned t) {
      return std::vector{instruction(maximum, t, 0, 32),          instruction(minimum, t, t, 34),
                         instruction(multiply, t + 1, t, t),      instruction(multiply, t + 2, 35, t),
                         instruction(subtract, t + 2, 36, t + 2), instruction(multiply, t, t + 1, t + 2)};
    });
    p.device.workspace_diameter = 1;
    if (swapped) std::swap(p.tick[3].a, p.tick[3].b), std::swap(p.tick[5].a, p.tick[5].b);
    const Program program = loaded(p);
    const Proof proof = prove(program);
    EXPECT_NEAR(proof.bound_newton, 1, 2e-6);
    EXPECT_EQ(proof.force[0].low, 0);
    Bank bank(program);
    for (int i = 0; i <= 65536; ++i) {
      const Force force = tick(bank, {.position = {static_cast<float>(i) / 65536, 0}});
      ASSERT_TRUE(proof.force[0].contains(force.x)) << i;
    }
  }
}

TEST(Vectors, WithALimitedLengthAreThatLong) { EXPECT_NEAR(prove(loaded(central(0, true))).bound_newton, 6, 1e-4); }

// More than a micrometre from the centre, a unit vector has a length of 1.
TEST(Vectors, OfOneDirectionAreAsLongAsTheirFactor) {
  EXPECT_NEAR(prove(loaded(central(1e-6f, false))).bound_newton, 6, 1e-4);
}

// Guarded only by a length above zero, components near 1e-19 m, whose squares are flushed, may both be as long as the
// computed length. The machine gives such a force.
TEST(Vectors, OfOneDirectionAreLongerWhereSquaresAreFlushed) {
  const Program program = loaded(central(0, false));
  EXPECT_NEAR(prove(program).bound_newton, 6 * std::sqrt(2.0), 1e-4);
  Bank bank(program);
  const Force force = tick(bank, {.position = {1.0841e-19f, 1.09e-19f}});
  EXPECT_GT(std::hypot(force.x, force.y), 8.4);
}

}  // namespace
}  // namespace wale::vectors_test
