#include "compiler/describe/held_figures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/describe/describe_figure.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

constexpr double changes_by = 0.03;                             // of the greater one: less is not told
constexpr double drag_told_at = 0.2, slow_drag_told_at = 0.05;  // m/s

std::string figure_words(double size, const char* unit) {
  return size == 0 ? "none" : readable("{:.3g} {}", size, unit);
}

}  // namespace

std::vector<HeldFigure> held_figures(const ForceReading& found) {
  std::vector<HeldFigure> figures;
  if (!found.held) return figures;
  const auto add = [&](const char* name, const char* unit, double held, double open, double least) {
    const double greater = std::max(std::abs(held), std::abs(open));
    if (std::abs(held - open) < std::max(least, changes_by * greater)) return;
    const auto counting = [&](double size) { return std::abs(size) < least ? 0 : size; };
    figures.push_back({name, unit, counting(held), counting(open)});
  };
  const auto add_both = [&](const char* name, const char* unit, std::pair<double, double> sizes, double least) {
    add(name, unit, sizes.first, sizes.second, least);
  };
  const OpposingForce &held = found.held->opposing, &open = found.opposing;
  if (held.explained && open.explained && held.limit == open.limit) {
    add_both("friction", "N", where_they_differ(held.frictions(), open.frictions(), least_force), least_force);
    add_both("viscosity", "N s/m", where_they_differ(held.dampings(), open.dampings(), least_damping), least_damping);
  } else {
    add_both("drag at 50 mm/s", "N", drags_where_they_differ(held, open, slow_drag_told_at), least_force);
    add_both("drag at 200 mm/s", "N", drags_where_they_differ(held, open, drag_told_at), least_force);
  }
  add_both("mass", "kg", where_they_differ(found.held->inertia, found.inertia, least_mass), least_mass);
  const auto add_swing = [&](const char* name, const char* rate, const Swing& with, const Swing& without) {
    const std::size_t before = figures.size();
    add(name, "N", with.amplitude, without.amplitude, least_force);
    if (std::min(with.amplitude, without.amplitude) >= least_force)
      add(rate, "Hz", with.frequency, without.frequency, 0);
    else if (figures.size() > before && figures.back().held > 0)
      figures.back().rate = with.frequency;
  };
  add_swing("vibration", "rate of vibration", found.held->vibration, found.vibration);
  add_swing("sway", "rate of sway", found.held->sway, found.sway);
  return figures;
}

std::string held_lines(const std::vector<HeldFigure>& figures) {
  std::string text;
  for (const HeldFigure& each : figures)
    text +=
        readable("  while the button is held: {} {}{} instead of {}\n", each.name, figure_words(each.held, each.unit),
                 each.rate > 0 ? readable(" at {:.3g} Hz", each.rate) : "", figure_words(each.open, each.unit));
  return text;
}

void add_held(nlohmann::ordered_json& json, const std::vector<HeldFigure>& figures) {
  for (const HeldFigure& each : figures) {
    auto& told = json["button_held"][each.name];
    told = {{"held", figure(each.held)}, {"open", figure(each.open)}, {"unit", each.unit}};
    if (each.rate > 0) told["held_hz"] = figure(each.rate);
  }
}

std::string course_line(const char* name, const SwingCourse& course) {
  if (course.grows)
    return readable("  the {} grows{}: half of it is there after {:.2g} s, up to {:.3g} N in the {:.3g} s looked at\n", name,
                    course.tenth_after > 0 ? readable(" from {:.2g} s on", course.tenth_after) : "", course.half_after,
                    course.greatest, still_seconds);
  return readable("  the {} dies away: {:.3g} N at first, half of that after {:.2g} s{}\n", name, course.greatest,
                  course.half_after,
                  course.tenth_after > 0 ? readable(", a tenth after {:.2g} s", course.tenth_after) : "");
}

std::string parts_line(const char* name, const std::vector<SwingPart>& parts) {
  if (parts.empty()) return {};
  std::string text = readable("  the {} is the sum of ", name);
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += readable("{}{:.3g} N at {:.3g} Hz", i == 0 ? "" : i + 1 < parts.size() ? ", " : " and ", parts[i].amplitude,
                     parts[i].frequency);
  return text + "\n";
}

nlohmann::ordered_json parts_json(const std::vector<SwingPart>& parts) {
  auto json = nlohmann::ordered_json::array();
  for (const SwingPart& each : parts)
    json.push_back({{"amplitude_newton", figure(each.amplitude)}, {"frequency_hz", figure(each.frequency)}});
  return json;
}

nlohmann::ordered_json course_json(const SwingCourse& course) {
  nlohmann::ordered_json json = {{"course", course.grows ? "grows" : "dies away"},
                                 {"greatest_newton", figure(course.greatest)},
                                 {"half_after_s", figure(course.half_after)}};
  if (course.tenth_after > 0) json["tenth_after_s"] = figure(course.tenth_after);
  return json;
}

std::string uneven_line(const Swing& swing) {
  if (!swing.least) return {};
  const char* name = swing.noise ? "noise in time" : swing.frequency < slowest_vibration ? "sway" : "vibration";
  return readable("  the {} differs from place to place: from {} to {}\n", name, figure_words(*swing.least, "N"),
                  figure_words(swing.amplitude, "N"));
}

}  // namespace wale
