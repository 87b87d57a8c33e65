#include "runtime/device/usb/system_error.hpp"

#include <cerrno>
#include <cstring>

namespace wale {

Error why_not_opened(int error, const std::string& node) {
  const Place place{.name = node};
  switch (error) {
    case EACCES:
    case EPERM: return {Code::no_permission, "no permission to open " + node, {}, place};
    case ENOENT:
    case ENODEV:
    case ENXIO: return {Code::absent_device, "it was unplugged", {}, place};
    case EBUSY: return {Code::unusable_device, "another program has claimed it", {}, place};
    default: return {Code::unusable_device, node + " cannot be opened: " + std::strerror(error), {}, place};
  }
}

}  // namespace wale
