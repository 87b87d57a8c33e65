#include "compiler/prove/largest_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/machine/arithmetic.hpp"
#include "wale/batch.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr std::size_t starts = 1024;      ///< hands for each choice of parameters
constexpr std::size_t neighbours = 128;   ///< hands of one step around the best
constexpr int steps = 14;                 ///< each step is half as wide as the one before
constexpr int passes = 4;                 ///< passes over all steps; the wide first steps may leave a local maximum
constexpr double gaining = 1.0001;        ///< passes go on while one raises the force by this factor
constexpr std::size_t refined = 4;        ///< the best choices of parameters, which are refined
constexpr double near_enough = 0.9;       ///< of the force that is looked for
constexpr double budget = 1.6e7;          ///< units of cost over all points of peaks and all hands, some milliseconds
constexpr double single = 4;              ///< a single hand costs this much more than one of many
constexpr std::size_t most_choices = 32;  ///< choices of parameters
constexpr std::size_t strokes = 16, stroke_ticks = 256, fewest_stroke_ticks = 8;
constexpr double stroking = 1e9;  ///< units of cost of all strokes, about a second; only the largest programs take less
constexpr double longest = 60;    ///< s; the latest time of a hand

/// Random numbers in [0, 1) that are the same everywhere.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : state_(seed) {}
  double next() { return arithmetic::mixed(++state_ * 0x9e3779b9u) * 0x1p-32; }
  bool coin() { return next() < 0.5; }

 private:
  std::uint32_t state_;
};

/// The member of a hand for a program's input; null if the hand does not have it.
float* component(Hand& hand, Input input) {
  switch (input) {
    case Input::x: return &hand.position.x;
    case Input::y: return &hand.position.y;
    case Input::velocity_x: return &hand.velocity.x;
    case Input::velocity_y: return &hand.velocity.y;
    case Input::acceleration_x: return &hand.acceleration.x;
    case Input::acceleration_y: return &hand.acceleration.y;
    case Input::raw_velocity_x: return &hand.raw_velocity.x;
    case Input::raw_velocity_y: return &hand.raw_velocity.y;
    case Input::raw_acceleration_x: return &hand.raw_acceleration.x;
    case Input::raw_acceleration_y: return &hand.raw_acceleration.y;
    case Input::workspace_x: return &hand.workspace.x;
    case Input::workspace_y: return &hand.workspace.y;
    case Input::shape_edge: return &hand.edge;
    case Input::shape_edge_x: return &hand.edge_slope.x;
    case Input::shape_edge_y: return &hand.edge_slope.y;
    default: return nullptr;
  }
}

/// One point of the search.
struct Choice {
  std::vector<float> parameters;
  PatchSize size;
};

class Search {
 public:
  Search(const Program& program, const ForceSlice& slice, const Domain& domain, double enough)
      : program_(program), description_(program.description()), domain_(domain), enough_(enough) {
    for (const Quantity& quantity : slice.quantities) {
      if (quantity.kind == Quantity::Kind::input) moving_.push_back(static_cast<Input>(quantity.index));
      if (quantity.kind == Quantity::Kind::parameter) live_.push_back(quantity.index);
      remembers_ |= quantity.kind == Quantity::Kind::state;
    }
    for (const Instruction& i : slice.tick) {
      remembers_ |= facts(static_cast<Operation>(i.operation)).fields[2] == 'g';
    }
  }

  LargestForce run() {
    std::vector<Tried> tried;
    bool hoped = false;
    for (const Choice& choice : choices()) {
      Tried& now = tried.emplace_back(best_of(choice));
      if (enough(now.best)) return now.best;
      // If the first hand near the goal reaches it at once, the peaks of further choices are not computed.
      if (hoped || now.best.newton < near_enough * enough_) continue;
      hoped = true;
      refine(now);
      if (enough(now.best)) return now.best;
    }
    std::stable_sort(tried.begin(), tried.end(),
                     [](const Tried& a, const Tried& b) { return a.best.newton > b.best.newton; });
    tried.erase(tried.begin() + static_cast<std::ptrdiff_t>(std::min(tried.size(), refined)), tried.end());
    LargestForce best = tried.front().best;
    const auto consider = [&best](const LargestForce& other) {
      if (other.newton > best.newton) best = other;
    };
    for (Tried& each : tried) {
      if (&each != &tried.front() && left_ <= 0) break;
      refine(each);
      consider(each.best);
      if (enough(best)) return best;
    }
    if (remembers_)
      for (const Tried& each : tried)
        if (&each == &tried.front() || left_ > 0) consider(stroked({each.bank}));
    // Memory written with one setting of the parameters is felt with another.
    if (remembers_ && !live_.empty()) {
      std::vector<Bank> banks;
      for (const Tried& each : tried)
        if (each.bank.size() == tried.front().bank.size()) banks.push_back(each.bank);
      consider(stroked(std::move(banks)));
    }
    return refined_parameters(best);
  }

 private:
  /// A choice that was tried.
  struct Tried {
    Bank bank;
    LargestForce best;
    bool refined = false;
  };

  double cost_of_setup() const {
    double cost = static_cast<double>(cost_of(description_.setup));
    for (const Peak& peak : description_.peaks) cost += peak.points * (1.0 + static_cast<double>(cost_of(peak.code)));
    return cost;
  }
  double cost_of_hand() const {
    return 1.0 + static_cast<double>(cost_of(description_.enter) + cost_of(description_.tick));
  }

  /// The number of choices that half of the budget allows.
  std::size_t affordable() const {
    const double each = cost_of_setup() + starts * cost_of_hand();
    return static_cast<std::size_t>(std::clamp(budget / 2 / each, 3.0, static_cast<double>(most_choices)));
  }

  /// The program's defaults, the corners of the parameters' ranges that are likeliest to matter, then random values.
  std::vector<Choice> choices() const {
    const auto within = [](const Interval& range, float value) { return std::clamp(value, range.low, range.high); };
    const auto size_of = [&](float half_width, float half_height, float rim) {
      return PatchSize{2 * within(domain_[Input::patch_half_width], half_width),
                       2 * within(domain_[Input::patch_half_height], half_height),
                       within(domain_[Input::patch_rim], rim)};
    };
    const PatchSize size =
        size_of(0.5f * description_.patch_width, 0.5f * description_.patch_height, description_.patch_rim);
    Choice usual{{}, size};
    for (std::size_t i = 0; i < domain_.parameters.size(); ++i) {
      usual.parameters.push_back(within(domain_.parameters[i], description_.parameters[i].value));
    }
    std::vector<Choice> all = {usual};
    const std::size_t most = affordable();
    const auto add = [&](const Choice& choice) {
      if (all.size() < most) all.push_back(choice);
    };
    Choice low = usual, high = usual;
    for (const std::size_t i : live_) {
      low.parameters[i] = domain_.parameters[i].low;
      high.parameters[i] = domain_.parameters[i].high;
    }
    if (!live_.empty()) add(high), add(low);
    for (const std::size_t i : live_) {
      Choice changed = usual;
      changed.parameters[i] = domain_.parameters[i].high;
      add(changed);
      changed.parameters[i] = domain_.parameters[i].low;
      add(changed);
    }
    if (std::any_of(moving_.begin(), moving_.end(), [](Input input) {
          return input == Input::patch_half_width || input == Input::patch_half_height || input == Input::patch_rim;
        })) {
      constexpr float vast = std::numeric_limits<float>::max();
      add({usual.parameters, size_of(vast, vast, 0)});
      add({usual.parameters, size_of(0.25f * size.width, 0.25f * size.height, 0.1f * size.rim)});
      add({high.parameters, size_of(vast, vast, 0)});
    }
    Dice dice(11);
    while (!live_.empty() && all.size() < most) {
      Choice any = usual;
      for (const std::size_t i : live_) {
        const Interval& range = domain_.parameters[i];
        // Forces are mostly largest at the ends of a range; for others, such as angles, anywhere.
        const double end = dice.next(), share = end < 0.35 ? 0.0 : end < 0.7 ? 1.0 : dice.next();
        any.parameters[i] = within(range, static_cast<float>(range.low + share * (range.high - range.low)));
      }
      all.push_back(any);
    }
    return all;
  }

  /// A hand within the domain: each input is given by a share of 0 .. 1 of its range, or of the part of the range over
  /// the patch.
  template <typename Share>
  Hand hand(const Share& share) const {
    Hand result;
    for (const Input input : moving_) {
      const Interval& range = domain_[input];
      const double at = share(input);
      if (input == Input::time)
        result.time = range.low + at * (std::min<double>(range.high, range.low + longest) - range.low);
      if (input == Input::button) result.button = range.high > 0 && (at >= 0.5 || range.low > 0);
      if (float* value = component(result, input)) {
        *value = std::clamp(static_cast<float>(range.low + at * (static_cast<double>(range.high) - range.low)),
                            range.low, range.high);
      }
    }
    return result;
  }

  std::vector<Hand> starting_hands(PatchSize size) const {
    std::vector<Hand> hands;
    Dice dice(5);
    for (std::size_t i = 0; i < starts; ++i) {
      switch (i % 4) {
        case 0:  // the corners of the envelope
          hands.push_back(hand([&](Input) { return dice.coin() ? 1.0 : 0.0; }));
          break;
        case 1:  // anywhere
          hands.push_back(hand([&](Input) { return dice.next(); }));
          break;
        case 2:  // over the patch, at rest or moving
        default: {
          const double slow = i % 4 == 2 ? 0.0 : 1.0;
          hands.push_back(hand([&](Input input) {
            const Interval& range = domain_[input];
            if (input == Input::x || input == Input::y) {
              const double side = input == Input::x ? size.width : size.height;
              const double place = (dice.next() - 0.5) * side;
              const double width = static_cast<double>(range.high) - range.low;
              return width > 0 ? std::clamp((place - range.low) / width, 0.0, 1.0) : 0.0;
            }
            return input == Input::time || input == Input::button ? dice.next() : 0.5 + slow * (dice.next() - 0.5);
          }));
        }
      }
    }
    return hands;
  }

  bool enough(const LargestForce& found) const { return found.newton >= enough_; }

  static double size_of(const Force& force) {
    return std::sqrt(static_cast<double>(force.x) * force.x + static_cast<double>(force.y) * force.y);
  }

  /// Keeps the hand with the largest force if it exceeds `best`.
  static void look_at(const std::vector<Hand>& hands, const std::vector<Force>& forces, LargestForce& best) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      const double newton = size_of(forces[i]);
      if (newton > best.newton) best.newton = newton, best.hand = hands[i];
    }
  }

  Tried best_of(const Choice& choice) {
    Tried tried{Bank(program_, choice.parameters, choice.size), {0, {}, choice.parameters, choice.size}};
    const std::vector<Hand> hands = starting_hands(choice.size);
    std::vector<Force> forces(hands.size());
    tick_all(tried.bank, hands, forces);
    look_at(hands, forces, tried.best);
    left_ -= cost_of_setup() + starts * cost_of_hand();
    return tried;
  }

  void refine(Tried& tried) {
    if (moving_.empty() || std::exchange(tried.refined, true)) return;
    LargestForce& best = tried.best;
    Dice dice(3);
    Batch batch(tried.bank, neighbours);  // like tick_all, with one block for all steps
    std::vector<Hand> hands;
    std::vector<Force> forces(neighbours);
    double before = 0;
    for (int step = 0; step < passes * steps && !enough(best); ++step) {
      if (step % steps == 0 && std::exchange(before, gaining * best.newton) > best.newton) break;
      const double width = std::ldexp(0.25, -(step % steps));
      hands.clear();
      for (std::size_t i = 0; i < neighbours; ++i) {
        Hand near = best.hand;
        for (const Input input : moving_) {
          const Interval& range = domain_[input];
          const double change = (2 * dice.next() - 1) * width;
          if (i % 2 == 0 && dice.coin()) continue;  // moves along some axes only
          if (input == Input::time) near.time = std::clamp<double>(near.time + change * longest, range.low, range.high);
          if (float* value = component(near, input)) {
            const double wide = static_cast<double>(range.high) - range.low;
            *value = std::clamp(static_cast<float>(*value + change * wide), range.low, range.high);
          }
        }
        hands.push_back(near);
      }
      batch.enter(hands);
      batch.tick(hands, forces);
      look_at(hands, forces, best);
      left_ -= neighbours * cost_of_hand();
    }
  }

  /// Moves the hand from position to position while the program remembers, at steady speeds and in jumps. At each
  /// position one of the banks, all with one patch size, takes over.
  LargestForce stroked(std::vector<Bank> banks) {
    const std::size_t ticks = static_cast<std::size_t>(
        std::clamp<double>(stroking / (strokes * cost_of_hand()), fewest_stroke_ticks, stroke_ticks));
    left_ -= static_cast<double>(strokes * ticks) * single * cost_of_hand();
    const PatchSize size = banks.front().size();
    LargestForce best{0, {}, {}, size, true};
    Dice dice(17);
    for (std::size_t stroke = 0; stroke < strokes; ++stroke) {
      Memory memory(program_);
      std::size_t chosen = 0;
      const bool over_patch = stroke % 2 == 0;
      const auto place = [&] {
        Hand somewhere = hand([&](Input) { return dice.coin() ? dice.next() : dice.coin() ? 1.0 : 0.0; });
        if (over_patch && dice.coin()) {
          somewhere.position = {static_cast<float>(dice.next() - 0.5) * size.width,
                                static_cast<float>(dice.next() - 0.5) * size.height};
        }
        return somewhere;
      };
      Hand from = place(), to = place();
      memory.enter(banks[chosen], from);
      std::size_t leg = 0;
      std::size_t length = 1 + static_cast<std::size_t>(dice.next() * 60);
      double time = 0;
      for (std::size_t i = 0; i < ticks; ++i, time += 1 / description_.device.rate) {
        if (++leg > length) {
          from = to, to = place();
          leg = 1, length = 1 + static_cast<std::size_t>(dice.next() * 60);
          if (banks.size() > 1) chosen = static_cast<std::size_t>(dice.next() * static_cast<double>(banks.size()));
        }
        Bank& bank = banks[chosen];
        const auto share = static_cast<float>(static_cast<double>(leg) / static_cast<double>(length));
        Hand now = to;
        now.position = from.position + share * (to.position - from.position);
        now.workspace = from.workspace + share * (to.workspace - from.workspace);
        now.time = std::clamp<double>(time, domain_[Input::time].low, domain_[Input::time].high);
        const double newton = size_of(tick(bank, memory, now));
        if (newton > best.newton) {
          const auto first = bank.registers().begin() + description_.first_parameter();
          best.newton = newton, best.hand = now;
          best.parameters.assign(first, first + static_cast<std::ptrdiff_t>(description_.parameters.size()));
        }
      }
    }
    return best;
  }

  /// Varies one parameter after the other, at the best hand and around it.
  LargestForce refined_parameters(LargestForce best) {
    if (best.after_a_stroke) return best;
    std::size_t left = most_choices;
    for (double width = 0.5; width > 0.01; width *= 0.5) {
      for (const std::size_t i : live_) {
        for (const double direction : {-1.0, 1.0}) {
          if (left == 0 || left_ <= 0) return best;
          const Interval& range = domain_.parameters[i];
          const double step = direction * width * (static_cast<double>(range.high) - range.low);
          LargestForce other = best;
          other.parameters[i] = std::clamp(static_cast<float>(best.parameters[i] + step), range.low, range.high);
          if (other.parameters[i] == best.parameters[i]) continue;
          --left;
          left_ -= cost_of_setup();
          Tried tried{Bank(program_, other.parameters, other.size), other};
          tried.best.newton = size_of(tick(tried.bank, other.hand));
          refine(tried);
          if (tried.best.newton > best.newton) best = tried.best;
          if (enough(best)) return best;
        }
      }
    }
    return best;
  }

  const Program& program_;
  const PatchProgram& description_;
  const Domain& domain_;
  double enough_;                  ///< N
  std::vector<Input> moving_;      ///< the inputs that the force depends on
  std::vector<std::size_t> live_;  ///< the parameters that the force depends on
  bool remembers_ = false;
  double left_ = budget;
};

}  // namespace

LargestForce largest_force(const Program& program, const ForceSlice& slice, const Domain& domain, double enough) {
  return Search(program, slice, domain, enough).run();
}

}  // namespace wale
