#include "runtime/record/profile_program.hpp"

#include <utility>

#include "wale/program.hpp"

namespace wale {
namespace {

constexpr float some_width = 1e-3f;  // m; a program needs a patch size, and a profile may lack one

PatchProgram nothing_on(const DeviceProfile& profile) {
  PatchProgram program;
  program.material = "nothing";
  program.device = profile;
  program.patch_width = program.patch_height = some_width;
  const bool vibrates = profile.shaker.has_value();
  program.constants = {0, static_cast<float>(profile.most()),
                       static_cast<float>(vibrates ? profile.shaker->frequency_high : profile.most())};
  program.temporaries = 2;
  for (std::uint8_t i = 0; i < 2; ++i) {
    const auto ceiling = static_cast<RegisterNumber>(first_constant + 1 + i);
    const auto value = static_cast<RegisterNumber>(program.first_temporary() + i);
    program.tick.push_back(
        {static_cast<std::uint8_t>(Operation::limit), value, static_cast<RegisterNumber>(first_constant), ceiling});
    const OutputQuantity quantity = !vibrates ? OutputQuantity::force
                                    : i == 0  ? OutputQuantity::amplitude
                                              : OutputQuantity::frequency;
    program.outputs.push_back({quantity, vibrates ? std::uint8_t{0} : i, value, ceiling});
  }
  program.picture.relief = static_cast<RegisterNumber>(first_constant);
  return program;
}

}  // namespace

Result<std::vector<std::byte>> write_profile(const DeviceProfile& profile) {
  PatchProgram program = nothing_on(profile);
  if (auto loaded = Program::load(program); !loaded) return std::move(loaded).error();
  return write_patch_program(program);
}

Result<DeviceProfile> read_profile(std::span<const std::byte> bytes) {
  auto loaded = Program::load(bytes);
  if (!loaded) return std::move(loaded).error();
  return loaded->description().device;
}

}  // namespace wale
