#pragma once

#include <string>
#include <vector>

#include "runtime/device/identification.hpp"
#include "wale/declared_device.hpp"

namespace wale::command {

/// The results of identifying, for a person: the axis that each motor moves, from which force on, and the axes that the
/// person showed.
std::string identified_text(const Identified& found);

/// A Wale file that declares `device`, to build for it. Assumed and unknown figures stay marked as such. `comments` are
/// lines without `//`.
std::string device_declaration(const DeclaredDevice& device, const std::vector<std::string>& comments);

}  // namespace wale::command
