#pragma once

#include <string>
#include <vector>

#include "runtime/device/identification.hpp"
#include "schema/declared_device.hpp"

namespace wale::command {

/// What identifying found out, for a person: what each motor moves, from which force on, and what the person showed.
std::string identified_text(const Identified& found);

/// A file that declares `device`, to build for it. Its figures that are assumed or unknown stay so. `comments` are
/// lines without `//`.
std::string device_declaration(const DeclaredDevice& device, const std::vector<std::string>& comments);

}  // namespace wale::command
