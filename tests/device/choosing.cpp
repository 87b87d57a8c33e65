// Choosing a device by the plugged devices, the declared devices, and the device that the program was built for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "calibration/command/device_declaration.hpp"
#include "compiler/compile.hpp"
#include "compiler/declarations/declared_devices.hpp"
#include "compiler/diagnostics/render.hpp"
#include "runtime/device/choose_device.hpp"
#include "runtime/device/identify_device.hpp"
#include "runtime/device/shipped_devices.hpp"
#include "runtime/device/trusted_device.hpp"
#include "schema/without_place.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::choosing_test {
namespace {

const Driver* const hid_pid = find_driver(drivers(), "hid-pid");

PluggedIn stick(const std::string& name, const std::string& numbers, const std::string& port,
                std::optional<Error> obstacle = std::nullopt) {
  return {.driver = hid_pid,
          .numbers = numbers,
          .port = port,
          .name = name,
          .can = "two axes by direction, 255 steps of force to each side",
          .obstacle = std::move(obstacle)};
}

const PluggedIn openffboard = stick("OpenFFBoard", "1209:ffb0", "1-1"), rhino = stick("Rhino", "ffff:2055", "1-2"),
                unheard_of = stick("Mine", "abcd:0123", "1-1.4"),
                forbidden = stick("OpenFFBoard", "1209:ffb0", "1-3",
                                  Error{Code::unusable_device, "no permission to open it", "as root, …"});
const PluggedIn mouse{
    .driver = hid_pid,
    .numbers = "046d:c077",
    .port = "2-1",
    .name = "Mouse",
    .obstacle =
        Error{Code::unlike_device, "it is not a force device: nothing in its report descriptor is of usage page 0F"}};

struct Choice {
  std::string device;   ///< its port, "simulated", "absent" or "refused"
  std::string profile;  ///< the mend where there is an error
  std::string said;
};

Choice choice(const DeviceRequest& request, const std::vector<PluggedIn>& plugged) {
  const auto chosen = choose_device(request, *shipped_devices(), *trusted_devices(), plugged);
  if (!chosen) {
    const bool is_absent = chosen.error().code == Code::absent_device;
    return {is_absent ? "absent" : "refused", chosen.error().mend, in_words_without_place(chosen.error())};
  }
  return {chosen->plugged ? chosen->plugged->port : "simulated", chosen->declared ? chosen->declared->profile.name : "",
          chosen->said};
}
/// The code of the error of a choice.
Code code_of(const DeviceRequest& request, const std::vector<PluggedIn>& plugged) {
  return choose_device(request, *shipped_devices(), *trusted_devices(), plugged).error().code;
}
Choice choice(const std::string& spelling, const std::vector<PluggedIn>& plugged) {
  return choice(DeviceRequest{.spelling = spelling}, plugged);
}
bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Choosing, AutoTakesTheBestAndSaysWhich) {
  EXPECT_EQ(choice("auto", {}).device, "simulated");
  EXPECT_EQ(choice("auto", {}).said, "no force-feedback device is plugged in; using a simulated one");
  EXPECT_EQ(choice("auto", {mouse}).said, "no force-feedback device is plugged in; using a simulated one");
  EXPECT_EQ(choice("auto", {mouse, rhino}).device, "1-2");
  EXPECT_EQ(choice("auto", {unheard_of, rhino}).profile, "vpforce_rhino")
      << "declared devices come before unknown ones";
  const Choice generic = choice("auto", {unheard_of});
  EXPECT_EQ(generic.profile, "usb_joystick");
  EXPECT_TRUE(contains(generic.said, "no declaration is about it"));
  EXPECT_TRUE(contains(choice("auto", {openffboard, rhino}).said, "also plugged in: Rhino (ffff:2055 at port 1-2)"));
}

TEST(Choosing, AutoExplainsWhyAPluggedDeviceIsNotUsed) {
  const Choice choice = choosing_test::choice("auto", {forbidden});
  EXPECT_EQ(choice.device, "simulated");
  EXPECT_EQ(choice.said,
            "OpenFFBoard (1209:ffb0 at port 1-3) cannot be used: no permission to open it; as root, …\n"
            "using a simulated device instead");
  EXPECT_EQ(choosing_test::choice("auto", {forbidden, rhino}).device, "1-2");
}

TEST(Choosing, ANamedDeviceIsTheRealOneWhereADriverExists) {
  const std::vector<PluggedIn> both{openffboard, rhino};
  EXPECT_EQ(choice("vpforce_rhino", both).device, "1-2");
  EXPECT_EQ(choice("ffff:2055", both).device, "1-2");
  EXPECT_EQ(choice("FFFF:2055", both).device, "1-2");
  EXPECT_EQ(choice("1-2", both).device, "1-2");
  EXPECT_EQ(choice("usb", both).device, "1-1");
  EXPECT_EQ(choice("hid-pid", both).device, "1-1");
  EXPECT_EQ(choice("simulated", both).device, "simulated");
  EXPECT_EQ(choice("simulated:vpforce_rhino", both).device, "simulated");
  EXPECT_EQ(choice("simulated:vpforce_rhino", both).profile, "vpforce_rhino");
  EXPECT_EQ(choice("sandpaper", both).device, "simulated");
  EXPECT_EQ(choice("sandpaper", both).said, "") << "no real device of that name can exist";
}

TEST(Choosing, AMissingRealDeviceIsAbsentAndNotSimulated) {
  for (const char* spelling : {"usb", "hid-pid", "1209:ffb0", "1-7", "arduino_ffb", "usb_joystick"})
    EXPECT_EQ(choice(spelling, {mouse}).device, "absent") << spelling;
  const Choice declared = choice("arduino_ffb", {openffboard, rhino});
  EXPECT_EQ(declared.said, "no arduino_ffb is plugged in; plug it in, or use `--device simulated:arduino_ffb`");
  EXPECT_EQ(choice("1209:ffb0", {rhino}).said,
            "no device 1209:ffb0 is plugged in; plug it in, or use `--device simulated`");
}

TEST(Choosing, UnusableDevicesAreRefusedWithAMend) {
  EXPECT_TRUE(contains(choice("1-3", {forbidden}).said, "no permission to open it"));
  EXPECT_TRUE(contains(choice("openffboard", {forbidden}).said, "no permission to open it")) << "not simulated instead";
  EXPECT_TRUE(contains(choice("2-1", {mouse}).said, "it is not a force device"));
  EXPECT_TRUE(contains(choice("openfboard", {}).said, "did you mean `openffboard`?"));
  EXPECT_TRUE(contains(choice("simulated:openfboard", {}).said, "did you mean `simulated:openffboard`?"));
  EXPECT_EQ(code_of({.spelling = "openffboard"}, {forbidden}), Code::unusable_device);
  EXPECT_EQ(code_of({.spelling = "2-1"}, {mouse}), Code::unlike_device);
  EXPECT_EQ(code_of({.spelling = "openfboard"}, {}), Code::unknown_device);
  EXPECT_EQ(code_of({.spelling = "1-1", .built_for = "sandpaper"}, {openffboard}), Code::other_device);
  EXPECT_EQ(code_of({.spelling = "1-1", .only_simulated = true}, {openffboard}), Code::malformed_value);
}

TEST(Choosing, ABuiltProgramKeepsItsDevice) {
  const auto built = [](const std::string& spelling, const std::string& profile, std::vector<PluggedIn> plugged) {
    return choice(DeviceRequest{.spelling = spelling, .built_for = profile}, plugged);
  };
  EXPECT_EQ(built("auto", "vpforce_rhino", {openffboard, rhino}).device, "1-2");
  const Choice other = built("auto", "sandpaper", {openffboard});
  EXPECT_EQ(other.device, "simulated");
  EXPECT_TRUE(contains(other.said, "is used as openffboard, and the program is built for sandpaper"));
  const Choice refused = built("1-1", "sandpaper", {openffboard});
  EXPECT_EQ(refused.device, "refused");
  EXPECT_TRUE(contains(refused.said, "wale build FILE --device openffboard -o OUT.wpp")) << refused.said;
  EXPECT_EQ(built("simulated:falcon", "sandpaper", {}).device, "refused");
  EXPECT_EQ(built("falcon", "sandpaper", {}).device, "refused") << "it would not help to plug it in";
  EXPECT_EQ(built("simulated", "sandpaper", {openffboard}).device, "simulated");
}

TEST(Choosing, VirtualTimeAndASimulatedHandNeedASimulatedDevice) {
  const auto simulated = [](const std::string& spelling) {
    return choice(DeviceRequest{.spelling = spelling, .only_simulated = true}, {openffboard});
  };
  EXPECT_EQ(simulated("auto").device, "simulated");
  EXPECT_EQ(simulated("openffboard").profile, "openffboard");
  EXPECT_EQ(simulated("openffboard").device, "simulated");
  for (const char* spelling : {"usb", "1209:ffb0", "1-1", "hid-pid", "phantom"})
    EXPECT_EQ(simulated(spelling).device, "refused") << spelling;
}

/// A checked file with its declarations.
struct Declared {
  SourceSet sources;
  Diagnostics diagnostics;
  std::unique_ptr<Resolver> resolver = file_resolver({});
  CheckedModule module;

  explicit Declared(const std::string& text)
      : module(check_source(sources, sources.add("devices.wale", text), *resolver, diagnostics)) {}
  std::string complaints() const {
    std::string said;
    for (const auto& each : diagnostics.all()) said += render_text(each, sources, false);
    return said;
  }
};

TEST(Choosing, TheUsersDeclarationComesFirst) {
  const Declared own(R"(wale 1
device at_home {
  usb       "1209:ffb0"
  axes      y, -x
  motors    -y, x
  gain      0.5, 2
  workspace disc(100 mm)
  position  1024 counts
  force     5 N, 512 counts
  rate      500 Hz
  speed     1 m/s
  slew      100 N/s
  velocity_filter 15, 1 counts
  patch     60 mm, 60 mm, 5 mm
  friction  unknown
}
)");
  ASSERT_EQ(own.complaints(), "");
  const auto known = declared_devices(own.module.declarations());
  const auto trusted = *trusted_devices({TrustedDevice::by_owner(known.front(), "devices.wale")});
  const auto chosen = choose_device({.spelling = "auto"}, known, trusted, std::vector{openffboard});
  ASSERT_TRUE(chosen);
  EXPECT_FALSE(chosen->is_generic);
  const DeclaredDevice& device = *chosen->declared;
  EXPECT_EQ(device.profile, known.front().profile);
  EXPECT_EQ(chosen->trusted->profile(), known.front().profile) << "the profile is unchanged";
  EXPECT_TRUE(contains(chosen->said, "as at_home, as devices.wale declares it")) << chosen->said;
  EXPECT_EQ(device.profile.name, "at_home");
  EXPECT_EQ(device.wiring.axes, (std::array<SignedAxis, 2>{{{1, 1}, {0, -1}}}));
  EXPECT_EQ(device.wiring.motors, (std::array<SignedAxis, 2>{{{1, -1}, {0, 1}}}));
  EXPECT_EQ(device.wiring.gain, (std::array<double, 2>{0.5, 2}));
  EXPECT_EQ(known.front().unknown, (std::vector<std::string>{"mass", "damping", "friction", "delay", "bandwidth"}));
  EXPECT_FALSE(known.front().profile.friction_known);
}

/// What a file of somebody else declares: a hair's breadth of a newton at full force.
constexpr const char* feeble = R"(wale 1
device feeble {
  usb       "1209:ffb0"
  gain      0.1
  workspace disc(100 mm)
  position  1024 counts
  force     1 mN, 512 counts
  rate      500 Hz
  speed     1 m/s
  slew      100 N/s
  velocity_filter 15, 1 counts
  patch     60 mm, 60 mm, 5 mm
}
)";

TEST(Choosing, ADeclarationThatIsOnlyKnownNeverScalesARealDevice) {
  const Declared file(feeble);
  ASSERT_EQ(file.complaints(), "");
  const auto known = declared_devices(file.module.declarations());
  const auto choose = [&](const std::string& spelling, std::vector<PluggedIn> plugged) {
    return choose_device({.spelling = spelling}, known, *trusted_devices(), plugged);
  };
  const auto chosen = choose("auto", {openffboard});
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->trusted->profile().name, "openffboard");
  EXPECT_EQ(chosen->declared->profile.force_newton, 20);
  EXPECT_TRUE(contains(chosen->said, "`feeble`")) << chosen->said;
  EXPECT_TRUE(contains(chosen->said, "--devices FILE")) << chosen->said;
  EXPECT_TRUE(contains(chosen->said, "`wale devices --identify 1-1`")) << chosen->said;
  for (const auto& plugged : {std::vector{openffboard}, std::vector<PluggedIn>{}}) {
    const auto named = choose("feeble", plugged);
    ASSERT_FALSE(named);
    EXPECT_EQ(named.error().code, Code::untrusted_device);
    EXPECT_TRUE(contains(named.error().mend, "--devices FILE"));
  }
  const auto simulated = choose("simulated:feeble", {openffboard});
  ASSERT_TRUE(simulated);
  EXPECT_FALSE(simulated->plugged);
  EXPECT_EQ(simulated->declared->profile.name, "feeble");
}

TEST(Choosing, AFileThatSaysWhatTheTrustedOneSaysIsNotComplainedAbout) {
  const Declared file(feeble);
  const auto known = declared_devices(file.module.declarations());
  const auto trusted = *trusted_devices({TrustedDevice::by_owner(known.front(), "mine.wale")});
  const auto chosen = choose_device({.spelling = "auto"}, known, trusted, std::vector{openffboard});
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->trusted->profile().name, "feeble");
  EXPECT_FALSE(contains(chosen->said, "not used")) << chosen->said;
}

/// The declaration of a device with that name and force.
std::string device_text(const std::string& name, int newton) {
  return "device " + name + " { workspace disc(100 mm); position 1024 counts; force " + std::to_string(newton) +
         " N, 512 counts; rate 500 Hz; speed 1 m/s; slew 100 N/s; velocity_filter 15, 1 counts; "
         "patch 60 mm, 60 mm, 5 mm }\n";
}

TEST(Choosing, DevicesOfAProjectAreDeclaredInItsFiles) {
  const TemporaryFolder project;
  const std::string material = "material m { physical { force = spring(20 N/m) } }\n";
  project.write("wale.project", "");
  project.write("devices.wale", "wale 1\nexport " + device_text("at_home", 5) + device_text("of_nobody", 6));
  project.write("fabric/m.wale", "wale 1\n" + material);
  project.write("fabric/own.wale", "wale 1\n" + device_text("at_home", 7) + material);
  const auto force_on = [&](const std::string& file, const std::string& device) {
    SourceSet sources;
    Diagnostics diagnostics;
    const auto resolver = file_resolver({});
    const std::string path = project / file;
    const SourceId source = sources.add(path, read_file(path)->bytes);
    const auto program = compile(sources, source, "", device, *resolver, diagnostics);
    if (!program) return std::string(code_name(diagnostics.all().front().code));
    return std::to_string(std::lround(program->description().device.force_newton));
  };
  EXPECT_EQ(force_on("fabric/m.wale", "at_home"), "5");
  EXPECT_EQ(force_on("fabric/m.wale", "of_nobody"), "W0601") << "it is not exported";
  EXPECT_EQ(force_on("fabric/own.wale", "at_home"), "7") << "the file's own declaration comes first";
  EXPECT_EQ(force_on("fabric/m.wale", "sandpaper"), "10");
  project.write("devices.wale", "");
  EXPECT_EQ(force_on("fabric/m.wale", "sandpaper"), "10") << "an empty file is no error";
  project.write("devices.wale", "wale 1\nexport " + device_text("sandpaper", 5));
  EXPECT_EQ(force_on("fabric/m.wale", "sandpaper"), "W0202") << "errors of devices.wale are reported";
}

TEST(Choosing, ShippedDeclarationsHaveDifferentNumbersAndOneIsGeneric) {
  std::vector<UsbNumbers> all;
  int generic = 0;
  for (const DeclaredDevice& device : *shipped_devices()) {
    generic += device.wiring.is_generic ? 1 : 0;
    for (const UsbNumbers& numbers : device.wiring.usb) {
      EXPECT_EQ(std::find(all.begin(), all.end(), numbers), all.end()) << in_words(numbers);
      all.push_back(numbers);
    }
  }
  EXPECT_EQ(generic, 1);
}

TEST(Choosing, AGainBelongsToItsMotor) {
  DeviceWiring before;
  before.motors = {{{1, -1}, {0, 1}}};  // its y motor pushes to the left with half of the force
  before.gain = {0.5, 2};
  Identified found;
  found.axes_settled = found.motors_settled = std::array<SignedAxis, 2>{{{0, 1}, {1, 1}}};
  const DeviceWiring after = rewired(before, found);
  EXPECT_EQ(after.motors, *found.motors_settled);
  EXPECT_EQ(after.axes, *found.axes_settled);
  EXPECT_EQ(after.gain, (std::array<double, 2>{2, 0.5}));
  found.motors_settled = before.motors;
  EXPECT_EQ(rewired(before, found).gain, before.gain);
}

TEST(Choosing, APrintedDeclarationReadsBackAsTheDevice) {
  DeviceWiring wiring;
  wiring.usb = {{0x1209, 0xffb0}};
  wiring.axes = {{{1, -1}, {0, 1}}};
  wiring.motors = {{{0, -1}, {1, 1}}};
  for (const DeclaredDevice& device : *shipped_devices()) {
    if (device.profile.shaker) continue;
    DeclaredDevice mine = device;
    mine.profile.name = "my_" + device.profile.name;
    mine.wiring = wiring;
    const std::string text = command::device_declaration(mine, {"a comment"});
    const Declared printed(text);
    ASSERT_EQ(printed.complaints(), "") << text;
    const DeclaredDevice again = declared_devices(printed.module.declarations()).front();
    EXPECT_EQ(again.profile, mine.profile) << text;
    EXPECT_EQ(again.wiring, wiring);
    EXPECT_EQ(again.unknown, device.unknown);
    EXPECT_EQ(std::set<std::string>(again.assumed.begin(), again.assumed.end()),
              std::set<std::string>(device.assumed.begin(), device.assumed.end()));
    EXPECT_EQ(again.of_class, device.of_class);
    EXPECT_EQ(again.source, device.source);
    DeclaredDevice unweighed = mine;
    unweighed.unknown.emplace_back("gain");
    const Declared said(command::device_declaration(unweighed, {}));
    ASSERT_EQ(said.complaints(), "");
    const auto unknown = declared_devices(said.module.declarations()).front().unknown;
    EXPECT_NE(std::ranges::find(unknown, "gain"), unknown.end());
  }
}

}  // namespace
}  // namespace wale::choosing_test
