#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// A finished picture: rows from the top, red, green and blue of 8 bits each, sRGB.
struct Drawing {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  friend bool operator==(const Drawing&, const Drawing&) = default;
};

/// The bytes of a picture file in the format that the extension of `name` says: png, or another that OpenImageIO writes
/// to memory. The same drawing gives the same bytes: they hold no date and no name of a machine or program.
///
/// Errors: `Code::malformed_value` for an extension of no such format, `unwritable_file`, `missing_library`; the place
/// has `name`.
Result<std::vector<std::byte>> encode_drawing(const Drawing& drawing, const std::string& name);

}  // namespace wale
