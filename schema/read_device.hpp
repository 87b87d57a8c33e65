#pragma once

#include "schema/byte_reader.hpp"
#include "schema/device_profile.hpp"

namespace wale::patch_program_format {

/// The section DEVI: everything but the vibration.
DeviceProfile read_device(ByteReader& in);
/// The section VIBR.
Shaker read_shaker(ByteReader& in);

}  // namespace wale::patch_program_format
