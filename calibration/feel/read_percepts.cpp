#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "calibration/feel/felt_report.hpp"
#include "calibration/feel/hand_motion.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/evidence/percept_reading.hpp"
#include "compiler/read/tolerances.hpp"

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

/// Removes what is told of level number `index`.
void forget_level(FeltReport& report, std::size_t index) {
  const auto at = [&](auto& all) { all.erase(all.begin() + static_cast<std::ptrdiff_t>(index)); };
  at(report.levels), at(report.asked), at(report.aimed), at(report.let_through), at(report.at_least);
  at(report.units), at(report.shown);
}

Error without_level(const std::string& percept, std::string sentence) {
  return {.code = Code::not_measured, .sentence = std::move(sentence), .place = {.name = percept}};
}

/// The carrier's size as the whole force gives it over the whole patch, of which `describe` may count a part for this
/// percept. What a factor or a limit changed, or the device cut, is no longer of the size that was solved or written.
float whole_size(const PerceptRecord& record, float aimed, float described, const std::optional<DescribedTexture>& texture,
                 const DeviceProfile& device) {
  const bool is_texture = record.extractor == Extractor::lateral_force;
  const float share = is_texture ? record.basis.share : 1;
  const bool is_cut = record.unit == "N" && aimed > static_cast<float>(device.most()) * share;
  if (record.basis.summand && !is_cut) return aimed;
  return is_texture && record.alone && texture ? static_cast<float>(texture->force.amplitude) * share : described;
}

/// Reads level number `index` of a run in the size that `describe` reads.
void read_as_described(FeltReport& report, std::size_t index, const DescribedPercept& told, const Bank& bank,
                       const std::optional<DescribedTexture>& relief) {
  LevelBack& level = report.levels[index];
  const PerceptRecord& record = bank.program().description().percepts[level.percept];
  const auto described = static_cast<float>(told.amplitude);
  if (!(described > 0)) {
    if (level.back) level.back = without_level(level.name, "`wale describe` reads none of it in this program");
    return;
  }
  const float whole = whole_size(record, level.predicted_amplitude, described, relief, report.device);
  const bool texture = record.extractor == Extractor::lateral_force;
  if (texture && !record.basis.summand) report.predicted_amplitude = whole / record.basis.share;
  float& shown = report.shown[index];
  if (!told.readable || !(shown > 0) || !(whole > 0)) {
    shown = 0;
    return;
  }
  if (std::abs(shown - whole) <= reading * whole) shown = whole;
  if (level.back) level.size *= described / shown;
  if (level.back) level.back = predict(bank, level.percept, level.size);
  // The person's limit cuts the whole force, of which the percept may have a share.
  const float part = (texture ? record.basis.share : 1) * described / whole;
  report.let_through[index] =
      record.unit == "N" ? std::min(described, static_cast<float>(report.manner.most) * part) : described;
  report.aimed[index] = described;
  shown = texture ? described * shown / whole : described;
  if (texture && level.back && shown != described) level.size *= shown / described;
}

}  // namespace

void tell_read_percepts(FeltReport& report, const Bank& bank, const Declarations& declarations) {
  const PatchProgram& program = bank.program().description();
  if (report.felt.vibration) return;
  const Description description = describe(bank, declarations, Texture::as_set);
  if (report.needed_seconds && *report.needed_seconds > longest_proposed_run && description.texture)
    report.crossing_motion = crossing_motion(report.manner, description.texture->force, declarations);
  for (std::size_t i = report.levels.size(); i-- > 0;) {
    LevelBack& level = report.levels[i];
    const PerceptRecord& record = program.percepts[level.percept];
    const auto told = std::ranges::find(description.percepts, level.name, &DescribedPercept::name);
    if (told == description.percepts.end()) {
      forget_level(report, i);
      continue;
    }
    report.at_least[i] = is_at_least(record.extractor, description.motion);
    if (!told->unknown) {
      read_as_described(report, i, *told, bank, description.texture);
    } else if (level.back) {
      const auto outside = outside_ranges(record, {.outside = told->outside});
      level.back = without_level(level.name, outside.empty() ? "what resists the hand is told by no one figure"
                                                             : outside_in_words(outside.front()));
    }
  }
  for (const DescribedPercept& percept : description.percepts) {
    if (std::ranges::find(report.levels, percept.name, &LevelBack::name) != report.levels.end()) continue;
    const Percept* declared = declarations.percepts.find(percept.name);
    report.read.push_back(
        {percept.name, percept.level, declared && is_at_least(declared->extractor, description.motion)});
  }
}

}  // namespace wale
