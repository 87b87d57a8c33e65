#include "runtime/device/usb/kernel_nodes.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "runtime/device/shipped_devices.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::test {
namespace {

TEST(NodeHolders, AreFoundAmongTheOpenFilesOfOtherProcesses) {
  const TemporaryFolder proc;
  const auto process = [&](const std::string& number, const std::string& program, const std::string& file) {
    std::filesystem::create_directories(proc.path() / number / "fd");
    std::filesystem::create_symlink(file, proc.path() / number / "fd" / "7");
    std::ofstream(proc.path() / number / "comm") << program << "\n";
  };
  process("4211", "steam", "/dev/hidraw3");
  process("93", "joystick", "/dev/input/event5");
  process("94", "editor", "/dev/hidraw30");
  process(std::to_string(getpid()), "this", "/dev/hidraw3");
  std::filesystem::create_directories(proc.path() / "sys");
  const NodeHolders holders = who_holds({"/dev/hidraw3", "/dev/input/event5"}, proc.path());
  EXPECT_EQ(holders.seen,
            (std::vector<NodeHolder>{{93, "joystick", "/dev/input/event5"}, {4211, "steam", "/dev/hidraw3"}}));
  EXPECT_EQ(in_words(holders),
            "joystick (process 93) has /dev/input/event5 open, steam (process 4211) has /dev/hidraw3 open");
  EXPECT_TRUE(in_words(who_holds({"/dev/hidraw4"}, proc.path())).empty());
}

TEST(UdevRule, TheFileHasItForEachDeclaredDevice) {
  std::ifstream file(std::string(WALE_SOURCE_DIR) + "/runtime/device/hid_pid/70-wale.rules");
  ASSERT_TRUE(file);
  std::string rules;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '#') rules += line + "\n";
  }
  const auto& devices = shipped_devices();
  ASSERT_TRUE(devices);
  std::size_t expected = 0;
  for (const DeclaredDevice& device : *devices) {
    for (const UsbNumbers& numbers : device.wiring.usb) {
      const std::string rule = udev_rule(numbers.vendor, numbers.product);
      EXPECT_NE(rules.find(rule), std::string::npos) << in_words(numbers) << "\n" << rule;
      expected += rule.size();
    }
  }
  EXPECT_GT(expected, 0u);
  EXPECT_EQ(rules.size(), expected) << "the file has other rules, too";
}

}  // namespace
}  // namespace wale::test
