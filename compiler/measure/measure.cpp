#include "compiler/measure/measure.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <vector>

#include "compiler/measure/coarseness.hpp"
#include "compiler/measure/hands.hpp"
#include "wale/memory.hpp"

namespace wale {

namespace {

constexpr std::size_t hands = 8192;                    ///< at rest: a percentile needs many
constexpr std::size_t moving_hands = 4096;             ///< for the largest force, which is at an extreme or a corner
constexpr std::size_t corners = 16;                    ///< of the patch, each at the four corners of velocity
constexpr std::size_t rim_along = 96, rim_across = 6;  ///< hands on each side of the rim
constexpr std::size_t climbers = 4, directions = 8;    ///< places from which a larger force is searched
constexpr int climbs = 10;                             ///< steps, each half as long as the one before
constexpr std::size_t resting_hands = 16;              ///< of a program with memory, for a second each
constexpr double resting_cost = 2e7;                   ///< units of cost of all their ticks
constexpr double first_seconds = 16;                   ///< of a program without memory, of which some ticks are taken
constexpr int looking_ticks = 64;                      ///< in which a force that changes by itself shows

bool reads(const PatchProgram& program, std::initializer_list<Input> inputs) {
  return std::ranges::any_of(program.tick, [&](const Instruction& instruction) {
    const auto fields = facts(static_cast<Operation>(instruction.operation)).fields;
    const RegisterNumber operands[] = {instruction.a, instruction.b, instruction.c};
    for (std::size_t i = 0; i < 3; ++i)
      if (fields[i] == 'r' && std::ranges::find(inputs, static_cast<Input>(operands[i])) != inputs.end()) return true;
    return false;
  });
}

/// The time of one of the ticks of the first seconds, s; different for each `i`.
double some_tick(std::size_t i, double rate) {
  constexpr double golden = 0.61803398874989485;
  const double share = static_cast<double>(i) * golden;
  return std::floor((share - std::floor(share)) * first_seconds * rate) / rate;
}

/// The largest force among hands that are looked at, and the hands from which a larger one is searched.
class Strongest {
 public:
  explicit Strongest(glm::vec2 whole) : step_(whole / 32.0f) {}

  float newton() const { return best_.empty() ? 0.0f : best_.front().newton; }

  void look_at(std::span<const Hand> hands, std::span<const Force> forces) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      const float newton = glm::length(forces[i]);
      if (best_.size() == climbers && !(newton > best_.back().newton)) continue;
      if (best_.size() == climbers) best_.pop_back();
      const auto after = [&](const Found& each) { return each.newton < newton; };
      best_.insert(std::ranges::find_if(best_, after), {newton, hands[i]});
    }
  }

  /// Moves the best hands by ever smaller steps, as long as the force grows, within the half extents `within` (m).
  void climb(const Bank& bank, glm::vec2 within) {
    std::vector<Hand> tried;
    std::vector<Force> forces(climbers * directions);
    glm::vec2 step = step_;
    for (int round = 0; round < climbs; ++round, step *= 0.5f) {
      tried.clear();
      for (const Found& from : best_)
        for (std::size_t direction = 0; direction < directions; ++direction) {
          const auto angle = static_cast<float>(static_cast<double>(direction) * std::numbers::pi / 4);
          Hand& hand = tried.emplace_back(from.hand);
          const glm::vec2 before = hand.position;
          hand.position = glm::clamp(before + step * glm::vec2(std::cos(angle), std::sin(angle)), -within, within);
          hand.workspace += hand.position - before;
        }
      tick_coarsely(bank, tried, forces);
      for (std::size_t i = 0; i < tried.size(); ++i)
        if (const float newton = glm::length(forces[i]); newton > best_[i / directions].newton)
          best_[i / directions] = {newton, tried[i]};
    }
    std::ranges::stable_sort(best_, [](const Found& a, const Found& b) { return a.newton > b.newton; });
  }

 private:
  struct Found {
    float newton;
    Hand hand;
  };
  glm::vec2 step_;
  std::vector<Found> best_;  ///< the largest force first
};

/// Hands at rest all over the rim, between the half extents `inner` and `outer` (m).
std::vector<Hand> rim_hands(glm::vec2 inner, glm::vec2 outer) {
  std::vector<Hand> found;
  for (std::size_t across = 0; across < rim_across; ++across)
    for (std::size_t along = 0; along < rim_along; ++along)
      for (const float sign : {-1.0f, 1.0f}) {
        const float depth = (static_cast<float>(across) + 0.5f) / rim_across;
        const float share = 2 * (static_cast<float>(along) + 0.5f) / rim_along - 1;
        const glm::vec2 at = inner + depth * (outer - inner);
        for (const glm::vec2 place : {glm::vec2(sign * at.x, share * outer.y), glm::vec2(share * outer.x, sign * at.y)})
          found.emplace_back().position = place;
      }
  for (Hand& hand : found) hand.workspace = hand.position;
  return found;
}

/// Replaces `sizes` by the sizes of the forces (N) on hands that rest on the patch for a second each, if the force on
/// such a hand changes by itself. Returns whether it does.
bool add_seconds(const Bank& bank, glm::vec2 extent, std::vector<float>& sizes) {
  const PatchProgram& program = bank.program().description();
  const auto ticks = static_cast<std::size_t>(std::lround(program.device.rate));
  const double cost = static_cast<double>(cost_of(program.tick) * static_cast<long>(ticks * resting_hands));
  if (leaves_out_motion(program) || cost > resting_cost) return false;
  Bank running = bank;
  std::vector<float> found;
  for (const Hand& from : hands_at_rest(resting_hands, extent)) {
    Memory memory(bank.program());
    Hand hand = from;
    memory.enter(running, hand);
    for (std::size_t i = 0; i < ticks; ++i) {
      hand.time = static_cast<double>(i) / program.device.rate;
      found.push_back(glm::length(tick(running, memory, hand)));
      if (found.size() != looking_ticks) continue;
      const auto [least, most] = std::ranges::minmax(found);
      if (!(most - least > 1e-3f * most)) return false;
    }
  }
  sizes = std::move(found);
  return true;
}

void find_distribution(Measured& measured, std::vector<float>& sizes) {
  double squares = 0;
  for (const float size : sizes) squares += static_cast<double>(size) * size;
  const auto p99 = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 99 / 100);
  std::ranges::nth_element(sizes, p99);
  measured.p99_newton = *p99;
  measured.rms_newton = static_cast<float>(std::sqrt(squares / static_cast<double>(sizes.size())));
}

}  // namespace

Measured measure(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const PatchSize size = bank.size();
  const glm::vec2 whole{size.width / 2, size.height / 2}, extent = whole - glm::vec2(size.rim);
  const float speed = static_cast<float>(program.device.speed_limit);
  const bool changes = reads(program, {Input::time});

  std::vector<Hand> at_rest = hands_at_rest(hands, extent);
  if (changes)
    for (std::size_t i = 0; i < at_rest.size(); ++i) at_rest[i].time = some_tick(i, program.device.rate);
  // If the force depends on the place only, moving hands add nothing to the hands at rest except the corners.
  std::vector<Hand> moving = hands_in_motion(depends_on_the_moment(program) ? moving_hands : corners, extent, speed);
  // Forces that grow outward are strongest at the corners, and those of motion at full speed.
  for (std::size_t i = 0; i < corners; ++i) {
    const auto sign = [&](unsigned bit) { return i >> bit & 1u ? 1.0f : -1.0f; };
    moving[i] = {glm::vec2(sign(0), sign(1)) * whole, speed * glm::vec2(sign(2), sign(3))};
    give_a_moment(moving[i], i);
  }

  std::vector<Force> forces(hands);
  Measured measured;
  Strongest strongest(whole);
  tick_coarsely(bank, at_rest, forces);
  std::vector<float> sizes;
  for (const auto& force : forces) sizes.push_back(glm::length(force));
  strongest.look_at(at_rest, forces);
  if (program.states.empty())
    measured.over_seconds = changes ? first_seconds : 0;
  else
    measured.over_seconds = add_seconds(bank, extent, sizes) ? 1 : 0;
  find_distribution(measured, sizes);
  tick_coarsely(bank, moving, forces);
  strongest.look_at(std::span(moving).subspan(corners), std::span<const Force>(forces).subspan(corners));
  strongest.climb(bank, extent);
  measured.less_rim = strongest.newton();
  strongest.look_at(std::span(moving).first(corners), forces);
  if (size.rim > 0) {
    const std::vector<Hand> in_rim = rim_hands(extent, whole);
    tick_coarsely(bank, in_rim, forces);
    strongest.look_at(in_rim, forces);
    strongest.climb(bank, whole);
  }
  measured.max_newton = strongest.newton();
  measured.may_be_larger = changes || !program.states.empty() || !program.grids.empty() ||
                           reads(program, {Input::acceleration_x, Input::acceleration_y, Input::raw_acceleration_x,
                                           Input::raw_acceleration_y});
  for (const auto& instruction : program.setup)
    if (instruction.operation == static_cast<std::uint8_t>(Operation::peak) &&
        !(bank.registers()[instruction.destination] > 0))
      measured.flat = true;
  return measured;
}

Force given_by(const Shaker& shaker, Force drive) {
  drive.y = static_cast<float>(std::clamp<double>(drive.y, shaker.frequency_low, shaker.frequency_high));
  drive.x = std::min(drive.x, static_cast<float>(shaker.acceleration(1, drive.y)));
  return drive;
}

MeasuredShaking measure_shaking(const Bank& bank, const HandDeclaration* person) {
  constexpr std::size_t moments = 4096;
  const PatchSize size = bank.size();
  const double frequency = person ? person->lateral_frequency : 1;
  const double reach = std::min(person ? person->lateral_amplitude : 0.04, 0.5 * size.width - size.rim);
  std::vector<Hand> stroke(moments);
  for (std::size_t i = 0; i < moments; ++i) {
    const double phase = 2 * std::numbers::pi * static_cast<double>(i) / moments;
    Hand& hand = stroke[i];
    hand.position = hand.workspace = glm::vec2(static_cast<float>(reach * std::sin(phase)), 0);
    const double speed = 2 * std::numbers::pi * frequency * reach * std::cos(phase);
    hand.velocity = hand.raw_velocity = glm::vec2(static_cast<float>(speed), 0);
    hand.time = static_cast<double>(i) / moments / frequency;
  }
  std::vector<Force> drives(moments);
  tick_all(bank, stroke, drives);
  const Shaker& shaker = *bank.program().description().device.shaker;
  for (Force& drive : drives) drive = given_by(shaker, drive);
  MeasuredShaking measured;
  std::vector<float> amplitudes;
  double squares = 0;
  for (const Force& drive : drives) {
    amplitudes.push_back(std::max(drive.x, 0.0f));
    squares += static_cast<double>(amplitudes.back()) * amplitudes.back();
  }
  measured.rms = static_cast<float>(std::sqrt(squares / moments));
  const auto p99 = amplitudes.begin() + static_cast<std::ptrdiff_t>(moments * 99 / 100);
  std::ranges::nth_element(amplitudes, p99);
  measured.p99 = *p99;
  measured.max = *std::max_element(p99, amplitudes.end());
  for (const Force& drive : drives) {
    if (!(drive.x > 0) || drive.x < measured.p99 / 2) continue;
    measured.lowest = measured.highest > 0 ? std::min(measured.lowest, drive.y) : drive.y;
    measured.highest = std::max(measured.highest, drive.y);
  }
  return measured;
}

}  // namespace wale
