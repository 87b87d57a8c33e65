#pragma once

#include <string>
#include <vector>

#include "runtime/device/identification.hpp"
#include "wale/declared_device.hpp"

namespace wale::command {

/// The results of identifying, for a person: the axis that each motor moves, from which force on, and the axes that the
/// person showed.
std::string identified_text(const Identified& found);

/// A Wale file that declares `device`, to build for it, with what was calibrated on it. Assumed and unknown figures
/// stay marked as such. `comments` are lines without `//`, `more` are settings besides the device's own.
std::string device_declaration(const DeclaredDevice& device, const std::vector<std::string>& comments,
                               const std::vector<std::string>& more = {});

/// The settings by which a declaration says what was calibrated: each a line without its end, `gain right 0.92, within
/// 0.91
/// .. 0.93`, with the key first. The handle's are among them only if they have an interval.
std::vector<std::string> calibrated_settings(const DeclaredDevice& device);

}  // namespace wale::command
