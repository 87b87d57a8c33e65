// The word `assumed` in a device record.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compiler/compile.hpp"

namespace wale::records_test {
namespace {

TEST(DeviceRecord, TheWordAssumedMayStandBeforeOrAfterTheFigure) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  const SourceId source = sources.add("device.wale", R"(wale 1
device bench {
  workspace disc(100 mm)
  position  4096 counts
  force     5 N, 1024 counts
  rate      900 Hz
  speed     1 m/s
  slew      100 N/s
  velocity_filter 15, 1 counts
  patch     50 mm, 50 mm, 2 mm
  mass      assumed 0.3 kg
  damping   1 N s/m assumed
  friction  0.15 N
}
)");
  const CheckedModule module = check_source(sources, source, *resolver, diagnostics);
  ASSERT_FALSE(diagnostics.has_errors());
  EXPECT_EQ(module.declarations().devices.find("bench")->assumed, (std::vector<std::string>{"mass", "damping"}));
}

}  // namespace
}  // namespace wale::records_test
