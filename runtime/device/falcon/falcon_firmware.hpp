#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// The file that holds the Falcon's firmware: the one that WALE_FALCON_FIRMWARE names in the environment, otherwise
/// `wale/falcon_firmware.bin` in the user's data folder ($XDG_DATA_HOME or ~/.local/share).
std::filesystem::path falcon_firmware_path();

/// Reads a firmware file. The error (`unreadable_file`, `damaged_file`) says where to get one and where to put it.
Result<std::vector<std::uint8_t>> read_falcon_firmware(const std::filesystem::path& path);

}  // namespace wale
