// Watching a file while it is felt: every way of saving it, and files with errors.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "calibration/feel/material_watch.hpp"
#include "compiler/open_file.hpp"
#include "tests/temporary_folder.hpp"
#include "wale/simulated.hpp"

namespace wale::watching_test {
namespace {

namespace fs = std::filesystem;
using Outcome = MaterialWatch::Outcome;

/// A time limit for changes that must be noticed. A passing test does not wait that long.
constexpr std::chrono::seconds long_enough{60};
/// The waiting time where no change may be noticed. The test cannot fail because the machine is slow.
constexpr std::chrono::milliseconds short_while{40};

/// Writes another file in the folder and renames it, as most editors do.
void write_and_rename(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  const std::string beside = folder.write("." + name + ".swp", text);
  fs::rename(beside, folder / name);
}

std::string pushing(double newton, const std::string& more = {}) {
  return "wale 1\nmaterial m {\n  physical {\n    param push = " + std::to_string(newton) +
         " N in -5 N .. 5 N\n    force = vector(push, 0 N)\n" + more + "  }\n}\n";
}

/// A stage with the program of a file, and the watch of that file.
struct Watched {
  explicit Watched(const std::string& file, const std::vector<std::string>& settings = {})
      : program(compiled(file)),
        joystick(program.description().device, {.mass = 0.55, .damping = 6.5, .stiffness = 135}, Rest{}),
        stage(joystick),
        patch(*stage.add(program)),
        watch({.file = file}, patch, program, settings, [this](const std::string& text) { said += text; }) {
    EXPECT_EQ(watch.attend(short_while), Outcome::nothing);
  }

  static Program compiled(const std::string& file) {
    const FileRequest request{.file = file};
    OpenedFile opened = *open_file(request);
    const auto program = compile_opened(opened, request, "", opened.diagnostics);
    if (!program) throw std::runtime_error("does not compile: " + file);
    return *program;
  }

  /// The value of the first parameter of the active program, in N.
  float felt() const { return patch.bank()->registers()[program.description().first_parameter()]; }
  std::string take_said() { return std::exchange(said, {}); }

  Program program;
  SimulatedJoystick joystick;
  Stage stage;
  Patch patch;
  std::string said;
  MaterialWatch watch;
};

TEST(Watching, EveryWayOfSavingActivatesTheNewVersion) {
  const TemporaryFolder folder;
  Watched watched(folder.write("m.wale", pushing(1)));
  EXPECT_EQ(watched.felt(), 1);
  folder.write("m.wale", pushing(2));
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::replaced);
  EXPECT_EQ(watched.felt(), 2);
  EXPECT_EQ(watched.take_said(), "wale: the new version of `m` is active\n");
  write_and_rename(folder, "m.wale", pushing(3));
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::replaced);
  EXPECT_EQ(watched.felt(), 3);
  fs::remove(folder / "m.wale");
  folder.write("m.wale", pushing(4));
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::replaced);
  EXPECT_EQ(watched.felt(), 4);
  fs::remove(folder / "m.wale");
  fs::create_symlink(folder.write("other.wale", pushing(5)), folder / "link.wale");
  fs::rename(folder / "link.wale", folder / "m.wale");
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::replaced);
  EXPECT_EQ(watched.felt(), 5);
  folder.write("other.wale", pushing(0.5));
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::replaced) << "the target of the link changed";
  EXPECT_EQ(watched.felt(), 0.5);
}

TEST(Watching, WhatWasSetHoldsForEveryVersionOrThePersonIsTold) {
  const TemporaryFolder folder;
  const auto with = [](const std::string& parameter, double more) {
    return "wale 1\nmaterial m {\n  physical {\n    " + parameter + "\n    force = vector(" +
           (parameter.empty() ? "" : "f + ") + std::to_string(more) + " N, 0 N)\n  }\n}\n";
  };
  const std::string active = "wale: the new version of `m` is active\n";
  Watched watched(folder.write("m.wale", with("param f = 1 N in 0 N .. 5 N", 0)), {"f=2 N"});
  ASSERT_TRUE(watched.patch.set("f", 2.0f));
  const auto save = [&](const std::string& text) {
    folder.write("m.wale", text);
    EXPECT_EQ(watched.watch.attend(long_enough), Outcome::replaced) << watched.said;
    return watched.take_said();
  };
  EXPECT_EQ(save(with("param f = 1 N in 0 N .. 1.5 N", 0)),
            "wale: `--set f=2 N` is outside 0 .. 1.5 N now: 1.5 N is used\n" + active);
  EXPECT_EQ(watched.felt(), 1.5);
  EXPECT_EQ(save(with("param f = 1 N in 0 N .. 1.5 N", 0.25)), active) << "it is told once";
  EXPECT_EQ(save(with("param f = 1000 mN in 0 mN .. 1500 mN", 0)),
            "wale: `--set f=2 N` is outside 0 .. 1500 mN now: 1500 mN is used\n" + active);
  EXPECT_EQ(save(with("", 1)), "wale: `f` is gone: `--set f=2 N` has no effect\n" + active);
  EXPECT_EQ(save(with("param f = 1 N in 0 N .. 5 N", 0)), active) << "it is back, and the setting holds again";
  EXPECT_EQ(watched.felt(), 2);
  const std::string said = save(
      "wale 1\nmaterial m {\n  physical {\n    param f = 1 mm in 0 mm .. 5 mm\n"
      "    force = vector(f * 1 N/mm, 0 N)\n  }\n}\n");
  EXPECT_TRUE(said.starts_with("wale: `--set f=2 N` does not fit `f` now: ") && said.ends_with(active)) << said;
}

TEST(Watching, OtherFilesAndUnchangedTextChangeNothing) {
  const TemporaryFolder folder;
  Watched watched(folder.write("m.wale", pushing(1)));
  folder.write("another.wale", pushing(2));
  folder.write("m.wale~", pushing(2));
  EXPECT_EQ(watched.watch.attend(short_while), Outcome::nothing);
  folder.write("m.wale", pushing(1));
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::nothing);
  EXPECT_EQ(watched.said, "");
}

TEST(Watching, ErrorsKeepTheOldVersionAndAreReportedOnce) {
  const TemporaryFolder folder;
  Watched watched(folder.write("m.wale", pushing(1)));
  folder.write("m.wale", "wale 1\nmaterial m {\n  physical {\n    force = 3 m\n  }\n}\n");
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::refused);
  EXPECT_EQ(watched.felt(), 1);
  const std::string said = watched.take_said();
  EXPECT_NE(said.find("error[W0301]"), std::string::npos) << said;
  EXPECT_NE(said.find("m.wale:4"), std::string::npos) << said;
  EXPECT_TRUE(said.ends_with("wale: the previous version stays active\n")) << said;
  folder.write("m.wale", "wale 1\nmaterial m {\n  physical {\n    force = 3 m\n  }\n}\n");
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::refused);
  EXPECT_EQ(watched.take_said(), "") << "the errors are the same";
  fs::remove(folder / "m.wale");
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::refused);
  EXPECT_NE(watched.take_said().find("no such file"), std::string::npos);
  folder.write("m.wale", pushing(1));
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::nothing);
  EXPECT_EQ(watched.take_said(), "wale: this version of `m` is active already\n");
  folder.write("m.wale", pushing(2));
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::replaced);
  EXPECT_EQ(watched.felt(), 2);
}

TEST(Watching, ImportsAreWatchedTooEvenBeforeTheyExist) {
  const TemporaryFolder folder;
  folder.write("strength.wale", "wale 1\nexport let strength = 1 N\n");
  const std::string text =
      "wale 1\nimport strength\nmaterial m {\n  physical {\n    param push = strength in -5 N .. 5 N\n"
      "    force = vector(push, 0 N)\n  }\n}\n";
  Watched watched(folder.write("m.wale", text));
  write_and_rename(folder, "strength.wale", "wale 1\nexport let strength = 2 N\n");
  ASSERT_EQ(watched.watch.attend(long_enough), Outcome::replaced) << watched.said;
  EXPECT_EQ(watched.felt(), 2);
  std::string other = text;
  for (std::size_t at = 0; (at = other.find("strength", at)) != std::string::npos; at += 7)
    other.replace(at, 8, "vigours");
  folder.write("m.wale", other);
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::refused);
  folder.write("vigours.wale", "wale 1\nexport let vigours = 3 N\n");
  ASSERT_EQ(watched.watch.attend(long_enough), Outcome::replaced) << watched.said;
  EXPECT_EQ(watched.felt(), 3);
}

TEST(Watching, ANewVersionIsActiveInTheNextTickAndKeepsStatesAndParameters) {
  const TemporaryFolder folder;
  const auto counting = [](const std::string& gain, const std::string& more, const std::string& state) {
    return "wale 1\nmaterial m {\n  physical {\n    param gain = " + gain + " in 0 N/s .. 5 N/s\n" + more +
           "    state " + state + "\n    force = vector(gain * t, 0 N)\n    active 5 W\n  }\n}\n";
  };
  const std::string seconds = "t : time = 0 s in 0 s .. 100 s\n    t' = 1";
  Watched watched(folder.write("m.wale", counting("0.5 N/s", "", seconds)));
  ASSERT_TRUE(watched.patch.set("gain", 0.25f));
  const auto save = [&](const Now& now) {
    if (now.ticks_run == 900) {  // a further parameter, and another default of the one that was set
      write_and_rename(folder, "m.wale", counting("0.75 N/s", "    param more = 2 mm in 0 mm .. 5 mm\n", seconds));
      EXPECT_EQ(watched.watch.attend(long_enough), Outcome::replaced) << watched.said;
    }
    if (now.ticks_run == 1800) {  // the state has another dimension
      folder.write("m.wale", counting("0.75 N/s", "",
                                      "u : length = 0 m in 0 m .. 100 m\n    u' = 1 m/s\n    let t = u / (1 m/s)"));
      EXPECT_EQ(watched.watch.attend(long_enough), Outcome::replaced) << watched.said;
    }
  };
  const auto result = watched.stage.run({.seconds = 3, .virtual_time = true, .progress = save});
  ASSERT_TRUE(result);
  const auto& ticks = result->record.ticks;
  const double step = 10.0 / 2048;  // of the force
  EXPECT_NEAR(ticks[899].force.x, 0.25 * 899 / 900, step);
  EXPECT_NEAR(ticks[900].force.x, 0.25 * 900 / 900, step) << "the state and the parameter are kept";
  EXPECT_NEAR(ticks[1799].force.x, 0.25 * 1799 / 900, step);
  EXPECT_NEAR(ticks[1810].force.x, 0.25 * 10 / 900, 0.05) << "the state begins anew; the force slews";
  EXPECT_NEAR(ticks[2699].force.x, 0.25 * 899 / 900, step);
}

TEST(Watching, AProgramForAnotherDeviceIsRefused) {
  const TemporaryFolder folder;
  const std::string file = folder.write("m.wale", pushing(1));
  const FileRequest falcon{.file = file, .device = "falcon"};
  const auto bytes_for = [&](const FileRequest& request) {
    OpenedFile opened = *open_file(request);
    const auto bytes = write_patch_program(compile_opened(opened, request, "", opened.diagnostics)->description());
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  Watched watched(file);
  folder.write("m.wale", bytes_for(falcon));
  EXPECT_EQ(watched.watch.attend(long_enough), Outcome::refused);
  EXPECT_NE(watched.said.find("`falcon`"), std::string::npos) << watched.said;
}

}  // namespace
}  // namespace wale::watching_test
