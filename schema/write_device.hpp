#pragma once

#include "schema/byte_writer.hpp"
#include "schema/device_profile.hpp"

namespace wale::patch_program_format {

/// The section DEVI: everything but the vibration.
void write_device(ByteWriter& out, const DeviceProfile& device);
/// The section VIBR.
void write_shaker(ByteWriter& out, const Shaker& vibration);

}  // namespace wale::patch_program_format
