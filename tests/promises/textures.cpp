// Promise 3 for textures of every sort. The compiler solves the amplitude for a level and keeps it while parameters
// change. The simulated hand rubs, and Minsky's regression, written independently here, converts the largest force of
// the actuator to the level, within one step of the device's force.

#include <glm/vec2.hpp>
#include <random>

#include "tests/promises/exploring.hpp"

namespace wale::promises::textures_test {
namespace {

// Minsky 1995, figure 19 and table 6.
constexpr double one_newton = 194 * 10.0 / 512, exponent = 0.759593;
double level_of(double newtons) { return std::pow(std::max(newtons, 0.0) / one_newton, exponent); }
double force_of(double level) { return one_newton * std::pow(level, 1 / exponent); }

/// The bytes of a PGM picture of 16 bits: grains of about 2 mm at 0.5 mm per pixel, within a fifth of the range, and
/// one pixel far above all others.
std::string photograph_with_a_spike() {
  constexpr int side = 176, grain = 4;
  std::mt19937 random(1995);
  std::vector<double> lattice((side / grain + 2) * (side / grain + 2));
  for (double& each : lattice) each = random() / 4294967296.0;
  std::string file = "P5\n" + std::to_string(side) + " " + std::to_string(side) + "\n65535\n";
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const auto corner = [&](int down, int right) {
        return lattice[static_cast<std::size_t>((row / grain + down) * (side / grain + 2) + column / grain + right)];
      };
      const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
      const double u = smooth(column % grain / double(grain)), v = smooth(row % grain / double(grain));
      const double value =
          (1 - v) * ((1 - u) * corner(0, 0) + u * corner(0, 1)) + v * ((1 - u) * corner(1, 0) + u * corner(1, 1));
      const bool spike = row == 100 && column == 92;
      const int code = spike ? 65535 : static_cast<int>(10000 + 13000 * value);
      file += static_cast<char>(code >> 8);
      file += static_cast<char>(code & 255);
    }
  return file;
}

struct Surface {
  const char* name;
  const char* physics;
  bool everywhere_alike = true;  ///< one line shows the whole texture; otherwise the hand covers the patch
};

/// Surfaces with two parameters each, which change the peak slope that `lateral` divides by.
const std::vector<Surface> surfaces = {
    {"grating",
     "param rib = 2.5 mm in 1.3 mm .. 5.3 mm\nparam duty = 0.5 in 0.35 .. 0.7\n"
     "force = lateral(grating(x, period: rib, duty: duty))"},
    {"sum of gratings",
     "param rib = 2.3 mm in 1.3 mm .. 3.7 mm\nparam across = 0.6 in 0 .. 1\n"
     "force = lateral(grating(x, period: rib) + across * grating(x + 0.3 * y, period: 5.9 mm))"},
    {"noise",
     "param grain = 2 mm in 1.5 mm .. 4 mm\nparam stretch = 1.5 in 1 .. 3\n"
     "force = lateral(noise2(x / grain, y / (stretch * grain)))",
     false},
    {"photograph",
     "param worn = 0.5 in 0.1 .. 1\nparam ribs = 0.05 mm in 0 mm .. 0.2 mm\n"
     "height face = worn * image(\"spiked.pgm\", scale: 0.5 mm/px, height: 1 mm)\n"
     "force = lateral(face + ribs * grating(x, period: 4.1 mm))",
     false},
};

/// Settings of the material's parameters: the defaults, and every corner of their ranges.
std::vector<std::map<std::string, float>> settings_of(const Program& program) {
  std::vector<std::map<std::string, float>> settings = {{}};
  std::vector<Parameter> own;
  for (const Parameter& each : program.description().parameters)
    if (each.name != "roughness") own.push_back(each);
  for (std::size_t corner = 0; corner < std::size_t{1} << own.size(); ++corner) {
    auto& setting = settings.emplace_back();
    for (std::size_t i = 0; i < own.size(); ++i)
      setting[own[i].name] = static_cast<float>(corner >> i & 1 ? own[i].high : own[i].low);
  }
  return settings;
}

TEST(Textures, HaveTheirLevelForAllParameters) {
  struct Run {
    const Surface* surface;
    Program program;
    std::map<std::string, float> setting;
    double level;
  };
  const std::string picture = photograph_with_a_spike();
  std::vector<Run> runs;
  for (const Surface& surface : surfaces)
    for (const DeviceProfile& device : force_devices()) {
      const Program program =
          compiled_for(device.name,
                       "material m {\nperceptual { roughness 0.6 }\nphysical {\npatch 80 mm, 80 mm\n" +
                           std::string(surface.physics) + "\n} }\n",
                       {{"spiked.pgm", picture}});
      for (const auto& setting : settings_of(program))
        for (const double level : {0.2, 0.6, 1.0}) runs.push_back({&surface, program, setting, level});
    }
  on_two_threads(runs.size(), [&](std::size_t i) {
    const Run& run = runs[i];
    auto set = run.setting;
    set["roughness"] = static_cast<float>(run.level);
    const DeviceProfile& device = run.program.description().device;
    const Motion motion = run.surface->everywhere_alike ? Motion(Lateral{34e-3, 1.1}) : line_by_line(32e-3, 12, 0.14);
    const std::vector<TickRecord> ticks = explored(run.program, motion, run.surface->everywhere_alike ? 3.5 : 6, set);
    const double size = force_of(run.level), step = device.force_step();
    const double felt = largest_force(ticks, run.program.default_size()).size;
    const double worth = std::max(level_of(size + step) - run.level, run.level - level_of(size - step));
    std::string setting;
    for (const auto& [name, value] : run.setting) setting += " " + name + " " + std::to_string(value);
    EXPECT_NEAR(level_of(felt), run.level, worth)
        << run.surface->name << " on " << device.name << setting << ": " << felt << " N for " << size;
  });
  EXPECT_EQ(runs.size(), surfaces.size() * force_devices().size() * 5 * 3);
}

}  // namespace
}  // namespace wale::promises::textures_test
