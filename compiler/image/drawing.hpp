#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace wale {

/// A finished picture: rows from the top, red, green and blue of 8 bits each, sRGB.
struct Drawing {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  /// False when no font is installed: then the picture is whole but carries no text (Debian: fonts-dejavu-core).
  bool has_text = true;

  friend bool operator==(const Drawing&, const Drawing&) = default;
};

/// Why a drawing could not be written; a whole phrase, "cannot write wall.png: Permission denied".
struct DrawingProblem {
  std::string reason;
};

/// The bytes of a picture file in the format that `name`'s extension names: png, or what else OpenImageIO writes to
/// memory. The same drawing gives the same bytes: no date, no name of a machine or program.
std::variant<std::vector<std::byte>, DrawingProblem> encode_drawing(const Drawing& drawing, const std::string& name);

/// Encodes by the extension of `path` and writes the file; nothing when all went well. A file that cannot be written
/// whole is removed.
std::optional<DrawingProblem> save_drawing(const Drawing& drawing, const std::string& path);

}  // namespace wale
