#include "calibration/experiment/planted_observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

constexpr double usual_frequency = 30;  // Hz
constexpr double usual_period = 2.5e-3;  // m

struct Field {
  const char* name;
  double PlantedLaw::*value;
  double least, most;
};
constexpr Field fields[] = {
    {"exponent", &PlantedLaw::exponent, 0.01, 10}, {"threshold", &PlantedLaw::threshold, 0, 100},
    {"modulus", &PlantedLaw::modulus, 1e-6, 1e6},  {"waveform", &PlantedLaw::waveform, -5, 5},
    {"period", &PlantedLaw::period, -5, 5},        {"carry", &PlantedLaw::carry_over, -1, 1},
    {"noise", &PlantedLaw::noise, 0, 10},          {"lapse", &PlantedLaw::lapse, 0, 1},
};

Error malformed(std::string sentence, std::string mend) {
  return {.code = Code::malformed_value,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = "--observer"}};
}

}  // namespace

Result<PlantedLaw> read_planted_law(std::string_view text) {
  PlantedLaw law;
  while (!text.empty()) {
    const auto comma = text.find(',');
    const std::string_view part = text.substr(0, comma);
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
    const auto equals = part.find('=');
    const std::string name(part.substr(0, equals));
    const std::string_view value = equals == std::string_view::npos ? "" : part.substr(equals + 1);
    if (name == "feels") {
      if (value != "actuator" && value != "interaction")
        return malformed(fmt::format("expected `feels=actuator` or `feels=interaction`, found `{}`",
                                     visible_text(std::string(part))),
                         "the interaction force is that between hand and handle");
      law.feels_actuator = value == "actuator";
      continue;
    }
    const auto field = std::ranges::find(fields, name, &Field::name);
    std::vector<std::string> names = {"feels"};
    for (const Field& each : fields) names.emplace_back(each.name);
    if (field == std::end(fields)) {
      const auto near = nearest_spelling(name, names);
      return malformed(fmt::format("a planted observer has no `{}`", visible_text(name)),
                       near ? fmt::format("did you mean `{}`?", *near)
                            : "write, for example, `planted:exponent=0.55,noise=0.2`");
    }
    double number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (value.empty() || error != std::errc() || end != value.data() + value.size() || !(number >= field->least) ||
        !(number <= field->most))
      return malformed(fmt::format("`{}` is a number from {} to {}, found `{}`", name, field->least, field->most,
                                   visible_text(std::string(value))),
                       fmt::format("write, for example, `planted:{}={}`", name, PlantedLaw{}.*field->value));
    law.*field->value = number;
  }
  return law;
}

double PlantedObserver::magnitude(const FeltSize& felt) const {
  const TextureForce& force = law_.feels_actuator || !felt.interaction_known ? felt.actuator : felt.interaction;
  const double above = force.size - law_.threshold;
  if (!(above > 0)) return 0;
  double magnitude = law_.modulus * std::pow(above, law_.exponent);
  if (law_.waveform != 0 && force.frequency > 0)
    magnitude *= std::pow(force.frequency / usual_frequency, law_.waveform);
  if (law_.period != 0 && force.frequency > 0 && felt.speed > 0)
    magnitude *= std::pow(felt.speed / force.frequency / usual_period, law_.period);
  return magnitude;
}

void PlantedObserver::begin(const Trial& trial, std::size_t, int interval, int) {
  if (trial.number != trial_) {
    if (!intervals_.empty()) before_ = intervals_.back();
    trial_ = trial.number, moves_ = 0, direction_ = 0, turned_ = false;
  }
  if (interval == 1) intervals_.clear();
}

void PlantedObserver::felt(const Presented& presented, const FeltSize& felt) {
  intervals_.push_back(magnitude(felt));
  if (presented.is_standard) standard_ = intervals_.back();
  else known_[presented.index] = intervals_.back();
}

/// The magnitude with noise; what is not felt has a little of its own, so that the answer is a guess.
double PlantedObserver::noisy(double magnitude, const Trial& trial, int interval) const {
  constexpr double nothing = 1e-3;  // of the modulus
  const Draws draws(seed_, static_cast<std::uint32_t>(Drawn::observer));
  const double z = draws.normal(std::uint64_t{trial.number} * 8 + static_cast<std::uint64_t>(interval));
  return std::max(magnitude, nothing * law_.modulus) * std::exp(law_.noise * z);
}

std::string PlantedObserver::answer(const Question& question) {
  const Trial& trial = *question.trial;
  const Draws draws(seed_, static_cast<std::uint32_t>(Drawn::observer));
  const double chance = draws.uniform((std::uint64_t{1} << 40) + trial.number);
  const bool lapses = chance < law_.lapse, coin = draws.bits((std::uint64_t{1} << 41) + trial.number) >> 63 != 0;
  std::vector<double> felt;
  for (std::size_t i = 0; i < intervals_.size(); ++i) felt.push_back(noisy(intervals_[i], trial, static_cast<int>(i)));
  if (felt.empty()) felt.push_back(0);
  double now = felt.back();
  if (law_.carry_over != 0 && before_ && *before_ > 0 && now > 0) now *= std::pow(*before_ / now, law_.carry_over);
  const ResponseKind kind = question.asked->kind;
  if (question.asked->name != "response" || kind == ResponseKind::text) {
    if (kind == ResponseKind::yes_no) return coin ? "yes" : "no";
    if (kind == ResponseKind::text) return intervals_.empty() || intervals_.back() == 0 ? "nothing" : "something rough";
  }
  switch (kind) {
    case ResponseKind::interval: return lapses ? (coin ? "1" : "2") : felt.front() > felt.back() ? "1" : "2";
    case ResponseKind::yes_no: {
      // A criterion one standard deviation of the noise above the standard, so that catch trials are "yes" in 16 %. Until
      // a standard was felt, or if it is not felt, above what the threshold alone would give by noise: a tenth of the
      // modulus.
      const double criterion =
          standard_ > 0 ? standard_ * std::exp(std::max(law_.noise, 1e-3)) : 0.1 * law_.modulus;
      const bool present = now > criterion;
      return (lapses ? coin : present) ? "yes" : "no";
    }
    case ResponseKind::same_different: {
      const double apart = std::abs(std::log(felt.front() / felt.back()));
      const bool differ = apart > 2 * std::max(law_.noise, 1e-3);
      return (lapses ? coin : differ) ? "different" : "same";
    }
    case ResponseKind::rating: {
      const double share = now / (now + law_.modulus);
      return fmt::format("{}", std::round(100 * share));
    }
    default: return fmt::format("{:.6g}", now);
  }
}

/// Moves towards the standard, which was felt first, and stops when it has gone past it.
std::string PlantedObserver::adjust() {
  constexpr int most_moves = 200;
  if (intervals_.size() < 2 || ++moves_ > most_moves) return "done";
  const int wanted = intervals_.back() < intervals_.front() ? 1 : -1;
  if (direction_ != 0 && wanted != direction_) return "done";
  direction_ = wanted;
  return wanted > 0 ? "+" : "-";
}

/// Feels all, then parts them where neighbours in order of magnitude are farthest apart.
std::string PlantedObserver::sort(const Sort& sort) {
  const std::size_t count = experiment_.stimuli.size();
  for (std::size_t i = 0; i < count; ++i)
    if (!known_.contains(i)) return sort.labels[i];
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto logarithm = [&](std::size_t each) { return std::log(std::max(known_[each], 1e-3 * law_.modulus)); };
  std::ranges::stable_sort(order, {}, logarithm);
  std::vector<std::size_t> gaps(count - 1);
  std::iota(gaps.begin(), gaps.end(), std::size_t{0});
  std::ranges::stable_sort(gaps, std::greater<>(),
                           [&](std::size_t i) { return logarithm(order[i + 1]) - logarithm(order[i]); });
  const auto groups = static_cast<std::size_t>(sort.groups.value_or(3));
  gaps.resize(std::min(groups, count) - 1);
  int pile = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto lies = sort.piles.find(order[i]);
    if (lies == sort.piles.end() || lies->second != pile) return fmt::format("{} {}", sort.labels[order[i]], pile);
    if (std::ranges::find(gaps, i) != gaps.end()) ++pile;
  }
  return "done";
}

Result<std::string> PlantedObserver::say(const Question& question) {
  if (stuck_) return Error{.code = Code::malformed_value, .sentence = "the planted observer has no answer to this"};
  switch (question.kind) {
    case Question::Kind::consent: return std::string("yes");
    case Question::Kind::trial: return answer(question);
    case Question::Kind::sort: return sort(*question.sort);
    case Question::Kind::adjust: return adjust();
    case Question::Kind::closing:
      switch (question.asked->kind) {
        case ResponseKind::yes_no: return std::string("no");
        case ResponseKind::text: return std::string("a planted observer");
        default: return std::string("50");
      }
    default: return std::string();
  }
}

void PlantedObserver::refuse(const std::string&) { stuck_ = true; }

}  // namespace wale
