// Devices that only vibrate: the shipped materials on them, and the four fates of percepts and forces.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "tests/calibration/declared.hpp"

namespace wale::pads_test {
namespace {

using calibrating::bank_at;
using calibrating::Declared;
using calibrating::percept_index;

const FateRecord& fate(const Program& program, const std::string& name, bool percept) {
  for (const FateRecord& each : program.description().fates)
    if (each.name == name && each.percept == percept) return each;
  throw std::runtime_error("there is no fate of " + name);
}

/// The fates with their names, percepts first, such as "roughness approximated, force kept".
std::string fates(const Program& program) {
  std::string text;
  const char* words[] = {"", "kept", "approximated", "saturated", "lost"};
  for (const FateRecord& each : program.description().fates)
    text += (text.empty() ? "" : ", ") + each.name + " " + words[static_cast<int>(each.fate)];
  return text;
}

std::string corduroy() {
  std::ifstream file(WALE_SOURCE_DIR "/library/fabric/corduroy.wale");
  std::stringstream text;
  text << file.rdbuf();
  return text.str().substr(text.str().find("material"));
}

// touch_pad gives less at other frequencies than at its best: a percept that shakes at one of them is reduced to what
// the actuator gives there, in the program and in all that is said of it.
TEST(Pads, APerceptIsLimitedByWhatTheActuatorGivesAtItsFrequency) {
  Declared file("material m { perceptual { vibration 1 } }\n");
  const Program program = file.program("m", "touch_pad");
  const Shaker& shaker = *program.description().device.shaker;
  const Force drive = tick(*std::make_unique<Bank>(program), {.position = {0, 0}, .velocity = {0.1f, 0}});
  const double most = shaker.acceleration(1, drive.y);
  ASSERT_LT(most, shaker.peak()) << "the test needs a frequency at which the actuator is weaker";
  EXPECT_LE(drive.x, most * 1.001);
  const FateRecord& told = fate(program, "vibration", true);
  if (told.fate == Fate::saturated) {
    EXPECT_NEAR(drive.x, most, 0.01 * most);
    EXPECT_EQ(file.codes(), "W0403");
  }
}

// The level of `estimates.shaken_roughness` is (a / 12 m/s^2)^0.76. The frequency is speed / period, and below 20 mm/s
// the amplitude is proportional to the speed.
TEST(Pads, CorduroyShakesAsItsRibsPass) {
  Declared file(corduroy());
  const Program program = file.program("corduroy", "touch_pad");
  ASSERT_TRUE(program.description().vibrates());
  EXPECT_EQ(file.codes(), "");
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-0.03f, 0.03f), speed(-0.15f, 0.15f), level(0.05f, 1), wale(1e-3f, 5e-3f);
  for (int i = 0; i < 200; ++i) {
    const double asked = level(random), period = wale(random);
    Bank bank = bank_at(program, {{"roughness", asked}, {"wale", period}});
    const double amplitude = 12 * std::pow(asked, 1 / 0.76);
    for (int k = 0; k < 5; ++k) {
      const Hand hand{.position = {place(random), place(random)}, .velocity = {speed(random), speed(random)}};
      const double fast = std::hypot(hand.velocity.x, hand.velocity.y);
      const Force drive = tick(bank, hand);
      ASSERT_NEAR(drive.x, amplitude * std::min(1.0, fast / 0.02), 1e-4 * amplitude);
      ASSERT_NEAR(drive.y, std::min(fast / period, 300.0), 1e-4 * fast / period);
    }
    ASSERT_NEAR(predict(bank, percept_index(program, "roughness"), static_cast<float>(amplitude)).level, asked, 1e-5);
  }
}

TEST(Pads, WithoutAPositionTheHandExploresAtTheDeclaredSpeed) {
  Declared file(corduroy());
  const Program program = file.program("corduroy", "gamepad");
  Bank bank(program);
  for (const float speed : {0.0f, 0.3f}) {
    const Force drive = tick(bank, {.position = {speed, 0}, .velocity = {speed, 0}});
    EXPECT_NEAR(drive.x, 12 * std::pow(0.6, 1 / 0.76), 1e-3);
    EXPECT_NEAR(drive.y, 0.1 / 0.0025, 1e-3);
  }
  EXPECT_EQ(fates(program),
            "roughness approximated, lateral amplitude approximated, texture period kept, place of features lost");
  EXPECT_EQ(file.codes(), "W0415") << "the places are lost";
}

TEST(Pads, TheShippedOnesAreCompleteAndEstimated) {
  Declared declared("");
  for (const char* name : {"touch_pad", "gamepad"}) {
    const DeviceDeclaration& device = *declared.declarations().devices.find(name);
    ASSERT_TRUE(device.profile.shaker) << name;
    const Shaker& shaker = *device.profile.shaker;
    EXPECT_EQ(device.of_class, "vibrating_pad");
    EXPECT_EQ(shaker.command_steps, 255);
    EXPECT_GT(shaker.spin_up, 0);
    EXPECT_GE(shaker.response.size(), 3u);
    EXPECT_GT(shaker.peak(), 12) << "level 1 of roughness";
    EXPECT_FALSE(device.assumed.empty());
    EXPECT_FALSE(device.source.empty());
    EXPECT_EQ(device.profile.has_position(), std::string(name) == "touch_pad");
  }
}

TEST(Pads, EveryFigureIsAnEstimate) {
  Declared file(corduroy() + "\nmaterial buzz { perceptual { vibration 0.5 } }\n");
  for (const char* device : {"touch_pad", "gamepad"})
    for (const char* material : {"corduroy", "buzz"}) {
      const Program program = file.program(material, device);
      ASSERT_EQ(program.description().percepts.size(), 1u);
      const PerceptRecord& record = program.description().percepts[0];
      EXPECT_EQ(record.slope, Evidence::estimated);
      EXPECT_EQ(record.anchor, Evidence::estimated);
      EXPECT_EQ(record.handle, Evidence::estimated);
      EXPECT_EQ(record.extractor, Extractor::acceleration);
      EXPECT_EQ(record.unit, "m/s^2");
      EXPECT_TRUE(record.alone);
      EXPECT_EQ(record.one, 12);
    }
}

TEST(Pads, TheFourFatesOfAForceDevice) {
  Declared file(
      "material own { perceptual { roughness 0.5 } physical { force = lateral(grating(x, period: 2.5 mm)) } }\n"
      "material left { perceptual { roughness 0.5 } }\n"
      "material much { perceptual { springiness 0.9; viscosity 0.9; essential stickiness 0.9 } }\n"
      "material most { perceptual { stickiness 1 } }\n"
      "device weak { class force_plane; workspace disc(200 mm); position 4096 counts; force 0.5 N, 2048 counts\n"
      "  rate 900 Hz; speed 1 m/s; slew 200 N/s; velocity_filter 15, 1 counts; patch 100 mm, 100 mm, 5 mm }\n");
  EXPECT_EQ(fates(file.program("own")), "roughness kept, force kept");
  EXPECT_EQ(fates(file.program("own", "falcon")), "roughness approximated, force kept")
      << "the map was measured on another device";
  EXPECT_EQ(fates(file.program("left")), "roughness approximated") << "the device's own ridges";
  // A spring at 40 mm and oil at 0.25 m/s need more than the Falcon's 8 N, so the last percept gets the least.
  const Program reduced = file.program("much", "falcon");
  EXPECT_EQ(fate(reduced, "stickiness", true).fate, Fate::approximated) << "essential, so it comes first";
  const FateRecord& oil = fate(reduced, "viscosity", true);
  EXPECT_EQ(oil.fate, Fate::saturated);
  EXPECT_NEAR(oil.asked, 0.9, 1e-6);
  EXPECT_LT(oil.given, 0.6);
  // A percept that the device cannot reach alone gets the level of 0.5 N by its map.
  const Program weak = file.program("most", "weak");
  const FateRecord& sticky = fate(weak, "stickiness", true);
  EXPECT_EQ(sticky.fate, Fate::saturated);
  EXPECT_EQ(sticky.asked, 1);
  EXPECT_NEAR(sticky.given, predict(Bank(weak), 0, 0.5f).level, 1e-5);
}

TEST(Pads, ForcesThatAPadCannotRenderAreLost) {
  Declared file(
      "material mixed {\n"
      "  perceptual { roughness 0.5; springiness 0.3 }\n"
      "  physical   { force = lateral(grating(x, period: 3 mm)) + spring() + firm(500 N/m) + vector(0.1 N, 0 N) }\n"
      "}\n"
      "material wall { physical { force = firm(500 N/m) } }\n"
      "material oil { physical { force = viscous(5 N s/m) } }\n"
      "material needs { perceptual { roughness 0.5; essential springiness 0.3 } }\n");
  const Program mixed = file.program("mixed", "touch_pad");
  EXPECT_EQ(fates(mixed),
            "roughness approximated, springiness lost, lateral amplitude approximated, texture period kept, "
            "spring stiffness lost, firm stiffness lost, other forces lost, place of features approximated");
  EXPECT_EQ(file.codes(), "W0415 W0415") << "the percept, and the physics";
  // A wall becomes a program without vibration, and its fates say so.
  Bank wall(file.program("wall", "touch_pad"));
  EXPECT_EQ(tick(wall, {.position = {0.03f, 0}, .velocity = {0.2f, 0}}), Force(0));
  EXPECT_EQ(fates(wall.program()), "firm stiffness lost, place of features lost");
  EXPECT_EQ(fates(file.program("oil", "touch_pad")), "viscous viscosity lost") << "oil has no features";
  EXPECT_THROW(file.program("needs", "gamepad"), std::runtime_error) << "W0404";
}

// A force with a fixed amplitude gets the roughness of Minsky's figure 19 on the pad: (1.2 N / 194 pu)^0.759593.
TEST(Pads, AFixedForceIsRenderedByItsRoughness) {
  Declared file("material fixed { physical { force = lateral(grating(x, period: 2 mm), amplitude: 1.2 N) } }\n");
  const Program program = file.program("fixed", "touch_pad");
  const double level = std::pow(1.2 / (194 * 10.0 / 512), 0.759593);
  EXPECT_NEAR(fate(program, "roughness", true).asked, level, 1e-5);
  Bank bank(program);
  const Force drive = tick(bank, {.velocity = {0.1f, 0}});
  EXPECT_NEAR(drive.x, 12 * std::pow(level, 1 / 0.76), 1e-3);
  EXPECT_NEAR(drive.y, 50, 1e-3);
}

TEST(Pads, TwoPerceptsShareTheActuator) {
  Declared file("material both { perceptual { roughness 0.4; vibration 0.6 } }\n");
  const Program program = file.program("both", "touch_pad");
  const double rough = 12 * std::pow(0.4, 1 / 0.76), buzz = 12 * std::pow(0.6, 1 / 0.89);
  Bank bank(program);
  const Force moving = tick(bank, {.velocity = {0.1f, 0}}), resting = tick(bank, {});
  EXPECT_NEAR(moving.x, std::hypot(rough, buzz), 1e-3);
  EXPECT_EQ(moving.y, 120) << "the buzz is the stronger";
  EXPECT_NEAR(resting.x, buzz, 1e-3);
  for (const PerceptRecord& record : program.description().percepts) EXPECT_FALSE(record.alone);
}

// A gamepad renders ribs of 2.5 mm at 0.1 m/s with 40 Hz, where it gives 10 m/s^2: a third of the way from 8 m/s^2 at
// 30 Hz to 14 m/s^2 at 60 Hz. A vibration of 120 Hz has up to 15 m/s^2; so have both together, at the rate of the
// stronger.
TEST(Pads, SaturateAtTheLimitOfTheActuator) {
  Declared file(
      "material ribs { perceptual { roughness 1 } }\nmaterial soft { perceptual { roughness 0.5 } }\n"
      "material both { perceptual { roughness 0.8; vibration 1 } }\n");
  const FateRecord ribs = fate(file.program("ribs", "gamepad"), "roughness", true);
  EXPECT_EQ(ribs.fate, Fate::saturated);
  EXPECT_NEAR(ribs.given, std::pow(10.0 / 12, 0.76), 1e-5);
  EXPECT_EQ(fate(file.program("ribs", "touch_pad"), "roughness", true).fate, Fate::approximated) << "at some speeds";
  EXPECT_EQ(fate(file.program("soft", "gamepad"), "roughness", true).fate, Fate::approximated);
  const FateRecord buzz = fate(file.program("both", "gamepad"), "vibration", true);
  EXPECT_EQ(buzz.fate, Fate::saturated);
  EXPECT_NEAR(buzz.given, std::pow((15 - 12 * std::pow(0.8, 1 / 0.76)) / 12, 0.89), 1e-5);
}

TEST(Pads, DeclarationsThatDoNotFitAreReported) {
  const auto complaint = [](const std::string& text) {
    try {
      Declared file(text);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string pad =
      "position none; explores 0.1 m/s; frequency 40 Hz .. 200 Hz; rate 250 Hz; patch 80 mm, 60 mm, 3 mm\n";
  const std::string row = "acceleration 60 Hz, 100 % = 5 m/s^2\n";
  EXPECT_EQ(complaint("device p { class vibrating_pad\n" + row + pad + "}"), "");
  EXPECT_TRUE(contains(complaint("device p { class force_plane\n" + row + pad + "}"), "`p` vibrates"));
  EXPECT_TRUE(contains(complaint("device p { acceleration 60 Hz, 50 % = 5 m/s^2, 100 % = 4 m/s^2\n" + pad + "}"),
                       "all rising"));
  EXPECT_TRUE(contains(complaint("device p { acceleration 60 Hz, 100 % = 5 N\n" + pad + "}"), "expected acceleration"));
  EXPECT_TRUE(contains(complaint("device p { force 3 N, 100 counts\n" + row + pad + "}"), "no setting `force`"));
  EXPECT_EQ(complaint("device p { realise roughness = shaking, rate = speed\n" + row + pad +
                      "}\nmaterial m { perceptual { roughness 0.5 } }"),
            "")
      << "a realisation is checked when a material uses it";
}

TEST(Pads, TheDimensionsOfARealisationAreChecked) {
  const std::string device =
      "device p { acceleration 60 Hz, 100 % = 20 m/s^2; position none; explores 0.1 m/s\n"
      "  frequency 40 Hz .. 200 Hz; rate 250 Hz; patch 80 mm, 60 mm, 3 mm\n";
  const std::string material = "}\nmaterial m { perceptual { roughness 0.5; vibration 0.3 } }\n";
  const auto said = [&](const std::string& rule) {
    Declared file(device + rule + material);
    try {
      file.program("m", "p");
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("fine");
  };
  EXPECT_EQ(said("  realise roughness = shaking, rate = speed / period, period 2 mm\n"), "fine");
  EXPECT_NE(said("  realise roughness = shaking, rate = speed\n").find("expected frequency"), std::string::npos);
  EXPECT_NE(said("  realise roughness = 2 N, rate = 100 Hz\n").find("expected acceleration"), std::string::npos);
  // A realisation that needs the hand's place is lost on a device without a position.
  Declared blind(device + "  realise roughness = shaking * (0.5 + x / 1 m), rate = 100 Hz\n" + material);
  EXPECT_EQ(fate(blind.program("m", "p"), "roughness", true).fate, Fate::lost);
}

}  // namespace
}  // namespace wale::pads_test
