// The rules of schema/PATCH_PROGRAM.md, "Verification", for states, grids and pictures, one test each.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/machine/running.hpp"

namespace wale::verification_of_memory_test {
namespace {

using enum Operation;
using example::instruction;
using example::refusal_of;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

/// Registers of `example::program()`: 32-35 constants, 36-37 parameters, 38-41 setup, 42 a state, 43-48 temporaries, of
/// which enter defines 43, tick 43-45 and 47-48, picture 43-48, frame 43-46.
std::string refusal_after(void (*change)(PatchProgram&)) {
  PatchProgram changed = example::program();
  change(changed);
  return refusal_of(changed);
}

TEST(VerificationOfMemory, StatesReadInTickPictureAndFrameOnly) {
  const std::string sentence = " `multiply` reads register 42, which no earlier instruction writes";
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[0].a = 42; }), "");
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.code[0].a = 42; }), "");
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.frame[0].a = 42; }), "");
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[0].a = 42; }),
            "setup 0 `divide` reads register 42, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.enter[0] = instruction(multiply, 43, 42, 42); }), "enter 0" + sentence);
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].code[0].a = 42; }), "peak 0 0" + sentence);
  EXPECT_EQ(refusal_after([](auto& p) { p.percepts[0].prediction[0].a = 42; }), "percept 0 0" + sentence);
}

TEST(VerificationOfMemory, NoSectionWritesStates) {
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[0].destination = 42; }),
            "tick 0 `multiply` writes register 42, but tick may write only 6 registers from 43 on");
  EXPECT_EQ(refusal_after([](auto& p) { p.enter[0].destination = 42; }),
            "enter 0 `multiply` writes register 42, but enter may write only 6 registers from 43 on");
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[0].destination = 42; }),
            "setup 0 `divide` writes register 42, but setup may write only 4 registers from 38 on");
}

TEST(VerificationOfMemory, InitialValues) {
  for (const RegisterNumber initial : {0, 3, 4, 17, 18, 32, 36, 41, 43}) {
    PatchProgram p = example::program();
    p.states[0].initial = initial;
    EXPECT_EQ(refusal_of(p), "") << initial;
  }
  EXPECT_EQ(refusal_after([](auto& p) { p.states[0].initial = 44; }),
            "enter takes the initial value of state wear from register 44, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.states[0].initial = 42; }),
            "enter takes the initial value of state wear from register 42, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.states[0].initial = 7; }),
            "enter takes the initial value of state wear from input 7, which enter does not have");
  EXPECT_EQ(refusal_after([](auto& p) { p.states[0].initial = 49; }),
            "enter takes the initial value of state wear from register 49, but the program has 49");
}

TEST(VerificationOfMemory, NextValues) {
  for (const RegisterNumber next : {0, 16, 32, 37, 40, 42, 48}) {
    PatchProgram p = example::program();
    p.states[0].next = next;
    EXPECT_EQ(refusal_of(p), "") << next;
  }
  EXPECT_EQ(refusal_after([](auto& p) { p.states[0].next = 46; }),
            "tick takes the next value of state wear from register 46, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.states[0].next = 22; }),
            "tick takes the next value of state wear from input 22, which tick does not have");
}

TEST(VerificationOfMemory, StatesHaveNamesAndRanges) {
  EXPECT_EQ(refusal_after([](auto& p) { p.states[0].name.clear(); }), "state 0 has no name");
  PatchProgram p = example::program();
  p.states.push_back(p.states[0]);
  EXPECT_EQ(refusal_of(p), "state 1 is the second with the name wear");
  EXPECT_EQ(refusal_after([](auto& p) { p.states[0].low = 2; }),
            "state wear has the range 2 .. 1, expected a finite range in rising order");
  for (const float end : {nan, inf, -inf}) {
    PatchProgram low = example::program(), high = example::program();
    low.states[0].low = end;
    high.states[0].high = end;
    EXPECT_NE(refusal_of(low), "") << end;
    EXPECT_NE(refusal_of(high), "") << end;
  }
}

/// The smallest program with `count` states.
PatchProgram with_states(std::size_t count) {
  PatchProgram p = example::least();
  for (std::size_t i = 0; i < count; ++i) p.states.push_back({std::to_string(i), 0, 1, 32, 33});
  const unsigned temporary = p.first_temporary();
  p.tick = {instruction(limit, temporary, 32, 33)};
  for (Output& output : p.outputs) output.value = static_cast<RegisterNumber>(temporary);
  return p;
}

TEST(VerificationOfMemory, NumberOfStates) {
  EXPECT_EQ(refusal_of(with_states(512)), "");
  EXPECT_EQ(refusal_of(with_states(513)), "the program has 513 states, expected at most 512");
}

TEST(VerificationOfMemory, GridsAreForTickPictureAndFrame) {
  const auto sentence = [](const std::string& who) {
    return who + " reads a grid, which only tick, picture and frame may do";
  };
  EXPECT_EQ(refusal_after([](auto& p) { p.enter.push_back(instruction(cell, 43, 0, 0, 0)); }),
            sentence("enter 1 `cell`"));
  EXPECT_EQ(refusal_after([](auto& p) { p.setup[0] = instruction(cell, 38, 32, 32, 0); }), sentence("setup 0 `cell`"));
  EXPECT_EQ(refusal_after([](auto& p) { p.peaks[0].code[0] = instruction(recall, 43, 0, 0, 0); }),
            sentence("peak 0 0 `recall`"));
  EXPECT_EQ(refusal_after([](auto& p) { p.percepts[0].prediction[0] = instruction(recall, 43, 7, 7, 0); }),
            sentence("percept 0 0 `recall`"));
  EXPECT_EQ(refusal_after([](auto& p) { p.tick.insert(p.tick.begin(), instruction(recall, 43, 0, 1, 1)); }), "");
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.code.push_back(instruction(cell, 43, 0, 1, 1)); }), "");
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.frame[1].c = 2; }),
            "frame 1 `recall` reads grid 2, but the program has 2");
}

TEST(VerificationOfMemory, GridsMakeSense) {
  EXPECT_EQ(refusal_after([](auto& p) { p.grids[1].name.clear(); }), "grid 1 has no name");
  EXPECT_EQ(refusal_after([](auto& p) { p.grids[1].name = "trace"; }), "grid 1 is the second with the name trace");
  EXPECT_EQ(refusal_after([](auto& p) { p.grids[0].columns = 0; }),
            "grid trace's number of columns is 0, expected 1 .. 1024");
  EXPECT_EQ(refusal_after([](auto& p) { p.grids[0].rows = 1025; }),
            "grid trace's number of rows is 1025, expected 1 .. 1024");
  EXPECT_EQ(refusal_after([](auto& p) { p.grids[0].columns = p.grids[0].rows = 0xffffffff; }).substr(0, 10),
            "grid trace");
  EXPECT_EQ(refusal_after([](auto& p) { p.grids[0].initial = 1.5f; }),
            "grid trace begins at 1.5 and has the range 0 .. 1, expected a value within a finite range");
  EXPECT_NE(refusal_after([](auto& p) { p.grids[0].initial = nan; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.grids[0].low = -inf; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.grids[0].high = inf; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.grids[0].high = nan; }), "");
}

TEST(VerificationOfMemory, GridsAreBounded) {
  PatchProgram p = example::least();
  for (int i = 0; i < 16; ++i) p.grids.push_back({std::to_string(i), 256, 256, 0, 0, 0});
  EXPECT_EQ(refusal_of(p), "");
  p.grids[3].rows = 257;
  EXPECT_EQ(refusal_of(p), "the program has 1048832 cells in its grids, expected at most 1048576");
  p.grids.assign(17, {"", 1, 1, 0, 0, 0});
  EXPECT_EQ(refusal_of(p), "the program has 17 grids, expected at most 16");
}

TEST(VerificationOfMemory, WritesAreDefined) {
  EXPECT_EQ(refusal_after([](auto& p) { p.writes[1].grid = 2; }), "write 1 goes to grid 2, but the program has 2");
  EXPECT_EQ(refusal_after([](auto& p) { p.writes[0].u = 46; }),
            "tick takes the column of write 0 from register 46, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.writes[0].v = 22; }),
            "tick takes the row of write 0 from input 22, which tick does not have");
  EXPECT_EQ(refusal_after([](auto& p) { p.writes[0].value = 49; }),
            "tick takes the value of write 0 from register 49, but the program has 49");
  PatchProgram p = example::program();
  p.writes.assign(16, p.writes[0]);
  EXPECT_EQ(refusal_of(p), "");
  p.writes.push_back(p.writes[0]);
  EXPECT_EQ(refusal_of(p), "the program has 17 writes to grids, expected at most 16");
}

TEST(VerificationOfMemory, ColoursAreDefined) {
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.colour = std::array<RegisterNumber, 3>{0, 42, 18}; }), "");
  EXPECT_EQ(refusal_after([](auto& p) {
              p.picture.colour = std::array<RegisterNumber, 3>{32, 16, 32};
            }),
            "picture takes the colour from input 16, which picture does not have");
  EXPECT_EQ(refusal_after([](auto& p) {
              p.picture.code.pop_back();
              p.picture.relief = 43;
            }),
            "picture takes the colour from register 48, which no earlier instruction writes");
}

TEST(VerificationOfMemory, MarksAreDefined) {
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.marks[0].operands[2] = 47; }),
            "frame takes the operand 2 of mark 0 from register 47, which no earlier instruction writes");
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.marks[1].operands[4] = 7; }),
            "frame takes the operand 4 of mark 1 from input 7, which frame does not have");
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.marks[0].operands[3] = 32; }),
            "mark 0 has 3 operands; the others must be 0");
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.marks[2].colour = 0x1000000; }),
            "mark 2 has a colour above 0xffffff");
  EXPECT_EQ(refusal_after([](auto& p) { p.picture.marks[0].kind = MarkKind{0}; }),
            "mark 0 is of a kind that this Wale does not know");
  PatchProgram p = example::program();
  p.picture.marks.assign(1024, p.picture.marks[0]);
  EXPECT_EQ(refusal_of(p), "");
  p.picture.marks.push_back(p.picture.marks[0]);
  EXPECT_EQ(refusal_of(p), "the program has 1025 marks, expected at most 1024");
}

// At 900 Hz a quarter of the period is 277 777 units of a nanosecond.
TEST(VerificationOfMemory, EnterAndFrameFitThePeriod) {
  for (const bool frame : {false, true}) {
    PatchProgram p = example::program();
    std::vector<Instruction>& code = frame ? p.picture.frame : p.enter;
    code.insert(code.begin(), 277777 - static_cast<std::size_t>(cost_of(code)), instruction(add, 43, 4, 4));
    EXPECT_EQ(refusal_of(p), "");
    code.insert(code.begin(), instruction(add, 43, 4, 4));
    EXPECT_EQ(refusal_of(p), std::string(frame ? "frame" : "enter") +
                                 " costs 277778 units, expected at most 277777 in the device's period");
  }
}

TEST(VerificationOfMemory, UsualRangesLieWithinTheHardOnes) {
  for (const auto& [low, high] : {std::pair{-0.1f, 4.0f}, {0.0f, 4.1f}, {3.0f, 2.0f}, {nan, 2.0f}, {1.0f, nan}}) {
    PatchProgram p = example::program();
    p.parameters[1].soft_low = low;
    p.parameters[1].soft_high = high;
    EXPECT_NE(refusal_of(p), "") << low << " " << high;
  }
  EXPECT_EQ(refusal_after([](auto& p) { p.parameters[1].soft_high = 4.5f; }),
            "parameter amplitude has the usual range 0 .. 4.5, which is not a range within 0 .. 4");
  EXPECT_EQ(refusal_after([](auto& p) { p.parameters[1].soft_low = p.parameters[1].soft_high = 3; }), "")
      << "the default need not be usual";
}

}  // namespace
}  // namespace wale::verification_of_memory_test
