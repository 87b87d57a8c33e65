#include "runtime/machine/verify_figures.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/machine/verify.hpp"
#include "schema/refuse.hpp"

namespace wale {
namespace {

/// `value` in low .. high, which not-a-number never is.
void require_within(double value, double low, double high, std::string_view what) {
  if (!(value >= low && value <= high)) refuse(what, " is ", value, " and must be in ", low, " .. ", high);
}

void verify_registers(const PatchProgram& program) {
  if (program.register_count() > register_limit) {
    refuse("the program has ", program.register_count(), " registers and may have ", register_limit);
  }
}

void verify_parameters(const PatchProgram& program) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < program.parameters.size(); ++i) {
    const Parameter& parameter = program.parameters[i];
    if (parameter.name.empty()) refuse("parameter ", i, " has no name");
    if (!names.insert(parameter.name).second) refuse("parameter ", i, " is the second of the name ", parameter.name);
    if (!std::isfinite(parameter.low) || !std::isfinite(parameter.high) ||
        !(parameter.low <= parameter.value && parameter.value <= parameter.high)) {
      refuse("parameter ", parameter.name, " has the value ", parameter.value, " and the range ", parameter.low, " .. ",
             parameter.high);
    }
    if (!std::isfinite(parameter.unit_in_si) || !(parameter.unit_in_si > 0)) {
      refuse("parameter ", parameter.name, " has a unit of ", parameter.unit_in_si);
    }
  }
}

void verify_tables(const PatchProgram& program) {
  for (std::size_t i = 0; i < program.tables.size(); ++i) {
    const HeightTable& table = program.tables[i];
    const std::string name = "table " + std::to_string(i);
    require_within(table.width, table_side_least, table_side_most, name + "'s width");
    require_within(table.height, table_side_least, table_side_most, name + "'s height");
    if (table.heights.size() != std::size_t{table.width} * table.height) {
      refuse(name, " has ", table.heights.size(), " heights for ", table.width, " x ", table.height);
    }
  }
}

void verify_lattices(const PatchProgram& program) {
  for (std::size_t i = 0; i < program.peaks.size(); ++i) {
    const Peak& peak = program.peaks[i];
    const std::string name = "peak " + std::to_string(i);
    require_within(peak.points, 1, peak_points_limit, name + "'s number of points");
    if (!(peak.percentile > 0 && peak.percentile <= 1)) {
      refuse(name, "'s percentile is ", peak.percentile, " and must be above 0 and at most 1");
    }
  }
}

void verify_patch(const PatchProgram& program) {
  const double most = program.device.workspace_diameter;
  const auto side = [most](float value, std::string_view what) {
    if (!(value > 0 && value <= most)) {
      refuse("the patch's ", what, " is ", value, " m and must be above 0 and at most the workspace's ", most);
    }
  };
  side(program.patch_width, "width");
  side(program.patch_height, "height");
  const float half = 0.5f * std::min(program.patch_width, program.patch_height);
  if (!(program.patch_rim >= 0 && program.patch_rim < half)) {
    refuse("the patch's rim is ", program.patch_rim, " m and must leave a middle of its ", 2 * half);
  }
}

void verify_device(const DeviceProfile& device) {
  require_within(device.workspace_diameter, 1e-3, 10, "the device's workspace diameter (m)");
  require_within(device.position_counts, 2, 1e9, "the device's number of position counts");
  require_within(device.force_newton, 1e-3, 1000, "the device's force (N)");
  require_within(device.force_counts, 1, 1e9, "the device's number of force counts");
  require_within(device.rate, 100, 10000, "the device's rate (Hz)");
  require_within(device.speed_limit, 1e-3, 100, "the device's speed limit (m/s)");
  require_within(device.slew, 0, 1e9, "the device's slew (N/s)");
  require_within(device.velocity_window, 0, 1e4, "the device's velocity window (ticks)");
  require_within(device.velocity_noise_counts, 0, 1e6, "the device's velocity noise (counts)");
  require_within(device.patch_width, 0, 10, "the device's patch width (m)");
  require_within(device.patch_height, 0, 10, "the device's patch height (m)");
  require_within(device.patch_rim, 0, 10, "the device's patch rim (m)");
  require_within(device.mass, 0, 1000, "the device's mass (kg)");
  require_within(device.damping, 0, 1e6, "the device's damping (N s/m)");
  require_within(device.friction, 0, 1000, "the device's friction (N)");
}

void verify_percepts(const PatchProgram& program) {
  const auto graded = [](Evidence evidence) {
    return evidence >= Evidence::measured && evidence <= Evidence::transferred;
  };
  for (std::size_t i = 0; i < program.percepts.size(); ++i) {
    const PerceptRecord& percept = program.percepts[i];
    const std::string name = "percept " + std::to_string(i);
    if (percept.name.empty()) refuse(name, " has no name");
    if (percept.parameter && *percept.parameter >= program.parameters.size()) {
      refuse(name, " is set by parameter ", *percept.parameter, " of ", program.parameters.size());
    }
    if (!std::isfinite(percept.valid_high) || !(percept.valid_low >= 0 && percept.valid_low <= percept.valid_high)) {
      refuse(name, "'s map is valid in ", percept.valid_low, " .. ", percept.valid_high);
    }
    require_within(percept.scatter, 0, 100, name + "'s scatter");
    if (!graded(percept.slope) || !graded(percept.anchor) || !graded(percept.handle)) {
      refuse(name, " grades its evidence in a way that this Wale does not know");
    }
  }
}

}  // namespace

void verify_figures(const PatchProgram& program) {
  verify_registers(program);
  verify_device(program.device);
  verify_patch(program);
  verify_parameters(program);
  verify_tables(program);
  verify_lattices(program);
  verify_percepts(program);
}

}  // namespace wale
