// The table of devices that a build without the compiler takes.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "runtime/device/shipped_devices.hpp"

namespace wale::device_test {
namespace {

TEST(ShippedTable, IsThatOfTheDeclarations) {
  std::ifstream file(WALE_SOURCE_DIR "/runtime/device/shipped_devices.wdt", std::ios::binary);
  const std::string kept((std::istreambuf_iterator<char>(file)), {});
  const auto table = shipped_device_table();
  ASSERT_FALSE(table.empty());
  EXPECT_TRUE(std::ranges::equal(kept, table, {}, [](char c) { return static_cast<std::byte>(c); }))
      << "calibration/devices has changed: copy build/runtime/devices.wdt to runtime/device/shipped_devices.wdt";
}

}  // namespace
}  // namespace wale::device_test
