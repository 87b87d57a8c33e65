#include "compiler/describe/describe_grade.hpp"

#include <fmt/format.h>

#include <cmath>

#include "compiler/describe/describe_figure.hpp"
#include "compiler/read/swing.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

std::string line(std::string_view key, const std::string& words) { return readable("  {:<12} {}\n", key, words); }

std::string place_words(const WorstPlace& place) {
  std::string words =
      readable("({}, {}) mm", with_decimals(1e3 * place.position.x, 1), with_decimals(1e3 * place.position.y, 1));
  if (place.velocity != glm::vec2(0.0f))
    words +=
        readable(" moving at ({}, {}) m/s", with_decimals(place.velocity.x, 2), with_decimals(place.velocity.y, 2));
  return words;
}

std::string damping_words(const Grade& grade) {
  if (grade.required_damping == 0 && grade.later_newton > 0) return "needs no damping at first";
  if (grade.required_damping == 0) return "needs no damping";
  if (std::isinf(grade.required_damping)) return "no damping makes the sampled loop passive";
  return readable("needs a damping of {:.3g} N s/m or more", grade.required_damping);
}

/// The verdict by the device's damping as it is assumed. Whoever needs more than device and hand have is not called
/// unstable: a loop may stay stable beyond the damping that makes it passive.
std::string assumed_words(const Grade& grade) {
  std::string words = readable("by the assumed {:.3g} N s/m: ", grade.device_damping);
  switch (*grade.assumed_standing()) {
    case Standing::passive: return words + "passive by itself";
    case Standing::stable_in_the_hand: return words + "not passive by itself, stable in the hand";
    default: return words + "not passive by itself, and a hand does not make it so";
  }
}

std::string standing_line(const Grade& grade, const DeviceProfile& device) {
  std::string words = damping_words(grade);
  if (grade.standing == Standing::not_analysed) return "not analysed: the program is too large";
  if (grade.required_damping == 0) return words;
  if (grade.assumed_standing()) return words + "; " + assumed_words(grade);
  if (!grade.damping_known)
    return words + (device.damping > 0
                        ? readable("; the damping of `{}` is assumed ({:.3g})", device.name, device.damping)
                        : readable("; the damping of `{}` is not known", device.name));
  // Of less than a thousandth of the damping, nobody knows the sign.
  constexpr double least_margin = 1e-3;
  const double margin = std::abs(*grade.margin()) < least_margin * device.damping ? 0 : *grade.margin();
  words += readable("; `{}` has {:.3g}, which leaves {}", device.name, device.damping,
                    margin == 0 ? std::string("no margin") : readable("a margin of {:.3g}", margin));
  if (grade.standing == Standing::stable_in_the_hand || grade.standing == Standing::unstable)
    words += readable(", and a hand adds {:.3g}", grade.hand_damping);
  return words;
}

std::string step_line(const Grade& grade) {
  std::string words = readable("the force changes by {:.3g} N from one encoder count to the next", grade.step_newton);
  if (grade.jumps) words += " (the force jumps)";
  if (grade.buzzes)
    words += *grade.buzzes ? readable(": more than the friction of {:.3g} N can hold, so it may buzz", grade.friction)
                           : readable(", which the friction of {:.3g} N holds", grade.friction);
  return words;
}

std::string resolution_line(const Grade& grade) {
  std::string words =
      readable("details of {:.3g} mm, {:.3g} encoder counts", 1e3 * grade.finest_period, grade.counts_per_period);
  if (grade.counts_per_period < grade.fewest_counts)
    words += ", too few for the encoder to show them as they are";
  else if (grade.counts_per_period < grade.faithful_counts)
    words += ", coarse";
  words += readable("; sampled often enough up to {:.2g} m/s", grade.fastest_hand);
  return words;
}

}  // namespace

std::string later_words(double newton) {
  return readable("the first {:.3g} s were looked at; later it may push up to {:.3f} N (proved)", still_seconds,
                  newton);
}

std::string grade_text(const Grade& grade, const DeviceProfile& device) {
  std::string text = line(standing_word(grade.standing), standing_line(grade, device));
  if (grade.standing == Standing::not_analysed) return text;
  for (const auto& reason : grade.energy.reasons) text += line("", reason);
  if (grade.later_newton > 0) text += line("", later_words(grade.later_newton));
  if (grade.standing == Standing::active && grade.energy.watt() > 0)
    text += line("", readable("gives a hand up to {:.2g} W", grade.energy.watt()));
  if (grade.required_damping > 0) text += line("", readable("largest at {}", place_words(grade.worst)));
  const std::string stiffness = readable("{:.4g} N/m at most", grade.stiffness);
  if (grade.jumps)
    text += line("stiffness", readable("the force jumps{}", grade.stiffness > 0 ? "; elsewhere " + stiffness : ""));
  else if (grade.stiffness > 0)
    text += line("stiffness", readable("{}, at {}", stiffness, place_words(grade.stiffest)));
  // Smaller steps cannot be commanded.
  if (grade.step_newton > 0.1 * device.force_step()) text += line("steps", step_line(grade));
  if (grade.finest_period < device.workspace_diameter) text += line("resolution", resolution_line(grade));
  if (grade.force_levels > 0 && grade.force_levels < grade.fewest_levels)
    text += line("", readable("only {:.2g} steps of force can be commanded: coarse", grade.force_levels));
  return text;
}

}  // namespace wale
