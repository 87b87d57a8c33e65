#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "calibration/feel/felt_report.hpp"
#include "calibration/feel/hand_motion.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/evidence/percept_reading.hpp"

namespace wale {
namespace {

/// Whether a friction is greater than its reading tells.
bool is_at_least(Extractor extractor, const OpposingForce& opposing) {
  return extractor == Extractor::opposing_force && (opposing.friction_cut || opposing.friction_grows);
}

/// "along y", "along 30 deg".
std::string along_words(double angle) {
  const long degrees = std::lround(angle * 180 / std::numbers::pi) % 180;
  return degrees == 0 ? "along x" : degrees == 90 ? "along y" : fmt::format("along {} deg", degrees);
}

/// Whether a hand that moves laterally goes this way (of length 1) so much that another direction gains little.
bool goes_along(const Motion& motion, glm::dvec2 way) {
  constexpr double half_as_often = 0.5;
  if (std::holds_alternative<Circular>(motion)) return true;
  const auto* lateral = std::get_if<Lateral>(&motion);
  return lateral && std::abs(glm::dot(lateral->direction, way)) >= half_as_often;
}

/// The motion that crosses a relief at least twice as often as that of the run; empty if the relief is the same in all
/// directions or the hand goes along it.
std::string crossing_motion(const RunManner& manner, const Relief& relief, const Declarations& declarations) {
  if (!relief.oriented()) return {};
  const std::string words = along_words(relief.orientation);
  if (manner.plugged) return words;
  const glm::dvec2 way(std::cos(relief.orientation), std::sin(relief.orientation));
  if (const HandDeclaration* person = declarations.hands.find("normal"))
    if (const auto motion = motion_of(manner.hand, *person, declarations); motion && goes_along(*motion, way))
      return {};
  return "lateral " + words;
}

}  // namespace

void tell_read_percepts(FeltReport& report, const Bank& bank, const Declarations& declarations) {
  const PatchProgram& program = bank.program().description();
  if (report.felt.vibration) return;
  if (report.levels.empty()) {
    const Description description = describe(bank, declarations);
    for (const DescribedPercept& percept : description.percepts) {
      const Percept* declared = declarations.percepts.find(percept.name);
      report.read.push_back(
          {percept.name, percept.level, declared && is_at_least(declared->extractor, description.motion)});
    }
    return;
  }
  const ForceReading found = read(bank, declarations, parts_for(program));
  if (report.needed_seconds && *report.needed_seconds > longest_proposed_run)
    report.crossing_motion = crossing_motion(report.manner, found.relief(), declarations);
  for (std::size_t i = 0; i < report.levels.size(); ++i) {
    LevelBack& level = report.levels[i];
    report.at_least[i] = is_at_least(program.percepts[level.percept].extractor, found.opposing);
    const PerceptReading told = percept_reading(bank, level.percept, found, declarations);
    if (level.back && told.unknown)
      level.back = Error{.code = Code::not_measured,
                         .sentence = outside_in_words(outside_ranges(program.percepts[level.percept], told).front()),
                         .place = {.name = level.name}};
  }
}

}  // namespace wale
