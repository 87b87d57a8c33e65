// Materials of the library that use the standard modules and each other.
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/standard/standard.hpp"

namespace wale::standard::showcases_test {
namespace {

double default_of(const Program& program, const std::string& name) {
  const auto index = program.parameter(name);
  if (!index) throw std::runtime_error("no parameter " + name);
  return program.default_parameters()[*index];
}

TEST(Showcases, DuckIsHalfWayFromCanvasToSailcloth) {
  const Program canvas = made("fabric.canvas", "canvas"), sailcloth = made("fabric.canvas", "sailcloth"),
                duck = made("fabric.canvas", "duck");
  for (const char* name : {"yarn", "roughness"})
    EXPECT_NEAR(default_of(duck, name), (default_of(canvas, name) + default_of(sailcloth, name)) / 2, 1e-6) << name;
  EXPECT_NEAR(default_of(sailcloth, "yarn"), 2.6e-3, 1e-9);
}

TEST(Showcases, WorkwearHasTheForceOfItsRoughness) {
  const Program workwear = made("fabric.workwear", "workwear");
  EXPECT_NEAR(amplitude(Bank(workwear), 0), 194 * 10.0 / 512 * std::pow(0.5, 1 / 0.759593),
              1e-3);  // Minsky 1995, figure 19
  EXPECT_TRUE(workwear.parameter("wale"));
  EXPECT_TRUE(workwear.parameter("yarn"));
}

TEST(Showcases, VelvetResistsAgainstTheNapAndIsSmooth) {
  // At roughness 0.02 the tufts push with at most 3.79 N * 0.02^1.3165 = 0.022 N.
  const Program velvet = material("import fabric.velvet\nmaterial m = velvet() { perceptual { roughness 0.02 } }", "m");
  Stroke stroke(velvet);
  stroke.line({0, 0.02}, 0.1);
  EXPECT_NEAR(stroke.force().y, -0.25, 0.025);
  stroke.line({0, -0.02}, 0.1);
  EXPECT_NEAR(stroke.force().y, 1, 0.025);
}

TEST(Showcases, ToothpasteHoldsUntilItYields) {
  Stroke stroke(made("fluid.toothpaste", "toothpaste"));
  stroke.line({0.003, 0}, 0.01);
  for (int i = 0; i < 900; ++i) stroke.move(stroke.place());
  EXPECT_NEAR(stroke.force().x, -0.003 * 250, 1e-3);
  stroke.line({0.04, 0}, 0.2);
  EXPECT_NEAR(stroke.force().x, -(0.9 + 3 * 0.2), 2e-3);
}

TEST(Page, ItsExampleCompilesAndItsTableIsComplete) {
  std::ifstream file(WALE_SOURCE_DIR "/library/std/README.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const auto begin = page.find("wale 1\n") + 7, end = page.find("```\n", begin);
  const std::string example = page.substr(begin, end - begin);
  for (const char* name : {"squeaky", "dry_canvas"}) EXPECT_NO_THROW(material(example, name)) << name;
  for (const auto& entry : std::filesystem::directory_iterator(WALE_SOURCE_DIR "/library/std")) {
    if (entry.path().extension() != ".wale") continue;
    std::ifstream module(entry.path());
    for (std::string line; std::getline(module, line);) {
      const bool function = line.starts_with("export function ");
      if (!function && !line.starts_with("material ")) continue;
      const auto from = line.find_last_of(' ', line.find_first_of(function ? "(" : "{") - 2) + 1;
      const std::string name = line.substr(from, line.find_first_of("( ", from) - from);
      EXPECT_NE(page.find("`" + name + "`"), std::string::npos) << entry.path() << " " << name;
    }
  }
}

}  // namespace
}  // namespace wale::standard::showcases_test
