#pragma once

#include <string>
#include <string_view>

#include "wale/result.hpp"

namespace wale {

/// What to do about a text that is no name.
inline constexpr const char* usual_name_mend = "write a name, as in \"corduroy\" or \"roughness\"";
/// The same where it names a device.
inline constexpr const char* device_name_mend = "write the name of a device's profile, as in \"sandpaper\"";

/// Whether a text that a program hands over may be a name at all. `argument` is the name of that argument, `mend` what to
/// do if the text is empty, blank or of several lines, and `what` what the argument is. Errors:
/// `invalid_encoding` for a text that is not UTF-8 or holds a zero byte; `malformed_value` for one that is empty, of
/// blanks alone, or of several lines.
Result<> is_name_text(const std::string& argument, std::string_view text, const char* mend = usual_name_mend,
                      const char* what = "a name");

/// Whether a text may be a path: the system would take one with a zero byte for what stands before that. Error:
/// `invalid_encoding`, about `argument`.
Result<> is_path_text(const std::string& argument, std::string_view path);

}  // namespace wale
