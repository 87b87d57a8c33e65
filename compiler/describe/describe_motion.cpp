#include "compiler/describe/describe_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/describe/describe_figure.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

constexpr std::array<double, 4> told_speeds = {0.05, 0.1, 0.2, 0.4};  // m/s
constexpr double creeping_speed = 0.01;  // m/s: told too if the drag is another one there
constexpr double plainly_differs = 0.1;  // relative

std::string size_words(double newton) {
  if (std::abs(newton) < least_force) return "none";
  return readable("{}{:.3g} N", newton < 0 ? "a push of " : "", std::abs(newton));
}

std::string power_words(double exponent) {
  constexpr double near = 0.05;
  if (exponent == 0) return "in no proportion to the speed";
  if (std::abs(exponent - 2) < near) return "with the square of the speed";
  if (std::abs(exponent - 3) < near) return "with the cube of the speed";
  if (std::abs(exponent - 0.5) < near) return "with the root of the speed";
  return readable("with the speed to the power {:.2g}", exponent);
}

bool goes_one_way(const OpposingForce& motion) { return motion.one_way() != glm::dvec2(0); }

std::string mass_words(double mass) {
  if (std::abs(mass) < least_mass) return "none";
  return readable("{:.3g} kg", mass);
}

/// "1 N to the right, none to the left", of a drag or of a mass.
template <typename Resistance>
std::string ways_words(const Resistance& motion, std::string (*words)(double)) {
  std::string text;
  const auto add = [&](double size, const char* way) {
    text += readable("{}{} {}", text.empty() ? "" : ", ", words(size), way);
  };
  if (motion.forward.x != motion.backward.x)
    add(motion.forward.x, "to the right"), add(motion.backward.x, "to the left");
  if (motion.forward.y != motion.backward.y) add(motion.forward.y, "upwards"), add(motion.backward.y, "downwards");
  return text;
}

}  // namespace

std::string motion_lines(const OpposingForce& motion) {
  std::string text;
  if (motion.friction_cut)
    text += readable("  the friction is at least {:.3g} N: the device gives no more\n", motion.friction);
  else if (motion.friction_grows)
    text += readable("  the friction is at least {:.3g} N: it still grows where the patch ends\n", motion.friction);
  if (motion.limit > 0)
    text += readable("  the viscosity of {:.3g} N s/m is cut at {:.3g} N: hands faster than {:.3g} mm/s feel no more\n",
                     motion.damping, motion.limit, 1e3 * motion.limit / std::abs(motion.damping));
  if (motion.rise() > 0)
    text += readable(
        "  the friction of {:.3g} N is whole from {:.3g} mm/s on: slower hands feel a viscosity of {:.3g} N s/m\n",
        motion.friction, 1e3 * motion.saturation_speed, motion.rise());
  if (motion.changes_in_time)
    text += readable("  the drag changes with time: at 200 mm/s from {} to {}, {}\n", size_words(motion.least_in_time),
                     size_words(motion.most_in_time),
                     motion.explained ? "and what is told is its mean" : "and no mean tells it");
  if (motion.changes_by_use)
    text += readable("  the drag changes where the hand has been: at 200 mm/s {} at first, {} after {:.3g} mm of strokes\n",
                     size_words(motion.at_first_use), size_words(motion.after_use), 1e3 * motion.way_of_use);
  if (goes_one_way(motion))
    text += readable("  the drag differs with the way that a hand goes: at 200 mm/s {}{}\n", ways_words(motion, size_words),
                     motion.uneven() > 0 ? ", on the mean over the patch" : "");
  if (motion.uneven() > 0) {
    const bool part = std::min(std::abs(motion.least_by_place), std::abs(motion.most_by_place)) < least_force;
    text += part ? readable("  a drag in part of the patch only: at 200 mm/s up to {}\n",
                            size_words(std::max(std::abs(motion.least_by_place), std::abs(motion.most_by_place))))
                 : readable("  the drag differs from place to place: at 200 mm/s from {} to {}\n",
                            size_words(motion.least_by_place), size_words(motion.most_by_place));
  }
  if (motion.explained || motion.changes_in_time || goes_one_way(motion) || motion.uneven() > 0) return text;
  std::string sizes;
  const double creeping = motion.creeping();
  const double slow = std::abs(motion.unexplained_at(told_speeds.front()));
  // A drag that grows from nothing by a power is told by that.
  const bool differs = motion.exponent == 0 && std::abs(std::abs(creeping) - slow) > plainly_differs * slow;
  if (std::abs(creeping) >= least_force && (differs || std::abs(creeping) >= slow))
    sizes = readable("{} at {:.0f} mm/s", size_words(creeping), 1e3 * creeping_speed);
  for (const double speed : told_speeds)
    sizes += readable("{}{} at {:.0f} mm/s", sizes.empty() ? "" : ", ", size_words(motion.unexplained_at(speed)),
                      1e3 * speed);
  return text + readable("  a drag that {} {}: {}\n", motion.exponent == 0 ? "changes" : "grows",
                         power_words(motion.exponent), sizes);
}

std::string mass_lines(const Mass& mass) {
  std::string text;
  if (mass.one_way() != glm::dvec2(0))
    text += readable("  the mass differs with the way that a hand speeds up: {}{}\n", ways_words(mass, mass_words),
                     mass.uneven() > 0 ? ", on the mean over the patch" : "");
  if (mass.uneven() > 0) {
    const bool part = std::min(std::abs(mass.least_by_place), std::abs(mass.most_by_place)) < least_mass;
    text += part ? readable("  a mass in part of the patch only: up to {}\n",
                            mass_words(std::abs(mass.most_by_place) >= std::abs(mass.least_by_place)
                                           ? mass.most_by_place
                                           : mass.least_by_place))
                 : readable("  the mass differs from place to place: from {} to {}\n", mass_words(mass.least_by_place),
                            mass_words(mass.most_by_place));
  }
  return text;
}

void add_mass(nlohmann::ordered_json& json, const Mass& mass) {
  if (mass.one_way() != glm::dvec2(0))
    json["mass_by_way"] = {{"forward_kg", {figure(mass.forward.x), figure(mass.forward.y)}},
                           {"backward_kg", {figure(mass.backward.x), figure(mass.backward.y)}}};
  if (mass.uneven() > 0)
    json["mass_by_place"] = {{"least_kg", figure(mass.least_by_place)}, {"most_kg", figure(mass.most_by_place)}};
}

void add_motion(nlohmann::ordered_json& json, const OpposingForce& motion) {
  if (motion.friction_grows || motion.friction_cut) json["friction_at_least_newton"] = figure(motion.friction);
  if (motion.changes_in_time)
    json["drag_by_time"] = {{"least_newton", figure(motion.least_in_time)},
                            {"most_newton", figure(motion.most_in_time)},
                            {"has_mean", motion.explained}};
  if (motion.changes_by_use)
    json["drag_by_use"] = {{"first_newton", figure(motion.at_first_use)},
                           {"last_newton", figure(motion.after_use)},
                           {"way", figure(motion.way_of_use)}};
  if (motion.limit > 0)
    json["viscosity_limit"] = {{"newton", figure(motion.limit)},
                               {"speed", figure(motion.limit / std::abs(motion.damping))}};
  if (motion.rise() > 0)
    json["friction_rise"] = {{"viscosity", figure(motion.rise())}, {"speed", figure(motion.saturation_speed)}};
  if (!motion.explained) {
    auto& drag = json["drag"] = nlohmann::ordered_json::object();
    if (motion.exponent > 0) drag["exponent"] = figure(motion.exponent);
    for (const DragAt& each : motion.by_speed)
      drag["by_speed"].push_back({{"speed", figure(each.speed)}, {"newton", figure(each.newton)}});
  }
  if (goes_one_way(motion))
    json["drag_by_way"] = {{"forward_newton", {figure(motion.forward.x), figure(motion.forward.y)}},
                           {"backward_newton", {figure(motion.backward.x), figure(motion.backward.y)}}};
  if (motion.uneven() > 0)
    json["drag_by_place"] = {{"least_newton", figure(motion.least_by_place)},
                             {"most_newton", figure(motion.most_by_place)}};
}

}  // namespace wale
