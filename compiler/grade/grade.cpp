#include "compiler/grade/grade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "compiler/grade/circulation.hpp"
#include "compiler/grade/explore.hpp"
#include "compiler/grade/slopes.hpp"
#include "compiler/grade/sources.hpp"
#include "compiler/grade/steep_places.hpp"
#include "compiler/grade/step_ahead.hpp"
#include "compiler/grade/steps.hpp"
#include "compiler/grade/switching.hpp"
#include "compiler/measure/hands.hpp"
#include "compiler/prove/later_force.hpp"
#include "compiler/prove/prove.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/swing.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

using std::numbers::pi;
constexpr std::size_t candidates = 12;       // of each kind: hands whose required damping is computed
constexpr std::size_t hands_at_once = 1024;  // evaluated at once, so that their values fit into the cache
constexpr double share_of_steps = 0.25;      // of the largest step: a smaller jump is not told
constexpr double steeper = 1.01;             // than the steepest slope found: less is rounding
constexpr double share_of_hand = 0.01;  // of the power that the hand absorbs at its pace; smaller powers are ignored
constexpr double sharp_over_step =
    1.5;  // ratio of a slope to the step between counts above which the slope is a sharp tip

/// The standing of a program that needs damping and gives no energy, by the device's damping and the hand's.
Standing by_damping(const Grade& grade) {
  if (grade.required_damping <= grade.device_damping) return Standing::passive;
  const double with_hand = grade.device_damping + grade.hand_damping;
  return grade.required_damping <= with_hand ? Standing::stable_in_the_hand : Standing::unstable;
}

class Grader {
 public:
  Grader(const Bank& bank, const GradingHand& hand)
      : bank_(bank),
        program_(bank.program().description()),
        device_(program_.device),
        hand_(hand),
        exploration_(explored()),
        slopes_(bank, exploration_ ? exploration_->changing : std::vector<char>{}) {}

  Grade grade() {
    grade_.device_damping = device_.damping;
    grade_.damping_known = device_.damping_known;
    grade_.friction = device_.friction;
    grade_.friction_known = device_.friction_known;
    grade_.hand_damping = hand_.damping;
    grade_.fewest_counts = hand_.fewest_counts;
    grade_.faithful_counts = hand_.faithful_counts;
    grade_.fewest_levels = hand_.fewest_levels;
    if (!slopes_.fits()) return grade_;
    choose_hands();
    at_ = slopes_.by_place(hands_, states_);
    find_stiffness();
    find_steps();
    find_energy();
    find_resolution();
    if (find_required_damping()) decide();
    return grade_;
  }

  Energy energy() {
    if (!slopes_.fits()) return {};
    choose_hands();
    at_ = slopes_.by_place(hands_, states_);
    steps_ = StepSearch(bank_, slopes_).largest(stepped_quantities(device_, extent_, peak_speed())[0], hands_, states_);
    find_energy();
    return grade_.energy;
  }

 private:
  std::optional<Exploration> explored() const {
    if (program_.states.empty() && !stores_motion()) return std::nullopt;
    return explore_with_button(bank_, hand_);
  }

  /// Whether the tick reads accelerations. A mass stores and returns energy, so the power at one moment says nothing.
  bool stores_motion() const {
    return std::ranges::any_of(program_.tick, [](const Instruction& instruction) {
      const int operands = facts(static_cast<Operation>(instruction.operation)).operands;
      const RegisterNumber from[] = {instruction.a, instruction.b, instruction.c};
      return std::any_of(from, from + operands, [](RegisterNumber number) {
        const auto input = static_cast<Input>(number);
        return input == Input::acceleration_x || input == Input::acceleration_y || input == Input::raw_acceleration_x ||
               input == Input::raw_acceleration_y;
      });
    });
  }

  /// Chooses the hands: for a program that remembers, those of the exploration; otherwise hands all over the patch.
  void choose_hands() {
    extent_ = 0.5f * glm::vec2(bank_.size().width, bank_.size().height);
    if (!program_.states.empty()) {
      hands_ = exploration_->hands;
      states_ = exploration_->states;
      return;
    }
    hands_ = hands_at_rest(lattice_hands, extent_);
    if (reads(program_, {Input::button}))
      for (Hand& hand : hands_at_rest(lattice_hands, extent_)) hand.button = true, hands_.push_back(hand);
    if (!depends_on_the_moment(program_)) return;
    for (Hand& hand : hands_in_motion(lattice_hands, extent_, static_cast<float>(peak_speed()))) hands_.push_back(hand);
  }

  /// The largest speed of the exploring hand, m/s.
  double peak_speed() const { return hand_.speed(); }

  /// The least power that counts, W: a share of the power that the hand absorbs at its pace.
  double least_watt() const { return share_of_hand * hand_.damping * peak_speed() * peak_speed(); }

  std::span<const float> states_of(std::size_t hand) const {
    return std::span(states_).subspan(hand * program_.states.size(), program_.states.size());
  }

  /// The number of hands in the group that begins with hand `first`.
  std::size_t hands_from(std::size_t first) const { return std::min(hands_at_once, hands_.size() - first); }
  std::span<const float> states_from(std::size_t first) const {
    return std::span(states_).subspan(first * program_.states.size(), hands_from(first) * program_.states.size());
  }

  /// Changes each hand by `move`, computes its force, and calls `visit` with the hand's number and that force.
  template <typename Move, typename Visit>
  void each_moved(const Move& move, const Visit& visit) {
    std::vector<Hand> moved;
    for (std::size_t first = 0; first < hands_.size(); first += moved.size()) {
      const auto from = hands_.begin() + static_cast<std::ptrdiff_t>(first);
      moved.assign(from, from + static_cast<std::ptrdiff_t>(hands_from(first)));
      std::ranges::for_each(moved, move);
      const auto at = slopes_.by_place(moved, states_from(first));
      for (std::size_t i = 0; i < moved.size(); ++i) visit(first + i, at[i]);
    }
  }

  void find_stiffness() {
    steepest_ = find_steepest(slopes_, {hands_, states_, at_}, extent_);
    grade_.stiffness = steepest_.stiffness;
    grade_.stiffest = steepest_.where;
  }

  /// Finds the largest changes of the force over one step of place and motion.
  void find_steps() {
    StepSearch search(bank_, slopes_);
    const auto quantities = stepped_quantities(device_, extent_, peak_speed());
    const SteppedQuantity& place = quantities[0];
    steps_ = search.largest(place, hands_, states_);
    for (ForceStep& step : search.around(place, steepest_.hands, steepest_.states)) steps_.push_back(std::move(step));
    for (const ForceStep& step : steps_) {
      grade_.largest_newton = std::max(grade_.largest_newton, step.largest);
      if (step.newton() > grade_.step_newton) grade_.step_newton = step.newton(), worst_step_ = step.hand;
    }
    find_steps_through_memory();
    find_finest_period();
    // A jump that is smaller than other steps, or than the device's own, is not told.
    const double least = std::max(device_.force_step(), share_of_steps * grade_.step_newton);
    grade_.jumps = (ahead_.jumps && ahead_.newton > least) || std::ranges::any_of(steps_, [&](const ForceStep& step) {
                     return step.jumps() && std::min(step.at_once, step.newton()) > least;
                   });
    const double count = device_.position_step();
    // A tip that is sharper than one count cannot be felt: the loop sees only the difference between two counts.
    if (grade_.stiffness * count > sharp_over_step * grade_.step_newton) {
      grade_.stiffness = grade_.step_newton / count;
      grade_.stiffest = {worst_step_.position, worst_step_.velocity};
    }
    // A smooth step between the hands of the lattice is steeper than these.
    for (const ForceStep& step : steps_)
      if (!step.jumps() && step.newton() > device_.force_step() && step.newton() / count > steeper * grade_.stiffness) {
        grade_.stiffness = step.newton() / count;
        grade_.stiffest = {step.hand.position, step.hand.velocity};
      }
    if (device_.friction_known) grade_.buzzes = grade_.step_newton > 2 * device_.friction;
    if (!slopes_.depends_on_motion()) return;
    for (const std::size_t motion : {1, 2})
      for (ForceStep& step : search.largest(quantities[motion], hands_, states_))
        motion_steps_.push_back({quantities[motion], std::move(step)});
  }

  /// Finds the change of the force over one count that comes through what a program remembers of the hand's places. The
  /// loop sees it later than a change that comes at once, so it needs at least as much damping.
  void find_steps_through_memory() {
    if (program_.states.empty() && program_.grids.empty()) return;
    ahead_ = largest_step_ahead(bank_, hand_);
    if (ahead_.newton > steeper * grade_.step_newton) grade_.step_newton = ahead_.newton, worst_step_ = ahead_.hand;
  }

  /// Finds the finest detail: the change of the force's slope over one encoder count shows it, and also steps between
  /// counts that are larger than those of the search. For a sine of period P, the slope changes by the share
  /// 2 sin(pi count / P).
  void find_finest_period() {
    const auto count = static_cast<float>(device_.position_step());
    double wave_number_squared = 0;  // rad^2 / m^2
    for (const glm::vec2 direction : {glm::vec2(count, 0), glm::vec2(0, count)}) {
      double slopes = 0, changes = 0;
      const auto move = [&](Hand& hand) { hand.position += direction, hand.workspace += direction; };
      each_moved(move, [&](std::size_t i, const ProgramSlopes::ByPlace& at) {
        const double step = glm::length(at.force - at_[i].force);
        if (step > grade_.step_newton) grade_.step_newton = step, worst_step_ = hands_[i];
        double slope = 0, change = 0;
        for (std::size_t row = 0; row < 2; ++row)
          for (std::size_t column = 0; column < 2; ++column) {
            const double here = at_[i].place[row][column], there = at.place[row][column];
            slope += here * here, change += (there - here) * (there - here);
          }
        if (std::isfinite(slope) && std::isfinite(change)) slopes += slope, changes += change;
      });
      const double share = slopes > 0 ? std::sqrt(changes / slopes) : 0;
      const double wave_number = 2 / count * std::asin(std::min(1.0, share / 2));
      wave_number_squared += wave_number * wave_number;
    }
    grade_.finest_period = 2 * pi / std::sqrt(wave_number_squared);
  }

  void find_resolution() {
    // A force below half a step of the command is never given, and what is left of two that cancel is rounding.
    if (std::max(grade_.largest_newton, grade_.step_newton) < 0.5 * device_.force_step()) {
      grade_.finest_period = std::numeric_limits<double>::infinity();
      grade_.stiffness = grade_.step_newton = 0;
      return;
    }
    grade_.counts_per_period = grade_.finest_period / device_.position_step();
    grade_.fastest_hand = grade_.finest_period * device_.rate / 2;
    grade_.force_levels = grade_.largest_newton / device_.force_step();
  }

  void find_energy() {
    for (const auto& here : at_) grade_.largest_newton = std::max(grade_.largest_newton, glm::length(here.force));
    find_curl();
    find_motion_power();
    find_sources({bank_, hand_, slopes_, {hands_, states_, at_}, steps_, least_watt()}, exploration_, grade_.energy);
    const double switched = switching_watt(bank_, hand_);
    if (switched <= least_watt()) return;
    grade_.energy.button_watt = switched;
    grade_.energy.reasons.push_back("the button switches its force: a hand that presses on one way alone gains energy");
  }

  /// Finds the power of the curl. For a program that remembers, the place does not determine the force, so the energy
  /// of the exploration is used.
  void find_curl() {
    if (!program_.states.empty()) return;
    const double watt = curl_watt(bank_, {hands_, states_, at_}, steps_, hand_, least_watt());
    grade_.energy.conservative = watt < least_watt();
    if (grade_.energy.conservative) return;
    grade_.energy.curl_watt = watt;
    grade_.energy.reasons.push_back("the field has a curl: a hand that moves in circles gains energy");
  }

  /// Finds the power of the part of the force that motion adds. As with the curl, a program that remembers is
  /// different.
  void find_motion_power() {
    if (!slopes_.depends_on_motion() || exploration_) return;
    const auto rest = [](Hand& hand) {
      hand.velocity = hand.raw_velocity = hand.acceleration = hand.raw_acceleration = glm::vec2(0.0f);
    };
    double worst = 0;
    each_moved(rest, [&](std::size_t i, const ProgramSlopes::ByPlace& still) {
      worst = std::max(worst, glm::dot(at_[i].force - still.force, glm::dvec2(hands_[i].velocity)));
    });
    if (worst <= least_watt()) return;
    grade_.energy.motion_watt = worst;
    grade_.energy.reasons.push_back("it pushes along the hand's motion");
  }

  /// False if the machine has too few registers for the derivatives.
  bool find_required_damping() {
    // The steepest places are included.
    std::vector<Hand> hands = steepest_.hands;
    std::vector<float> states = steepest_.states;
    if (slopes_.depends_on_motion() || !program_.states.empty()) {
      // Add the hands where the slope by place, by motion, or by both is greatest, and some of the others.
      const double half = 0.5 / device_.rate;
      std::vector<double> motion(hands_.size()), both(hands_.size());
      for (std::size_t first = 0; first < hands_.size(); first += hands_at_once) {
        const auto some = slopes_.at(std::span(hands_).subspan(first, hands_from(first)), states_from(first));
        if (some.empty()) return false;
        for (std::size_t i = 0; i < some.size(); ++i) {
          const HandSlopes& direct = some[i].linear.direct;
          const double norm = spectral_norm(direct.velocity) + spectral_norm(direct.raw_velocity);
          motion[first + i] = std::isfinite(norm) ? norm : 0;
          both[first + i] = motion[first + i] + half * steepness(direct.place);
        }
      }
      const auto add = [&](std::size_t i) {
        hands.push_back(hands_[i]);
        states.insert(states.end(), states_of(i).begin(), states_of(i).end());
      };
      std::ranges::for_each(greatest_of(motion, candidates), add);
      std::ranges::for_each(greatest_of(both, candidates), add);
      for (std::size_t i = 0; i < candidates; ++i) add(i * hands_.size() / candidates);
    }
    const LoopTiming timing(device_);
    auto all = slopes_.at(hands, states);
    if (all.empty()) return false;
    if (slopes_.depends_on_motion()) limit_by_steps(all, hands, states);
    // Many places are equal, in oil all of them; of equal ones the first is reported as the worst.
    std::vector<std::size_t> different;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (is_smooth(all[i].linear) && steepness(all[i].linear.direct.place) <= sharp_over_step * grade_.stiffness &&
          std::ranges::none_of(different, [&](std::size_t j) { return all[j].linear == all[i].linear; }))
        different.push_back(i);
    std::vector<double> of_different(different.size());
    const auto work = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) of_different[i] = required_damping(all[different[i]].linear, timing);
    };
    // Without motion and states there is a closed form, which is not worth a thread.
    if (slopes_.depends_on_motion() || !program_.states.empty())
      in_parallel(different.size(), work);
    else
      work(0, different.size());
    std::vector<double> needed(all.size());
    for (std::size_t i = 0; i < different.size(); ++i) needed[different[i]] = of_different[i];
    for (std::size_t i = 0; i < all.size(); ++i)
      if (needed[i] > grade_.required_damping) {
        grade_.required_damping = needed[i];
        grade_.worst = {hands[i].position, hands[i].velocity};
      }
    for (const auto& [quantity, step] : motion_steps_) {
      const double damping = required_damping(across_motion(quantity, step), timing);
      if (damping <= grade_.required_damping) continue;
      grade_.required_damping = damping;
      grade_.worst = {step.hand.position, step.hand.velocity};
    }
    // Across a jump or a steep step the sampled loop sees the slope between two counts.
    const double across = grade_.step_newton / device_.position_step() * (timing.period / 2 + timing.latest());
    if (across <= steeper * grade_.required_damping) return true;
    grade_.required_damping = across;
    grade_.worst = {worst_step_.position, worst_step_.velocity};
    return true;
  }

  /// Replaces slopes by motion that are steeper than the change over one step of the motion, which is all that the loop
  /// sees.
  void limit_by_steps(std::vector<ProgramSlopes::At>& all, std::span<const Hand> hands, std::span<const float> states) {
    StepSearch search(bank_, slopes_);
    const auto quantities = stepped_quantities(device_, extent_, peak_speed());
    for (const std::size_t motion : {1, 2}) {
      const SteppedQuantity& quantity = quantities[motion];
      const auto steps = search.around(quantity, hands, states);
      if (steps.size() != 2 * all.size()) continue;
      for (std::size_t i = 0; i < all.size(); ++i) {
        Slopes& exact = all[i].linear.direct.*quantity.slopes;
        Slopes seen{};
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const glm::dvec2 change = steps[2 * i + axis].change / quantity.step;
          seen[0][axis] = change.x, seen[1][axis] = change.y;
        }
        if (spectral_norm(exact) > sharp_over_step * spectral_norm(seen)) exact = seen;
      }
    }
  }

  /// The program across a step of the hand's motion, with its slope by place there.
  LinearProgram across_motion(const SteppedQuantity& quantity, const ForceStep& step) {
    LinearProgram linear;
    const auto at = slopes_.by_place(std::span(&step.hand, 1), step.states);
    if (const double steep = steepness(at[0].place); steep > 0 && steep <= sharp_over_step * grade_.stiffness)
      linear.direct.place = at[0].place;
    for (std::size_t row = 0; row < 2; ++row)
      (linear.direct.*quantity.slopes)[row][step.axis] = step.change[static_cast<int>(row)] / quantity.step;
    return linear;
  }

  /// Whether the slopes exist: at the tip of a cone they do not.
  static bool is_smooth(const LinearProgram& linear) {
    const auto finite = [](double value) { return std::isfinite(value); };
    const auto smooth = [&](const HandSlopes& slopes) {
      for (const Slopes* each :
           {&slopes.place, &slopes.velocity, &slopes.raw_velocity, &slopes.acceleration, &slopes.raw_acceleration})
        for (const auto& row : *each)
          if (!finite(row[0]) || !finite(row[1])) return false;
      return true;
    };
    return smooth(linear.direct) && std::ranges::all_of(linear.input, smooth) &&
           std::ranges::all_of(linear.output, finite) && std::ranges::all_of(linear.carry, finite);
  }

  void decide() {
    grade_.later_newton = later_force(bank_, still_seconds, remembers_time_only(program_));
    // A state that runs on may bring what nobody has looked at, so the program is not called passive; of states that go
    // by time alone, the proof above says it.
    const bool runs_on = exploration_ && exploration_->runs_on && !remembers_time_only(program_);
    if (runs_on && grade_.later_newton == 0 && !grade_.energy.active() && by_damping(grade_) == Standing::passive)
      grade_.later_newton = prove(bank_.program()).bound_newton;
    if (grade_.energy.active())
      grade_.standing = Standing::active;
    else if (grade_.later_newton > 0)
      grade_.standing = Standing::unknown;
    else if (grade_.required_damping == 0)
      grade_.standing = Standing::passive;
    else
      grade_.standing = grade_.damping_known ? by_damping(grade_) : Standing::unknown;
  }

  const Bank& bank_;
  const PatchProgram& program_;
  const DeviceProfile& device_;
  const GradingHand hand_;
  std::optional<Exploration> exploration_;
  ProgramSlopes slopes_;
  Grade grade_;
  glm::vec2 extent_{0.0f};
  std::vector<Hand> hands_;
  std::vector<float> states_;
  std::vector<ProgramSlopes::ByPlace> at_;  ///< slopes by place for each of `hands_`
  SteepPlaces steepest_;
  std::vector<ForceStep> steps_;  ///< by place
  std::vector<std::pair<SteppedQuantity, ForceStep>> motion_steps_;
  StepAhead ahead_;
  Hand worst_step_;
};

}  // namespace

GradingHand normal_hand(const Declarations& declarations) {
  GradingHand hand{.name = "normal"};
  if (const HandDeclaration* declared = declarations.hands.find(hand.name))
    hand = {.damping = declared->damping,
            .radius = declared->circular_radius,
            .frequency = declared->circular_frequency,
            .name = declared->name,
            .fewest_counts = declared->fewest_counts,
            .faithful_counts = declared->faithful_counts,
            .fewest_levels = declared->fewest_levels};
  return hand;
}

std::string_view standing_word(Standing standing) {
  switch (standing) {
    case Standing::passive: return "passive";
    case Standing::stable_in_the_hand: return "stable in the hand";
    case Standing::unstable: return "unstable";
    case Standing::active: return "active";
    case Standing::unknown: return "unknown";
    case Standing::not_analysed: return "not analysed";
  }
  return "unknown";
}

double Energy::watt() const { return std::max({curl_watt, motion_watt, source_watt, button_watt}); }

std::optional<Standing> Grade::assumed_standing() const {
  if (standing != Standing::unknown || device_damping <= 0 || later_newton > 0) return std::nullopt;
  return by_damping(*this);
}

std::optional<double> Grade::margin() const {
  if (!damping_known) return std::nullopt;
  return device_damping - required_damping;
}

Grade grade(const Bank& bank, const GradingHand& hand) {
  if (bank.program().description().vibrates()) return {};
  return Grader(bank, hand).grade();
}

Energy energy_of(const Bank& bank, const GradingHand& hand) {
  if (bank.program().description().vibrates()) return {};
  return Grader(bank, hand).energy();
}

}  // namespace wale
