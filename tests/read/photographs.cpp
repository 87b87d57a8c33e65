// Descriptions of pictures as reliefs, against pictures made of known waves.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "compiler/compile.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/modules/load_modules.hpp"

namespace wale::photographs_test {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int side = 320;
constexpr double pixel = 0.4;  // mm, so that the picture is 128 mm wide

/// The bytes of a PGM picture of 16 bits. `height` gives 0 .. 1 at a place in mm from the upper left corner, y down.
std::string picture(const std::function<double(double, double)>& height) {
  std::string file = "P5\n" + std::to_string(side) + " " + std::to_string(side) + "\n65535\n";
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const auto code = static_cast<int>(std::lround(65535 * height(pixel * column, pixel * row)));
      file += static_cast<char>(code >> 8);
      file += static_cast<char>(code & 255);
    }
  return file;
}

class OnePicture final : public Resolver {
 public:
  explicit OnePicture(std::string bytes) : bytes_(std::move(bytes)) {}
  Result<ResolvedFile> module(const std::string&, const std::string&) override {
    return Error{Code::unreadable_file, "no such file"};
  }
  Result<ResolvedFile> file(const std::string& name, const std::string&) override { return ResolvedFile{name, bytes_}; }

 private:
  std::string bytes_;
};

/// The description of a material whose relief is the picture, 1 mm high.
Description described(const std::string& bytes, const std::string& force = "lateral(face, amplitude: 1 N)",
                      const std::string& perceptual = "") {
  static const auto common = common_modules();
  SourceSet sources;
  Diagnostics diagnostics;
  OnePicture resolver(bytes);
  const SourceId source =
      sources.add("test.wale", "wale 1\nmaterial photograph {\n" + perceptual +
                                   "\nphysical {\npatch 120 mm, 120 mm\n"
                                   "height face = image(\"taken.pgm\", scale: 0.4 mm/px, height: 1 mm)\n"
                                   "force = " +
                                   force + "\n} }\n");
  const auto program = compile(sources, source, "", default_device, resolver, diagnostics);
  if (!program) throw std::runtime_error(render_text(diagnostics.all().front(), sources, false));
  return describe(Bank(*program), common->declarations);
}

/// Ribs of one period (mm) that change along the direction `degrees` from x, counterclockwise on the patch, where y
/// goes up.
double ribs(double x, double y, double period, double degrees) {
  const double angle = degrees * pi / 180;
  return std::sin(2 * pi * (x * std::cos(angle) - y * std::sin(angle)) / period);
}

TEST(Photographs, ACorduroyHasItsPeriodItsAngleAndOneDirection) {
  const Description description =
      described(picture([](double x, double y) { return 0.5 + 0.4 * ribs(x, y, 3.2, 30); }));
  const Relief& force = description.texture->force;
  EXPECT_NEAR(force.amplitude, 1, 0.04);
  EXPECT_NEAR(force.period, 3.2e-3, 0.05e-3);
  EXPECT_NEAR(force.orientation, 30 * pi / 180, 0.03);
  EXPECT_GT(force.anisotropy, 0.95);
  EXPECT_GT(force.regularity, 0.95);
  ASSERT_EQ(force.waves.size(), 1u);
  EXPECT_GT(force.waves[0].share, 0.9);
  EXPECT_EQ(description.texture->kind, "grating");
}

TEST(Photographs, ANoiseHasNoDirectionAndDoesNotComeBack) {
  // A sum of many waves of all directions with periods about 2.5 mm.
  std::mt19937 random(7);
  struct Wave {
    double period, degrees, phase;
  };
  std::vector<Wave> waves(120);
  for (Wave& wave : waves)
    wave = {2.5 * std::exp(0.8 * (random() / 4294967296.0 - 0.5)), 360 * (random() / 4294967296.0),
            2 * pi * (random() / 4294967296.0)};
  const Description description = described(picture([&](double x, double y) {
    double sum = 0;
    for (const Wave& wave : waves) {
      const double angle = wave.degrees * pi / 180;
      sum += std::sin(2 * pi * (x * std::cos(angle) + y * std::sin(angle)) / wave.period + wave.phase);
    }
    return std::clamp(0.5 + 0.012 * sum, 0.0, 1.0);
  }));
  const Relief& force = description.texture->force;
  EXPECT_LT(force.anisotropy, 0.3);
  EXPECT_LT(force.regularity, 0.5);
  EXPECT_GT(force.period, 1.5e-3);
  EXPECT_LT(force.period, 4e-3);
  EXPECT_EQ(description.texture->kind, "irregular") << "a narrow band of periods, which no lattice makes";
  EXPECT_EQ(description.texture->confidence, "");
}

TEST(Photographs, OfTwoPeriodsHaveBothWithTheirShares) {
  // Slopes are proportional to height over period, 0.3 / 6 and 0.05 / 2: the coarse waves are twice as steep.
  const Description description =
      described(picture([](double x, double y) { return 0.5 + 0.3 * ribs(x, y, 6, 0) + 0.05 * ribs(x, y, 2, 90); }));
  const Relief& force = description.texture->force;
  ASSERT_EQ(force.waves.size(), 2u);
  EXPECT_NEAR(force.waves[0].period, 6e-3, 0.12e-3);
  EXPECT_NEAR(std::sin(force.waves[0].orientation), 0, 0.03);
  EXPECT_NEAR(force.waves[1].period, 2e-3, 0.04e-3);
  EXPECT_NEAR(force.waves[1].orientation, pi / 2, 0.03);
  // Shares are of the mean square: 2^2 to 1.
  EXPECT_NEAR(force.waves[0].share, 0.8, 0.03);
  EXPECT_NEAR(force.waves[1].share, 0.2, 0.03);
  EXPECT_NEAR(force.anisotropy, 0.6, 0.05);  // 0.8 along one direction minus 0.2 across it
  EXPECT_GT(force.regularity, 0.9);
}

TEST(Photographs, AreRescaledByARoughness) {
  const std::string taken = picture([](double x, double y) { return 0.5 + 0.2 * ribs(x, y, 3.2, 30); });
  const Description plain = described(taken, "lateral(face, amplitude: 3 N)");
  const Description rescaled = described(taken, "lateral(face)", "perceptual { roughness 0.5 }");
  // Minsky 1995, figure 19: level = (F / 194 pu)^0.759593.
  const double newton = 194 * 10.0 / 512 * std::pow(0.5, 1 / 0.759593);
  ASSERT_EQ(rescaled.percepts.size(), 1u);
  EXPECT_NEAR(rescaled.percepts[0].level, 0.5, 1e-4);
  EXPECT_NEAR(rescaled.texture->force.amplitude, newton, 0.04 * newton);
  EXPECT_NEAR(plain.texture->force.amplitude, 3, 0.12);
  EXPECT_NEAR(rescaled.texture->force.period, plain.texture->force.period, 1e-6);
  EXPECT_NEAR(plain.percepts.at(0).level, std::pow(3 / (194 * 10.0 / 512), 0.759593), 0.03);
}

TEST(Photographs, ThePeriodsAndTheAnisotropyAreInTheTextAndInTheJson) {
  const Description description =
      described(picture([](double x, double y) { return 0.5 + 0.3 * ribs(x, y, 6, 0) + 0.05 * ribs(x, y, 2, 90); }));
  const std::string text = description_text(description);
  EXPECT_NE(text.find("anisotropy 0.6, changes along the direction 0 degrees from x"), std::string::npos) << text;
  EXPECT_NE(text.find("80 % of it has a period of 6 mm along 0 degrees"), std::string::npos) << text;
  EXPECT_NE(text.find("20 % of it has a period of 2 mm along 90 degrees"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(descriptions_json({description})).at("texture");
  EXPECT_NEAR(json.at("anisotropy").get<double>(), 0.6, 0.05);
  ASSERT_EQ(json.at("waves").size(), 2u);
  EXPECT_NEAR(json.at("waves").at(1).at("period_m").get<double>(), 2e-3, 0.04e-3);
  EXPECT_NEAR(json.at("waves").at(1).at("orientation_rad").get<double>(), pi / 2, 0.03);
  EXPECT_NEAR(json.at("waves").at(1).at("share").get<double>(), 0.2, 0.03);
}

}  // namespace
}  // namespace wale::photographs_test
