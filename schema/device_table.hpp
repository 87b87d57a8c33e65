#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "wale/declared_device.hpp"
#include "wale/result.hpp"

namespace wale {

/// Declared devices as bytes, so that programs without the compiler know them. All numbers are little-endian; texts,
/// counts, and the sections DEVI and VIBR are as in a patch program (schema/PATCH_PROGRAM.md):
///
///     8 bytes  89 'W' 'D' 'T' 0d 0a 1a 0a
///     u16      version: 1
///     u32      number of devices, each:
///       DEVI     the profile
///       u8       1 if VIBR, the shaker of a pad, follows; else 0
///       u32      number of its USB devices, each u16 vendor, u16 product
///       u8       1 if it stands for all USB devices that no other declaration names; else 0
///       4 u8     its axes to the right and away, then its motors: 0 x, 1 -x, 2 y, 3 -y
///       2 f64    gain of both motors, 0.1 .. 10
///       text     class, then source
///       texts    u32 and that many texts, twice: the settings that are assumed, then those that are unknown
///
/// What was calibrated on one device (its responses, offsets and intervals) has no place here, so that no table can
/// hold the corrections of another device.
std::vector<std::byte> write_device_table(std::span<const DeclaredDevice> devices);

/// The same devices in the same order, without what was calibrated. Error: `damaged_file` for bytes that `write_device_table` does not write, and
/// for figures that no device can have. Never reads beyond the end, and allocates in proportion to the bytes.
Result<std::vector<DeclaredDevice>> read_device_table(std::span<const std::byte> bytes);

}  // namespace wale
