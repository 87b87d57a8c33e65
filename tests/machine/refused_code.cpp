// A refusal shows the instructions that led to it, and their lines in the source when these are known.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/machine/running.hpp"

namespace wale::refused_code_test {
namespace {

using enum Operation;
using example::instruction;

Error refusal_after(void (*change)(PatchProgram&)) {
  PatchProgram changed = example::program();
  changed.places = {};
  change(changed);
  const Result<> verified = verify(changed);
  return verified ? Error{} : verified.error();
}

std::vector<std::string> lines_of(const Error& refusal) {
  std::vector<std::string> lines;
  for (const Place& each : refusal.led_to) {
    lines.push_back(each.name + " " + std::to_string(each.number.value()) + ": " + each.text);
  }
  return lines;
}

// Tick of the example: 43 = x * 38; 44 = cos 43; 45 = 44 * 38; 45 = 45 * 41; 45 = 34 - 45; 47 = limit 45 by 40.
TEST(RefusedCode, IsShownWithTheInstructionsOfItsOperands) {
  EXPECT_EQ(lines_of(refusal_after([](auto& p) { p.tick[5].b = 33; })),
            (std::vector<std::string>{"tick 1: r44 = cosine r43", "tick 2: r45 = multiply r44 r38",
                                      "tick 3: r45 = multiply r45 r41", "tick 4: r45 = subtract r34 r45",
                                      "tick 5: r47 = limit r45 r33"}));
  EXPECT_EQ(lines_of(refusal_after([](auto& p) { p.tick[2].b = 46; })),
            (std::vector<std::string>{"tick 0: r43 = multiply r0 r38", "tick 1: r44 = cosine r43",
                                      "tick 2: r45 = multiply r44 r46"}));
  EXPECT_EQ(lines_of(refusal_after([](auto& p) { p.tick[0].a = 46; })),
            std::vector<std::string>{"tick 0: r43 = multiply r46 r38"});
}

TEST(RefusedCode, NamesItsSection) {
  EXPECT_EQ(lines_of(refusal_after([](auto& p) { p.peaks[0].code[1].c = 7; })),
            (std::vector<std::string>{"peak 0 0: r43 = multiply r0 r38", "peak 0 1: r44 = cosine r43 7"}));
  EXPECT_EQ(lines_of(refusal_after([](auto& p) { p.picture.code[2].c = 9; })),
            std::vector<std::string>{"picture 2: r45 = sample r0 r1 9"});
  EXPECT_EQ(lines_of(refusal_after([](auto& p) { p.setup[2].operation = 200; })),
            std::vector<std::string>{"setup 2: r40 = operation 200 37 33"});
  // The fault lies in setup, which computes the ceiling: 40 = limit 37 by 36, and 36 is a parameter.
  EXPECT_EQ(lines_of(refusal_after([](auto& p) { p.setup[2].b = 36; })),
            std::vector<std::string>{"setup 2: r40 = limit r37 r36"});
}

TEST(RefusedCode, KnowsItsPlaceInTheSource) {
  // Places of setup, one peak, enter and tick. The tick's first instruction names file 1, which is not listed.
  const Error refusal = refusal_after([](auto& p) {
    p.tick[1].b = 5;
    p.places = {{"bench.wale"}, {{}, {}, {}, {{1, 1, 1}, {6, 0, 7}}}};
  });
  EXPECT_EQ(refusal.code, Code::refused_program);
  EXPECT_EQ(refusal.place.name, "tick");
  EXPECT_EQ(refusal.place.number, 1u);
  ASSERT_EQ(refusal.led_to.size(), 2u);
  EXPECT_EQ(refusal.led_to[0].source, "");
  EXPECT_EQ(refusal.led_to[1].source, "bench.wale:7");
  EXPECT_EQ(explained(refusal),
            "tick 1 `cosine` has 5 for operand b, which it does not use, expected 0\n"
            "  tick 0  r43 = multiply r0 r38\n"
            "  tick 1  r44 = cosine r43 5  (bench.wale:7)\n");
}

TEST(RefusedCode, IsEmptyWhereAFigureIsWrong) {
  EXPECT_TRUE(refusal_after([](auto& p) { p.device.rate = 20; }).led_to.empty());
  EXPECT_TRUE(refusal_after([](auto& p) { p.outputs.pop_back(); }).led_to.empty());
  EXPECT_EQ(explained({.sentence = "no"}), "no\n");
  EXPECT_EQ(explained({.sentence = "no", .mend = "say yes"}), "no; say yes\n");
}

// In long code whose instructions all depend on each other, only the last of the chain are shown.
TEST(RefusedCode, ShowsAFewInstructionsOnly) {
  PatchProgram p = example::program();
  p.tick.insert(p.tick.begin(), 100000, instruction(add, 43, 0, 0));
  for (std::size_t i = 1; i < 100000; ++i) p.tick[i] = instruction(add, 43, 43, 43);
  p.tick[100000].a = 43;
  p.tick[100000].c = 1;
  const auto verified = verify(p);
  ASSERT_FALSE(verified);
  const std::vector<Place>& led_to = verified.error().led_to;
  ASSERT_EQ(led_to.size(), shown_instructions);
  EXPECT_EQ(led_to.back().number, 100000u);
  EXPECT_EQ(led_to.front().number, 100000u - (shown_instructions - 1));
}

// The page states the limits of the code.
TEST(Documentation, VerificationHasTheFiguresOfTheCode) {
  std::ifstream file(WALE_SOURCE_DIR "/schema/PATCH_PROGRAM.md");
  std::string page{std::istreambuf_iterator<char>(file), {}};
  page = page.substr(page.find("## Verification"));
  const auto grouped = [](std::size_t number) {
    std::string digits = std::to_string(number);
    for (int at = static_cast<int>(digits.size()) - 3; at > 0 && number > 9999; at -= 3) digits.insert(at, " ");
    return digits;
  };
  for (const std::string& sentence :
       {"when it has more than " + grouped(register_limit) + ";",
        "when there are more than " + std::to_string(states_limit) + ",",
        "when there are more than " + std::to_string(grids_limit) + ",",
        "a side is not in 1 .. " + std::to_string(grid_side_limit) + ",",
        "all have more than " + grouped(cells_limit) + " cells together",
        "or there are more than " + std::to_string(writes_limit) + " writes",
        "when there are more than " + std::to_string(marks_limit) + ",",
        "when it has no points or more than " + grouped(peak_points_limit) + ",",
        "a side is not in " + std::to_string(table_side_least) + " .. " + grouped(table_side_most),
        std::string("costs more than a quarter of the device's period"), std::string("cost more than 1e9.")}) {
    EXPECT_NE(page.find(sentence), std::string::npos) << sentence;
  }
  EXPECT_EQ(tick_share_of_period, 0.25);
  EXPECT_EQ(setup_cost_limit, 1'000'000'000u);
}

}  // namespace
}  // namespace wale::refused_code_test
