#include "compiler/read/proportional.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "compiler/measure/coarseness.hpp"
#include "compiler/read/dependence.hpp"

namespace wale {
namespace {

constexpr std::size_t felt_at = 768;   // hands: a limit that cuts less than a hundredth of the patch is still met
constexpr double equal = 1e-4;         // of the largest force: what single precision leaves of a proportion
constexpr double nothing_felt = 1e-6;  // N
constexpr double fastest = 0.4, hardest = 2, longest = 8;  // m/s, m/s^2, s

/// Parts of the numbers 0 .. 1 that are spread evenly in every dimension: Kronecker's sequence of the roots of primes.
double spread(std::size_t index, double prime) {
  const double at = static_cast<double>(index + 1) * std::sqrt(prime);
  return at - std::floor(at);
}

/// Hands all over the patch: a half of them at rest, since still forces are the finest.
std::vector<Hand> hands_over(const Bank& bank) {
  const PatchSize patch = bank.size();
  const glm::dvec2 inside = glm::dvec2(patch.width, patch.height) - 2.0 * patch.rim;
  std::vector<Hand> hands(felt_at);
  for (std::size_t i = 0; i < felt_at; ++i) {
    const auto both = [&](double one, double other) { return glm::dvec2(spread(i, one), spread(i, other)) - 0.5; };
    Hand& hand = hands[i];
    hand.position = hand.workspace = glm::vec2(both(2, 3) * inside);
    hand.time = longest * spread(i, 5);
    if (i % 2 == 0) continue;
    hand.velocity = hand.raw_velocity = glm::vec2(2 * fastest * both(7, 11));
    hand.acceleration = hand.raw_acceleration = glm::vec2(2 * hardest * both(13, 17));
  }
  return hands;
}

}  // namespace

std::optional<double> times_as_strong(const Bank& here, const Bank& there) {
  const PatchProgram& program = here.program().description();
  if (remembers_anything(program) || program.vibrates() || coarseness_of(program) > 1) return std::nullopt;
  const std::vector<Hand> hands = hands_over(here);
  std::vector<Force> before(hands.size()), after(hands.size());
  tick_coarsely(here, hands, before);
  tick_coarsely(there, hands, after);
  double squares = 0, products = 0, largest = 0;
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const glm::dvec2 one(before[i]), other(after[i]);
    squares += glm::dot(one, one), products += glm::dot(one, other);
    largest = std::max({largest, glm::length(one), glm::length(other)});
  }
  if (!(squares > nothing_felt * nothing_felt)) return std::nullopt;
  const double times = products / squares;
  for (std::size_t i = 0; i < hands.size(); ++i)
    if (glm::length(glm::dvec2(after[i]) - times * glm::dvec2(before[i])) > equal * largest) return std::nullopt;
  return times >= 0 ? std::optional(times) : std::nullopt;
}

namespace {

void scale(Principal& principal, double times) { principal.greatest *= times, principal.across *= times; }

void scale(Mass& mass, double times) {
  scale(static_cast<Principal&>(mass), times);
  mass.forward *= times, mass.backward *= times, mass.least_by_place *= times, mass.most_by_place *= times;
}

void scale(Swing& swing, double times) {
  swing.amplitude *= times;
  if (swing.least) *swing.least *= times;
  if (swing.course) swing.course->greatest *= times;
  for (SwingPart& each : swing.parts) each.amplitude *= times;
}

void scale(OpposingForce& opposing, double times) {
  for (double* each : {&opposing.friction, &opposing.friction_across, &opposing.damping, &opposing.damping_across,
                       &opposing.limit, &opposing.scatter, &opposing.aside, &opposing.forward.x, &opposing.forward.y,
                       &opposing.backward.x, &opposing.backward.y, &opposing.least_in_time, &opposing.most_in_time,
                       &opposing.least_by_place, &opposing.most_by_place, &opposing.at_first_use,
                       &opposing.after_use})
    *each *= times;
  for (DragAt& each : opposing.by_speed) each.newton *= times;
  for (std::vector<DragAt>& drags : opposing.along)
    for (DragAt& each : drags) each.newton *= times;
}

void scale(SlowChange& slow, double times) {
  slow.newton *= times;
  for (glm::dvec2* each : {&slow.push, &slow.at_first, &slow.lower, &slow.higher}) *each *= times;
}

}  // namespace

ForceReading times_as_strong(ForceReading found, double times) {
  StaticForce& still = found.still;
  still.largest *= times, still.cut_at *= times, still.beyond_cut *= times;
  for (glm::dvec2* each : {&still.trend.mean, &still.trend.by_x, &still.trend.by_y}) *each *= times;
  for (Feature& each : still.features) {
    for (glm::dvec2& force : each.profile) force *= times;
    each.range *= times;
  }
  for (Wall& each : still.obstacles.walls) each.stiffness *= times, each.preload *= times;
  if (still.obstacles.hill)
    for (double& each : still.obstacles.hill->push) each *= times;
  for (std::vector<StaticStep>* steps : {&still.obstacles.steps, &found.steps})
    for (StaticStep& each : *steps) each.change *= times;
  Relief& relief = still.relief;
  for (double* each : {&relief.amplitude,
                       &relief.maximum,
                       &relief.beside_waves,
                       &relief.rms,
                       &relief.mean,
                       &found.stiffness,
                       &found.stiffness_across,
                       &found.breakaway,
                       &found.other.button,
                       &found.other.slowly,
                       &found.other.remembered,
                       &found.other.moving,
                       &found.other.rehearsed,
                       &found.wall_push,
                       &found.at_first,
                       &found.outward,
                       &found.other.later,
                       &found.coming.later_swing,
                       &found.directions.aside,
                       &found.directions.swirl,
                       &found.directions.drag.greatest,
                       &found.directions.drag.across})
    *each *= times;
  scale(found.opposing, times), scale(found.inertia, times), scale(found.sway, times), scale(found.vibration, times);
  if (HeldButton* held = found.held ? &*found.held : nullptr) {
    scale(held->opposing, times), scale(held->inertia, times), scale(held->sway, times);
    scale(held->vibration, times), scale(held->slow, times);
  }
  for (glm::dvec2* each : {&found.constant, &found.asked_in_middle, &found.other.button_push, &found.other.slow_push, &found.coming.later_push,
                           &found.directions.steps, &found.directions.step_push})
    *each *= times;
  const auto scale_wall = [&](WallFace& wall) {
    for (double* each : {&wall.stiffness, &wall.damping, &wall.release, &wall.preload}) *each *= times;
  };
  if (found.wall) scale_wall(*found.wall);
  std::ranges::for_each(found.more_walls, scale_wall);
  return found;
}

}  // namespace wale
