#pragma once

#include "schema/byte_writer.hpp"
#include "wale/device_profile.hpp"

namespace wale::patch_program_format {

/// Writes the section DEVI: the profile without the shaker.
void write_device(ByteWriter& out, const DeviceProfile& device);
/// Writes the section VIBR: the shaker.
void write_shaker(ByteWriter& out, const Shaker& vibration);

}  // namespace wale::patch_program_format
