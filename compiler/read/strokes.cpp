#include "compiler/read/strokes.hpp"

#include <algorithm>
#include <functional>
#include <glm/common.hpp>
#include <span>
#include <utility>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/unlimited.hpp"
#include "wale/batch.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

// m/s, speeds of an exploring hand; fewer for programs whose ticks must run one after another
constexpr std::array<double, 10> speeds = {0.005, 0.01, 0.02, 0.035, 0.05, 0.075, 0.1, 0.15, 0.2, 0.4};
constexpr std::array<double, 4> few_speeds = {0.05, 0.1, 0.2, 0.4};
constexpr std::array<double, 7> some_speeds = {0.01, 0.02, 0.035, 0.05, 0.1, 0.2, 0.4};
constexpr double stretch = 0.024;      // m, length of a stroke, which goes there and back
constexpr double least_stretch = 0.5;  // of the patch's extent, if that is smaller
constexpr double looked_at = 0.5;      // of the stretch, in its middle: there a program with memory has settled
constexpr int shortened = 3;           // times by half, what is looked at
constexpr int places = 64;             // of a stroke, for programs without memory
constexpr double least_below = 0.125;  // of the places of a stroke: below the device's limit

}  // namespace

Hand Stroke::hand(double along, bool forth) const {
  Hand hand;
  hand.position = hand.workspace = glm::vec2(middle + along * direction);
  hand.velocity = hand.raw_velocity = glm::vec2((forth ? 1 : -1) * speed * direction);
  return hand;
}

std::pair<double, bool> Stroke::at(long tick, double rate) const {
  const double half = 0.5 * static_cast<double>(pass) * speed / rate;
  const long since = tick + pass / 2;  // as if the stroke had begun at the end of its stretch
  const double gone = (static_cast<double>(since % pass) + 0.5) * speed / rate;
  const bool forth = since / pass % 2 == 0;
  return {forth ? gone - half : half - gone, forth};
}

glm::dvec2 Outside::middle(glm::dvec2 half) const {
  if (!wall) return {0, 0};
  const double face = glm::dot(wall->place, wall->inward), far = glm::dot(glm::abs(wall->inward), half);
  return std::clamp(0.5 * (face - far), -far, 0.0) * wall->inward;
}

glm::dvec2 half_of(const Bank& bank) {
  const PatchSize patch = bank.size();
  return 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
}

double reach_within(glm::dvec2 half, glm::dvec2 place, glm::dvec2 direction) {
  const glm::dvec2 left = (half - glm::abs(place)) / glm::max(glm::abs(direction), glm::dvec2(1e-9));
  return std::max(0.0, std::min(left.x, left.y));
}

std::vector<Stroke> strokes_over(const Bank& bank, glm::dvec2 axis, const Outside& outside, const Room& space,
                                 double settling, bool slowly) {
  const PatchProgram& program = bank.program().description();
  const bool alone = !remembers_anything(program);
  const std::span<const double> gone_at = alone ? std::span<const double>(speeds)
                                          : slowly ? std::span<const double>(some_speeds)
                                                   : std::span<const double>(few_speeds);
  const glm::dvec2 half = half_of(bank), middle = outside.middle(half);
  const double rate = program.device.rate, usual = std::min(stretch / 2, least_stretch * std::min(half.x, half.y));
  std::vector<Stroke> strokes;
  for (const glm::dvec2 direction : {axis, glm::dvec2(-axis.y, axis.x)}) {
    std::vector<glm::dvec2> taken;
    for (int line = 0; line < stroke_lines; ++line) {
      const glm::dvec2 across = glm::abs(glm::dvec2(direction.y, direction.x));
      const double room = glm::dot(half, across) / (across.x + across.y);
      const glm::dvec2 aside = room * ((line + 0.5) / (0.5 * stroke_lines) - 1) * glm::dvec2(-direction.y, direction.x);
      const glm::dvec2 wanted = outside.wall ? middle + 0.5 * aside : aside;
      // Between the steep sides of a valley there may be room for a short stroke only.
      double counts = looked_at * usual;
      glm::dvec2 place = space.nearest({wanted, direction, counts, counts}, taken);
      for (int turn = 0; turn < shortened && !space.is_along({place, direction, counts, counts}); ++turn)
        counts *= 0.5, place = space.nearest({wanted, direction, counts, counts}, taken);
      taken.push_back(place);
      const double reach = std::max(usual, std::min(counts + settling, reach_within(half, place, direction)));
      for (const double speed : gone_at)
        strokes.push_back({direction, place, speed, 2 * std::max(2L, std::lround(reach / speed * rate)), counts});
    }
  }
  return strokes;
}

std::vector<Stroke> slow_strokes(const Bank& bank, const std::vector<Stroke>& strokes) {
  const double rate = bank.program().description().device.rate;
  std::vector<Stroke> slow;
  for (const std::size_t first : {std::size_t{0}, strokes.size() / 2}) {
    Stroke stroke = strokes[first];
    const double reach = 0.5 * static_cast<double>(stroke.pass) * stroke.speed / rate;
    stroke.speed = slow_stroke_speed, stroke.pass = 2 * std::lround(reach / slow_stroke_speed * rate);
    slow.push_back(stroke);
  }
  return slow;
}

namespace {

/// Gives strokes where the device's limit cuts everything off the mean of the others at their speed and along their
/// axis, if there are any.
void tell_cut_strokes(const std::vector<Stroke>& strokes, const std::vector<bool>& cut,
                      std::vector<glm::dvec2>& means) {
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (!cut[i]) continue;
    glm::dvec2 sum{0};
    double others = 0;
    for (std::size_t k = 0; k < strokes.size(); ++k)
      if (!cut[k] && strokes[k].speed == strokes[i].speed && strokes[k].direction == strokes[i].direction)
        sum += means[k], others += 1;
    if (others > 0) means[i] = sum / others;
  }
}

/// The mean force on each stroke for a program whose ticks are independent. Both ways are at the same moment, so that
/// forces that depend on time cancel too. Places where the device's limit cuts a force off say nothing
/// about its law, unless there are hardly any others.
std::vector<glm::dvec2> opposed_anywhere(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside) {
  std::vector<Hand> hands;
  hands.reserve(strokes.size() * 2 * places);
  for (const Stroke& stroke : strokes)
    for (const bool forth : {true, false})
      for (int i = 0; i < places; ++i)
        hands.push_back(stroke.hand(stroke.counts * (2 * (i + 0.5) / places - 1), forth));
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  const double most = bank.program().description().device.most();
  std::vector<glm::dvec2> means(strokes.size());
  std::vector<bool> cut(strokes.size());
  for (std::size_t stroke = 0; stroke < strokes.size(); ++stroke) {
    const Force *there = &forces[2 * places * stroke], *back = there + places;
    glm::dvec2 whole{0}, below{0};
    int count = 0;
    for (int i = 0; i < places; ++i) {
      // The places of both passes are the same, in the same order.
      const glm::dvec2 change = 0.5 * (glm::dvec2(back[i]) - glm::dvec2(there[i]));
      whole += change;
      if (at_limit(there[i], most) || at_limit(back[i], most)) continue;
      if (!outside.at(glm::dvec2(hands[2 * places * stroke + i].position))) continue;
      below += change, ++count;
    }
    cut[stroke] = count < least_below * places;
    means[stroke] = count == places || cut[stroke] ? whole / (1.0 * places) : below / (1.0 * count);
  }
  tell_cut_strokes(strokes, cut, means);
  return means;
}

/// For each stroke, the force on a hand that rests in its middle, tick by tick: what changes with time is felt there
/// too. One tick alone where nothing changes; what goes by time may begin to later.
std::vector<std::vector<Force>> felt_in_the_middles(const Bank& bank, const std::vector<Stroke>& strokes,
                                                    long at_least = 0) {
  constexpr std::size_t some = 64;
  const double rate = bank.program().description().device.rate;
  const auto longest =
      static_cast<std::size_t>(std::max(at_least, std::ranges::max(strokes, {}, &Stroke::ticks).ticks()));
  // Strokes side by side share their middles.
  std::vector<Hand> hands;
  std::vector<std::size_t> hand_of(strokes.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (i == 0 || strokes[i].middle != strokes[i - 1].middle) {
      Hand& hand = hands.emplace_back();
      hand.position = hand.workspace = glm::vec2(strokes[i].middle);
    }
    hand_of[i] = hands.size() - 1;
  }
  const bool timed = goes_by_time(bank.program().description());
  std::vector<std::vector<Force>> felt(hands.size());
  std::vector<char> is_even(hands.size());
  std::vector<Force> forces(hands.size());
  Batch batch(bank, hands.size());
  batch.enter(hands);
  for (std::size_t now = 0; now < longest; ++now) {
    for (Hand& hand : hands) hand.time = static_cast<double>(now) / rate;
    batch.tick(hands, forces);
    for (std::size_t i = 0; i < hands.size(); ++i)
      if (!is_even[i]) felt[i].push_back(forces[i]);
    if (timed || now + 1 != some) continue;
    for (std::size_t i = 0; i < hands.size(); ++i) {
      is_even[i] = std::ranges::all_of(felt[i], [&](Force each) { return each == felt[i].back(); });
      if (is_even[i]) felt[i].resize(1);
    }
    if (std::ranges::all_of(is_even, [](char each) { return each != 0; })) break;
  }
  std::vector<std::vector<Force>> of_strokes;
  for (const std::size_t hand : hand_of) of_strokes.push_back(felt[hand]);
  return of_strokes;
}

/// The same for a program that remembers in states only, tick by tick, with all hands side by side.
std::vector<glm::dvec2> opposed_side_by_side(const Bank& bank, const std::vector<Stroke>& strokes,
                                             const Outside& outside, double seconds) {
  const double rate = bank.program().description().device.rate;
  const auto at_least = static_cast<long>(seconds * rate);
  const std::vector<std::vector<Force>> resting = felt_in_the_middles(bank, strokes, at_least);
  const auto ends = [&](const Stroke& stroke) { return std::max(at_least, stroke.ticks()); };
  // The longest first, so that those that go on are the first lanes.
  std::vector<std::size_t> order(strokes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return ends(strokes[i]); });
  std::vector<Hand> hands(strokes.size());
  std::vector<Force> forces(strokes.size());
  std::vector<glm::dvec2> sums(strokes.size());
  std::vector<long> counts(strokes.size());
  std::vector<std::pair<double, bool>> at(strokes.size());
  Batch batch(bank, strokes.size());
  std::size_t going = strokes.size();
  for (long now = 0;; ++now) {
    while (going > 0 && now >= ends(strokes[order[going - 1]])) --going;
    if (going == 0) break;
    for (std::size_t lane = 0; lane < going; ++lane) {
      const Stroke& stroke = strokes[order[lane]];
      at[lane] = stroke.at(now, rate);
      hands[lane] = stroke.hand(at[lane].first, at[lane].second);
      hands[lane].time = static_cast<double>(now) / rate;
    }
    if (now == 0) batch.enter(hands);
    batch.tick(std::span(hands).first(going), std::span(forces).first(going));
    for (std::size_t lane = 0; lane < going; ++lane) {
      const std::size_t i = order[lane];
      const auto [along, forth] = at[lane];
      if (now < strokes[i].pass / 2 || !strokes[i].counts_at(along) || !outside.at(glm::dvec2(hands[lane].position)))
        continue;
      const Force force = forces[lane] - resting[i][std::min<std::size_t>(now, resting[i].size() - 1)];
      sums[i] -= (forth ? 1.0 : -1.0) * glm::dvec2(force);
      ++counts[i];
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= static_cast<double>(std::max(1L, counts[i]));
  return sums;
}

/// The same for any program; memories stay as they are at the start.
std::vector<glm::dvec2> opposed_on_the_way(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside,
                                           double seconds) {
  if (bank.program().description().grids.empty()) return opposed_side_by_side(bank, strokes, outside, seconds);
  const double rate = bank.program().description().device.rate;
  const long longest = std::ranges::max(strokes, {}, &Stroke::ticks).ticks();
  std::vector<glm::dvec2> sums(strokes.size());
  std::vector<long> counts(strokes.size());
  const auto move = [&](std::size_t first, long tick, std::span<const Force> forces, std::span<Hand> hands) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      const Stroke& stroke = strokes[first + i];
      const bool counts_now = tick > stroke.pass / 2 && tick <= stroke.ticks();
      if (counts_now && stroke.counts_at(stroke.at(tick - 1, rate).first) &&
          outside.at(glm::dvec2(hands[i].position))) {
        sums[first + i] -= (stroke.at(tick - 1, rate).second ? 1.0 : -1.0) * glm::dvec2(forces[i]);
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

/// A hand on a stroke, and what hands feel that rest where it goes.
struct WalkedStroke {
  std::vector<glm::dvec2> moving;  ///< N, at each tick that counts; what rests in the middle feels then is taken off
  std::vector<bool> forth;         ///< whether the hand goes forth then
  std::vector<Force> still;        ///< N, two for each such tick: of hands that have just come, there and in the middle
};

/// `own` and `memory` are those of `bank`'s program, and `resting` what a hand in the stroke's middle feels.
WalkedStroke walked(const Bank& bank, Bank& own, Memory& memory, const Stroke& stroke, std::span<const Force> resting,
                    const Outside& outside) {
  const double rate = bank.program().description().device.rate;
  WalkedStroke found;
  std::vector<Hand> fresh;
  for (long now = 0; now < stroke.ticks(); ++now) {
    const auto [along, forth] = stroke.at(now, rate);
    Hand hand = stroke.hand(along, forth);
    hand.time = static_cast<double>(now) / rate;
    if (now == 0) memory.enter(own, hand);
    const Force force = tick(own, memory, hand) - resting[std::min<std::size_t>(now, resting.size() - 1)];
    if (now < stroke.pass / 2 || !stroke.counts_at(along) || !outside.at(glm::dvec2(hand.position))) continue;
    found.moving.emplace_back(force), found.forth.push_back(forth);
    for (const double at : {along, 0.0}) fresh.push_back(stroke.hand(at, forth)), fresh.back().time = hand.time;
  }
  for (Hand& hand : fresh) hand.velocity = hand.raw_velocity = glm::vec2(0);
  found.still.resize(fresh.size());
  if (!fresh.empty()) tick_all(bank, fresh, found.still);
  return found;
}

}  // namespace

std::vector<glm::dvec2> opposed_on(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside,
                                   double seconds) {
  return remembers_anything(bank.program().description()) ? opposed_on_the_way(bank, strokes, outside, seconds)
                                                          : opposed_anywhere(bank, strokes, outside);
}

Steadiness steadiness_of(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside) {
  // The second line of each axis.
  std::vector<Stroke> some;
  const std::size_t half = strokes.size() / 2, a_line = half / stroke_lines;
  for (const std::size_t first : {a_line, half + a_line})
    some.insert(some.end(), strokes.begin() + static_cast<std::ptrdiff_t>(first),
                strokes.begin() + static_cast<std::ptrdiff_t>(first + a_line));
  Bank own = bank;
  Memory memory(own.program());
  const std::vector<std::vector<Force>> resting = felt_in_the_middles(bank, some);
  Steadiness found;
  for (std::size_t i = 0; i < some.size(); ++i) {
    const WalkedStroke felt = walked(bank, own, memory, some[i], resting[i], outside);
    if (felt.moving.empty()) continue;
    double sum = 0, squares = 0;
    for (std::size_t k = 0; k < felt.moving.size(); ++k) {
      const glm::dvec2 by_motion = felt.moving[k] - glm::dvec2(felt.still[2 * k] - felt.still[2 * k + 1]);
      const double against = (felt.forth[k] ? -1 : 1) * glm::dot(by_motion, some[i].direction);
      sum += against, squares += against * against;
    }
    const auto count = static_cast<double>(felt.moving.size());
    found.mean += sum / count * sum / count, found.beside += squares / count - sum / count * sum / count;
  }
  return found;
}

std::vector<glm::dvec2> pushed_either_way(const Bank& bank, const std::vector<Stroke>& strokes,
                                          const Outside& outside) {
  Bank own = bank;
  Memory memory(own.program());
  const std::vector<std::vector<Force>> resting = felt_in_the_middles(bank, strokes);
  std::vector<glm::dvec2> means(strokes.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const WalkedStroke felt = walked(bank, own, memory, strokes[i], resting[i], outside);
    std::array<glm::dvec2, 2> sums{};
    std::array<long, 2> counts{};
    glm::dvec2 by_place{0};
    for (std::size_t k = 0; k < felt.moving.size(); ++k) {
      sums[felt.forth[k]] += felt.moving[k], ++counts[felt.forth[k]];
      by_place += glm::dvec2(felt.still[2 * k] - felt.still[2 * k + 1]);
    }
    if (counts[0] == 0 || counts[1] == 0) continue;
    means[i] = 0.5 * (sums[0] / static_cast<double>(counts[0]) + sums[1] / static_cast<double>(counts[1])) -
               by_place / static_cast<double>(counts[0] + counts[1]);
  }
  return means;
}

}  // namespace wale
