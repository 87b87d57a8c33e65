#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wale {

/// A file that holds something else than Wale's text.
struct OtherFile {
  std::string_view what;  ///< "a picture"
  std::string_view mend;  ///< what to do with it, or what to name instead
};

/// Says what a file is by the bytes that it begins with, a table also by its name; none for what may be a Wale file.
/// A text that begins with `wale` is one, whatever follows.
std::optional<OtherFile> other_file(std::string_view name, std::string_view bytes);

/// What to name instead of a path that cannot be read as a Wale file: of a folder, a file in it.
std::string mend_of_path(const std::string& path);

}  // namespace wale
