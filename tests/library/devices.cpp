// Every material of the library for every declared device: it compiles, or the pad's diagnostics explain why not, and
// its fates are complete.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "compiler/describe/describe.hpp"
#include "compiler/cpp/print_header.hpp"
#include "compiler/listing/print_program.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/library/shelf.hpp"

namespace wale::devices_test {
namespace {

std::vector<std::string> declared_devices() { return common_modules()->declarations.devices.spellings(); }

const DeviceProfile& profile_of(const std::string& device) {
  return common_modules()->declarations.devices.find(device)->profile;
}

/// Whether the diagnostics say that a percept is not realised (W0404), the only valid reason on a device that vibrates.
bool explains(const Diagnostics& diagnostics) {
  return std::ranges::any_of(diagnostics.all(),
                             [](const Diagnostic& each) { return each.code == Code::percept_unrealised; });
}

/// Whether the diagnostics say that the patch is cut to the device.
bool tells_of_cut(const Diagnostics& diagnostics) {
  return std::ranges::any_of(diagnostics.all(), [](const Diagnostic& each) { return each.code == Code::cut_patch; });
}

class EveryDevice : public testing::TestWithParam<std::string> {};

TEST_P(EveryDevice, BuildsEachMaterialOrSaysWhyNot) {
  const std::string device = GetParam();
  int built = 0, refused = 0;
  // Each device with another tenth of the library.
  const auto devices = declared_devices();
  const auto which = static_cast<std::size_t>(std::ranges::find(devices, device) - devices.begin());
  for (const std::string& path : shelf::sampled_files(10, which)) {
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
        EXPECT_TRUE(profile_of(device).shaker && explains(diagnostics)) << material.name << "\n" << said;
        continue;
      }
      ++built;
      const PatchProgram& description = program->description();
      EXPECT_EQ(description.vibrates(), profile_of(device).shaker.has_value());
      const double widest = profile_of(device).widest_patch();
      EXPECT_LE(double{std::max(description.patch_width, description.patch_height)}, widest);
      // There is a fate for each percept by name, and one for the force where there is one.
      std::set<std::string> told;
      for (const FateRecord& fate : description.fates) told.insert(fate.name);
      for (const auto& asked : material.percepts) EXPECT_TRUE(told.contains(asked.name)) << material.name;
      EXPECT_GE(told.size(), material.percepts.size() + (material.force ? 1 : 0)) << material.name;
      const bool is_wider = material.patch && std::max((*material.patch)[0], (*material.patch)[1]) > widest;
      EXPECT_EQ(tells_of_cut(diagnostics), is_wider) << material.name;
      EXPECT_EQ(told.contains("place"), is_wider) << material.name;
      if (!description.vibrates()) continue;
      EXPECT_TRUE(read_patch_program(write_patch_program(description)));
      const Description described = describe(Bank(*program), common_modules()->declarations, Texture::left_out);
      EXPECT_TRUE(described.shaking);
      EXPECT_FALSE(description_text(described).empty());
      EXPECT_FALSE(descriptions_json({described}).empty());
      EXPECT_FALSE(print_header(*program, {}).empty());
      EXPECT_FALSE(print_program(description).empty());
    }
  }
  EXPECT_GT(built, 30) << refused;
}

INSTANTIATE_TEST_SUITE_P(Devices, EveryDevice, testing::ValuesIn(declared_devices()),
                         [](const auto& device) { return device.param; });

}  // namespace
}  // namespace wale::devices_test
