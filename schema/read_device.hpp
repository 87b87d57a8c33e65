#pragma once

#include "schema/byte_reader.hpp"
#include "wale/device_profile.hpp"

namespace wale::patch_program_format {

/// Reads the section DEVI: the profile without the shaker. Throws `Error` with `damaged_file`.
DeviceProfile read_device(ByteReader& in);
/// Reads the section VIBR: the shaker. Throws `Error` with `damaged_file`.
Shaker read_shaker(ByteReader& in);

}  // namespace wale::patch_program_format
