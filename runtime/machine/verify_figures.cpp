#include "runtime/machine/verify_figures.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <set>

#include "runtime/machine/arithmetic.hpp"
#include "runtime/machine/verify.hpp"

namespace wale {
namespace {

/// Refuses a quantity outside low .. high, not-a-number included.
template <std::floating_point Value, typename... What>
void require_within(Value value, double low, double high, const What&... what) {
  if (!(value >= low && value <= high)) refuse(what..., " is ", value, ", expected ", low, " .. ", high);
}

/// The same for a count.
template <std::integral Count, typename... What>
void require_within(Count count, std::uint64_t low, std::uint64_t high, const What&... what) {
  if (!(count >= low && count <= high)) refuse(what..., " is ", count, ", expected ", low, " .. ", high);
}

void verify_registers(const PatchProgram& program) {
  if (program.register_count() > register_limit) {
    refuse("the program has ", program.register_count(), " registers, expected at most ", register_limit);
  }
}

void verify_parameters(const PatchProgram& program) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < program.parameters.size(); ++i) {
    const Parameter& parameter = program.parameters[i];
    if (parameter.name.empty()) refuse("parameter ", i, " has no name");
    if (!names.insert(parameter.name).second) refuse("parameter ", i, " is the second with the name ", parameter.name);
    if (!std::isfinite(parameter.low) || !std::isfinite(parameter.high) ||
        !(parameter.low <= parameter.value && parameter.value <= parameter.high)) {
      refuse("parameter ", parameter.name, " has the value ", parameter.value, " and the range ", parameter.low, " .. ",
             parameter.high, ", expected a value within a finite range");
    }
    if (!(parameter.low <= parameter.soft_low && parameter.soft_low <= parameter.soft_high &&
          parameter.soft_high <= parameter.high)) {
      refuse("parameter ", parameter.name, " has the usual range ", parameter.soft_low, " .. ", parameter.soft_high,
             ", which is not a range within ", parameter.low, " .. ", parameter.high);
    }
    if (!std::isfinite(parameter.unit_in_si) || !(parameter.unit_in_si > 0)) {
      refuse("parameter ", parameter.name, " has a unit of ", parameter.unit_in_si, ", expected more than 0");
    }
  }
}

void require_at_most(std::size_t count, std::size_t most, std::string_view what) {
  if (count > most) refuse("the program has ", count, " ", what, ", expected at most ", most);
}

void verify_states(const PatchProgram& program) {
  require_at_most(program.states.size(), states_limit, "states");
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < program.states.size(); ++i) {
    const State& state = program.states[i];
    if (state.name.empty()) refuse("state ", i, " has no name");
    if (!names.insert(state.name).second) refuse("state ", i, " is the second with the name ", state.name);
    if (!std::isfinite(state.low) || !std::isfinite(state.high) || !(state.low <= state.high)) {
      refuse("state ", state.name, " has the range ", state.low, " .. ", state.high,
             ", expected a finite range in rising order");
    }
  }
}

void verify_grids(const PatchProgram& program) {
  require_at_most(program.grids.size(), grids_limit, "grids");
  require_at_most(program.writes.size(), writes_limit, "writes to grids");
  std::set<std::string_view> names;
  std::size_t cells = 0;
  for (std::size_t i = 0; i < program.grids.size(); ++i) {
    const Grid& grid = program.grids[i];
    if (grid.name.empty()) refuse("grid ", i, " has no name");
    if (!names.insert(grid.name).second) refuse("grid ", i, " is the second with the name ", grid.name);
    require_within(grid.columns, 1, grid_side_limit, "grid ", grid.name, "'s number of columns");
    require_within(grid.rows, 1, grid_side_limit, "grid ", grid.name, "'s number of rows");
    cells += std::size_t{grid.columns} * grid.rows;
    if (!std::isfinite(grid.low) || !std::isfinite(grid.high) ||
        !(grid.low <= grid.initial && grid.initial <= grid.high)) {
      refuse("grid ", grid.name, " begins at ", grid.initial, " and has the range ", grid.low, " .. ", grid.high,
             ", expected a value within a finite range");
    }
  }
  require_at_most(cells, cells_limit, "cells in its grids");
}

void verify_marks(const PatchProgram& program) {
  const std::vector<Mark>& marks = program.picture.marks;
  require_at_most(marks.size(), marks_limit, "marks");
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const std::size_t operands = mark_operands(marks[i].kind);
    if (operands == 0) refuse("mark ", i, " is of a kind that this Wale does not know");
    for (std::size_t beyond = operands; beyond < marks[i].operands.size(); ++beyond) {
      if (marks[i].operands[beyond] != 0) refuse("mark ", i, " has ", operands, " operands; the others must be 0");
    }
    if (marks[i].colour > 0xffffff) refuse("mark ", i, " has a colour above 0xffffff");
  }
}

void verify_tables(const PatchProgram& program) {
  for (std::size_t i = 0; i < program.tables.size(); ++i) {
    const HeightTable& table = program.tables[i];
    const std::string name = "table " + std::to_string(i);
    require_within(table.width, table_side_least, table_side_most, name, "'s width");
    require_within(table.height, table_side_least, table_side_most, name, "'s height");
    if (table.heights.size() != std::size_t{table.width} * table.height) {
      refuse(name, " has ", table.heights.size(), " heights for ", table.width, " x ", table.height);
    }
  }
}

void verify_lattices(const PatchProgram& program) {
  for (std::size_t i = 0; i < program.peaks.size(); ++i) {
    const Peak& peak = program.peaks[i];
    const std::string name = "peak " + std::to_string(i);
    require_within(peak.points, 1, peak_points_limit, name, "'s number of points");
    if (!(peak.percentile > 0 && peak.percentile <= 1)) {
      refuse(name, "'s percentile is ", peak.percentile, ", expected more than 0 and at most 1");
    }
  }
}

void verify_patch(const PatchProgram& program) {
  const double most = program.device.widest_patch();
  const auto side = [most](float value, std::string_view what) {
    if (!(value >= 2 * arithmetic::least_normal &&
          value <= most)) {  // the machine flushes half of a smaller one to zero
      refuse("the patch's ", what, " is ", value, " m, expected more than 0 and at most the workspace's ", most, " m");
    }
  };
  side(program.patch_width, "width");
  side(program.patch_height, "height");
  const float half = 0.5f * std::min(program.patch_width, program.patch_height);
  if (!(program.patch_rim >= 0 && program.patch_rim < half)) {
    refuse("the patch's rim is ", program.patch_rim, " m, expected 0 or more and less than ", half,
           " m, half of its smaller side");
  }
  if (!(program.active_watt >= 0 && program.active_watt <= most_active_watt)) {
    refuse("the program declares that it gives ", program.active_watt, " W by itself, expected 0 .. ",
           most_active_watt);
  }
}

/// Checks a pad's vibration: there is a command for every acceleration that a program may ask for.
void verify_vibration(const Shaker& vibration) {
  require_within(vibration.frequency_low, 1e-3, 1e5, "the device's least frequency (Hz)");
  require_within(vibration.frequency_high, vibration.frequency_low, 1e5, "the device's greatest frequency (Hz)");
  require_within(vibration.command_steps, 0, 1e9, "the device's number of command steps");
  require_within(vibration.spin_up, 0, 10, "the device's spin-up (s)");
  const bool has_position = vibration.position != PositionSource::none;
  if (vibration.position > PositionSource::touch)
    refuse("the device has a position source that this Wale does not know");
  require_within(vibration.exploring_speed, has_position ? 0 : 1e-3, 100, "the device's exploring speed (m/s)");
  require_within(vibration.response.size(), 1, 4096, "the number of frequencies in its response");
  double frequency = 0;
  for (const Shaker::Response& response : vibration.response) {
    if (!(response.frequency > frequency)) refuse("the frequencies of the device's response do not rise");
    require_within(frequency = response.frequency, 1e-3, 1e5, "a frequency of the device's response (Hz)");
    require_within(response.points.size(), 1, 4096, "the number of points in its response");
    double command = 0, acceleration = 0;
    for (const auto& point : response.points) {
      if (!(point.command > command && point.acceleration > acceleration)) {
        refuse("the points of the device's response at ", frequency, " Hz do not rise");
      }
      require_within(command = point.command, 1e-6, 1, "a command of the device's response");
      require_within(acceleration = point.acceleration, 1e-6, 1e5, "an acceleration of the device's response (m/s^2)");
    }
  }
}

}  // namespace

void verify_device(const DeviceProfile& device, RefusedFigure* refused) {
  const auto require = [refused](std::string_view name, double value, double low, double high, const char* what) {
    if (refused != nullptr) *refused = {name, value, low, high};
    require_within(value, low, high, what);
  };
  if (device.has_position()) {
    require("workspace", device.workspace_diameter, 1e-3, 10, "the device's workspace diameter (m)");
    require("position counts", device.position_counts, 2, 1e9, "the device's number of position counts");
    require("speed limit", device.speed_limit, 1e-3, 100, "the device's speed limit (m/s)");
  } else {
    require("workspace", device.workspace_diameter, 0, 0, "the workspace diameter (m) of a device without a position");
    require("position counts", device.position_counts, 0, 0,
            "the number of position counts of a device without a position");
    require("speed limit", device.speed_limit, 0, 0, "the speed limit (m/s) of a device without a position");
  }
  if (device.shaker) {
    if (refused != nullptr) *refused = {};
    verify_vibration(*device.shaker);
    require("force", device.force_newton, 0, 0, "the force (N) of a device that vibrates");
    require("force counts", device.force_counts, 0, 0, "the number of force counts of a device that vibrates");
  } else {
    require("force", device.force_newton, 1e-3, 1000, "the device's force (N)");
    require("force counts", device.force_counts, 1, 1e9, "the device's number of force counts");
  }
  require("rate", device.rate, DeviceProfile::least_rate, DeviceProfile::most_rate, "the device's rate (Hz)");
  require("slew", device.slew, 0, 1e9, "the device's slew (N/s)");
  require("continuous_force", device.continuous_newton, 0, device.force_newton, "the device's continuous force (N)");
  require("heating_seconds", device.heating_seconds,
          device.continuous_newton > 0 ? DeviceProfile::least_heating_seconds : 0, 1e6,
          "the device's time constant of heating (s)");
  require("active_power", device.active_watt, 0, most_active_watt, "the device's power for active programs (W)");
  require("velocity_window", device.velocity_window, 0, most_velocity_window, "the device's velocity window (ticks)");
  require("velocity_noise_counts", device.velocity_noise_counts, 0, 1e6, "the device's velocity noise (counts)");
  require("patch_width", device.patch_width, 0, 10, "the device's patch width (m)");
  require("patch_height", device.patch_height, 0, 10, "the device's patch height (m)");
  require("patch_rim", device.patch_rim, 0, 10, "the device's patch rim (m)");
  require("mass", device.mass, 0, 1000, "the device's mass (kg)");
  require("damping", device.damping, 0, 1e6, "the device's damping (N s/m)");
  require("friction", device.friction, 0, 1000, "the device's friction (N)");
  require("delay_x", device.delay_x, 0, 1, "the device's delay along x (s)");
  require("delay_y", device.delay_y, 0, 1, "the device's delay along y (s)");
  require("bandwidth_x", device.bandwidth_x, 0, 1e6, "the device's bandwidth along x (Hz)");
  require("bandwidth_y", device.bandwidth_y, 0, 1e6, "the device's bandwidth along y (Hz)");
}

namespace {

void verify_percepts(const PatchProgram& program) {
  const auto graded = [](Evidence evidence) {
    return evidence >= Evidence::measured && evidence <= Evidence::simulated;
  };
  for (std::size_t i = 0; i < program.percepts.size(); ++i) {
    const PerceptRecord& percept = program.percepts[i];
    const std::string name = "percept " + std::to_string(i);
    if (percept.name.empty()) refuse(name, " has no name");
    if (percept.parameter && *percept.parameter >= program.parameters.size()) {
      refuse(name, " is set by parameter ", *percept.parameter, ", but the program has ", program.parameters.size());
    }
    if (!std::isfinite(percept.valid_high) || !(percept.valid_low >= 0 && percept.valid_low <= percept.valid_high)) {
      refuse(name, "'s map is valid in ", percept.valid_low, " .. ", percept.valid_high,
             ", expected a finite range from 0 on");
    }
    const LawUncertainty& law = percept.uncertainty;
    for (const auto& [figure, words] : {std::pair{law.scatter, "'s scatter"},
                                        {law.slope_error, "'s error of the slope"},
                                        {law.spread, "'s spread"},
                                        {law.noise, "'s noise"}})
      require_within(figure, 0, 100, name, words);
    if (!(percept.period_low >= 0 && percept.period_low <= percept.period_high)) {
      refuse(name, " is read at periods of ", percept.period_low, " .. ", percept.period_high,
             " m, expected a range from 0 on");
    }
    require_within(percept.one, 0, 1e9, name, "'s level 1");
    require_within(percept.near_threshold, 0, 1, name, "'s near threshold");
    require_within(percept.weber, 0, 100, name, "'s Weber fraction");
    require_within(percept.floor, 0, 1e9, name, "'s least difference");
    require_within(percept.basis.share, 1e-6, 1e6, name, "'s share of its force");
    require_within(percept.basis.domain.crest_low, 0, 1e6, name, "'s least crest");
    require_within(percept.basis.domain.crest_high, 0, 1e6, name, "'s greatest crest");
    require_within(percept.basis.tolerance, 0, 1, name, "'s tolerance");
    for (const MeasuredRange& range : percept.basis.ranges) {
      if (!std::isfinite(range.low) || !std::isfinite(range.high) || !(range.low <= range.high)) {
        refuse(name, "'s map is valid for ", range.quantity, " in ", range.low, " .. ", range.high,
               ", expected a finite range");
      }
      require_within(range.unit_in_si, 1e-30, 1e30, name, "'s unit of a range");
    }
    if (!graded(percept.slope) || !graded(percept.anchor) || !graded(percept.handle) ||
        !graded(percept.weber_evidence)) {
      refuse(name, " has a grade of evidence that this Wale does not know");
    }
  }
}

void verify_fates(const PatchProgram& program) {
  for (std::size_t i = 0; i < program.fates.size(); ++i) {
    const FateRecord& fate = program.fates[i];
    const std::string name = "fate " + std::to_string(i);
    if (fate.name.empty()) refuse(name, " has no name");
    if (fate.fate < Fate::kept || fate.fate > Fate::lost) refuse(name, " is of a kind that this Wale does not know");
    require_within(fate.asked, 0, 1, name + "'s level asked for");
    require_within(fate.given, 0, 1, name + "'s level given");
  }
}

}  // namespace

void verify_figures(const PatchProgram& program) {
  verify_registers(program);
  verify_device(program.device);
  verify_patch(program);
  verify_parameters(program);
  verify_states(program);
  verify_grids(program);
  verify_marks(program);
  verify_tables(program);
  verify_lattices(program);
  verify_percepts(program);
  verify_fates(program);
}

void verify_costs(const PatchProgram& program) {
  const auto most = static_cast<long>(tick_share_of_period * 1e9 / program.device.rate);
  const auto check = [most](const std::string& name, std::span<const Instruction> code) {
    const long cost = cost_of(code);
    if (cost > most) refuse(name, " costs ", cost, " units, expected at most ", most, " in the device's period");
  };
  check("tick", program.tick);
  check("enter", program.enter);
  check("picture", program.picture.code);
  check("frame", program.picture.frame);
  for (std::size_t i = 0; i < program.percepts.size(); ++i) {
    check("percept " + std::to_string(i), program.percepts[i].prediction);
  }
  auto setup = static_cast<std::uint64_t>(cost_of(program.setup));
  for (const Peak& peak : program.peaks)
    setup += std::uint64_t{peak.points} * (1 + static_cast<std::uint64_t>(cost_of(peak.code)));
  if (setup > setup_cost_limit) {
    refuse("setup and its peaks cost ", setup, " units, expected at most ", setup_cost_limit);
  }
}

}  // namespace wale
