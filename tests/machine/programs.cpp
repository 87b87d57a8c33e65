// Programs written by hand, against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/machine/arithmetic.hpp"
#include "tests/machine/running.hpp"

namespace wale::programs_test {
namespace {

using enum Operation;
using example::instruction;
using example::loaded;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

/// A program of one operation: force x = operation(x, y, velocity x), limited at 10 N.
Program one_operation(Operation operation) {
  PatchProgram p = example::least();
  p.constants = {0.0f, 10.0f};
  p.temporaries = 2;
  const auto fields = facts(operation).fields;
  p.tick = {instruction(operation, 34, 0, fields[1] == 'r' ? 1 : 0, fields[2] == 'r' ? 2 : 0),
            instruction(limit, 35, 34, 33), instruction(limit, 34, 32, 33)};
  p.outputs = {{OutputQuantity::force, 0, 35, 33}, {OutputQuantity::force, 1, 34, 33}};
  return loaded(p);
}

float result(Operation operation, float a, float b = 0, float c = 0) {
  Bank bank(one_operation(operation));
  return tick(bank, {{a, b}, {c, 0}}).x;
}

TEST(Machine, OperationsMeanWhatTheySay) {
  EXPECT_EQ(result(add, 0.125f, 0.0625f), 0.1875f);
  EXPECT_EQ(result(subtract, 0.125f, 0.0625f), 0.0625f);
  EXPECT_EQ(result(multiply, 0.125f, 0.0625f), 0.0078125f);
  EXPECT_EQ(result(divide, 0.125f, 0.0625f), 2.0f);
  EXPECT_EQ(result(divide, 0.125f, 0.0f), 10.0f) << "infinity, limited";
  EXPECT_EQ(result(divide, 0.0f, 0.0f), 0.0f) << "not a number, limited";
  EXPECT_EQ(result(negate, 0.125f), -0.125f);
  EXPECT_EQ(result(absolute, -0.125f), 0.125f);
  EXPECT_EQ(result(minimum, 0.125f, 0.0625f), 0.0625f);
  EXPECT_EQ(result(minimum, 0.0625f, 0.125f), 0.0625f);
  EXPECT_EQ(result(maximum, 0.125f, 0.0625f), 0.125f);
  EXPECT_EQ(result(maximum, 0.0625f, 0.125f), 0.125f);
  EXPECT_EQ(result(Operation::floor, -0.125f), -1.0f);
  EXPECT_EQ(result(square_root, 0.0625f), 0.25f);
  EXPECT_EQ(result(square_root, -0.0625f), 0.0f) << "not a number, limited";
  EXPECT_EQ(result(less, 0.0625f, 0.125f), 1.0f);
  EXPECT_EQ(result(less, 0.125f, 0.125f), 0.0f);
  EXPECT_EQ(result(Operation::select, 0.125f, 0.0625f, 0.5f), 0.0625f);
  EXPECT_EQ(result(Operation::select, 0.0f, 0.0625f, 0.5f), 0.5f);
  EXPECT_NEAR(result(sine, 0.125f), std::sin(0.125), 1e-7);
  EXPECT_NEAR(result(cosine, 0.125f), std::cos(0.125), 1e-7);
  EXPECT_NEAR(result(Operation::exp2, 0.125f), std::exp2(0.125), 2e-7);
  EXPECT_EQ(result(Operation::log2, 0.125f), -3.0f);
  EXPECT_NEAR(result(normal, 0.125f), 0.5 * std::erfc(-0.125 / std::numbers::sqrt2), 2e-7);
  EXPECT_EQ(result(limit, 0.125f, 0.0625f), 0.0625f);
  EXPECT_NEAR(result(arctangent, 0.125f, -0.0625f), std::atan2(0.125, -0.0625), 3e-7);
  EXPECT_EQ(result(hash, 0.125f, -0.0625f, 1.5f), hash_of(0, -1, 1));
}

// example::program(): amplitude 2 N, period 2 mm. |cos| exceeds cos(k) on 2 k / pi of its points, so its 99th
// percentile is cos(pi / 200) of the maximum and the force -2 N cos(2 pi x / 2 mm) / 0.99988, limited at 2 N.
TEST(Machine, GratingPushesWithItsAmplitude) {
  Bank bank(loaded(example::program()));
  const double wave = 2 * std::numbers::pi / 0.002;
  const double percentile = std::cos(std::numbers::pi / 200);
  for (float x = -0.02f; x < 0.02f; x += 0.00007f) {
    const Force force = tick(bank, {{x, 0.01f}, {}});
    const double expected = std::clamp(-2 * std::cos(wave * x) / percentile, -2.0, 2.0);
    EXPECT_NEAR(force.x, expected, 2e-4) << x;
    EXPECT_EQ(force.y, 0.0f);
  }
}

TEST(Machine, PeakKeepsTheAmplitudeWhenTheParameterMoves) {
  const Program program = loaded(example::program());
  for (const float period : {0.001f, 0.003f, 0.01f}) {
    const Bank bank(program, std::vector<float>{period, 1.5f}, program.default_size());
    const double slope = 2 * std::numbers::pi / period;  // of sin(2 pi x / period), at most
    EXPECT_NEAR(bank.registers()[39] / (slope * std::cos(std::numbers::pi / 200)), 1, 3e-4) << period;
    EXPECT_EQ(amplitude(bank, 0), 1.5f);
  }
}

TEST(Machine, ParametersAreHeldInTheirRanges) {
  const Program program = loaded(example::program());
  const auto with = [&](float a) { return amplitude(Bank(program, std::vector<float>{0.002f, a}, {}), 0); };
  EXPECT_EQ(with(3), 3);
  EXPECT_EQ(with(7), 4);
  EXPECT_EQ(with(inf), 4);
  EXPECT_EQ(with(-1), 0);
  EXPECT_EQ(with(nan), 2) << "the default";
  EXPECT_EQ(amplitude(Bank(program, {}, {}), 0), 2) << "parameters not given keep their defaults";
  EXPECT_EQ(program.parameter("amplitude"), std::size_t{1});
  EXPECT_EQ(program.parameter("roughness"), std::nullopt);
  EXPECT_EQ(program.default_parameters(), (std::vector<float>{0.002f, 2.0f}));
}

TEST(Machine, SizesThatMakeNoSenseAreReplaced) {
  const Program program = loaded(example::program());
  const auto size = [&](PatchSize asked) { return Bank(program, {}, asked).size(); };
  EXPECT_EQ(size({}).width, 0.1f);
  EXPECT_EQ(size({}).height, 0.08f);
  EXPECT_EQ(size({}).rim, 0.0f) << "a rim of 0 is valid";
  EXPECT_EQ(size({nan, -1, nan}).width, 0.1f);
  EXPECT_EQ(size({nan, -1, nan}).height, 0.08f);
  EXPECT_EQ(size({nan, -1, nan}).rim, 0.005f);
  EXPECT_EQ(size({inf, 0.02f, 0.001f}).width, 0.1f);
  EXPECT_EQ(size({0.04f, 0.02f, 0.015f}).rim, 0.005f) << "a quarter of the smaller side";
  EXPECT_EQ(size({3, 0.02f, 0}).width, 0.2286f) << "the workspace";
  EXPECT_EQ(size({0.02f, 1e30f, 0}).height, 0.2286f);
  const Bank bank(program, {}, {0.04f, 0.02f, 0.001f});
  EXPECT_EQ(bank.registers()[4], 0.02f);
  EXPECT_EQ(bank.registers()[5], 0.01f);
  EXPECT_EQ(bank.registers()[6], 0.001f);
}

/// The number that a program sees in one input.
float seen(Input input, const Hand& hand) {
  PatchProgram p = example::least();
  const auto number = static_cast<unsigned>(input);
  p.tick = {instruction(limit, 34, number, 33)};
  Bank bank(loaded(p));
  tick(bank, hand);
  return bank.registers()[number];
}

TEST(Machine, HandIsHeldInTheEnvelope) {
  const float reach = 0.2286f, speed = 2.0f, jolt = 1800.0f;  // 2 m/s in one tick of 900 Hz
  const auto held = [](Input input, glm::vec2 Hand::*quantity, int axis, float most) {
    const auto with = [&](float value) {
      Hand hand;
      (hand.*quantity)[axis] = value;
      return seen(input, hand);
    };
    EXPECT_EQ(with(0.5f * most), 0.5f * most);
    EXPECT_EQ(with(-most), -most);
    for (const float beyond : {1.001f * most, 1e30f, inf}) {
      EXPECT_EQ(with(beyond), most);
      EXPECT_EQ(with(-beyond), -most);
    }
    EXPECT_EQ(with(nan), 0.0f);
  };
  for (const int axis : {0, 1}) {
    const auto along = [axis](Input x) { return static_cast<Input>(static_cast<int>(x) + axis); };
    held(along(Input::x), &Hand::position, axis, reach);
    held(along(Input::velocity_x), &Hand::velocity, axis, speed);
    held(along(Input::acceleration_x), &Hand::acceleration, axis, jolt);
    held(along(Input::raw_velocity_x), &Hand::raw_velocity, axis, speed);
    held(along(Input::raw_acceleration_x), &Hand::raw_acceleration, axis, jolt);
    held(along(Input::workspace_x), &Hand::workspace, axis, reach);
    held(along(Input::shape_edge_x), &Hand::edge_slope, axis, 1);
  }
}

TEST(Machine, TheEdgeOfAShapeArrivesWithinReach) {
  EXPECT_EQ(seen(Input::shape_edge, {}), 0.0f);
  EXPECT_EQ(seen(Input::shape_edge, {.edge = 0.0125f}), 0.0125f);
  EXPECT_EQ(seen(Input::shape_edge, {.edge = -0.0125f}), -0.0125f);
  EXPECT_EQ(seen(Input::shape_edge, {.edge = std::numeric_limits<float>::min()}), std::numeric_limits<float>::min());
  EXPECT_EQ(seen(Input::shape_edge, {.edge = 1e30f}), seen(Input::x, {.position = {1e30f, 0}}));
  EXPECT_EQ(seen(Input::shape_edge, {.edge = std::nanf("")}), 0.0f);
}

TEST(Machine, TimeAndButtonArriveAsFiniteNumbers) {
  const double endless = std::numeric_limits<double>::infinity();
  EXPECT_EQ(seen(Input::time, {.time = 12.5}), 12.5f);
  EXPECT_EQ(seen(Input::time, {.time = -1}), 0.0f);
  EXPECT_EQ(seen(Input::time, {.time = std::nan("")}), 0.0f);
  EXPECT_EQ(seen(Input::time, {.time = endless}), std::numeric_limits<float>::max());
  EXPECT_EQ(seen(Input::time, {.time = 1e300}), std::numeric_limits<float>::max());
  EXPECT_EQ(seen(Input::button, {.button = true}), 1.0f);
  EXPECT_EQ(seen(Input::button, {}), 0.0f);
}

TEST(Machine, PeriodIsThatOfTheDevice) {
  const Bank bank(loaded(example::least()));
  EXPECT_FLOAT_EQ(bank.registers()[18], 1.0f / 900);
}

TEST(Machine, PredictsFromTheProbe) {
  const Bank bank(loaded(example::program()));
  for (const float probe : {0.0f, 1.0f, 3.5f}) {
    const Prediction prediction = predict(bank, 0, probe);
    EXPECT_EQ(prediction.magnitude, 0.5f * probe);
    EXPECT_EQ(prediction.level, 0.5f * probe + 0.5f);
  }
}

/// A program whose setup holds one peak of `code`, over a box of 2 by 2 (half sizes 1), in register 20.
float peak_of(std::vector<Instruction> code, RegisterNumber value, std::uint32_t points, float percentile) {
  PatchProgram p = example::least();
  p.constants = {0.0f, 1.0f, 0.0f, 10.0f};
  p.setup_registers = 1;
  p.temporaries = 4;  // 37 ..
  p.setup = {instruction(peak, 36, 0)};
  p.peaks = {{std::move(code), value, 33, 33, points, percentile}};
  p.tick = {instruction(limit, 37, 32, 33)};
  p.outputs = {{OutputQuantity::force, 0, 37, 33}, {OutputQuantity::force, 1, 37, 33}};
  return Bank(loaded(p)).registers()[36];
}

// x and y are uniform in -1 .. 1, so their percentile q is 2 q - 1 within the lattice's discrepancy.
TEST(Machine, PeakIsThePercentileOfAUniformDistribution) {
  for (const float q : {0.01f, 0.25f, 0.5f, 0.9f, 0.99f, 1.0f}) {
    EXPECT_NEAR(peak_of({}, 0, 10000, q), 2 * q - 1, 1e-3) << q;
    EXPECT_NEAR(peak_of({}, 1, 10000, q), 2 * q - 1, 1e-3) << q;
  }
  // x^2 + y^2 <= r^2 covers pi r^2 / 4 of the square.
  const std::vector<Instruction> radius = {instruction(multiply, 37, 0, 0), instruction(multiply, 38, 1, 1),
                                           instruction(add, 39, 37, 38), instruction(square_root, 40, 39)};
  EXPECT_NEAR(peak_of(radius, 40, 20000, 0.5f), std::sqrt(2 / std::numbers::pi), 2e-3);
}

// The lattice by its definition, in double, and the order statistic by sorting.
TEST(Machine, PeakSortsTheDocumentedLattice) {
  for (const std::uint32_t points : {1u, 2u, 100u, 127u, 128u, 129u, 1000u}) {
    std::vector<float> xs;
    for (std::uint64_t i = 0; i < points; ++i) {
      const double u = static_cast<double>(i * 3242174889ull % 4294967296ull) / 4294967296.0;
      xs.push_back(static_cast<float>(2 * u - 1));
    }
    std::sort(xs.begin(), xs.end());
    EXPECT_EQ(peak_of({}, 0, points, 1.0f), xs.back());
    EXPECT_EQ(peak_of({}, 0, points, 1e-9f), xs.front());
    EXPECT_EQ(peak_of({}, 0, points, 0.5f), xs[(points + 1) / 2 - 1]);
  }
  // 0.99 of 100 is the 99th, although the float 0.99 is a little more than 0.99.
  std::vector<float> xs;
  for (std::uint64_t i = 0; i < 100; ++i) {
    xs.push_back(static_cast<float>(static_cast<double>(i * 3242174889ull % 4294967296ull) / 2147483648.0 - 1));
  }
  std::sort(xs.begin(), xs.end());
  EXPECT_EQ(peak_of({}, 0, 100, 0.99f), xs[98]);
}

TEST(Machine, PeakCountsNotANumberAsZero) {
  // 1 / 0 and 0 / 0 everywhere.
  EXPECT_EQ(peak_of({instruction(divide, 37, 33, 32)}, 37, 1000, 0.99f), 0.0f);
  EXPECT_EQ(peak_of({instruction(divide, 37, 32, 32)}, 37, 1000, 0.5f), 0.0f);
  // The square root of x is not a number on half of the points: the median is 0, the third quartile sqrt(0.5).
  EXPECT_NEAR(peak_of({instruction(square_root, 37, 0)}, 37, 10000, 0.75f), std::sqrt(0.5), 2e-3);
  EXPECT_NEAR(peak_of({instruction(square_root, 37, 0)}, 37, 10000, 0.49f), 0.0, 1e-9);
}

TEST(Machine, ReliefIsThePicture) {
  const Bank bank(loaded(example::program()));
  std::vector<glm::vec2> at;
  for (int i = 0; i < 300; ++i) at.push_back({static_cast<float>(i) * 1e-5f, 0});
  std::vector<float> heights(at.size());
  relief_all(bank, at, heights);
  for (std::size_t i = 0; i < at.size(); ++i) {
    // At y = 0 the table adds its first row near its first sample, whose height is 0.
    EXPECT_NEAR(heights[i], std::sin(2 * std::numbers::pi / 0.002 * at[i].x), 2e-3) << i;
  }
}

TEST(Machine, LoadSaysWhyNot) {
  auto bytes = write_patch_program(example::program());
  EXPECT_TRUE(Program::load(bytes));
  bytes[100] ^= std::byte{4};
  EXPECT_EQ(Program::load(bytes).error().sentence, "the file is damaged: its checksum does not match its bytes");
  EXPECT_EQ(Program::load(bytes).error().code, Code::damaged_file);
  PatchProgram unsafe = example::program();
  unsafe.outputs[0].ceiling = 37;
  unsafe.tick[5].b = 37;
  EXPECT_FALSE(Program::load(write_patch_program(unsafe)));
}

}  // namespace
}  // namespace wale::programs_test
