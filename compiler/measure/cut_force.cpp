#include "compiler/measure/cut_force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "compiler/measure/coarseness.hpp"
#include "compiler/measure/hands.hpp"
#include "compiler/measure/rehearsal.hpp"
#include "compiler/prove/prove.hpp"
#include "compiler/text/readable.hpp"
#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/lane.hpp"
#include "runtime/machine/states.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr std::size_t cut_hands = 4096;    // at rest, and as many in motion if that matters
constexpr std::size_t hands_asked = 256;   // of those at the limit, whose force before it is computed
constexpr float single_precision = 1e-4f;  // relative: a force may exceed the limit by this and count as given

/// The code of a tick up to the limit of one output, and the register of the force that is limited.
struct BeforeLimit {
  std::span<const Instruction> code;
  RegisterNumber asked = 0;
  float ceiling = 0;  ///< N
};

std::vector<BeforeLimit> limits_of(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  std::vector<BeforeLimit> limits;
  for (const Output& output : program.outputs) {
    // Registers are used again: the last instruction that writes the register is the output's limit.
    std::size_t last = program.tick.size() - 1;
    while (program.tick[last].destination != output.value) --last;
    limits.push_back({std::span(program.tick).first(last), program.tick[last].a, bank.registers()[output.ceiling]});
  }
  return limits;
}

/// Whether a force is at the limit, so that more may have been asked for.
bool is_at(const BeforeLimit& limit, const Force& force) {
  return std::max(std::abs(force.x), std::abs(force.y)) >= limit.ceiling * (1 - single_precision);
}

/// Runs the code of a tick on a hand that has just entered, or with the states and cells of `memory` if it is not null.
#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
float asked_by(const Bank& bank, const BeforeLimit& limit, const Hand& hand, const Memory* memory,
               std::span<const float> states) {
  const DecodedProgram& program = bank.program().decoded();
  std::vector<float> registers(bank.registers().begin(), bank.registers().end());
  program.hand_reader(hand, registers.data());
  const FloatingPointMode mode;
  if (memory != nullptr)
    std::ranges::copy(states, registers.begin() + program.first_state);
  else if (!program.description.states.empty())
    enter_lane(program, registers.data());
  const float* cells = memory != nullptr ? memory->cells().data() : program.initial_cells.data();
  run_lane(program, limit.code, registers.data(), cells);
  const float asked = std::abs(registers[limit.asked]);
  return asked > limit.ceiling * (1 + single_precision) ? asked : 0;
}

/// The largest force asked for beyond a limit on a hand that strokes over the whole patch for some seconds, at up to
/// `speed`, on a program that remembers.
float most_asked_on_a_stroke(Bank bank, const std::vector<BeforeLimit>& limits, float speed) {
  constexpr double two_pi = 6.283185307179586, most_seconds = 5, share_of_patch = 0.95;
  const PatchSize size = bank.size();
  const glm::dvec2 reach = share_of_patch * 0.5 * glm::dvec2(size.width, size.height);
  const double rate = bank.program().description().device.rate, turn = speed / std::max(reach.x, reach.y);  // rad/s
  const long ticks = std::lround(std::min(most_seconds, two_pi / turn) * rate);
  Memory memory(bank.program());
  float most = 0;
  for (long i = 0; i <= ticks; ++i) {
    // To and fro along x while it goes up and down at half the pace.
    const double time = static_cast<double>(i) / rate, phase = turn * time;
    Hand hand;
    hand.position = hand.workspace = reach * glm::dvec2(std::sin(phase), std::sin(phase / 2));
    hand.velocity = hand.raw_velocity = reach * glm::dvec2(std::cos(phase), std::cos(phase / 2) / 2) * turn;
    hand.acceleration = hand.raw_acceleration =
        reach * glm::dvec2(-std::sin(phase), -std::sin(phase / 2) / 4) * (turn * turn);
    hand.time = time;
    if (i == 0) memory.enter(bank, hand);
    const std::vector<float> states(memory.states().begin(), memory.states().end());
    const Force force = tick(bank, memory, hand);
    if (!is_at(limits.front(), force)) continue;
    for (const BeforeLimit& limit : limits) most = std::max(most, asked_by(bank, limit, hand, &memory, states));
  }
  return most;
}

/// Among the hands whose force is at a limit, the largest force that was asked for.
float most_asked(const Bank& bank, const std::vector<BeforeLimit>& limits, std::span<const Hand> hands) {
  std::vector<Force> forces(hands.size());
  tick_coarsely(bank, hands, forces);
  std::vector<const Hand*> at_limit;
  for (std::size_t i = 0; i < hands.size(); ++i)
    if (is_at(limits.front(), forces[i])) at_limit.push_back(&hands[i]);
  float most = 0;
  const std::size_t step = at_limit.size() / hands_asked + 1;
  for (std::size_t i = 0; i < at_limit.size(); i += step)
    for (const BeforeLimit& limit : limits) most = std::max(most, asked_by(bank, limit, *at_limit[i], nullptr, {}));
  return most;
}

}  // namespace

CutForce cut_force(const Bank& bank, float speed) {
  const PatchProgram& program = bank.program().description();
  CutForce cut{.asked = 0, .given = static_cast<float>(program.device.most())};
  if (program.vibrates()) return cut;
  const Proof proof = prove(bank.program());
  if (!proof.limit_matters(0) && !proof.limit_matters(1)) return cut;
  const std::vector<BeforeLimit> limits = limits_of(bank);
  const PatchSize size = bank.size();
  const glm::vec2 extent = 0.5f * glm::vec2(size.width, size.height);
  cut.asked = most_asked(bank, limits, hands_at_rest(cut_hands, extent));
  if (depends_on_the_moment(program))
    cut.asked = std::max(cut.asked, most_asked(bank, limits, hands_in_motion(cut_hands, extent, speed)));
  if (remembers(program) && !leaves_out_motion(program))
    cut.asked = std::max(cut.asked, most_asked_on_a_stroke(bank, limits, speed));
  return cut;
}

std::vector<CutRange> cut_ranges(const Bank& bank, std::size_t parameter, float speed) {
  constexpr int looks = 8, halvings = 7;  // an eighth of the range in 128 parts: a thousandth of it
  const Parameter& facts = bank.program().description().parameters[parameter];
  const auto first = bank.registers().begin() + bank.program().description().first_parameter();
  std::vector<float> values(first, first + static_cast<std::ptrdiff_t>(bank.program().description().parameters.size()));
  const auto value_at = [&](double share) {
    return static_cast<float>(facts.low + share * (double{facts.high} - facts.low));
  };
  const auto is_cut = [&](double share) {
    values[parameter] = value_at(share);
    return cut_force(Bank(bank.program(), values, bank.size()), speed).asked > 0;
  };
  bool cut[looks + 1];
  for (int i = 0; i <= looks; ++i) cut[i] = is_cut(static_cast<double>(i) / looks);
  // Between a value that is cut and its neighbour that is not.
  const auto border = [&](double inside, double outside) {
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (inside + outside);
      (is_cut(middle) ? inside : outside) = middle;
    }
    return value_at(inside);
  };
  std::vector<CutRange> ranges;
  if (std::ranges::all_of(cut, [](bool each) { return each; })) return ranges;
  constexpr double step = 1.0 / looks;
  int last = 0, begin = looks;
  while (cut[last]) ++last;
  while (cut[begin]) --begin;
  if (last > 0) ranges.push_back({false, border((last - 1) * step, last * step)});
  if (begin < looks) ranges.push_back({true, border((begin + 1) * step, begin * step)});
  return ranges;
}

FateRecord fate_of_force(FateRecord force, const Bank& bank, float speed) {
  constexpr double told_newtons = 1e6;  // a larger number tells nothing more
  const CutForce cut = cut_force(bank, speed);
  force.fate = cut.asked > 0 ? Fate::saturated : Fate::kept;
  force.reason = "by the material's formulas, not found from a level";
  if (cut.asked > 0)
    force.reason = readable("by the material's formulas, which ask for {} along x or y, and `{}` gives {:.3g} N",
                            !std::isfinite(cut.asked)  ? "more than any number"
                            : cut.asked > told_newtons ? readable("more than {:g} N", told_newtons)
                            : readable("{:.3g}", cut.asked) == readable("{:.3g}", cut.given)
                                ? readable("a little more than {:.3g} N", cut.given)
                                                       : readable("up to {:.3g} N", cut.asked),
                            bank.program().description().device.name, cut.given);
  return force;
}

}  // namespace wale
