#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <string_view>
#include <vector>

#include "wale/result.hpp"

namespace wale {

struct TracePoint {
  double time = 0;         ///< s
  glm::dvec2 position{0};  ///< m
  glm::dvec2 velocity{0};  ///< m/s; from the file, otherwise the slope of the trace
};

/// A recorded movement: at least one point, times strictly increasing, everything finite.
struct Trace {
  std::vector<TracePoint> points;
  bool velocities_given = false;
};

/// Reads CSV text: a header with the columns `t` (or `time`), `x`, `y` and optionally both `vx` and `vy`, in any order.
/// Other columns are ignored. A unit may follow the name as `t (s)`, `t [s]` or `t_s`: s, ms; m, cm, mm; m/s,
/// cm/s, mm/s; without a unit, SI. Lines may end in CRLF, be blank, or be a comment that begins with `#`; a byte order
/// mark is skipped. The CSV of a run's record is also a trace.
/// Error: `unreadable_table`, whose place is the line, from 1.
Result<Trace> read_trace(std::string_view text);

/// The position and velocity at `time` (s), on the cubic through the two neighbouring points with their velocities, so
/// velocity is the derivative of position. Before the trace it rests at the first point, after it at the last one.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
TracePoint at(const Trace& trace, double time) noexcept;

}  // namespace wale
