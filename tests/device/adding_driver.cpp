// A driver is a folder and a row of a table. The code for all drivers finds, lists, chooses, opens, feels, loses and
// reopens the device of made_up/.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "calibration/command/device_report.hpp"
#include "runtime/device/open_device.hpp"
#include "runtime/device/shipped_devices.hpp"
#include "runtime/device/wait_for_device.hpp"
#include "tests/device/made_up/made_up.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/stage.hpp"

namespace wale::adding_driver_test {
namespace {

using namespace std::chrono_literals;

/// The table of drivers with one more row.
std::vector<const Driver*> table() {
  std::vector<const Driver*> all(drivers().begin(), drivers().end());
  all.push_back(&made_up_driver);
  return all;
}

/// The shipped devices and one of the owner's.
std::vector<TrustedDevice> trusted() {
  DeclaredDevice device;
  device.profile = sandpaper();
  device.profile.name = "handle_on_rails";
  device.wiring.motors = {{{0, -1}, {1, 1}}};  // its x motor pushes to the left
  return *trusted_devices({TrustedDevice::by_owner(device, "rails.wale")});
}

const Connections nowhere{Error{Code::unusable_device, "no USB here"}};

class AddingADriver : public testing::Test {
 protected:
  AddingADriver() {
    made_up::Rails& rails = made_up::rails();
    rails.is_plugged_in = true;
    rails.x = 200, rails.y = 0;
    rails.forces.clear();
    rails.descriptors.clear();
  }
  ~AddingADriver() override { made_up::rails().is_plugged_in = false; }

  Result<ChosenDevice> chosen(const std::string& spelling) const {
    return choose_device({.spelling = spelling}, {}, trusted_, plugged_in(nowhere, {}, drivers_), drivers_);
  }

  const std::vector<const Driver*> drivers_ = table();
  const std::vector<TrustedDevice> trusted_ = trusted();
};

TEST_F(AddingADriver, IsFoundAndListed) {
  const auto plugged = plugged_in(nowhere, {}, drivers_);
  ASSERT_EQ(plugged.size(), 1u);
  EXPECT_EQ(in_words(plugged[0]), "Handle on rails (rails)");
  const std::string listed = command::devices_text({}, trusted_, nowhere, plugged);
  EXPECT_NE(listed.find("Handle on rails"), std::string::npos);
  EXPECT_NE(listed.find("used as handle_on_rails, which rails.wale declares"), std::string::npos) << listed;
  made_up::rails().is_plugged_in = false;
  EXPECT_TRUE(plugged_in(nowhere, {}, drivers_).empty());
}

TEST_F(AddingADriver, IsChosenByEachOfItsSpellings) {
  for (const char* spelling : {"auto", "made-up", "handle_on_rails"}) {
    const auto choice = chosen(spelling);
    ASSERT_TRUE(choice) << spelling << ": " << choice.error().sentence;
    ASSERT_TRUE(choice->plugged) << spelling;
    EXPECT_EQ(choice->plugged->port, "rails") << spelling;
    EXPECT_EQ(choice->declared->profile.name, "handle_on_rails") << spelling;
  }
  const auto near = chosen("made-upp");
  ASSERT_FALSE(near);
  EXPECT_EQ(near.error().code, Code::unknown_device);
  EXPECT_EQ(near.error().mend, "did you mean `made-up`?");
}

TEST_F(AddingADriver, IsFeltAsItsDeclarationSays) {
  const auto choice = chosen("auto");
  ASSERT_TRUE(choice);
  auto opened = open_device(nowhere, *choice);
  ASSERT_TRUE(opened) << opened.error().sentence;
  EXPECT_EQ((*opened)->profile(), choice->declared->profile);
  Stage stage(**opened);
  Patch patch = *stage.add(built_for(spring(300), choice->declared->profile));
  const auto ran = stage.run({.seconds = 0.3});
  ASSERT_TRUE(ran) << ran.error().sentence;
  const auto& ticks = ran->record.ticks;
  ASSERT_FALSE(ticks.empty());
  EXPECT_LT(ticks.back().force.x, -1) << "the spring pushes towards the centre";
  float most = 0;
  for (const Force& force : made_up::rails().forces) {
    EXPECT_GE(force.x, 0) << "this motor is declared as reversed";
    most = std::max(most, force.x);
  }
  EXPECT_NEAR(most, -ticks.back().force.x, 1e-3);
  EXPECT_EQ(made_up::rails().open, 1);
  opened->reset();
  EXPECT_EQ(made_up::rails().open, 0);
}

TEST_F(AddingADriver, IsReopenedWithoutTheGivenDescriptor) {
  const auto choice = chosen("made-up");
  ASSERT_TRUE(choice);
  auto opened = open_device(nowhere, *choice, {.descriptor = 17});
  ASSERT_TRUE(opened);
  HotPluggedDevice& device = **opened;
  EXPECT_EQ(device.sample().contact, Contact::good);
  made_up::rails().is_plugged_in = false;
  EXPECT_EQ(device.sample().contact, Contact::lost);
  made_up::rails().is_plugged_in = true;
  while (device.sample().contact != Contact::good) {
    device.elapse(1);
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(made_up::rails().descriptors, (std::vector<int>{17, -1}));
  EXPECT_EQ(device.report().reason, "it came off its rails");
  EXPECT_EQ(device.report().returns, 1);
}

TEST_F(AddingADriver, IsWaitedForThoughNothingAnnouncesIt) {
  made_up::rails().is_plugged_in = false;
  const long looks_before = made_up::rails().looks;
  const std::atomic<bool> stop{false};
  Connections connections = nowhere;
  std::atomic<int> tries{0};
  auto waiting = std::async(std::launch::async, [&] {
    return wait_for_device(connections, {.spelling = "made-up"}, {}, trusted_, std::nullopt, stop, drivers_,
                           [&] { return ++tries, nowhere; });
  });
  // The first look, and two of those that no news has caused.
  while (made_up::rails().looks < looks_before + 3 && waiting.wait_for(1ms) == std::future_status::timeout) continue;
  made_up::rails().is_plugged_in = true;
  const auto choice = waiting.get();
  ASSERT_TRUE(choice) << choice.error().sentence;
  EXPECT_EQ(choice->plugged->port, "rails");
  EXPECT_GT(tries, 0) << "USB may come late too";
}

TEST_F(AddingADriver, TheTableOfDriversHasEachOnce) {
  std::vector<std::string> names;
  for (const Driver* driver : drivers()) names.emplace_back(driver->name);
  EXPECT_EQ(names, (std::vector<std::string>{"hid-pid", "novint-falcon", "pointer"})) << "in the order of `auto`";
  EXPECT_EQ(find_driver(drivers(), "made-up"), nullptr);
  EXPECT_EQ(find_driver(drivers_, "made-up"), &made_up_driver);
}

}  // namespace
}  // namespace wale::adding_driver_test
