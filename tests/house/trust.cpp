// Who may say what scales a real device, and who writes force into packets: one file each.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace wale::trust_test {
namespace {

namespace fs = std::filesystem;

/// The files outside the tests that have a text.
std::set<std::string> files_with(const std::string& text) {
  std::set<std::string> found;
  const fs::path root = WALE_SOURCE_DIR;
  for (const char* folder : {"schema", "runtime", "compiler", "calibration", "library", "examples"})
    for (const auto& each : fs::recursive_directory_iterator(root / folder)) {
      if (each.path().extension() != ".cpp" && each.path().extension() != ".hpp") continue;
      std::ifstream file(each.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), {}};
      if (bytes.find(text) != std::string::npos) found.insert(each.path().lexically_relative(root).generic_string());
    }
  return found;
}

TEST(Trust, OnlyTheReaderOfTheOwnersFilesMakesTrustedDevices) {
  EXPECT_EQ(files_with("TrustedDevice::by_owner"),
            (std::set<std::string>{"calibration/feel/trusted_declarations.cpp"}));
}

TEST(Trust, OnlyTheGatesMakeForcesForPackets) {
  EXPECT_EQ(files_with("Magnitude(counts)"), (std::set<std::string>{"runtime/device/hid_pid/force_gate.cpp"}));
  EXPECT_EQ(files_with("command.torques = "), (std::set<std::string>{"runtime/device/falcon/falcon_session.cpp"}));
  EXPECT_EQ(files_with("constant.level = "), (std::set<std::string>{"runtime/device/hid_pid/evdev_transport.cpp"}));
}

}  // namespace
}  // namespace wale::trust_test
