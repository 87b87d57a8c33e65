#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace wale {

/// A value as JSON in one line. Texts that are not UTF-8 have U+FFFD for their wrong bytes, since names come from
/// files, paths and devices.
template <class Json>
std::string json_text(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The same in indented lines, with a newline at the end: what a command prints.
template <class Json>
std::string json_lines(const Json& value) {
  return value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace wale
