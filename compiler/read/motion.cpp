#include "compiler/read/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/fourier.hpp"
#include "compiler/read/window_spectrum.hpp"
#include "wale/batch.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

// m/s, speeds of an exploring hand; fewer for programs whose ticks must run one after another
constexpr std::array<double, 8> speeds = {0.02, 0.035, 0.05, 0.075, 0.1, 0.15, 0.2, 0.4};
constexpr std::array<double, 4> few_speeds = {0.05, 0.1, 0.2, 0.4};
constexpr double stretch = 0.024;      // m, length of a stroke, which goes there and back
constexpr double least_stretch = 0.5;  // of the patch's extent, if that is smaller
constexpr double looked_at = 0.5;      // of the stretch, in its middle: there a program with memory has settled
constexpr int lines = 4;               // parallel strokes
constexpr int places = 64;             // of a stroke, for programs without memory
constexpr double push = 1;             // m/s^2
constexpr std::size_t still_places = 8;
constexpr double still_seconds = 8;
constexpr std::size_t fewest_swings = 3;  // over that time; slower changes are a drift
constexpr std::size_t most_harmonic = 8;
constexpr double of_the_strongest = 0.2;  // line's power, in a fundamental
constexpr double stands_out = 0.25;       // of a peak's power, at most this is three lines before it
constexpr double nothing = 1e-5;          // N

/// A stroke goes over half of its stretch, back over the whole, and forward over the whole. The first half settles a
/// program with memory. The middles of the other two are evaluated: they pass the same positions, so that forces that
/// depend on position cancel.
struct Stroke {
  glm::dvec2 direction{0}, middle{0};
  double speed = 0;
  long pass = 0;  // ticks, an even number

  long ticks() const { return pass / 2 + 2 * pass; }

  /// A hand at `along` (m from the middle of the stroke), moving there or back.
  Hand hand(double along, bool forth) const {
    Hand hand;
    hand.position = hand.workspace = glm::vec2(middle + along * direction);
    hand.velocity = hand.raw_velocity = glm::vec2((forth ? 1 : -1) * speed * direction);
    return hand;
  }

  /// The distance from the middle in m at a tick, and whether the hand moves there or back.
  std::pair<double, bool> at(long tick, double rate) const {
    const double half = 0.5 * static_cast<double>(pass) * speed / rate;
    const long since = tick + pass / 2;  // as if the stroke had begun at the end of its stretch
    const double gone = (static_cast<double>(since % pass) + 0.5) * speed / rate;
    const bool forth = since / pass % 2 == 0;
    return {forth ? gone - half : half - gone, forth};
  }
};

/// Half the extent of the patch without its rim, m.
glm::dvec2 half_of(const Bank& bank) {
  const PatchSize patch = bank.size();
  return 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
}

/// m on either side of the middle of a stroke.
double reach_of(const Bank& bank) {
  const glm::dvec2 half = half_of(bank);
  return std::min(stretch / 2, least_stretch * std::min(half.x, half.y));
}

std::vector<Stroke> strokes_over(const Bank& bank, bool alone) {
  const double rate = bank.program().description().device.rate;
  std::vector<Stroke> strokes;
  for (const glm::dvec2 direction : {glm::dvec2(1, 0), glm::dvec2(0, 1)})
    for (int line = 0; line < lines; ++line)
      for (const double speed : alone ? std::span<const double>(speeds) : std::span<const double>(few_speeds)) {
        const glm::dvec2 aside =
            half_of(bank) * ((line + 0.5) / (0.5 * lines) - 1) * glm::dvec2(direction.y, direction.x);
        strokes.push_back({direction, aside, speed, 2 * std::max(2L, std::lround(reach_of(bank) / speed * rate))});
      }
  return strokes;
}

/// The mean force against each stroke, N, for a program whose ticks are independent. Both ways are at the same moment,
/// so that forces that depend on time cancel too.
std::vector<double> opposed_anywhere(const Bank& bank, const std::vector<Stroke>& strokes) {
  std::vector<Hand> hands;
  hands.reserve(strokes.size() * 2 * places);
  for (const Stroke& stroke : strokes)
    for (const bool forth : {true, false})
      for (int i = 0; i < places; ++i)
        hands.push_back(stroke.hand(looked_at * reach_of(bank) * (2 * (i + 0.5) / places - 1), forth));
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  std::vector<double> means(strokes.size());
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const std::size_t stroke = i / (2 * places);
    means[stroke] -=
        glm::dot(glm::dvec2(forces[i]), glm::dvec2(hands[i].velocity)) / strokes[stroke].speed / (2 * places);
  }
  return means;
}

/// For each stroke, the force on a hand that rests in its middle, tick by tick: what changes with time is felt there
/// too. One tick alone where nothing changes.
std::vector<std::vector<Force>> felt_in_the_middles(const Bank& bank, const std::vector<Stroke>& strokes) {
  constexpr std::size_t some = 64;
  const double rate = bank.program().description().device.rate;
  const auto longest = static_cast<std::size_t>(std::ranges::max(strokes, {}, &Stroke::ticks).ticks());
  Bank own = bank;
  Memory memory(own.program());
  std::vector<std::vector<Force>> felt(strokes.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (i > 0 && strokes[i].middle == strokes[i - 1].middle) {
      felt[i] = felt[i - 1];
      continue;
    }
    Hand still;
    still.position = still.workspace = glm::vec2(strokes[i].middle);
    memory.enter(own, still);
    for (std::size_t now = 0; now < longest; ++now) {
      still.time = static_cast<double>(now) / rate;
      felt[i].push_back(tick(own, memory, still));
      if (now + 1 != some || std::ranges::any_of(felt[i], [&](Force each) { return each != felt[i].back(); })) continue;
      felt[i].resize(1);
      break;
    }
  }
  return felt;
}

/// The same for a program that remembers in states only, tick by tick. The hands run one after another: there are too
/// few to fill the lanes of a block.
std::vector<double> opposed_one_by_one(const Bank& bank, const std::vector<Stroke>& strokes) {
  const double rate = bank.program().description().device.rate, middle = looked_at * reach_of(bank);
  Bank own = bank;
  Memory memory(own.program());
  const std::vector<std::vector<Force>> resting = felt_in_the_middles(bank, strokes);
  std::vector<double> means(strokes.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const Stroke& stroke = strokes[i];
    double sum = 0;
    long count = 0;
    for (long now = 0; now < stroke.ticks(); ++now) {
      const auto [along, forth] = stroke.at(now, rate);
      Hand hand = stroke.hand(along, forth);
      hand.time = static_cast<double>(now) / rate;
      if (now == 0) memory.enter(own, hand);
      const Force force = tick(own, memory, hand) - resting[i][std::min<std::size_t>(now, resting[i].size() - 1)];
      if (now < stroke.pass / 2 || std::abs(along) > middle) continue;
      sum -= glm::dot(glm::dvec2(force), glm::dvec2(hand.velocity)) / stroke.speed;
      ++count;
    }
    means[i] = sum / static_cast<double>(std::max(1L, count));
  }
  return means;
}

/// The same for any program; memories stay as they are at the start.
std::vector<double> opposed_on_the_way(const Bank& bank, const std::vector<Stroke>& strokes) {
  if (bank.program().description().grids.empty()) return opposed_one_by_one(bank, strokes);
  const double rate = bank.program().description().device.rate, middle = looked_at * reach_of(bank);
  const long longest = std::ranges::max(strokes, {}, &Stroke::ticks).ticks();
  std::vector<double> sums(strokes.size());
  std::vector<long> counts(strokes.size());
  const auto move = [&](std::size_t first, long tick, std::span<const Force> forces, std::span<Hand> hands) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      const Stroke& stroke = strokes[first + i];
      const bool counts_now = tick > stroke.pass / 2 && tick <= stroke.ticks();
      if (counts_now && std::abs(stroke.at(tick - 1, rate).first) <= middle) {
        sums[first + i] -= glm::dot(glm::dvec2(forces[i]), glm::dvec2(hands[i].velocity)) / stroke.speed;
        ++counts[first + i];
      }
      const auto [along, forth] = stroke.at(tick, rate);
      hands[i] = stroke.hand(along, forth);
      hands[i].time = static_cast<double>(tick) / rate;
    }
  };
  run_batch(bank, strokes.size(), longest, move);
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= static_cast<double>(std::max(1L, counts[i]));
  return sums;
}

/// The forces on hands that hold still at a few positions, for each tick; empty if they cannot change.
std::vector<std::vector<Force>> felt_at_rest(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const bool timed = reads(program, {Input::time});
  std::vector<std::vector<Force>> felt;
  if (!timed && program.states.empty()) return felt;
  const double rate = program.device.rate;
  const auto ticks = static_cast<std::size_t>(std::lround(still_seconds * rate));
  std::vector<Hand> hands(still_places);
  for (std::size_t i = 0; i < still_places; ++i) {
    // On a spiral, so that no two positions have the same distance or angle.
    const auto number = static_cast<double>(i);
    const double radius = 0.8 * number / still_places, angle = number * std::numbers::pi * (3 - std::sqrt(5.0));
    hands[i].position = hands[i].workspace =
        glm::vec2(half_of(bank) * radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  felt.assign(still_places, std::vector<Force>(ticks));
  if (program.states.empty()) {
    for (std::size_t i = 0; i < still_places; ++i) {
      std::vector<Hand> moments(ticks, hands[i]);
      for (std::size_t tick = 0; tick < ticks; ++tick) moments[tick].time = static_cast<double>(tick) / rate;
      tick_all(bank, moments, felt[i]);
    }
    return felt;
  }
  Batch batch(bank, still_places);
  batch.enter(hands);
  std::vector<Force> forces(still_places);
  const std::size_t all = program.states.size() * still_places;
  std::vector<float> before(all), now(all);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    for (Hand& hand : hands) hand.time = static_cast<double>(tick) / rate;
    batch.tick(hands, forces);
    for (std::size_t i = 0; i < still_places; ++i) felt[i][tick] = forces[i];
    for (std::size_t i = 0; i < all; ++i) now[i] = batch.state(i / still_places, i % still_places);
    // Without a clock, a force that does not change in one tick never changes.
    if (!timed && tick > 0 && now == before) {
      for (auto& each : felt) each.assign(ticks, each[tick]);
      break;
    }
    before.swap(now);
  }
  return felt;
}

/// The laws of friction that are tried, simplest first: which of friction and damping there is, and whether the
/// friction rises with the speed until it is whole.
struct FrictionLaw {
  bool friction, damping, rises;
};
constexpr std::array<FrictionLaw, 5> laws = {
    {{false, true, false}, {true, false, false}, {true, true, false}, {true, false, true}, {true, true, true}}};
constexpr double well_fitted = 0.02;  // of the largest force: a law that leaves less is good enough
constexpr int rises_tried = 60;

/// One law by least squares, with a friction that is whole from the speed `whole` on.
OpposingForce fitted(const FrictionLaw& law, double whole, const std::vector<Stroke>& strokes,
                     const std::vector<double>& opposed) {
  double ss = 0, sv = 0, vv = 0, sf = 0, vf = 0;
  const auto share = [&](double speed) { return !law.friction ? 0.0 : whole > 0 ? std::min(1.0, speed / whole) : 1.0; };
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double v = law.damping ? strokes[i].speed : 0, s = share(strokes[i].speed), f = opposed[i];
    ss += s * s, sv += s * v, vv += v * v, sf += s * f, vf += v * f;
  }
  OpposingForce found;
  const double area = ss * vv - sv * sv;
  if (law.friction && law.damping) {
    if (area < 1e-6 * ss * vv) return {0, 0, 0, HUGE_VAL};
    found.friction = (vv * sf - sv * vf) / area, found.damping = (ss * vf - sv * sf) / area;
  } else if (law.friction) {
    found.friction = sf / ss;
  } else {
    found.damping = vf / vv;
  }
  found.saturation_speed = law.rises ? whole : 0;
  double squares = 0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double v = strokes[i].speed, off = opposed[i] - found.friction * share(v) - found.damping * v;
    squares += off * off;
  }
  found.scatter = std::sqrt(squares / static_cast<double>(strokes.size()));
  return found;
}

/// The simplest law that fits the strokes, or the one that fits best.
OpposingForce law_of(const std::vector<Stroke>& strokes, const std::vector<double>& opposed) {
  double largest = 0;
  for (const double force : opposed) largest = std::max(largest, std::abs(force));
  if (largest < nothing) return {};
  OpposingForce best{0, 0, 0, HUGE_VAL};
  for (const FrictionLaw& law : laws) {
    OpposingForce found{0, 0, 0, HUGE_VAL};
    const double fastest = strokes.back().speed, slowest = strokes.front().speed;
    for (int i = 0; i < (law.rises ? rises_tried : 1); ++i) {
      const double whole = law.rises ? slowest * std::pow(fastest / slowest, (i + 0.5) / rises_tried) : 0;
      const OpposingForce other = fitted(law, whole, strokes, opposed);
      if (other.scatter < found.scatter) found = other;
    }
    if (found.scatter < 0.7 * best.scatter) best = found;
    if (best.scatter < well_fitted * largest) break;
  }
  return best;
}

/// Forces as changes, without their mean and their drift: a parabola in time.
std::vector<std::complex<float>> without_drift(const std::vector<Force>& forces) {
  const auto count = static_cast<double>(forces.size());
  // Legendre's polynomials are nearly orthogonal on so many ticks.
  const auto at = [&](std::size_t i, int order) {
    const double u = 2 * (static_cast<double>(i) + 0.5) / count - 1;
    return order == 0 ? 1.0 : order == 1 ? u : 1.5 * u * u - 0.5;
  };
  glm::dvec2 parts[3] = {};
  for (std::size_t i = 0; i < forces.size(); ++i)
    for (int order : {0, 1, 2}) parts[order] += (2 * order + 1) / count * at(i, order) * glm::dvec2(forces[i]);
  std::vector<std::complex<float>> changes(forces.size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    glm::dvec2 left(forces[i]);
    for (int order : {0, 1, 2}) left -= at(i, order) * parts[order];
    changes[i] = {static_cast<float>(left.x), static_cast<float>(left.y)};
  }
  return changes;
}

/// The swing within some lines of a power spectrum; none if its strongest line does not stand out, as those of a drift.
Swing swing_in(const std::vector<double>& powers, std::size_t first, std::size_t end, double seconds) {
  if (first >= end) return {};
  const auto peak = std::max_element(powers.begin() + static_cast<std::ptrdiff_t>(first),
                                     powers.begin() + static_cast<std::ptrdiff_t>(end));
  auto at = static_cast<std::size_t>(peak - powers.begin());
  // A beat's strongest line may be a harmonic. Its fundamental is the slowest of the lines below of which it is a
  // multiple.
  for (std::size_t times = most_harmonic; times >= 2; --times) {
    const std::size_t slow = (at + times / 2) / times;
    if (slow < first + 1) continue;
    const auto line = std::max_element(powers.begin() + static_cast<std::ptrdiff_t>(slow - 1),
                                       powers.begin() + static_cast<std::ptrdiff_t>(slow + 2));
    if (*line < of_the_strongest * *peak) continue;
    at = static_cast<std::size_t>(line - powers.begin());
    break;
  }
  double sum = 0;
  for (std::size_t i = first; i < end; ++i) sum += powers[i];
  const double before = at > 0 ? powers[at - 1] : 0, after = at + 1 < powers.size() ? powers[at + 1] : 0;
  const double slower = at >= 3 ? powers[at - 3] : HUGE_VAL;
  // A neighbour in a slower band may be the foot of a stronger peak there.
  if (powers[at] <= 0 || slower > stands_out * powers[at] || before > powers[at] || after > powers[at]) return {};
  // Under Hann's window, let r be the ratio in amplitude of the larger neighbour to the strongest line. The swing then
  // lies (2 r - 1) / (1 + r) lines further on: Grandke 1983, IEEE Trans. Instrum. Meas. 32(2).
  const double ratio = std::sqrt(std::max(before, after) / powers[at]);
  const double off = std::clamp((2 * ratio - 1) / (1 + ratio), 0.0, 0.5) * (after > before ? 1 : -1);
  return {std::sqrt(2 * sum), (static_cast<double>(at) + off) / seconds};
}

}  // namespace

OpposingForce opposing_force(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  if (!depends_on_the_moment(program) && !remembers_anything(program)) return {};
  const bool alone = !remembers_anything(program);
  const std::vector<Stroke> strokes = strokes_over(bank, alone);
  return law_of(strokes, alone ? opposed_anywhere(bank, strokes) : opposed_on_the_way(bank, strokes));
}

double inertia(const Bank& bank) {
  if (!reads(bank.program().description(),
             {Input::acceleration_x, Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y}))
    return 0;
  const glm::dvec2 half = half_of(bank);
  std::vector<Hand> hands;
  constexpr int side = 8;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      for (const glm::dvec2 direction : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
        Hand& hand = hands.emplace_back();
        hand.position = hand.workspace = glm::vec2(half * ((glm::dvec2(column, row) + 0.5) / (0.5 * side) - 1.0));
        hand.acceleration = hand.raw_acceleration = glm::vec2(push * direction);
      }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  double sum = 0;
  for (std::size_t i = 0; i < hands.size(); ++i)
    sum -= glm::dot(glm::dvec2(forces[i]), glm::dvec2(hands[i].acceleration));
  return sum / (push * push * static_cast<double>(hands.size()));
}

void tell_swings(const Bank& bank, Swing& sway, Swing& vibration) {
  std::vector<std::complex<float>> busiest;
  double most = 0;
  for (const std::vector<Force>& forces : felt_at_rest(bank)) {
    const std::vector<std::complex<float>> changes = without_drift(forces);
    double squares = 0;
    for (const auto& each : changes) squares += std::norm(each);
    if (squares > most) most = squares, busiest = changes;
  }
  const auto ticks = static_cast<double>(busiest.size());
  if (busiest.empty() || std::sqrt(2 * most / ticks) <= nothing) return;
  const double rate = bank.program().description().device.rate, seconds = ticks / rate;
  const std::vector<float> fade = hann_window(busiest.size());
  for (std::size_t i = 0; i < busiest.size(); ++i) busiest[i] *= fade[i];
  const Spectrum spectrum = fourier_of_line(busiest);
  // The transform of x + i y holds one of theirs in a coefficient and the other in its mirror image. Hann's window lets
  // three eighths of the power through.
  std::vector<double> powers(spectrum.size() / 2, 0.0);
  for (std::size_t i = 1; i < powers.size(); ++i)
    powers[i] = (std::norm(spectrum[i]) + std::norm(spectrum[spectrum.size() - i])) / (0.375 * ticks * ticks);
  const auto first_fast = static_cast<std::size_t>(slowest_vibration * seconds);
  sway = swing_in(powers, fewest_swings, first_fast, seconds);
  vibration = swing_in(powers, first_fast, powers.size(), seconds);
  // The harmonics of a sway count with it.
  const double times = sway.frequency > 0 ? vibration.frequency / sway.frequency : 0;
  if (times > 0 && vibration.amplitude < 0.5 * sway.amplitude && std::abs(times - std::round(times)) < 0.05)
    sway.amplitude = std::hypot(sway.amplitude, vibration.amplitude), vibration = {};
}

}  // namespace wale
