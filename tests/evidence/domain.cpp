// Whether a stimulus is one of those that a map was measured with: gratings of one dimension alone, for figure 19.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compiler/describe/describe.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/compiler/compiling.hpp"

namespace wale::domain_test {
namespace {

using std::numbers::pi;

DescribedPercept roughness(const std::string& physical, compiling::Files files = {}) {
  static const auto common = common_modules();
  const Program program = compiling::compiled(physical, "", "roughness 0.5", std::move(files));
  const Description description = describe(Bank(program), common->declarations);
  for (const DescribedPercept& each : description.percepts)
    if (each.name == "roughness") return each;
  throw std::runtime_error("no roughness");
}

struct Stimulus {
  const char* physical;
  const char* why;  ///< how it differs; empty for one that was measured
};

TEST(Domain, OfFigure19IsGratingsInOneDimensionAlone) {
  for (const Stimulus& each : {
           Stimulus{"force = lateral(grating(x, period: 2.5 mm))", ""},
           Stimulus{"force = lateral(grating(0.6 * x + 0.8 * y, period: 2.5 mm))", ""},
           Stimulus{"force = lateral(sin(2 * pi * x / 2.5 mm))", ""},
           Stimulus{"force = lateral(noise2(x / 2 mm, y / 2 mm))", "an irregular relief, measured with gratings"},
           Stimulus{"force = lateral(noise(x / 2 mm))", "an irregular relief, measured with gratings"},
           Stimulus{"force = lateral(sin(2 * pi * x / 2.5 mm) + sin(2 * pi * y / 2.5 mm))",
                    "in two dimensions, measured in one"},
           Stimulus{"force = lateral(grating(x, period: 2.5 mm)) + viscous(3 N s/m)",
                    "beside viscosity, measured alone"},
           Stimulus{"force = lateral(grating(x, period: 2.5 mm)) + sticky(0.5 N)", "beside friction, measured alone"},
       }) {
    const DescribedPercept found = roughness("    " + std::string(each.physical));
    EXPECT_EQ(found.domain_why, each.why) << each.physical;
    EXPECT_EQ(found.evidence(), std::string(each.why).empty() ? Evidence::measured : Evidence::extrapolated)
        << each.physical;
  }
}

TEST(Domain, OfNarrowRidgesIsNotThatOfASmoothedSquareWave) {
  const DescribedPercept found = roughness("    force = lateral(grating(x, period: 8 mm, duty: 0.1, smooth: 0.02))");
  EXPECT_NE(found.domain_why.find("a waveform with a crest of"), std::string::npos) << found.domain_why;
  EXPECT_EQ(found.evidence(), Evidence::extrapolated);
}

TEST(Domain, OfAPhotographIsExtrapolated) {
  constexpr int side = 320;
  std::string picture = "P5\n320 320\n65535\n";
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      // Ribs of 4 mm at 0.4 mm a pixel: to the hand it is a grating, and it is a photograph all the same.
      const auto code = static_cast<int>(std::lround(65535 * (0.5 + 0.5 * std::sin(2 * pi * column / 10))));
      picture += static_cast<char>(code >> 8);
      picture += static_cast<char>(code & 255);
    }
  compiling::Files files;
  files.contents["taken.pgm"] = picture;
  const DescribedPercept found = roughness(
      "    patch 120 mm, 120 mm\n    height face = image(\"taken.pgm\", scale: 0.4 mm/px, height: 1 mm)\n"
      "    force = lateral(face)",
      files);
  EXPECT_TRUE(found.domain_why.starts_with("a picture, measured with gratings")) << found.domain_why;
  EXPECT_EQ(found.domain, Evidence::extrapolated);
  EXPECT_EQ(found.evidence(), Evidence::extrapolated);
  EXPECT_NEAR(found.level, 0.5, 0.02);
}

TEST(Domain, IsReadFromTheMapsRecord) {
  const auto common = common_modules();
  for (const Map* map : common->declarations.maps()) {
    if (map->source.find("Minsky 1995") == std::string::npos || map->name.starts_with("estimates")) continue;
    EXPECT_TRUE(map->domain.stated) << map->name;
    EXPECT_EQ(map->domain.profiles, static_cast<int>(SurfaceProfile::grating)) << map->name;
    EXPECT_EQ(map->domain.dimensions, 1) << map->name;
    EXPECT_TRUE(map->domain.alone) << map->name;
    EXPECT_FALSE(map->quotes.empty()) << map->name;
  }
}

}  // namespace
}  // namespace wale::domain_test
