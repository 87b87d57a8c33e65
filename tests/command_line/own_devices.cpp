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
    if (words.front() != "levels") EXPECT_EQ(wale(words).status, 0) << testing::PrintToString(words);
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
                             {"devices"}}) {
    const Outcome outcome = wale(words, {}, config);
    EXPECT_EQ(outcome.status, 0) << testing::PrintToString(words) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "warning: nothing in ")) << testing::PrintToString(words) << outcome.err;
  }
  for (const Words& words : {Words{"feel", file, "--device", "falcon", "--seconds", "0.1"},
                             {"feel", file, "--device", "1209:aaaa", "--seconds", "0.1"},
                             {"devices", "--identify"},
                             {"build", file, "--device", "mine", "-o", declared.folder / "mine.wpp"}}) {
    const Outcome outcome = wale(words, {}, config);
    EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "W0103")) << testing::PrintToString(words) << outcome.err;
  }
}

}  // namespace
}  // namespace wale::command_line::own_devices_test
