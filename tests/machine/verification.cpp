// One test for every rule of schema/PATCH_PROGRAM.md, "Verification", with programs that only this rule refuses.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "tests/machine/running.hpp"

namespace wale::verification_test {
namespace {

using enum Operation;
using example::instruction;
using example::refusal_of;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

/// Registers of `example::program()`: 32-35 constants, 36-37 parameters, 38-41 setup, 42 a state, 43-48 temporaries.
PatchProgram program() { return example::program(); }

std::string refusal_after(void (*change)(PatchProgram&)) {
  PatchProgram changed = program();
  change(changed);
  return refusal_of(changed);
}

TEST(Verification, AcceptsTheExamples) {
  EXPECT_EQ(refusal_of(program()), "");
  EXPECT_EQ(refusal_of(example::least()), "");
}

TEST(Verification, Operations) {
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[2].operation = 0; }),
            "tick 2 has operation number 0, which this Wale does not know");
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[2].operation = 200; }),
            "setup 2 has operation number 200, which this Wale does not know");
}

TEST(Verification, UnusedFieldsAreZero) {
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[1].b = 5; }),
            "tick 1 `cosine` has 5 for operand b, which it does not use, expected 0");
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[1].c = 1; }),
            "setup 1 `peak` has 1 for operand c, which it does not use, expected 0");
}

TEST(Verification, Destinations) {
  const auto sentence = [](std::string who, int destination, std::string section, int count, int first) {
    return who + " writes register " + std::to_string(destination) + ", but " + section + " may write only " +
           std::to_string(count) + " registers from " + std::to_string(first) + " on";
  };
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[0].destination = 43; }),
            sentence("setup 0 `divide`", 43, "setup", 4, 38));
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[0].destination = 33; }),
            sentence("setup 0 `divide`", 33, "setup", 4, 38));
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[0].destination = 40; }),
            sentence("tick 0 `multiply`", 40, "tick", 6, 43));
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[0].destination = 49; }),
            sentence("tick 0 `multiply`", 49, "tick", 6, 43));
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.code[0].destination = 41; }),
            sentence("picture 0 `multiply`", 41, "picture", 6, 43));
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].code[0].destination = 32; }),
            sentence("peak 0 0 `multiply`", 32, "peak 0", 6, 43));
  EXPECT_EQ(refusal_after([](auto& p) { p.percepts[0].prediction[0].destination = 7; }),
            sentence("percept 0 0 `multiply`", 7, "percept 0", 6, 43));
  EXPECT_EQ(
      refusal_after([](auto& p) { p.picture.code[2].destination = 47; }),
      "picture 2 `sample` writes register 47 and those after it, but picture may write only 6 registers from 43 on");
}

TEST(Verification, DefinitionsComeBeforeUse) {
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[0].b = 47; }),
            "tick 0 `multiply` reads register 47, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[0].b = 41; }),
            "setup 0 `divide` reads register 41, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[0].a = 49; }),
            "tick 0 `multiply` reads register 49, but the program has 49");
  // The picture may not read registers that the tick wrote.
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.code[0].a = 47; }),
            "picture 0 `multiply` reads register 47, which no earlier instruction writes");
  // The tick may not read registers that a peak wrote.
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[0].a = 46; }),
            "tick 0 `multiply` reads register 46, which no earlier instruction writes");
}

TEST(Verification, SetupDefinesAllItsRegisters) {
  EXPECT_EQ(refusal_after([](auto& p) {
              p.setup.pop_back();
              p.tick[3].b = 40;
            }),
            "setup leaves register 41 undefined");
}

TEST(Verification, PeaksReadSetupAsItIsWhenTheyRun) {
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].code[2].b = 40; }),
            "peak 0 2 `multiply` reads register 40, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].half_width = 41; }),
            "peak 0 takes the half width from register 41, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].half_height = 46; }),
            "peak 0 takes the half height from register 46, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].half_height = 0; }),
            "peak 0 takes the half height from input 0, which peak 0 does not have");
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].value = 48; }),
            "peak 0 takes the value from register 48, which no earlier instruction writes");
}

TEST(Verification, PeaksRunOnceAndInSetup) {
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[3] = instruction(peak, 41, 0); }),
            "setup 3 `peak` runs peak 0 a second time");
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[1] = instruction(add, 39, 32, 32); }),
            "no instruction of setup runs peak 0");
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[1].a = 1; }), "setup 1 `peak` runs peak 1, but the program has 1");
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[0] = instruction(peak, 43, 0); }),
            "tick 0 `peak` runs a peak, which only setup may do");
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].code[0] = instruction(peak, 43, 0); }),
            "peak 0 0 `peak` runs a peak, which only setup may do");
}

TEST(Verification, InputsBelongToSections) {
  // As schema/PATCH_PROGRAM.md lists them, by number.
  const std::set<RegisterNumber> patch = {4, 5, 6, 18}, place = {0, 1, 4, 5, 6, 18, 19, 20, 21},
                                 predicted = {4, 5, 6, 7, 18};
  const std::set<RegisterNumber> tick = {0, 1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21};
  const auto check = [](const std::string& section, const std::set<RegisterNumber>& legal, auto place_of) {
    for (RegisterNumber input = 0; input < first_constant; ++input) {
      PatchProgram p = program();
      place_of(p) = instruction(add, place_of(p).destination, input, input);
      const std::string refusal =
          section + " 0 `add` reads input " + std::to_string(input) + ", which " + section + " does not have";
      EXPECT_EQ(refusal_of(p), legal.contains(input) ? "" : refusal) << section << " " << input;
    }
  };
  check("setup", patch, [](PatchProgram& p) -> Instruction& { return p.setup[0]; });
  check("peak 0", place, [](PatchProgram& p) -> Instruction& { return p.peaks[0].code[0]; });
  check("enter", tick, [](PatchProgram& p) -> Instruction& { return p.enter[0]; });
  check("tick", tick, [](PatchProgram& p) -> Instruction& { return p.tick[0]; });
  check("picture", place, [](PatchProgram& p) -> Instruction& { return p.picture.code[0]; });
  check("frame", tick, [](PatchProgram& p) -> Instruction& { return p.picture.frame[0]; });
  check("percept 0", predicted, [](PatchProgram& p) -> Instruction& { return p.percepts[0].prediction[0]; });
}

TEST(Verification, Tables) {
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.code[2].c = 1; }),
            "picture 2 `sample` reads table 1, but the program has 1");
  EXPECT_EQ(refusal_after([](auto& p) {
              p.tables[0] = {1, 6, std::vector<std::uint16_t>(6)};
            }),
            "table 0's width is 1, expected 2 .. 16384");
  EXPECT_EQ(refusal_after([](auto& p) {
              p.tables[0] = {2, 16385, std::vector<std::uint16_t>(2 * 16385)};
            }),
            "table 0's height is 16385, expected 2 .. 16384");
  EXPECT_EQ(refusal_after([](auto& p) { p.tables[0].heights.pop_back(); }), "table 0 has 5 heights for 3 x 2");
}

TEST(Verification, Lattices) {
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].points = 0; }),
            "peak 0's number of points is 0, expected 1 .. 1048576");
  EXPECT_NE(refusal_after([](auto& p) { p.peaks[0].points = (1u << 20) + 1; }), "");
  for (const float percentile : {0.0f, -0.5f, 1.01f, nan}) {
    PatchProgram p = program();
    p.peaks[0].percentile = percentile;
    EXPECT_NE(refusal_of(p), "") << percentile;
  }
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].percentile = 1; }), "");
}

TEST(Verification, RegisterSpace) {
  PatchProgram p = example::least();
  p.temporaries = static_cast<std::uint16_t>(16384 - 34);
  EXPECT_EQ(refusal_of(p), "");
  ++p.temporaries;
  EXPECT_EQ(refusal_of(p), "the program has 16385 registers, expected at most 16384");
  p = example::least();
  p.constants.resize(70000);
  EXPECT_EQ(refusal_of(p), "the program has 70033 registers, expected at most 16384");
}

TEST(Verification, OutputsAreForceXAndForceYOnce) {
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs.pop_back(); }), "output force y occurs 0 times, expected once");
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs.clear(); }), "output force x occurs 0 times, expected once");
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs.push_back(p.outputs[0]); }),
            "output force x occurs 2 times, expected once");
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs[0].axis = 2; }), "an output is neither force x nor force y");
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs[0].quantity = OutputQuantity{2}; }),
            "an output is neither force x nor force y");
}

TEST(Verification, OutputsEndInTheirLimit) {
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs[0].value = 44; }),
            "output force x is written last by tick 1 `cosine`, expected a `limit`");
  EXPECT_EQ(refusal_after([](auto& p) { p.tick.push_back(instruction(add, 47, 47, 47)); }),
            "output force x is written last by tick 7 `add`, expected a `limit`");
  EXPECT_EQ(refusal_after([](auto& p) { p.tick.push_back(instruction(sample, 46, 0, 1, 0)); }),
            "output force x is written last by tick 7 `sample`, expected a `limit`");
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs[0].value = 46; }),
            "output force x is register 46, which tick does not write");
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs[0].value = 40; }),
            "output force x is register 40, which tick does not write");
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs[0].ceiling = 33; }),
            "output force x is limited by register 40 but declares register 33 as its ceiling");
}

TEST(Verification, CeilingsAreProved) {
  const auto unproved = [](int number) {
    return "output force x has register " + std::to_string(number) +
           " as its ceiling, expected a constant above 0 and up to 10 N, or a register that setup limits by such a "
           "constant";
  };
  const auto with_ceiling = [](RegisterNumber number) {
    PatchProgram p = program();
    p.tick[5].b = number;
    p.outputs[0].ceiling = number;
    return p;
  };
  EXPECT_EQ(refusal_of(with_ceiling(33)), "");
  EXPECT_EQ(refusal_of(with_ceiling(40)), "");
  EXPECT_EQ(refusal_of(with_ceiling(34)), unproved(34)) << "a constant of 0";
  EXPECT_EQ(refusal_of(with_ceiling(37)), unproved(37)) << "a parameter";
  EXPECT_EQ(refusal_of(with_ceiling(41)), unproved(41)) << "set up, but not limited";
  EXPECT_EQ(refusal_of(with_ceiling(45)), unproved(45)) << "a temporary";
  EXPECT_EQ(refusal_of(with_ceiling(4)), unproved(4)) << "an input";
  for (const float ceiling : {10.01f, -1.0f, nan, inf}) {
    PatchProgram p = program();
    p.constants[1] = ceiling;
    EXPECT_EQ(refusal_of(p), unproved(40)) << ceiling;
  }
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[2].b = 37; }), unproved(40)) << "limited by a parameter";
  EXPECT_EQ(refusal_after([](auto& p) { p.setup.push_back(instruction(add, 40, 40, 40)); }), unproved(40))
      << "overwritten after its limit";
  PatchProgram exactly = program();
  exactly.constants[1] = 10.0f;
  EXPECT_EQ(refusal_of(exactly), "");
}

TEST(Verification, Parameters) {
  EXPECT_EQ(refusal_after([](auto& p) { p.parameters[0].name.clear(); }), "parameter 0 has no name");
  EXPECT_EQ(refusal_after([](auto& p) { p.parameters[1].name = "period"; }),
            "parameter 1 is the second with the name period");
  EXPECT_EQ(refusal_after([](auto& p) { p.parameters[1].value = 5; }),
            "parameter amplitude has the value 5 and the range 0 .. 4, expected a value within a finite range");
  EXPECT_NE(refusal_after([](auto& p) { p.parameters[1].value = -1; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.parameters[1].value = nan; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.parameters[1].high = inf; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.parameters[1].low = -inf; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.parameters[1].low = nan; }), "");
  EXPECT_EQ(refusal_after([](auto& p) { p.parameters[1].unit_in_si = 0; }),
            "parameter amplitude has a unit of 0, expected more than 0");
  EXPECT_NE(refusal_after([](auto& p) { p.parameters[1].unit_in_si = std::nan(""); }), "");
}

TEST(Verification, Patch) {
  EXPECT_EQ(refusal_after([](auto& p) { p.patch_width = 0; }),
            "the patch's width is 0 m, expected more than 0 and at most the workspace's 0.2286 m");
  for (const float side : {-1.0f, 0.3f, nan, inf}) {
    PatchProgram p = program();
    p.patch_height = side;
    EXPECT_NE(refusal_of(p), "") << side;
  }
  EXPECT_EQ(refusal_after([](auto& p) { p.patch_rim = 0.04f; }),
            "the patch's rim is 0.04 m, expected 0 or more and less than 0.04 m, half of its smaller side");
  EXPECT_NE(refusal_after([](auto& p) { p.patch_rim = -0.001f; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.patch_rim = nan; }), "");
  EXPECT_EQ(refusal_after([](auto& p) { p.patch_rim = 0; }), "");
}

TEST(Verification, Device) {
  EXPECT_EQ(refusal_after([](auto& p) { p.device.rate = 20; }), "the device's rate (Hz) is 20, expected 100 .. 10 000");
  for (double DeviceProfile::*figure :
       {&DeviceProfile::workspace_diameter, &DeviceProfile::position_counts, &DeviceProfile::force_newton,
        &DeviceProfile::force_counts, &DeviceProfile::rate, &DeviceProfile::speed_limit}) {
    for (const double value : {0.0, -1.0, 1e12, std::nan("")}) {
      PatchProgram p = program();
      p.device.*figure = value;
      EXPECT_NE(refusal_of(p), "") << value;
    }
  }
  for (double DeviceProfile::*figure :
       {&DeviceProfile::slew, &DeviceProfile::continuous_newton, &DeviceProfile::heating_seconds,
        &DeviceProfile::active_watt, &DeviceProfile::velocity_window, &DeviceProfile::velocity_noise_counts,
        &DeviceProfile::patch_width, &DeviceProfile::patch_height, &DeviceProfile::patch_rim, &DeviceProfile::mass,
        &DeviceProfile::damping, &DeviceProfile::friction, &DeviceProfile::delay_x, &DeviceProfile::delay_y,
        &DeviceProfile::bandwidth_x, &DeviceProfile::bandwidth_y}) {
    for (const double value : {-1.0, 1e12, std::nan("")}) {
      PatchProgram p = program();
      p.device.*figure = value;
      EXPECT_NE(refusal_of(p), "") << value;
    }
  }
}

TEST(Verification, ADeviceHeatsAtSomePace) {
  EXPECT_EQ(refusal_after([](auto& p) { p.device.continuous_newton = p.device.force_newton + 1; }),
            "the device's continuous force (N) is 11, expected 0 .. 10");
  EXPECT_EQ(refusal_after([](auto& p) { p.device.heating_seconds = 0; }),
            "the device's time constant of heating (s) is 0, expected 0.001 .. 1 000 000");
  EXPECT_EQ(refusal_after([](auto& p) { p.device.continuous_newton = p.device.heating_seconds = 0; }), "");
}

TEST(Verification, Percepts) {
  EXPECT_EQ(refusal_after([](auto& p) { p.percepts[0].name.clear(); }), "percept 0 has no name");
  EXPECT_EQ(refusal_after([](auto& p) { p.percepts[0].parameter = 2; }),
            "percept 0 is set by parameter 2, but the program has 2");
  for (const RegisterNumber amplitude : {0, 4, 42, 43, 60}) {
    PatchProgram p = program();
    p.percepts[0].amplitude = amplitude;
    EXPECT_EQ(refusal_of(p), "percept 0 takes the amplitude from register " + std::to_string(amplitude) +
                                 ", expected a constant, a parameter or a setup register");
  }
  EXPECT_EQ(refusal_after([](auto& p) { p.percepts[0].level = 48; }),
            "percept 0 takes the level from register 48, which no earlier instruction writes");
  EXPECT_NE(refusal_after([](auto& p) { p.percepts[0].magnitude = 0; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.percepts[0].valid_low = 5; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.percepts[0].valid_low = -1; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.percepts[0].valid_high = inf; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.percepts[0].uncertainty.scatter = -1; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.percepts[0].uncertainty.noise = nan; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.percepts[0].handle = Evidence{0}; }), "");
}

TEST(Verification, PictureHasItsRelief) {
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.relief = 43 + 6; }),
            "picture takes the relief from register 49, but the program has 49");
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.code.clear(); }),
            "picture takes the relief from register 48, which no earlier instruction writes");
}

// At 900 Hz a quarter of the period is 277 777 units of a nanosecond.
TEST(Verification, TickFitsItsPeriod) {
  PatchProgram p = program();
  const auto fill = [](std::vector<Instruction>& code, long cost) {
    const long missing = cost - cost_of(code);
    code.insert(code.begin(), static_cast<std::size_t>(missing / 16), instruction(normal, 43, 4));
    code.insert(code.begin(), static_cast<std::size_t>(missing % 16), instruction(add, 43, 4, 4));
  };
  fill(p.tick, 277777);
  EXPECT_EQ(refusal_of(p), "");
  fill(p.tick, 277778);
  EXPECT_EQ(refusal_of(p), "tick costs 277778 units, expected at most 277777 in the device's period");
  p = program();
  fill(p.picture.code, 277778);
  EXPECT_EQ(refusal_of(p), "picture costs 277778 units, expected at most 277777 in the device's period");
  p = program();
  fill(p.percepts[0].prediction, 277778);
  EXPECT_EQ(refusal_of(p), "percept 0 costs 277778 units, expected at most 277777 in the device's period");
}

TEST(Verification, PeaksEndInTime) {
  PatchProgram p = program();
  p.peaks[0].points = 1u << 20;
  EXPECT_EQ(refusal_of(p), "");
  for (int i = 0; i < 60; ++i) p.peaks[0].code.insert(p.peaks[0].code.begin(), instruction(normal, 43, 4));
  EXPECT_EQ(refusal_of(p), "setup and its peaks cost 1019215882 units, expected at most 1000000000");
}

}  // namespace
}  // namespace wale::verification_test
