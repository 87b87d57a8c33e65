#include "compiler/warn_of_energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "compiler/measure/hands.hpp"
#include "compiler/solve/plausible.hpp"
#include "compiler/solve/still_field.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

constexpr double least_declared_watt = 0.01;  // W; the resolution of the proposed `active`

/// Whether the device's limit cuts a component of the force on a resting hand.
bool reaches_limit(const Bank& bank, double limit) {
  constexpr std::size_t looked_at = 16384;
  constexpr double rounding = 1e-5;
  std::vector<Hand> hands = hands_at_rest(looked_at, 0.5f * glm::vec2(bank.size().width, bank.size().height));
  const auto cuts = [&](const Force& force) {
    return std::max(std::abs(force.x), std::abs(force.y)) >= limit * (1 - rounding);
  };
  std::vector<Force> forces(hands.size());
  for (const bool button : {false, true}) {
    for (Hand& hand : hands) hand.button = button;
    tick_all(bank, hands, forces);
    if (std::ranges::any_of(forces, cuts)) return true;
  }
  return false;
}

/// What gives the energy of a force whose formulas have no curl, and the mend; empty if neither is known.
struct Turned {
  std::string cause, help;
};

/// `declare`: what to write instead.
Turned turned(const Bank& bank, const CheckedMaterial& checked, const SolvedMaterial& material,
              const std::string& declare) {
  const double most = material.device.most();
  if (!reaches_limit(bank, most)) {
    const auto jump = find_jump(checked, material.device);
    if (!jump) return {};
    return {fmt::format("its height jumps, and `{}` leaves the jump out, so a way round that crosses it gains energy",
                        jump->function),
            fmt::format("let the height rise over a distance there, as `smoothstep(x / 1 mm)` does, or {}", declare)};
  }
  // A device's limit cuts x and y separately, and so turns a slanted force. A limited force keeps its direction, but
  // one that differs with the direction turns in circles all the same.
  const bool helps = has_no_curl(checked, material.device, most);
  return {fmt::format("`{}` limits its force along x and y separately, which turns it", material.device.name),
          !helps ? readable("keep the force below {:.4g} N, or {}", most, declare)
          : checked.forces.size() > 1
              ? typeable("let the whole force keep its direction: `force = … + … limit {:.4g} N`", most)
              : typeable("let the force keep its direction: `force = … limit {:.4g} N`", most)};
}

/// Whether what `motion` adds to the force pushes along it wherever it pushes, as a drag or a mass does that lacks its
/// minus. Only of a program that remembers nothing.
bool pushes_along(const Bank& bank, const GradingHand& hand, glm::vec2 Hand::*motion, glm::vec2 Hand::*raw) {
  const PatchProgram& program = bank.program().description();
  if (!program.states.empty() || !program.grids.empty()) return false;
  constexpr std::size_t looked_at = 4096;
  constexpr double hardly = 1e-3;  // of the most that is along the motion: less is rounding
  const glm::vec2 half = 0.5f * glm::vec2(bank.size().width, bank.size().height);
  std::vector<Hand> hands = hands_in_motion(looked_at, half, static_cast<float>(hand.speed()));
  std::vector<Force> moving(hands.size()), without(hands.size());
  tick_all(bank, hands, moving);
  const std::vector<Hand> whole = hands;
  for (Hand& each : hands) each.*motion = each.*raw = glm::vec2(0.0f);
  tick_all(bank, hands, without);
  double most = 0, least = 0;
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const double along = glm::dot(glm::dvec2(moving[i]) - glm::dvec2(without[i]), glm::dvec2(whole[i].*motion));
    most = std::max(most, along), least = std::min(least, along);
  }
  return most > 0 && least >= -hardly * most;
}

/// Whether a force that pushes along the motion may lack its minus: no sign, and no parameter that may be negative,
/// says that it is meant. Of any of the forces, if `giving`, that which gives the energy, is not known.
bool may_lack_minus(const CheckedMaterial& material, const WrittenForce* giving) {
  const auto may = [&](const WrittenForce& each) {
    return !each.signed_by_author && !may_turn(material, each.force[0], each.force[1]);
  };
  return giving ? may(*giving) : std::ranges::any_of(material.forces, may);
}

/// That of several forces that gives the energy, if it is known.
const WrittenForce* giving_most(const CheckedMaterial& checked, const DeviceProfile& device, const Energy& energy,
                                double speed) {
  if (checked.forces.size() < 2) return nullptr;
  constexpr double acceleration = 1;  // m/s^2
  if (energy.motion_watt >= energy.watt()) return giving_energy(checked, device, GivenBy::velocity, speed);
  if (energy.curl_watt >= energy.watt()) return giving_energy(checked, device, GivenBy::place, speed);
  if (energy.source_watt < energy.watt()) return nullptr;
  // Of a program that remembers, all that gives is told as one.
  if (const auto* mass = giving_energy(checked, device, GivenBy::acceleration, acceleration)) return mass;
  if (const auto* drag = giving_energy(checked, device, GivenBy::velocity, speed)) return drag;
  return giving_energy(checked, device, GivenBy::place, speed);
}

}  // namespace

void warn_of_undeclared_energy(const Bank& bank, const CheckedMaterial& checked, const SolvedMaterial& material,
                               const GradingHand& hand, Diagnostics& diagnostics) {
  const Energy energy = energy_of(bank, hand);
  const bool declares = material.active_watt > 0;
  if (!energy.active() || (declares && energy.watt() <= material.active_watt)) return;
  const double watt = std::max(energy.watt(), least_declared_watt);
  // Upwards to two digits, so that what is declared then is enough.
  const double step = std::max(0.01, std::pow(10, std::floor(std::log10(watt)) - 1));
  const std::string mend = typeable("active {:.6g} W", std::ceil(watt / step) * step);
  // Of what is declared, it may be a little more.
  const std::string given = declares ? readable("{:.3g}", energy.watt()) : readable("{:.2g}", energy.watt());
  const WrittenForce* const giving = giving_most(checked, material.device, energy, hand.speed());
  const auto report = [&](std::string message, std::string help) {
    diagnostics.report({.code = Code::undeclared_energy,
                        .span = giving ? giving->span : material.force_span,
                        .message = std::move(message),
                        .help = std::move(help)});
  };
  if (energy.reasons.size() == 1 && energy.curl_watt > 0 && has_no_curl(checked, material.device)) {
    const Turned found =
        turned(bank, checked, material, fmt::format("{} `{}`", declares ? "declare" : "declare what it gives:", mend));
    if (!found.cause.empty())
      return report(
          readable("`{}` gives energy to a hand that moves in circles, up to {:.2g} W at an ordinary pace: {}",
                   material.name, energy.watt(), found.cause),
          found.help);
  }
  std::string help = declares ? readable("it declares {:.3g} W; write `{}`", material.active_watt, mend)
                              : fmt::format("write `{}` in its physical block", mend);
  if (!declares && may_lack_minus(checked, giving)) {
    const bool drag = energy.motion_watt > 0 && pushes_along(bank, hand, &Hand::velocity, &Hand::raw_velocity);
    const bool mass =
        !drag && energy.source_watt > 0 && pushes_along(bank, hand, &Hand::acceleration, &Hand::raw_acceleration);
    if (drag || mass)
      help = fmt::format("perhaps a minus is missing, as in `force = -{}`; if it is meant, {}",
                         drag ? "3 N s/m * velocity" : "0.1 kg * acceleration", help);
  }
  report(fmt::format("`{}` gives energy to the hand, up to {} W at an ordinary pace: {}", material.name, given,
                     energy.reasons.front()),
         std::move(help));
}

void warn_of_driving_away(const CheckedMaterial& material, const SolvedMaterial& solved, Diagnostics& diagnostics) {
  const auto span = driving_away(material, solved.device);
  if (!span) return;
  diagnostics.report(
      {.code = Code::pushes_away,
       .span = *span,
       .message = "the further a hand goes from where it rests, the harder this force pushes it on, up "
                  "to the edge of the patch",
       .help = "perhaps a minus is missing, as in `force = -20 N/m * hand`; a plus, as in `force = +20 N/m * "
               "hand`, says that it is meant"});
}

}  // namespace wale
