#include "calibration/experiment/trial_order.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace wale {
namespace {

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;

}  // namespace

Draws::Draws(std::uint32_t seed, std::uint32_t purpose)
    : key_(mixed((std::uint64_t{purpose} << 32 | seed) + golden)) {}

std::uint64_t Draws::bits(std::uint64_t number) const { return mixed(key_ ^ mixed(number * golden + golden)); }

double Draws::uniform(std::uint64_t number) const {
  return static_cast<double>(bits(number) >> 11) * 0x1p-53;
}

double Draws::normal(std::uint64_t number) const {
  const double radius = std::sqrt(-2 * std::log(1 - uniform(2 * number)));
  return radius * std::cos(2 * std::numbers::pi * uniform(2 * number + 1));
}

std::vector<std::size_t> Draws::order(std::size_t count, std::uint64_t number) const {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) {
    // Of 2^64 values the remainder favours none by more than one in 2^50 here.
    const std::uint64_t drawn = bits(number << 32 | i);
    std::swap(order[i - 1], order[static_cast<std::size_t>(drawn % i)]);
  }
  return order;
}

bool is_adaptive(const CheckedExperiment& experiment) {
  return experiment.method != TrialMethod::constant_stimuli && experiment.over.has_value();
}

Trial trial_about(const CheckedExperiment& experiment, std::uint32_t seed, std::size_t stimulus, std::uint32_t number,
                  std::uint32_t block) {
  Trial trial{number, block, stimulus, {{false, stimulus}}, 0};
  const auto standard = experiment.stimuli[stimulus].standard;
  if (!standard) return trial;
  const Presented target{false, stimulus}, other{true, *standard};
  const bool first = Draws(seed, static_cast<std::uint32_t>(Drawn::interval)).bits(number) >> 63 != 0;
  const bool is_catch =
      Draws(seed, static_cast<std::uint32_t>(Drawn::catch_trial)).uniform(number) < experiment.catches;
  switch (experiment.task) {
    case TrialTask::two_interval:
      trial.intervals = first ? std::vector{target, other} : std::vector{other, target};
      trial.target = first ? 1 : 2;
      break;
    case TrialTask::one_interval:
      trial.intervals = {is_catch ? other : target};
      trial.target = is_catch ? 0 : 1;
      break;
    case TrialTask::same_different:
      if (is_catch) trial.intervals = first ? std::vector{target, target} : std::vector{other, other};
      else trial.intervals = first ? std::vector{target, other} : std::vector{other, target};
      trial.target = is_catch ? 0 : 1;
      break;
    case TrialTask::adjustment: trial.intervals = {other, target}; break;
    default: break;
  }
  return trial;
}

std::vector<std::vector<std::size_t>> tracks_of(const CheckedExperiment& experiment) {
  std::vector<std::vector<std::size_t>> tracks;
  if (!experiment.over) return tracks;
  const auto rest = [&](std::size_t stimulus) {
    auto levels = experiment.stimuli[stimulus].levels;
    levels[*experiment.over].reset();
    return levels;
  };
  for (std::size_t i = 0; i < experiment.stimuli.size(); ++i) {
    // Stimuli of one `stimulus` statement share its place in the text.
    const auto same = std::ranges::find_if(tracks, [&](const auto& track) {
      return experiment.stimuli[track.front()].span == experiment.stimuli[i].span && rest(track.front()) == rest(i);
    });
    if (same == tracks.end()) tracks.push_back({i});
    else same->push_back(i);
  }
  for (auto& track : tracks)
    std::ranges::sort(track, {}, [&](std::size_t each) { return *experiment.stimuli[each].levels[*experiment.over]; });
  return tracks;
}

std::vector<Trial> trial_order(const CheckedExperiment& experiment, std::uint32_t seed) {
  std::vector<Trial> trials;
  const std::size_t count = experiment.stimuli.size();
  if (experiment.task == TrialTask::sorting || count == 0) return trials;
  const auto add = [&](std::size_t stimulus, std::uint32_t block) {
    trials.push_back(
        trial_about(experiment, seed, stimulus, static_cast<std::uint32_t>(trials.size() + 1), block));
  };
  // Practice: the named stimuli, and others until there are enough; all of them before one comes again.
  const Draws practice(seed, static_cast<std::uint32_t>(Drawn::practice));
  std::vector<std::size_t> practised = experiment.practised;
  const auto wanted = static_cast<std::size_t>(experiment.practice);
  for (std::uint64_t round = 0; practised.size() < wanted; ++round) {
    for (const std::size_t each : practice.order(count, round)) {
      const bool named = round == 0 && std::ranges::find(experiment.practised, each) != experiment.practised.end();
      if (!named && practised.size() < wanted) practised.push_back(each);
    }
  }
  const auto mixed_up = practice.order(practised.size(), std::uint64_t{1} << 20);
  for (std::size_t i = 0; i < practised.size(); ++i) add(practised[experiment.random ? mixed_up[i] : i], 0);
  if (is_adaptive(experiment)) return trials;
  const Draws order(seed, static_cast<std::uint32_t>(Drawn::block));
  if (experiment.task == TrialTask::adjustment) {
    const Draws start(seed, static_cast<std::uint32_t>(Drawn::start));
    const auto tracks = tracks_of(experiment);
    for (int block = 1; block <= experiment.repetitions; ++block) {
      const auto mixed = order.order(tracks.size(), static_cast<std::uint64_t>(block));
      for (std::size_t i = 0; i < tracks.size(); ++i) {
        const auto& track = tracks[experiment.random ? mixed[i] : i];
        add(track[start.bits(trials.size()) % track.size()], static_cast<std::uint32_t>(block));
      }
    }
    return trials;
  }
  for (int block = 1; block <= experiment.repetitions; ++block) {
    const auto mixed = order.order(count, static_cast<std::uint64_t>(block));
    for (std::size_t i = 0; i < count; ++i) add(experiment.random ? mixed[i] : i, static_cast<std::uint32_t>(block));
  }
  return trials;
}

}  // namespace wale
