#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/modules/load_modules.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

/// Compiles materials for every force device, explores them with a simulated hand, and measures the size of a percept's
/// carrier from the actuator's force.
namespace wale::promises {

/// All declared devices that exert a force and measure a position.
inline std::vector<DeviceProfile> force_devices() {
  std::vector<DeviceProfile> found;
  common_modules()->declarations.devices.each([&](const std::string&, const DeviceDeclaration& device) {
    const DeviceProfile& profile = device.profile;
    if (profile.name == "pointer") return;  // it draws its forces and has no handle
    if (profile.force_newton > 0 && profile.force_counts > 0 && profile.position_counts > 0) found.push_back(profile);
  });
  return found;
}

/// Files in memory, by name.
class InMemory final : public Resolver {
 public:
  explicit InMemory(std::map<std::string, std::string> files = {}) : files_(std::move(files)) {}
  Result<ResolvedFile> module(const std::string&, const std::string&) override {
    return Error{Code::unreadable_file, "no such file"};
  }
  Result<ResolvedFile> file(const std::string& name, const std::string&) override {
    if (const auto found = files_.find(name); found != files_.end()) return ResolvedFile{name, found->second};
    return Error{Code::unreadable_file, "no such file"};
  }

 private:
  std::map<std::string, std::string> files_;
};

inline Program compiled_for(const std::string& device, const std::string& text,
                            const std::map<std::string, std::string>& files = {}) {
  SourceSet sources;
  Diagnostics diagnostics;
  InMemory resolver(files);
  const auto program = compile(sources, sources.add("test.wale", "wale 1\n" + text), "", device, resolver, diagnostics);
  if (program) return *program;
  std::string reasons;
  for (const auto& diagnostic : diagnostics.all()) reasons += render_text(diagnostic, sources, false);
  throw std::runtime_error(reasons);
}

/// The firm hand of tests/reference/closed_loop.md, "Hands".
inline constexpr HandModel firm_hand{0.8, 15, 400};

/// The ticks of a run of `seconds`, without the first half second.
inline std::vector<TickRecord> explored(const Program& program, const Motion& motion, double seconds,
                                        const std::map<std::string, float>& parameters) {
  SimulatedJoystick stick(program.description().device, firm_hand, motion);
  Stage stage(stick);
  Patch patch = *stage.add(program);
  for (const auto& [name, value] : parameters)
    if (const auto set = patch.set(name, value); !set) throw std::runtime_error(in_words(set.error()));
  const auto result = stage.run({.seconds = seconds, .virtual_time = true});
  if (!result) throw std::runtime_error(in_words(result.error()));
  std::vector<TickRecord> ticks = result->record.ticks;
  std::erase_if(ticks, [](const TickRecord& tick) { return tick.time < 0.5; });
  return ticks;
}

/// A path to and fro along x over `half` (m) to either side, at constant speed (m/s) except for 50 ms at each turn.
inline Trace steady_strokes(double half, double speed, double seconds) {
  constexpr double turn = 0.05;
  Trace trace{.points = {}, .velocities_given = true};
  const double pass = 2 * half / speed;
  double time = 0;
  for (double way = 1; time < seconds; way = -way) {
    trace.points.push_back({time, {-way * half, 0}, {way * speed, 0}});
    trace.points.push_back({time + pass, {way * half, 0}, {way * speed, 0}});
    time += pass + turn;
  }
  return trace;
}

/// A path of `lines` parallel lines over a square of `half` (m) to either side, at about `speed` (m/s).
inline Trace line_by_line(double half, int lines, double speed) {
  constexpr double turn = 0.05;
  Trace trace{.points = {}, .velocities_given = true};
  double time = 0, way = 1;
  for (int line = 0; line < lines; ++line, way = -way) {
    const double y = half * (2 * (line + 0.5) / lines - 1);
    trace.points.push_back({time, {-way * half, y}, {way * speed, 0}});
    time += 2 * half / speed;
    trace.points.push_back({time, {way * half, y}, {way * speed, 0}});
    time += turn;
  }
  return trace;
}

/// The measured size of a carrier, and its change per newton of force.
struct FeltSize {
  double size = 0, per_newton = 1;
};

/// Calls `work` for 0 .. count - 1 on two threads.
inline void on_two_threads(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto some = [&] {
    for (std::size_t i = next++; i < count; i = next++) try {
        work(i);
      } catch (const std::exception& problem) {
        ADD_FAILURE() << problem.what();
      }
  };
  std::thread other(some);
  some();
  other.join();
}

/// The largest lateral force on the patch without its rim: the amplitude as in Minsky 1995, section 6.2.4. A lateral
/// force never exceeds it, and reaches it on a hundredth of the patch.
inline FeltSize largest_force(const std::vector<TickRecord>& ticks, PatchSize patch) {
  FeltSize felt;
  for (const TickRecord& tick : ticks)
    if (tick.inside && std::abs(tick.position.x) < patch.width / 2 - patch.rim &&
        std::abs(tick.position.y) < patch.height / 2 - patch.rim)
      felt.size = std::max(felt.size, static_cast<double>(std::hypot(tick.force.x, tick.force.y)));
  return felt;
}

}  // namespace wale::promises
