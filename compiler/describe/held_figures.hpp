#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compiler/read/read.hpp"

namespace wale {

/// A figure that the button changes: what it is while the button is held, and what it is otherwise.
struct HeldFigure {
  const char* name;  ///< "viscosity"
  const char* unit;  ///< SI
  double held = 0, open = 0;
  double rate = 0;  ///< Hz: of what swings while the button is held, if nothing else does
};

/// The figures of motion and time that holding the button changes.
std::vector<HeldFigure> held_figures(const ForceReading& found);

/// "while the button is held: viscosity 5 N s/m instead of none", in lines of two spaces' indent.
std::string held_lines(const std::vector<HeldFigure>& figures);

/// Adds the same to the JSON; only what there is.
void add_held(nlohmann::ordered_json& json, const std::vector<HeldFigure>& figures);

/// "the vibration dies away: 1 N at first, half of that after 0.69 s, a tenth after 2.3 s", as a line; and in JSON.
std::string course_line(const char* name, const SwingCourse& course);
nlohmann::ordered_json course_json(const SwingCourse& course);

/// "the vibration is the sum of 0.5 N at 80 Hz and 0.3 N at 200 Hz", as a line; empty without parts; and in JSON.
std::string parts_line(const char* name, const std::vector<SwingPart>& parts);
nlohmann::ordered_json parts_json(const std::vector<SwingPart>& parts);

/// "the vibration differs from place to place: from none to 1 N", as a line; empty if `swing` has no least size.
std::string uneven_line(const Swing& swing);

}  // namespace wale
