#include "compiler/grade/explore.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/grade/exploring_place.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/swing.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr std::size_t moments = 60;    // of a second, at which the energy is summed up
constexpr std::size_t way_back = 64;   // places on a way back
constexpr long later_hands = 8;        // ticks from one hand that is kept to the next, after the first second
constexpr double settled_from = 0.75;  // of the first second: a state that went further after that is on its way
constexpr double on_its_way = 1e-3;    // of the range that a state went through
constexpr double uneven = 0.02;        // of a second's change, by which that of others may differ in a clock
constexpr double visit_seconds = 0.25, press_after = 0.4;  // the latter is a part of a visit
constexpr double visit_radius = 0.01;                      // m

/// What a hand has gained at some moment, J, and where it is, m.
struct Gained {
  double joule = 0;
  glm::dvec2 place{0};
};

/// The most that a hand has gained at one of some moments, J. What a force by place gave it on its way, it takes back
/// on the way to where the hand began: of a gain counts what is left after the straight way back through the forces on
/// hands that have just entered, at the time and with the button of `moment`.
double gained_for_good(const Bank& bank, glm::dvec2 from, std::vector<Gained> all, const Hand& moment) {
  std::erase_if(all, [](const Gained& each) { return !(each.joule > 0); });
  std::vector<Hand> hands;
  for (const Gained& each : all)
    for (std::size_t i = 0; i < way_back; ++i) {
      Hand& hand = hands.emplace_back();
      const double part = (static_cast<double>(i) + 0.5) / way_back;
      hand.position = hand.workspace = glm::vec2(each.place + part * (from - each.place));
      hand.time = moment.time, hand.button = moment.button;
    }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  double most = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    glm::dvec2 mean{0};
    for (std::size_t k = 0; k < way_back; ++k) mean += glm::dvec2(forces[i * way_back + k]) / (1.0 * way_back);
    most = std::max(most, std::min(all[i].joule, all[i].joule + glm::dot(mean, from - all[i].place)));
  }
  return most;
}

/// The energies of a hand since some moment, J.
struct Energies {
  double work = 0, moved = 0;

  void add(double joule) { work += joule, moved += std::abs(joule); }
};

/// Runs a program under a hand on its way, and sums up the energies that it gets.
template <typename Place>
class Explorer {
 public:
  Explorer(const Bank& bank, const Place& at, Exploration& found)
      : bank_(bank),
        at_(at),
        found_(found),
        memory_(bank_.program()),
        rate_(bank_.program().description().device.rate) {
    found_.changing.resize(bank_.program().description().states.size(), false);
  }

  /// Lets the hand enter at time `begins`, s.
  void enter(double begins, bool button) {
    begins_ = begins, now_ = 0;
    memory_.enter(bank_, hand(button));
    entered_.assign(memory_.states().begin(), memory_.states().end());
  }

  /// Runs some ticks and returns their energies; every `keep`-th hand is kept. Calls `after` after each tick.
  template <typename After>
  Energies run(long ticks, bool button, long keep, const After& after) {
    Energies energies;
    for (long i = 0; i < ticks; ++i, ++now_) {
      const Hand now = hand(button);
      for (std::size_t state = 0; state < entered_.size(); ++state)
        if (memory_.states()[state] != entered_[state]) found_.changing[state] = true;
      if (now_ % keep == 0) {
        found_.hands.push_back(now);
        found_.states.insert(found_.states.end(), memory_.states().begin(), memory_.states().end());
      }
      // The step is centred on the hand's place, so that sampling gives almost no energy to a conservative field.
      const double time = seconds(), period = 1 / rate_;
      const glm::dvec2 force = glm::dvec2(tick(bank_, memory_, now)),
                       step = 0.5 * (at_(time + period) - at_(time - period));
      energies.add(force.x * step.x + force.y * step.y);
      after(energies, i);
    }
    return energies;
  }

  double seconds() const { return static_cast<double>(now_) / rate_; }
  /// Where the hand is between the last tick and the next, m.
  glm::dvec2 here() const { return at_(seconds() + 0.5 / rate_); }
  const Bank& bank() const { return bank_; }
  std::span<const float> states() const { return memory_.states(); }
  Hand hand(bool button) const {
    Hand hand = hand_along(at_, seconds(), 1 / rate_);
    hand.time += begins_;
    hand.button = button;
    return hand;
  }

 private:
  Bank bank_;
  const Place& at_;
  Exploration& found_;
  Memory memory_;
  double rate_, begins_ = 0;
  long now_ = 0;
  std::vector<float> entered_;
};

ExploredPower power(double gained, const Energies& energies, double seconds) {
  return {gained / seconds, energies.moved / seconds};
}

/// The ranges that states went through.
struct Ranges {
  std::vector<float> low, high;

  void add(std::span<const float> states) {
    if (low.empty()) low.assign(states.begin(), states.end()), high = low;
    for (std::size_t i = 0; i < states.size(); ++i)
      low[i] = std::min(low[i], states[i]), high[i] = std::max(high[i], states[i]);
  }
  bool left_by(std::span<const float> states, std::size_t i) const {
    const double margin = on_its_way * (static_cast<double>(high[i]) - low[i]);
    return states[i] > high[i] + margin || states[i] < low[i] - margin;
  }
  bool left_by(std::span<const float> states) const {
    for (std::size_t i = 0; i < low.size(); ++i)
      if (left_by(states, i)) return true;
    return false;
  }
};

/// Whether a state runs on evenly, second by second, as a clock or a sum of ways does: one that settles goes ever more
/// slowly, and a phase comes back to where it was in the first second.
bool runs_on(const std::vector<std::vector<float>>& by_second, const Ranges& first) {
  for (std::size_t state = 0; state < first.low.size(); ++state) {
    const auto change = [&](std::size_t second) {
      return static_cast<double>(by_second[second][state]) - by_second[second - 1][state];
    };
    bool on = by_second.size() > 2 && first.left_by(by_second.back(), state);
    for (std::size_t i = 1; i < by_second.size(); ++i)
      on = on && change(i) != 0 && std::abs(change(i) - change(1)) <= uneven * std::abs(change(1));
    if (on) return true;
  }
  return false;
}

}  // namespace

void ExploredPower::add(const ExploredPower& other) {
  gained = std::max(gained, other.gained);
  moved = std::max(moved, other.moved);
}

void Exploration::add(Exploration other) {
  for (const Run& run : other.runs) runs.push_back({run.begin + hands.size(), run.end + hands.size(), run.usual});
  hands.insert(hands.end(), other.hands.begin(), other.hands.end());
  states.insert(states.end(), other.states.begin(), other.states.end());
  changing.resize(other.changing.size(), false);
  for (std::size_t i = 0; i < changing.size(); ++i) changing[i] = changing[i] || other.changing[i];
  usual.add(other.usual), beyond.add(other.beyond);
  runs_on = runs_on || other.runs_on;
}

Exploration explore(const Bank& bank, const GradingHand& hand, bool button) {
  const PatchProgram& program = bank.program().description();
  const double radius = std::min(hand.radius, room_to_stroke(bank.size()));
  const long second = std::lround(exploring_seconds * program.device.rate);
  const bool timed = reads(program, {Input::time});
  Exploration found;
  for (const bool circles : {false, true}) {
    const auto at = [&](double time) { return exploring_place(time, radius, hand.frequency, circles); };
    const std::size_t hands_before = found.hands.size();
    Explorer explorer(bank, at, found);
    explorer.enter(0, button);
    std::vector<Gained> gained;
    Ranges ranges;
    const long each = std::max(1L, second / static_cast<long>(moments));
    const auto settled = static_cast<long>(settled_from * static_cast<double>(second));
    const Energies first = explorer.run(second, button, 1, [&](const Energies& energies, long i) {
      if ((i + 1) % each == 0) gained.push_back({energies.work, explorer.here()});
      if (i < settled) ranges.add(explorer.states());
    });
    found.runs.push_back({hands_before, found.hands.size(), !button});
    const double kept = gained_for_good(bank, at(0), std::move(gained), explorer.hand(button));
    (button ? found.beyond : found.usual).add(power(kept, first, exploring_seconds));
    if (!timed && !ranges.left_by(explorer.states())) continue;
    // Over whole turns of a hand that goes the same way again, what it gains is no energy that a field has stored; and
    // what it gains in all is none that a mass or a spring in the program took from it before.
    double in_all = first.work;
    const double turns = std::max(1.0, std::round(exploring_seconds * hand.frequency)) / hand.frequency;
    const long ticks = std::lround(turns * program.device.rate);
    std::vector<std::vector<float>> by_second;
    while (explorer.seconds() < still_seconds) {
      const std::size_t begin = found.hands.size();
      const Energies later = explorer.run(ticks, button, later_hands, [](const Energies&, long) {});
      found.runs.push_back({begin, found.hands.size(), false});
      in_all += later.work;
      found.beyond.add(power(std::min(later.work, in_all), later, turns));
      by_second.emplace_back(explorer.states().begin(), explorer.states().end());
    }
    const bool clock = runs_on(by_second, ranges);
    found.runs_on = found.runs_on || clock;
    if (timed || clock) continue;
    // Nothing new began; the hands of the first second are enough.
    found.hands.resize(hands_before + static_cast<std::size_t>(second));
    found.states.resize(found.hands.size() * program.states.size());
    std::erase_if(found.runs, [&](const Exploration::Run& run) { return run.end > found.hands.size(); });
  }
  return found;
}

Exploration visit(const Bank& bank, const GradingHand& hand, std::span<const Hand> centres, bool reads_button) {
  const double rate = bank.program().description().device.rate;
  const double radius = std::min(visit_radius, room_to_stroke(bank.size()));
  const double frequency = hand.speed() / (2 * std::numbers::pi * visit_radius);
  const long ticks = std::lround(visit_seconds * rate);
  const auto press = static_cast<long>(press_after * static_cast<double>(ticks));
  Exploration found;
  for (const Hand& centre : centres) {
    const glm::dvec2 middle(centre.position);
    const auto at = [&](double time) {
      const double angle = 2 * std::numbers::pi * frequency * time;
      return middle +
             radius * coming_up(time, press_after * visit_seconds) * glm::dvec2(std::sin(angle), std::cos(angle));
    };
    Explorer explorer(bank, at, found);
    const auto run_part = [&](long part, bool button, double earlier, glm::dvec2 from) {
      std::vector<Gained> since, in_all;
      const std::size_t begin = found.hands.size();
      const Energies energies = explorer.run(part, button, later_hands, [&](const Energies& now, long i) {
        if ((i + 1) % 8 != 0) return;
        since.push_back({now.work, explorer.here()});
        in_all.push_back({now.work + earlier, explorer.here()});
      });
      found.runs.push_back({begin, found.hands.size(), false});
      double gained = gained_for_good(bank, from, std::move(since), explorer.hand(button));
      if (earlier != 0)
        gained = std::min(gained, gained_for_good(bank, from, std::move(in_all), explorer.hand(button)));
      found.beyond.add(power(gained, energies, static_cast<double>(part) / rate));
      return energies.work;
    };
    for (const bool button : {false, true}) {
      if (button && !reads_button) continue;
      explorer.enter(centre.time, button);
      run_part(ticks, button, 0, middle);
      if (!reads_button) continue;
      explorer.enter(centre.time, button);
      const double before = run_part(press, button, 0, middle);
      run_part(ticks - press, !button, before, explorer.here());
    }
  }
  return found;
}

}  // namespace wale
