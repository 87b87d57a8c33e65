#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "schema/patch_program.hpp"

namespace wale {

/// Where the Falcon's firmware is looked for: what the environment's WALE_FALCON_FIRMWARE names, otherwise
/// `wale/falcon_firmware.bin` in the user's data ($XDG_DATA_HOME, ~/.local/share).
std::filesystem::path falcon_firmware_path();

/// A file of firmware. The refusal says where one comes from and how to name it.
std::variant<std::vector<std::uint8_t>, Refusal> read_falcon_firmware(const std::filesystem::path& path);

}  // namespace wale
