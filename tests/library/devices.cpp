// Every material of the library for every device: it builds, or says why not, and what is said of it is whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "compiler/describe/describe.hpp"
#include "compiler/listing/print_cpp.hpp"
#include "compiler/listing/print_program.hpp"
#include "tests/library/shelf.hpp"

namespace wale::devices_test {
namespace {

/// What of a device a material may ask too much of: an essential percept (W0404), a patch that does not fit (W0305).
bool explains(const Diagnostics& diagnostics) {
  return std::ranges::any_of(diagnostics.all(), [](const Diagnostic& each) {
    return each.code == Code::percept_unrealised || each.code == Code::value_out_of_range;
  });
}

class EveryDevice : public testing::TestWithParam<std::string> {};

TEST_P(EveryDevice, BuildsEachMaterialOrSaysWhyNot) {
  const std::string device = GetParam();
  int built = 0, refused = 0;
  for (const std::string& path : shelf::library_files()) {
    const shelf::Checked checked(path);
    const SourceSet& sources = checked.sources;
    for (const auto& material : checked.module.materials) {
      Diagnostics diagnostics;
      const auto program = compile_material(checked.module, material.name, device, sources, checked.source,
                                            *checked.resolver, diagnostics);
      std::string said;
      for (const auto& each : diagnostics.all()) said += render_text(each, sources, false);
      if (!program) {
        ++refused;
        EXPECT_TRUE(explains(diagnostics)) << material.name << "\n" << said;
        continue;
      }
      ++built;
      const PatchProgram& description = program->description();
      EXPECT_EQ(description.vibrates(), device == "touch_pad" || device == "gamepad");
      // A fate for each percept that was asked for, by name, and one for the physics where there is some.
      std::set<std::string> told;
      for (const FateRecord& fate : description.fates) told.insert(fate.name);
      for (const auto& asked : material.percepts) EXPECT_TRUE(told.contains(asked.name)) << material.name;
      EXPECT_GE(told.size(), material.percepts.size() + (material.force ? 1 : 0)) << material.name;
      if (!description.vibrates()) continue;
      EXPECT_EQ(read_patch_program(write_patch_program(description)).index(), 0u);
      const Description described = describe(Bank(*program));
      EXPECT_TRUE(described.shaking);
      EXPECT_FALSE(description_text(described).empty());
      EXPECT_FALSE(descriptions_json({described}).empty());
      EXPECT_FALSE(print_cpp(description).empty());
      EXPECT_FALSE(print_program(description).empty());
    }
  }
  EXPECT_GT(built, 100) << refused;
}

INSTANTIATE_TEST_SUITE_P(Devices, EveryDevice, testing::Values("falcon", "touch_pad", "gamepad"),
                         [](const auto& device) { return device.param; });

}  // namespace
}  // namespace wale::devices_test
