// The application's own devices, and errors in the words of the interface.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "tests/temporary_folder.hpp"
#include "wale/library.hpp"
#include "wale/loop.hpp"
#include "wale/stage.hpp"

namespace wale::own_devices_test {
namespace {

std::string declared(const std::string& name, const std::string& before = "export ") {
  return before + "device " + name +
         " {\n  class force_plane\n  workspace disc(100 mm)\n  position 8192 counts\n  force 4 N, 1000 counts\n"
         "  rate 1000 Hz\n  speed assumed 1 m/s\n  slew assumed 100 N/s\n  velocity_filter 15, 1 counts\n"
         "  patch 80 mm, 80 mm, 5 mm\n  mass 0.1 kg\n  damping assumed 1 N s/m\n  friction assumed 0.05 N\n}\n";
}

std::vector<std::byte> bytes_of(const Result<Compiled>& compiled) {
  if (!compiled) throw std::runtime_error(in_words(compiled.error()));
  const auto bytes = write_patch_program(compiled->program.description());
  const auto view = std::as_bytes(std::span(bytes));
  return {view.begin(), view.end()};
}

TEST(OwnDevices, ShippedMaterialsAreCompiledForThem) {
  const Library library({.devices = "wale 1\n" + declared("rail_stick") + declared("pit_stick")});
  ASSERT_TRUE(library.is_usable());
  for (const std::string name : {"rail_stick", "pit_stick"}) {
    const CompileOptions for_it{.device = name};
    const Result<Compiled> all[] = {
        library.find("corduroy", for_it), library.level("roughness", "coarse", for_it),
        library.compile("wale 1\nmaterial m { physical { force = spring(50 N/m) } }", for_it),
        library.open(std::string(WALE_SOURCE_DIR) + "/library/fabric/denim.wale", for_it),
        library.find_later("oak", for_it).get()};
    for (const Result<Compiled>& each : all) {
      ASSERT_TRUE(each) << in_words(each.error());
      EXPECT_EQ(each->program.description().device.name, name);
      Stage stage(each->program.description().device);
      EXPECT_TRUE(stage.add(each->program));
      EXPECT_TRUE(Loop::begin(stage));
    }
    const auto desk = library.workspace("wale 1\nworkspace w { patch a = corduroy { at 0 mm, 0 mm } }", {.device = name});
    ASSERT_TRUE(desk) << in_words(desk.error());
    EXPECT_EQ(desk->workspace.patches.front().program.description().device.name, name);
    const auto devices = library.devices();
    EXPECT_EQ(std::ranges::count(devices, name, [](const DeclaredDevice& each) { return each.profile.name; }), 1);
  }
  const Library plain;
  EXPECT_EQ(bytes_of(library.find("corduroy")), bytes_of(plain.find("corduroy"))) << "shipped devices stay as they are";
  EXPECT_EQ(plain.find("corduroy", {.device = "rail_stick"}).error().code, Code::unknown_device);
  const auto misspelt = library.find("corduroy", {.device = "rail_stik"});
  ASSERT_FALSE(misspelt);
  EXPECT_EQ(misspelt.error().nearest.front(), "rail_stick");
}

TEST(OwnDevices, AreSimulatedByNameAndScaleNoRealOne) {
  std::string wired = declared("wired_stick");
  wired.insert(wired.find("  class"), "  usb \"1209:ffb0\"\n");
  const Library library({.devices = "wale 1\n" + declared("rail_stick") + wired});
  ASSERT_TRUE(library.is_usable()) << in_words(library.is_usable().error());
  const auto program = library.compile("wale 1\nmaterial m { physical { force = -2 N s/m * velocity } }",
                                       {.device = "rail_stick"});
  ASSERT_TRUE(program) << in_words(program.error());
  for (const char* spelling : {"simulated:rail_stick", "rail_stick"}) {
    auto device = library.open_device(spelling);
    ASSERT_TRUE(device) << in_words(device.error());
    EXPECT_EQ((*device)->profile(), program->program.description().device);
    Stage stage(*std::move(device));
    ASSERT_TRUE(stage.add(program->program));
    const auto run = stage.run({.seconds = 1, .virtual_time = true});
    ASSERT_TRUE(run) << in_words(run.error());
    float most = 0;
    for (const TickRecord& each : run->record.ticks) most = std::max(most, std::abs(each.force.x));
    EXPECT_GT(most, 0.05) << "it moves, and syrup resists";
  }
  EXPECT_TRUE(library.open_device("simulated", {.built_for = "rail_stick"}));
  EXPECT_TRUE(library.open_device("simulated:wired_stick"));
  const auto refused = library.open_device("wired_stick");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::untrusted_device);
  EXPECT_NE(refused.error().sentence.find("declared by the application"), std::string::npos) << refused.error().sentence;
  const auto misspelt = library.open_device("simulated:rail_stik");
  ASSERT_FALSE(misspelt);
  EXPECT_EQ(misspelt.error().nearest.front(), "simulated:rail_stick");
  const auto shown = devices(*library.trusted_devices(), library.devices());
  EXPECT_EQ(std::ranges::count(shown, "simulated:rail_stick", &DeviceInfo::spelling), 1);
  EXPECT_EQ(std::ranges::count(shown, "simulated:sandpaper", &DeviceInfo::spelling), 1);
}

TEST(OwnDevices, WhatIsWrongWithThemIsSaid) {
  const auto refused = [](const std::string& text) {
    const Library library({.devices = text});
    const auto usable = library.is_usable();
    EXPECT_FALSE(usable) << text;
    EXPECT_TRUE(library.folders_exist());
    const auto found = library.find("corduroy");
    EXPECT_FALSE(found) << "no call passes it over";
    if (usable || found) return Error{};
    EXPECT_EQ(in_words(usable.error()), in_words(found.error()));
    EXPECT_EQ(usable.error().place.name, "devices");
    EXPECT_FALSE(usable.error().mend.empty());
    return usable.error();
  };
  EXPECT_EQ(refused("wale 1\n" + declared("falcon")).code, Code::declared_twice);
  const Error kept = refused("wale 1\n" + declared("rail_stick", ""));
  EXPECT_EQ(kept.code, Code::unknown_device);
  EXPECT_NE(kept.mend.find("export device rail_stick"), std::string::npos);
  EXPECT_EQ(kept.place.number, 2u);
  EXPECT_EQ(refused("wale 1\n").code, Code::unknown_device);
  EXPECT_EQ(refused("rubbish").code, Code::missing_version);
  const Error wrong = refused("wale 1\n" + declared("rail_stick") + "export device lost {\n  force 4 N m, 10 counts\n}\n");
  EXPECT_FALSE(wrong.others.empty());
  EXPECT_TRUE(Library({.devices = ""}).is_usable());
  for (const std::string spelling : {"auto", "usb", "simulated", "pointer"})
    EXPECT_EQ(refused("wale 1\n" + declared(spelling)).code, Code::declared_twice) << spelling;
  const Library hidden({.devices = "wale 1\nexport device rail_stick { }"});
  EXPECT_EQ(in_words(hidden.open_device("simulated:rail_stick").error()), in_words(hidden.is_usable().error()))
      << "what hides the device is said";
}

TEST(OwnDevices, FiguresThatNoProgramRunsWithAreToldWhereTheyStand) {
  const std::pair<const char*, const char*> changes[] = {
      {"mass 0.1 kg", "mass -1 kg"},
      {"mass 0.1 kg", "mass 5 t"},
      {"friction assumed 0.05 N", "friction -3 N"},
      {"damping assumed 1 N s/m", "damping -1 N s/m"},
      {"force 4 N, 1000 counts", "force 4 N, 0 counts"},
      {"force 4 N, 1000 counts", "force 4 N, -5 counts"},
      {"force 4 N, 1000 counts", "force 5 kN, 1000 counts"},
      {"disc(100 mm)", "disc(1 km)"},
      {"speed assumed 1 m/s", "speed 1 km/s"},
      {"slew assumed 100 N/s", "slew 1e12 N/s"},
      {"velocity_filter 15, 1 counts", "velocity_filter 101, 1 counts"},
      {"velocity_filter 15, 1 counts", "velocity_filter 15, -1 counts"},
      {"patch 80 mm, 80 mm, 5 mm", "patch -80 mm, 80 mm, 5 mm"},
      {"patch 80 mm, 80 mm, 5 mm", "patch 80 mm, 0 mm, 5 mm"},
      {"patch 80 mm, 80 mm, 5 mm", "patch 80 mm, 80 mm, 40 mm"},
      {"patch 80 mm, 80 mm, 5 mm", "patch 80 mm, 80 mm, -1 mm"}};
  for (const auto& [figure, wrong] : changes) {
    std::string text = "wale 1\nunit t = 1000 kg\n" + declared("rail_stick");
    const std::size_t at = text.find(figure);
    ASSERT_NE(at, std::string::npos) << figure;
    text.replace(at, std::string(figure).size(), wrong);
    const auto usable = Library({.devices = text}).is_usable();
    ASSERT_FALSE(usable) << wrong;
    EXPECT_EQ(usable.error().code, Code::value_out_of_range) << in_words(usable.error());
    EXPECT_EQ(usable.error().place.number, 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'))
        << in_words(usable.error());
  }
}

TEST(OwnDevices, ComeBeforeThoseOfTheOwner) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "wale");
  std::string owners = declared("rail_stick");
  owners.replace(owners.find("4 N"), 3, "9 N");
  std::ofstream(folder / "wale/devices.wale") << "wale 1\n" + owners + declared("of_owner");
  const char* const before = std::getenv("XDG_CONFIG_HOME");
  const std::string kept = before != nullptr ? before : "";
  setenv("XDG_CONFIG_HOME", folder.path().string().c_str(), 1);
  const Library library({.devices = "wale 1\n" + declared("rail_stick")}), without;
  if (before != nullptr) setenv("XDG_CONFIG_HOME", kept.c_str(), 1);
  else unsetenv("XDG_CONFIG_HOME");
  const auto force_for = [](const Library& of, const std::string& device) {
    const auto made = of.find("corduroy", {.device = device});
    return made ? made->program.description().device.force_newton : -1;
  };
  EXPECT_EQ(force_for(without, "rail_stick"), 9);
  EXPECT_EQ(force_for(library, "rail_stick"), 4);
  EXPECT_EQ(force_for(library, "of_owner"), 4);
  const auto devices = library.devices();
  EXPECT_EQ(std::ranges::count(devices, "rail_stick", [](const DeclaredDevice& each) { return each.profile.name; }), 1);
}

/// Looks at an error and its others.
void look_at(const Error& error, const std::string& file) {
  static const std::regex option(R"((^|[^-\w])--[a-z])");
  EXPECT_FALSE(std::regex_search(error.mend, option)) << file << ": " << error.mend;
  EXPECT_EQ(error.mend.find("`wale find"), std::string::npos) << file << ": " << error.mend;
  EXPECT_EQ((error.expected + error.found).find("  "), std::string::npos) << file << ": " << error.expected;
  if (error.sentence.starts_with("expected ")) {
    EXPECT_FALSE(error.expected.empty()) << file << ": " << error.sentence;
  }
  if (error.sentence.starts_with("expected ") && error.sentence.find(", found ") != std::string::npos) {
    EXPECT_FALSE(error.found.empty()) << file << ": " << error.sentence;
  }
  if (error.code == Code::wrong_dimension || error.code == Code::mismatched_dimensions) {
    EXPECT_TRUE(error.nearest.empty()) << file << ": " << error.sentence;
  }
  for (const Error& each : error.others) look_at(each, file);
}

TEST(ErrorsOfTheLibrary, SpeakOfTheInterfaceAndFillTheirMembers) {
  const Library library;
  long errors = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(WALE_SOURCE_DIR) +
                                                                         "/tests/language/diagnostics")) {
    if (entry.path().extension() != ".wale") continue;
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto compiled = library.compile(text, {.name = entry.path().string()});
    if (compiled) continue;
    ++errors;
    look_at(compiled.error(), entry.path().string());
  }
  EXPECT_GT(errors, 150);
  for (const std::string path : {"/nowhere/corduroy.wale", "corduroyy.wale", "corduroy", "/", ""}) {
    const auto opened = library.open(path);
    ASSERT_FALSE(opened) << path;
    look_at(opened.error(), path);
    EXPECT_FALSE(opened.error().mend.empty()) << path;
    look_at(library.open_workspace(path + ".wws").error(), path);
  }
  for (const std::string name : {"corduory", "qqqqqqq", "x", "kord"}) {
    const auto found = library.find(name);
    ASSERT_FALSE(found);
    look_at(found.error(), name);
    EXPECT_EQ(found.error().nearest.size(), 3u) << name;
    EXPECT_EQ(library.level(name, "0.5").error().nearest.size(), 3u) << name;
    EXPECT_EQ(library.level("roughness", "0.5", {.device = name}).error().nearest.size(), 3u) << name;
  }
}

}  // namespace
}  // namespace wale::own_devices_test
