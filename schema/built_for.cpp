#include "schema/built_for.hpp"

#include <array>
#include <charconv>
#include <string>

namespace wale {
namespace {

struct Figure {
  const char* name;
  const char* unit;
  double DeviceProfile::*value;
};

/// What is compiled into a program, or what its code counts on at run time.
constexpr std::array figures{Figure{"force", " N", &DeviceProfile::force_newton},
                             Figure{"force counts", "", &DeviceProfile::force_counts},
                             Figure{"rate", " Hz", &DeviceProfile::rate},
                             Figure{"workspace", " m", &DeviceProfile::workspace_diameter},
                             Figure{"position counts", "", &DeviceProfile::position_counts},
                             Figure{"speed", " m/s", &DeviceProfile::speed_limit},
                             Figure{"window of the velocity filter", " ticks", &DeviceProfile::velocity_window},
                             Figure{"noise of the velocity filter", " counts", &DeviceProfile::velocity_noise_counts}};

std::string shown(double value, const char* unit) {
  std::array<char, 32> text;
  return std::string(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr) + unit;
}

}  // namespace

Result<> is_built_for(const PatchProgram& program, const DeviceProfile& declared) {
  const DeviceProfile& built = program.device;
  if (built.name != declared.name)
    return Error{Code::other_device,
                 "`" + program.material + "` is built for `" + built.name + "`, not for `" + declared.name + "`",
                 "feel it on `" + built.name + "`, or build it for `" + declared.name + "`"};
  std::string differences;
  const auto differ = [&](const std::string& what) { differences += (differences.empty() ? "" : "; ") + what; };
  for (const auto& [name, unit, value] : figures)
    if (!(built.*value == declared.*value))
      differ(std::string(name) + " " + shown(built.*value, unit) + " in the program, " + shown(declared.*value, unit) +
             " declared");
  if (built.shaker != declared.shaker) differ("how it vibrates");
  if (differences.empty()) return {};
  return Error{Code::other_figures,
               "`" + program.material + "` is built for other figures of `" + built.name +
                   "` than its declaration has: " + differences,
               "build it again from its Wale file by this Wale; a declaration of your own belongs into your "
               "devices.wale, or into another file or text of devices that you name"};
}

}  // namespace wale
