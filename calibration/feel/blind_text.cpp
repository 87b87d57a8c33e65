#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "calibration/feel/blind_comparison.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/text/json_text.hpp"
#include "schema/without_place.hpp"

namespace wale {
namespace {

BlindScore score_of(const BlindSession& session) {
  return blind_score(static_cast<int>(std::ranges::count_if(session.trials, &BlindTrial::right)),
                     static_cast<int>(session.trials.size()));
}

/// A share in percent with two digits that count: "100", "7.3", "0.024"; "less than 0.01" below that.
std::string percent_text(double share) {
  const double percent = 100 * share;
  if (percent < 0.01) return "less than 0.01";
  return with_decimals(percent, percent >= 9.95 ? 0 : percent >= 0.995 ? 1 : percent >= 0.0995 ? 2 : 3);
}

/// "1.4 (0.3 to 2.6)", "2.9 (1.1 or more)".
std::string sensitivity_text(const BlindScore& score) {
  const auto end = [](const std::optional<double>& value) { return value ? with_decimals(*value, 1) : ""; };
  const std::string interval = !score.sensitivity_high ? end(score.sensitivity_low) + " or more"
                               : !score.sensitivity_low
                                   ? end(score.sensitivity_high) + " or less"
                                   : end(score.sensitivity_low) + " to " + end(score.sensitivity_high);
  return fmt::format("{} ({})", with_decimals(score.sensitivity, 1), interval);
}

std::string predicted_text(const Comparison& predicted) {
  const CueDifference* plainest = predicted.plainest();
  if (predicted.verdict == Verdict::unknown) return "unknown: they differ in a cue whose threshold is not known";
  if (!plainest || *plainest->noticeable == 0) return "d' 0.0: no known difference, so half of the answers are right";
  const std::string by = cue_table()[static_cast<std::size_t>(plainest->kind)].name +
                         std::string(plainest->outside.empty() ? "" : ", extrapolated");
  if (*plainest->noticeable > 20) return fmt::format("d' > 20 by their {}: all answers are right", by);
  return fmt::format("d' {:.1f} by their {}: {:.0f} % of answers right", *plainest->noticeable, by,
                     100 * proportion_right(*plainest->noticeable));
}

}  // namespace

std::string blind_text(const BlindReport& report) {
  const std::size_t answered = report.session.trials.size();
  std::string text = fmt::format("A {} and B {}, on {}: which of two was A?\n", report.a, report.b, report.device);
  if (report.session.ended)
    text += fmt::format("  ended early  {} of {} trials {} answered: {}\n", answered, report.asked,
                        answered == 1 ? "was" : "were", in_words_without_place(*report.session.ended));
  if (answered > 0) {
    const BlindScore score = score_of(report.session);
    text += fmt::format(
        "  right        {} of {}: {:.0f} % ({:.0f} to {:.0f} %); guessing gets as many or more in {} % of sessions\n",
        score.right, score.trials, 100 * score.proportion, 100 * score.low, 100 * score.high,
        percent_text(score.by_chance));
    text += fmt::format("  d'           {}: sqrt(2) z(share right), two intervals, forced choice\n",
                        sensitivity_text(score));
    const auto first = std::ranges::count(report.session.trials, 1, &BlindTrial::answer);
    const auto times = [](long count) { return fmt::format("{} time{}", count, count == 1 ? "" : "s"); };
    text += fmt::format("  answered     {} \"the first\", {} \"the second\"\n", times(first),
                        times(static_cast<long>(answered) - first));
  }
  text += fmt::format("  predicted    {}\n", predicted_text(report.predicted));
  return text + fmt::format("  --seed {} gives the same order again\n", report.seed);
}

std::string blind_json(const BlindReport& report) {
  using Json = nlohmann::ordered_json;
  const auto value = [](const std::optional<double>& each) { return each ? Json(*each) : Json(nullptr); };
  Json json = {{"a", report.a},           {"b", report.b},
               {"device", report.device}, {"method", "two-interval forced choice: which was A"},
               {"seed", report.seed},     {"asked", report.asked}};
  if (report.session.ended) json["ended"] = in_words_without_place(*report.session.ended);
  Json& trials = json["trials"] = Json::array();
  for (const BlindTrial& each : report.session.trials)
    trials.push_back({{"a_first", each.a_first}, {"answer", each.answer}, {"right", each.right()}});
  if (!report.session.trials.empty()) {
    const BlindScore score = score_of(report.session);
    json["right"] = score.right;
    json["proportion"] = {{"value", score.proportion}, {"low", score.low}, {"high", score.high}};
    json["d_prime"] = {
        {"value", score.sensitivity}, {"low", value(score.sensitivity_low)}, {"high", value(score.sensitivity_high)}};
    json["by_chance"] = score.by_chance;
  }
  const CueDifference* plainest = report.predicted.plainest();
  const bool known = report.predicted.verdict != Verdict::unknown;
  const double apart = plainest ? plainest->noticeable.value_or(0) : 0;
  json["predicted"] = {
      {"d_prime", known ? Json(apart) : Json(nullptr)},
      {"proportion", known ? Json(proportion_right(apart)) : Json(nullptr)},
      {"cue", known && apart > 0 ? Json(cue_table()[static_cast<std::size_t>(plainest->kind)].name) : Json(nullptr)},
      {"outside", known && apart > 0 ? Json(plainest->outside) : Json::array()}};
  return json_lines(json);
}

}  // namespace wale
