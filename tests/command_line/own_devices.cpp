// Devices that a person or a file declares: every verb with --device knows them by the same rule.
#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::own_devices_test {
namespace {

/// A material, and where devices of one's own may be declared.
struct Declared {
  TemporaryFolder folder;
  std::string material = folder.write("two.wale",
                                      "wale 1\nmaterial a { physical { force = -1 N/m * hand } }\n"
                                      "material b { physical { force = -2 N/m * hand } }\n");
  std::string file = folder.write("mine.wale", "wale 1\nexport " + text("mine"));

  /// The shipped Falcon under another name, on other numbers of USB or on none.
  static std::string text(const std::string& name, bool is_on_usb = true) {
    std::string all = bytes_of(std::string(WALE_SOURCE_DIR) + "/calibration/devices/falcon.wale");
    all = all.substr(all.find("device falcon"));
    all.replace(all.find("falcon"), 6, name);
    const auto usb = all.find("  usb");
    return all.replace(usb, all.find('\n', usb) - usb, is_on_usb ? "  usb       \"1209:aaaa\"" : "");
  }

  /// A folder of settings whose devices.wale has this text.
  std::string config(const std::string& text) const {
    fs::create_directories(folder / "config/wale");
    folder.write("config/wale/devices.wale", text);
    return folder / "config";
  }

  /// A command for each verb with --device.
  std::vector<std::vector<std::string>> verbs(const std::string& name) const {
    return {{"build", material, "--device", name, "-o", folder / "m.wpp"},
            {"build", material, "--device", name, "--emit", "listing"},
            {"build", material, "--device", name, "--all", "-o", folder / "all"},
            {"describe", material, "--device", name},
            {"preview", material, "--device", name, "-o", folder / "p.png"},
            {"compare", material, "--device", name},
            {"levels", "roughness", "--device", name},
            {"sample", material, "--device", name, "--at", "1 mm, 1 mm"},
            {"feel", material, "--device", name, "--virtual-time", "--seconds", "0.1"},
            {"feel", material, "--device", "simulated:" + name, "--virtual-time", "--seconds", "0.1"},
            {"feel", material, "--built-for", name, "--virtual-time", "--seconds", "0.1"}};
  }
};

TEST(OwnDevices, OfANamedFileAreKnownToEveryVerb) {
  const Declared declared;
  for (auto words : declared.verbs("mine")) {
    EXPECT_EQ(wale(words).status, 2) << testing::PrintToString(words);
    words.insert(words.end(), {"--devices", declared.file});
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, 0) << testing::PrintToString(words) << outcome.err;
  }
  const Outcome all = wale({"describe", declared.material, "--device", "all", "--devices", declared.file});
  EXPECT_TRUE(contains(all.out, "mine")) << all.out << all.err;
}

TEST(OwnDevices, OfTheOwnerAreKnownToEveryVerb) {
  const Declared declared;
  const std::string config = declared.config("wale 1\nexport " + Declared::text("mine"));
  const std::string other = declared.folder.write("other.wale", "wale 1\nexport " + Declared::text("other"));
  for (auto words : declared.verbs("mine")) {
    EXPECT_EQ(wale(words, {}, config).status, 0) << testing::PrintToString(words);
    words.insert(words.end(), {"--devices", other});  // comes besides the owner's, not instead of it
    EXPECT_EQ(wale(words, {}, config).status, 0) << testing::PrintToString(words);
  }
}

TEST(OwnDevices, OfTheFileItselfAreSimulated) {
  Declared declared;
  declared.material = declared.folder.write("two.wale", bytes_of(declared.material) + Declared::text("mine", false));
  for (const auto& words : declared.verbs("mine"))
    if (words.front() != "levels") {
      EXPECT_EQ(wale(words).status, 0) << testing::PrintToString(words);
    }
  const Outcome real = wale({"feel", declared.material, "--device", "mine", "--seconds", "0.1"});
  EXPECT_TRUE(real.status == 0 && contains(real.out, "simulated mine")) << real.out << real.err;
}

TEST(OwnDevices, OfAPatchProgramAreSimulated) {
  const Declared declared;
  const std::string program = declared.folder / "m.wpp";
  ASSERT_EQ(wale({"build", declared.material, "--device", "mine", "--devices", declared.file, "-o", program}).status,
            0);
  for (const std::string& name : {std::string("mine"), std::string("simulated:mine"), std::string("simulated")}) {
    const Outcome outcome = wale({"feel", program, "--device", name, "--virtual-time", "--seconds", "0.1"});
    EXPECT_TRUE(outcome.status == 0 && contains(outcome.out, "simulated mine")) << name << outcome.err;
  }
  // Trusted, its name means the real one.
  const Outcome real = wale({"feel", program, "--device", "mine", "--devices", declared.file, "--seconds", "0.1"});
  EXPECT_EQ(real.status, 1);
  EXPECT_TRUE(contains(real.err, "W0701")) << real.err;
  // Not trusted, nobody knows whether there is a real one.
  const Outcome unknown = wale({"feel", program, "--device", "mine", "--seconds", "0.1"});
  EXPECT_EQ(unknown.status, 1);
  EXPECT_TRUE(contains(unknown.err, "W0710") && contains(unknown.err, "known only from the patch program"))
      << unknown.err;
}

TEST(OwnDevices, OfOtherFiguresThanTheProgramsAreNotSimulatedByName) {
  const Declared declared;
  const std::string program = declared.folder / "m.wpp";
  ASSERT_EQ(wale({"build", declared.material, "--device", "mine", "--devices", declared.file, "-o", program}).status,
            0);
  std::string text = Declared::text("mine");
  const auto rate = text.find("1000 Hz");
  ASSERT_NE(rate, std::string::npos) << "the Falcon's rate";
  const std::string other = declared.folder.write("other.wale", "wale 1\nexport " + text.replace(rate, 7, "900 Hz"));
  for (const std::string& name : {std::string("mine"), std::string("simulated:mine")}) {
    const Outcome outcome =
        wale({"feel", program, "--devices", other, "--device", name, "--virtual-time", "--seconds", "0.1"});
    EXPECT_EQ(outcome.status, 1) << name << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "W0608") && contains(outcome.err, "rate 1000 Hz in the program, 900 Hz declared"))
        << name << outcome.err;
  }
  const Outcome own = wale({"feel", program, "--devices", other, "--device", "simulated", "--virtual-time"});
  EXPECT_EQ(own.status, 0) << own.err;
}

TEST(OwnDevices, ANameInVirtualTimeIsASimulationAndSaidToBe) {
  for (const std::vector<std::string>& how : {std::vector<std::string>{"--virtual-time"}, {"--hand", "rest"}}) {
    std::vector<std::string> words{"feel", corduroy, "--device", "falcon", "--seconds", "0.1"};
    words.insert(words.end(), how.begin(), how.end());
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "simulating `falcon`")) << outcome.err;
  }
  const Outcome absent = wale({"feel", corduroy, "--device", "falcon", "--seconds", "0.1"});
  EXPECT_EQ(absent.status, 1);
  EXPECT_TRUE(contains(absent.err, "waiting for it")) << absent.err;
}

TEST(OwnDevices, AnErrorInTheOwnersFileStopsOnlyWhatNeedsIt) {
  Declared declared;
  const std::string config = declared.config("wale 1\nexport device mine {");
  using Words = std::vector<std::string>;
  declared.material = declared.folder.write("two.wale", bytes_of(declared.material) + Declared::text("own", false));
  const std::string& file = declared.material;
  for (const Words& words : {Words{"feel", file, "--device", "simulated", "--seconds", "0.1"},
                             {"feel", file, "--device", "simulated:falcon", "--virtual-time", "--seconds", "0.1"},
                             {"feel", file, "--device", "falcon", "--virtual-time", "--seconds", "0.1"},
                             {"feel", file, "--device", "sandpaper", "--seconds", "0.1"},
                             {"feel", file, "--virtual-time", "--seconds", "0.1"},
                             {"build", file, "--device", "own", "-o", declared.folder / "own.wpp"},
                             {"build", file, "--device", "falcon", "-o", declared.folder / "falcon.wpp"},
                             {"describe", file, "--device", "falcon", "--material", "a"},
                             {"describe", file, "--device", "all", "--material", "a"},
                             {"preview", file, "--device", "falcon", "-o", declared.folder / "p.png"},
                             {"compare", file, "--device", "own"},
                             {"levels", "roughness", "--device", "falcon"},
                             {"sample", file, "--device", "falcon", "--at", "1 mm, 1 mm"},
                             {"devices"}}) {
    const Outcome outcome = wale(words, {}, config);
    EXPECT_EQ(outcome.status, 0) << testing::PrintToString(words) << outcome.err;
    const std::string said = "wale: warning: nothing in " + config + "/wale/devices.wale is used: error[W0103]: ";
    const auto first = outcome.err.find(said);
    EXPECT_TRUE(first != std::string::npos && outcome.err.find(said, first + 1) == std::string::npos)
        << "once: " << testing::PrintToString(words) << outcome.err;
  }
  EXPECT_EQ(wale({"describe", file, "--material", "a"}, {}, config).err, "") << "no device is named";
  for (const Words& words : {Words{"feel", file, "--device", "falcon", "--seconds", "0.1"},
                             {"feel", file, "--device", "1209:aaaa", "--seconds", "0.1"},
                             {"devices", "--identify"},
                             {"compare", file, "--device", "mine"},
                             {"levels", "roughness", "--device", "mine"},
                             {"build", file, "--device", "mine", "-o", declared.folder / "mine.wpp"}}) {
    const Outcome outcome = wale(words, {}, config);
    EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "W0103")) << testing::PrintToString(words) << outcome.err;
  }
}

TEST(OwnDevices, AFileThatDeclaresThemOrMarksTheProjectIsNoOutput) {
  const Declared declared;
  const std::string config = declared.config("wale 1\nexport " + Declared::text("mine"));
  const std::string owners = config + "/wale/devices.wale";
  const std::string marker = declared.folder.write("wale.project", "");
  const std::string imported = declared.folder.write("other.wale", "wale 1\nexport let one = 1\n");
  const std::string importing = declared.folder.write(
      "m.wale", "wale 1\nimport other\nmaterial m { physical { force = spring(one * 9 N/m) } }\n");
  for (const auto& [words, file] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"build", declared.material, "--device", "mine", "-o", owners}, owners},
           {{"sample", declared.material, "--device", "mine", "--at", "1 mm, 1 mm", "-o", owners}, owners},
           {{"build", declared.material, "--devices", declared.file, "-o", declared.file}, declared.file},
           {{"build", importing, "-o", imported}, imported},
           {{"build", importing, "-o", marker}, marker}}) {
    const std::string before = bytes_of(file);
    const Outcome outcome = wale(words, {}, config);
    EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words);
    EXPECT_TRUE(contains(outcome.err, "error[W0508]")) << testing::PrintToString(words) << outcome.err;
    EXPECT_EQ(bytes_of(file), before) << testing::PrintToString(words);
  }
}

TEST(OwnDevices, WithoutExportAreNamedWithTheMend) {
  const Declared declared;
  const std::string both =
      declared.folder.write("both.wale", "wale 1\nexport " + Declared::text("mine") + "\n" + Declared::text("kept"));
  for (auto words : declared.verbs("kept")) {
    words.insert(words.end(), {"--devices", both});
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, 2) << testing::PrintToString(words);
    EXPECT_TRUE(contains(outcome.err, "error[W0215]") && contains(outcome.err, "`kept` is private to " + both) &&
                contains(outcome.err, "write `export device kept` there"))
        << testing::PrintToString(words) << outcome.err;
  }
  const std::string none = declared.folder.write("none.wale", "wale 1\n\n" + Declared::text("kept"));
  const Outcome outcome = wale({"devices", "--devices", none});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "write `export device kept` in line 3")) << outcome.err;
  // The file itself knows its own.
  const std::string own =
      declared.folder.write("own.wale", bytes_of(declared.material) + Declared::text("kept", false));
  EXPECT_EQ(wale({"feel", own, "--device", "simulated:kept", "--devices", both, "--virtual-time"}).status, 0);
}

TEST(OwnDevices, OfOneNameTheFirstCountsAndTheOthersAreNamed) {
  const Declared declared;
  std::string text = Declared::text("mine");
  const auto rate = text.find("1000 Hz");
  ASSERT_NE(rate, std::string::npos) << "the Falcon's rate";
  const std::string second =
      declared.folder.write("second.wale", "wale 1\n\nexport " + text.replace(rate, 7, "900 Hz"));
  const std::string config = declared.config("wale 1\n\n\nexport " + text);
  const auto warning = [&](const std::string& unused) {
    return "warning[W0214]: " + unused + ": `mine` is not used from here, since " + declared.file +
           ":2 declares it too";
  };
  for (auto words : declared.verbs("mine")) {
    words.insert(words.end(), {"--devices", declared.file, "--devices", second});
    const Outcome outcome = wale(words, {}, config);
    EXPECT_EQ(outcome.status, 0) << testing::PrintToString(words) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, warning(second + ":3")) &&
                contains(outcome.err, warning(config + "/wale/devices.wale:4")))
        << testing::PrintToString(words) << outcome.err;
    words.back() = declared.file;  // twice the same file
    EXPECT_FALSE(contains(wale(words).err, "W0214")) << testing::PrintToString(words);
  }
  const Outcome listed = wale({"devices", "--json", "--devices", second, "--devices", declared.file});
  for (const auto& device : listed.json()) {
    if (device["name"] == "mine") {
      EXPECT_EQ(device["rate_hz"], 900);
    }
  }
  EXPECT_TRUE(contains(listed.err, "W0214")) << listed.err;
}

TEST(OwnDevices, ABrokenFileIsToldWithTheNumberOfItsErrors) {
  const Declared declared;
  std::string text = Declared::text("mine");
  text.replace(text.find("  position"), 10, "  positon ");
  const std::string one = declared.folder.write("one.wale", "wale 1\nexport " + text);
  text.replace(text.find("  rate"), 6, "  rat ");
  const std::string two = declared.folder.write("two_errors.wale", "wale 1\nexport " + text);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"devices"}, {"feel", declared.material, "--virtual-time"}}) {
    const auto with = [&](const std::string& file) {
      std::vector<std::string> all = words;
      all.insert(all.end(), {"--devices", file});
      return wale(all);
    };
    const Outcome first = with(one);
    EXPECT_EQ(first.status, 1);
    EXPECT_TRUE(contains(first.err, "W0206") && contains(first.err, "did you mean `position`?\n")) << first.err;
    EXPECT_TRUE(contains(with(two).err, "did you mean `position`? 1 more error: `wale check " + two + "` shows it"));
  }
  const Outcome checked = wale({"check", one});
  EXPECT_TRUE(contains(checked.out, "1 error,") && !contains(checked.out, "W0207")) << "one mistake" << checked.out;
}

}  // namespace
}  // namespace wale::command_line::own_devices_test
