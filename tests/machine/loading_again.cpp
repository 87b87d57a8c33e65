// A program that loads writes bytes that load to the same program: also one with texts that a terminal would obey, and one
// that a program has put together.

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/machine/random_program.hpp"
#include "tests/schema/wpp_bytes.hpp"
#include "wale/program.hpp"

namespace wale::loading_again_test {
namespace {

using Bytes = std::vector<std::byte>;

/// Whether it loads; then what it writes must load, and be written the same.
bool loads_again(const Result<Program>& loaded) {
  if (!loaded) {
    EXPECT_FALSE(loaded.error().sentence.empty());
    return false;
  }
  const Bytes written = write_patch_program(loaded->description());
  const auto again = Program::load(written);
  EXPECT_TRUE(again) << in_words(again.error());
  if (!again) return true;
  EXPECT_TRUE(write_patch_program(again->description()) == written);
  return true;
}

PatchProgram with_all() {
  PatchProgram p = example::program();
  p.claims = {{"roughness", Evidence::estimated}};
  p.fates = {{"roughness", true, Fate::kept, 0.5f, 0.5f, ""}};
  for (PerceptRecord& percept : p.percepts) percept.basis.ranges = {{"speed", 0.01f, 0.1f, "m/s", 1, false}};
  return p;
}

std::vector<std::string*> texts_of(PatchProgram& p) {
  std::vector<std::string*> texts = {&p.material, &p.device.name, &p.layers.perceptual, &p.layers.physical,
                                     &p.layers.documentation};
  const auto take = [&](std::initializer_list<std::string*> some) { texts.insert(texts.end(), some); };
  for (auto& each : p.parameters) take({&each.name, &each.unit, &each.si_unit, &each.description});
  for (auto& each : p.states) take({&each.name, &each.si_unit});
  for (auto& each : p.grids) take({&each.name, &each.si_unit});
  for (auto& each : p.percepts) {
    take({&each.name, &each.carrier, &each.map, &each.device, &each.source, &each.unit, &each.weber_source,
          &each.realisation});
    for (auto& range : each.basis.ranges) take({&range.quantity, &range.unit});
  }
  for (auto& each : p.fates) take({&each.name, &each.reason});
  for (auto& each : p.claims) take({&each.percept});
  for (auto& each : p.places.files) take({&each});
  return texts;
}

TEST(LoadingAgain, HoldsForEveryTextOfAProgram) {
  const std::string obeyed = "a\x1b[31m\xff\xe2\x80\xae b\n\tc", zero("a\0b", 3);
  PatchProgram counted = with_all();
  const std::size_t all = texts_of(counted).size();
  ASSERT_GT(all, 30u);
  for (std::size_t i = 0; i < all; ++i) {
    SCOPED_TRACE(i);
    PatchProgram p = with_all();
    std::string& text = *texts_of(p)[i];
    text = obeyed;
    EXPECT_TRUE(loads_again(Program::load(p)));
    EXPECT_TRUE(loads_again(Program::load(write_patch_program(p))));
    const auto shown = Program::load(p);
    ASSERT_TRUE(shown);
    PatchProgram copy = shown->description();
    EXPECT_EQ(texts_of(copy)[i]->find('\x1b'), std::string::npos);
    text = zero;
    EXPECT_TRUE(loads_again(Program::load(p)) || !Program::load(write_patch_program(p)));
    if (i % 8 != 0) continue;  // long ones take long
    for (const char letter : {'z', '\x01'}) {  // \x01 takes six letters when it is shown
      text.assign(std::size_t{1} << 20, letter);
      EXPECT_EQ(loads_again(Program::load(p)), letter == 'z');
      EXPECT_EQ(loads_again(Program::load(write_patch_program(p))), letter == 'z');
    }
    text.assign((std::size_t{1} << 20) + 1, 'z');
    EXPECT_FALSE(loads_again(Program::load(p)));
  }
}

TEST(LoadingAgain, RefusesNamesThatAreShownTheSame) {
  PatchProgram p = with_all();
  ASSERT_GE(p.parameters.size(), 1u);
  p.parameters.push_back(p.parameters[0]);
  p.parameters.front().name = "\xff", p.parameters.back().name = "\xfe";
  const auto refused = Program::load(write_patch_program(p));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::refused_program);
}

/// Changes a program as one that puts it together by mistake.
void disturb(PatchProgram& p, std::mt19937& random) {
  const float figures[] = {0, -1, 1, 0.5f, 1e-45f, 3e38f, std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::quiet_NaN()};
  const auto figure = [&] { return figures[random() % std::size(figures)]; };
  const std::vector<std::string*> texts = texts_of(p);
  const std::string words[] = {"", "a", "\xff", "\x01", "wale", std::string("a\0b", 3), "\xfe", "a\nb"};
  const std::function<void()> changes[] = {
      [&] { *texts[random() % texts.size()] = words[random() % std::size(words)]; },
      [&] { p.constants[random() % p.constants.size()] = figure(); },
      [&] { p.setup_registers = static_cast<std::uint16_t>(p.setup_registers + random() % 3); },
      [&] { p.parameters[0].unit_in_si = figure(); },
      [&] { p.parameters[0].description = "x"; },
      [&] { p.patch_rim = figure(); },
      [&] { p.active_watt = figure(); },
      [&] { p.device.delay_x = figure(); },
      [&] { p.claims.push_back({"x", static_cast<Evidence>(random() % 9)}); },
      [&] { p.claims.clear(); },
      [&] { p.fates.push_back({"x", false, static_cast<Fate>(random() % 6), figure(), figure(), "y"}); },
      [&] { p.fates.clear(); },
      [&] { p.layers.representative.push_back({words[random() % 8], {words[random() % 8]}}); },
      [&] { p.layers = {}; },
      [&] { p.places = {}; },
      [&] { p.places.files.emplace_back("x"); },
      [&] { p.places.sections.resize(random() % 6); },
      [&] { p.percepts.clear(); },
      [&] { if (!p.percepts.empty()) p.percepts[0].slope = static_cast<Evidence>(random() % 9); },
      [&] { if (!p.percepts.empty()) p.percepts[0].extractor = static_cast<Extractor>(random() % 14); },
      [&] { if (!p.percepts.empty()) p.percepts[0].weber = figure(); },
      [&] { if (!p.percepts.empty()) p.percepts[0].period_low = figure(); },
      [&] { if (!p.percepts.empty()) p.percepts[0].basis.share = figure(); },
      [&] { if (!p.percepts.empty()) p.percepts[0].basis.domain.profiles = static_cast<std::uint8_t>(random() % 20); },
      [&] { if (!p.percepts.empty()) p.percepts[0].basis.domain.dimensions = static_cast<std::uint8_t>(random() % 4); },
      [&] { if (!p.percepts.empty()) p.percepts[0].basis.ranges.push_back({"x", figure(), figure(), "y", figure()}); },
      [&] { p.picture.marks.push_back({static_cast<MarkKind>(random() % 9), {}, static_cast<std::uint32_t>(random())}); },
      [&] { p.outputs[0].axis = static_cast<std::uint8_t>(random() % 4); },
      [&] { p.outputs[0].quantity = static_cast<OutputQuantity>(random() % 5); },
      [&] { p.tables.clear(); },
      [&] { if (!p.tables.empty()) p.tables[0].width = static_cast<std::uint32_t>(random() % 9); },
  };
  changes[random() % std::size(changes)]();
}

TEST(LoadingAgain, HoldsForWhatAProgramPutsTogether) {
  std::mt19937 random(5);
  int loaded = 0, refused = 0;
  for (int round = 0; round < 8000; ++round) {
    PatchProgram p = with_all();
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes) disturb(p, random);
    ++(loads_again(Program::load(std::move(p))) ? loaded : refused);
  }
  EXPECT_GT(loaded, 1000);
  EXPECT_GT(refused, 1000);
}

TEST(LoadingAgain, HoldsForFilesThatSomebodyChanged) {
  std::mt19937 random(6);
  PatchProgram p = with_all();
  p.peaks[0].points = 64;
  const wpp::Bytes original = write_patch_program(p);
  int loaded = 0;
  for (int round = 0; round < 8000; ++round) {
    wpp::Bytes bytes = original;
    for (unsigned changes = 1 + random() % 2; changes > 0; --changes)
      bytes[32 + random() % (bytes.size() - 32)] = static_cast<std::byte>(random());
    loaded += loads_again(Program::load(wpp::sealed(std::move(bytes))));
  }
  EXPECT_GT(loaded, 1000);
}

}  // namespace
}  // namespace wale::loading_again_test
