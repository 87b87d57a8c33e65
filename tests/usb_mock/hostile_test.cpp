// Files of somebody else, through the command line, on devices that are plugged in: patch programs whose device block
// lies, and materials and projects that declare the device themselves. The user allows 0.5 N. What the model's motors
// exert at the handle never exceeds it, and whoever is refused is told why.
//
// WALE_HOSTILE_FILES=N tries N files instead of 200.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "tests/usb/falcon_model.hpp"
#include "tests/usb_mock/running_wale.hpp"
#include "tests/usb_mock/usb_driver.hpp"
#include "tests/usb_mock/usb_mock.hpp"
#include "wale/library.hpp"
#include "wale/patch_program.hpp"

namespace wale::test::hostile {
namespace {

constexpr double allowed = 0.5;          // N, what the user allows
constexpr double openffboard_full = 20;  // N, as its shipped declaration says

/// What pushes as hard as a device can.
constexpr const char* strong = "material strong { physical { force = vector(8 N, 6 N) } }\n";

/// A figure as no honest file has it.
double odd_figure(std::mt19937& random, double honest) {
  const std::array<double, 14> odd{
      0,    -honest, 1e-3 * honest, 1e3 * honest, 2 * honest, 5e-324,       1e-310,
      1e-3, 1,       1e3,           1e9,          -0.0,       std::nan(""), std::numeric_limits<double>::infinity()};
  return odd[random() % odd.size()];
}

/// A patch program whose device block says something else than the device that it names.
std::string lying_program(std::mt19937& random, const PatchProgram& honest) {
  PatchProgram program = honest;
  DeviceProfile& device = program.device;
  const std::array figures{&device.force_newton,
                           &device.force_counts,
                           &device.rate,
                           &device.workspace_diameter,
                           &device.position_counts,
                           &device.speed_limit,
                           &device.slew,
                           &device.continuous_newton,
                           &device.heating_seconds,
                           &device.active_watt,
                           &device.velocity_window,
                           &device.velocity_noise_counts,
                           &device.mass,
                           &device.damping,
                           &device.delay_x};
  for (auto left = random() % 3 + 1; left > 0; --left) {
    double& figure = *figures[random() % figures.size()];
    figure = odd_figure(random, figure);
  }
  if (random() % 4 == 0) program.active_watt = static_cast<float>(odd_figure(random, 1));
  if (random() % 4 == 0 && !program.constants.empty()) {
    float& constant = program.constants[random() % program.constants.size()];
    constant = static_cast<float>(odd_figure(random, constant));
  }
  if (random() % 8 == 0) device.name = "sandpaper";
  const std::vector<std::byte> bytes = write_patch_program(program);
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (random() % 8 == 0) text[random() % text.size()] ^= static_cast<char>(1u << random() % 8);
  return text;
}

std::string pick(std::mt19937& random, std::initializer_list<const char*> texts) {
  return *(texts.begin() + static_cast<std::ptrdiff_t>(random() % texts.size()));
}

/// A declaration of the device that is plugged in, whose scale is a lie.
std::string lying_declaration(std::mt19937& random, const std::string& name, const std::string& numbers) {
  return "export device " + name + " {\n  usb " + pick(random, {"any", ("\"" + numbers + "\"").c_str()}) +
         "\n  class force_plane\n  axes " + pick(random, {"x, y", "y, -x", "-x, -y", "-y, x", "x, x"}) + "\n  motors " +
         pick(random, {"x, y", "-y, x", "-x, y"}) + "\n  gain " +
         pick(random, {"0.1", "0.1", "0.1, 10", "10", "10, 0.1", "unknown", "1e-9", "0/0"}) + "\n  workspace disc(" +
         pick(random, {"200 mm", "1 mm", "10 m", "0 mm"}) + ")\n  position " +
         pick(random, {"4096 counts", "2 counts", "1e9 counts"}) + "\n  force " +
         pick(random, {"0.001 N, 32767 counts", "1 mN, 1 counts", "1e-320 N, 32767 counts", "1e300 N, 1e300 counts",
                       "20 N, 32767 counts", "-20 N, 32767 counts"}) +
         "\n  rate " + pick(random, {"900 Hz", "100 Hz", "10 kHz", "1 Hz"}) + "\n  speed 1 m/s\n  slew " +
         pick(random, {"1e9 N/s", "200 N/s", "0 N/s"}) +
         "\n  velocity_filter 15, 1 counts\n  patch 120 mm, 120 mm, 5 mm\n}\n";
}

/// Writes a file and what stands beside it; gives the words behind `wale feel`.
std::string hostile_file(std::mt19937& random, const TemporaryFolder& folder, const PatchProgram& honest,
                         const std::string& numbers) {
  const std::string name = pick(random, {"hostile", "my_stick", honest.device.name.c_str()});
  const std::string device = " --device " + pick(random, {"auto", "usb", "1-1", numbers.c_str(), name.c_str()});
  const std::string declaration = lying_declaration(random, name, numbers);
  switch (random() % 4) {
    case 0: {
      folder.write("strong.wale", "wale 1\n" + declaration + strong);  // beside it, and never in its place
      return folder.write("strong.wpp", lying_program(random, honest)) + device;
    }
    case 1: return folder.write("strong.wale", "wale 1\n" + declaration + strong) + device;
    case 2: {
      folder.write("wale.project", "");
      folder.write("devices.wale", "wale 1\n" + declaration);
      return folder.write("cloth/strong.wale", std::string("wale 1\n") + strong) + device;
    }
    default: {
      folder.write("sticks.wale", "wale 1\n" + declaration);
      const std::string built_for = random() % 2 == 0 ? " --built-for " + name : "";
      return folder.write("strong.wale", std::string("wale 1\nimport sticks\n") + strong) + device + built_for;
    }
  }
}

long how_many() {
  const char* const wanted = std::getenv("WALE_HOSTILE_FILES");
  return wanted == nullptr ? 200 : std::atol(wanted);
}

/// Feels `count` files. `most_force` gives the largest force at the handle so far, in N.
void feel_all(unsigned seed, long count, const std::string& profile, const std::string& numbers,
              const std::function<double()>& most_force) {
  std::mt19937 random(seed);
  const TemporaryFolder source;
  const Library library;
  const auto honest = library.open(source.write("strong.wale", std::string("wale 1\n") + strong), {.device = profile});
  ASSERT_TRUE(honest) << in_words(honest.error());
  const test::Outcome honestly = run_wale("feel " + (source / "strong.wale") + " --seconds 1 --max-force '0.5 N'");
  ASSERT_EQ(honestly.status, 0) << honestly.err;
  ASSERT_GT(most_force(), 0.9 * allowed) << "an honest file reaches the limit\n" << honestly.err << honestly.out;
  long felt = 0, refused = 0;
  for (long i = 0; i < count; ++i) {
    const TemporaryFolder folder;
    const std::string file = hostile_file(random, folder, honest->program.description(), numbers);
    const test::Outcome run = run_wale("feel " + file + " --seconds 0.15 --max-force '0.5 N'");
    ASSERT_LE(most_force(), allowed * (1 + 1e-9)) << i << ": " << file << "\n" << run.err << run.out;
    ASSERT_LE(run.status, 2) << i << ": " << file << "\n" << run.err;
    ASSERT_TRUE(run.status == 0 || contains(run.err, "error[W")) << i << ": " << file << "\n" << run.err;
    ++(run.status == 0 ? felt : refused);
  }
  EXPECT_GT(felt, count / 50) << "some are honest enough";
  EXPECT_GT(refused, count / 10);
}

class Hostile : public testing::Test {
 protected:
  UsbMock mock_;
};

TEST_F(Hostile, NoFilePushesAPidStickHarderThanItsUserAllows) {
  PidModel model(openffboard());
  model.logs = model.moves = false;
  const auto stick = mock_.plug(std::move(model), 1);
  const auto most_force = [&] {
    return openffboard_full * stick->with_model([](PidModel& of) { return of.most_force; });
  };
  feel_all(1, how_many() * 3 / 4, "openffboard", "1209:ffb0", most_force);
}

TEST_F(Hostile, NoFilePushesAFalconHarderThanItsUserAllows) {
  const TemporaryFolder folder;
  setenv("WALE_FALCON_FIRMWARE", folder.write("firmware", std::string(100, 'x')).c_str(), 1);
  FalconModel model({}, true);
  model.logs = false;
  const auto falcon = mock_.plug(std::move(model), 1);
  const auto most_force = [&] { return falcon->with_model([](FalconModel& of) { return of.most_force; }); };
  feel_all(2, how_many() / 4, "falcon", "0403:cb48", most_force);
  unsetenv("WALE_FALCON_FIRMWARE");
}

/// The programs that were seen to push with all their might, one by one.
TEST_F(Hostile, ABlockThatSaysAMillinewtonIsRefusedWithBothFigures) {
  PidModel model(openffboard());
  model.logs = model.moves = false;
  const auto stick = mock_.plug(std::move(model), 1);
  const TemporaryFolder folder;
  const Library library;
  const auto honest =
      library.open(folder.write("strong.wale", std::string("wale 1\n") + strong), {.device = "openffboard"});
  ASSERT_TRUE(honest);
  PatchProgram program = honest->program.description();
  program.device.force_newton = 1e-3;
  for (float& constant : program.constants) constant = std::min(constant, 1e-3f);
  const auto bytes = write_patch_program(program);
  folder.write("strong.wpp", std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  const test::Outcome run = run_wale("feel " + (folder / "strong.wpp") + " --seconds 0.3 --max-force '0.5 N'");
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(contains(run.err, "error[W0608]")) << run.err;
  EXPECT_TRUE(contains(run.err, "force 0.001 N in the program, 20 N declared")) << run.err;
  EXPECT_EQ(stick->with_model([](PidModel& of) { return of.most_force; }), 0);
}

}  // namespace
}  // namespace wale::test::hostile
