#include "library/device_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

namespace wale {

std::string devices_text(const std::vector<DescribedDevice>& devices) {
  std::string text =
      "to feel on (wale feel --device NAME)\n"
      "  simulated    the joystick that the program was built for, simulated, in a simulated hand\n"
      "  USB joysticks are not driven by this version.\n\nto build for (wale build --device NAME)\n";
  for (const auto& [profile, source, assumed] : devices) {
    text += fmt::format("  {:<12} 2 axes, {:.4g} N in {:.4g} steps, {:.4g} mm across in {:.4g} counts, {:.4g} Hz\n",
                        profile.name, profile.force_newton, profile.force_counts, 1e3 * profile.workspace_diameter,
                        profile.position_counts, profile.rate);
    text += fmt::format("  {:<12} moving mass {:.3g} kg, damping {:.3g} N s/m, friction {:.3g} N\n", "", profile.mass,
                        profile.damping, profile.friction);
    if (!assumed.empty()) text += fmt::format("  {:<12} assumed, not measured: {}\n", "", fmt::join(assumed, ", "));
    if (!source.empty()) text += fmt::format("  {:<12} {}\n", "", source);
  }
  return text;
}

std::string devices_json(const std::vector<DescribedDevice>& devices) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  json.push_back({{"name", "simulated"}, {"feel", true}, {"build", false}});
  for (const auto& [profile, source, assumed] : devices)
    json.push_back({{"name", profile.name},
                    {"feel", false},
                    {"build", true},
                    {"axes", 2},
                    {"force_newton", profile.force_newton},
                    {"force_counts", profile.force_counts},
                    {"workspace_m", profile.workspace_diameter},
                    {"position_counts", profile.position_counts},
                    {"rate_hz", profile.rate},
                    {"mass_kg", profile.mass},
                    {"damping_newton_second_per_m", profile.damping},
                    {"friction_newton", profile.friction},
                    {"assumed", assumed},
                    {"source", source}});
  return json.dump(2) + "\n";
}

}  // namespace wale
