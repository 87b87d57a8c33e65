#include "calibration/experiment/response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "schema/utf8.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

constexpr std::size_t longest_answer = 4000;  // bytes

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const auto begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string lower(std::string_view text) {
  std::string made(text);
  std::ranges::transform(made, made.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return made;
}

/// "12", "0.5", "0,5", "1/2"; nothing for anything else.
std::optional<double> number_typed(std::string_view text) {
  if (const auto slash = text.find('/'); slash != std::string_view::npos) {
    const auto above = number_typed(trimmed(text.substr(0, slash))), below = number_typed(trimmed(text.substr(slash + 1)));
    if (!above || !below || *below == 0) return std::nullopt;
    return *above / *below;
  }
  std::string plain(text);
  if (plain.find('.') == std::string::npos && std::ranges::count(plain, ',') == 1)
    std::ranges::replace(plain, ',', '.');
  if (plain.starts_with('+')) plain.erase(0, 1);
  double value = 0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (plain.empty() || error != std::errc() || end != plain.data() + plain.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Character each = decode(text, at);
    if (!each.valid) return false;
    at += each.bytes;
  }
  return true;
}

ResponseKind kind_of(AnswerKind kind) {
  switch (kind) {
    case AnswerKind::number: return ResponseKind::number;
    case AnswerKind::rating: return ResponseKind::rating;
    case AnswerKind::yes_no: return ResponseKind::yes_no;
    case AnswerKind::text: break;
  }
  return ResponseKind::text;
}

Asked of_task(const CheckedExperiment& experiment) {
  switch (experiment.task) {
    case TrialTask::magnitude_estimation:
      return {"response", ResponseKind::magnitude, "How strong does it feel? Give a number above 0."};
    case TrialTask::rating: return {"response", ResponseKind::rating, "Rate it from 0 to 100."};
    case TrialTask::confidence: return {"response", ResponseKind::rating, "How sure are you, from 0 to 100?"};
    case TrialTask::description: return {"response", ResponseKind::text, "What does it feel like?"};
    case TrialTask::two_interval: return {"response", ResponseKind::interval, "In which was there more, 1 or 2?"};
    case TrialTask::one_interval: return {"response", ResponseKind::yes_no, "Was it there? yes or no"};
    case TrialTask::same_different:
      return {"response", ResponseKind::same_different, "Were they the same or different?"};
    case TrialTask::adjustment:
    case TrialTask::sorting: break;
  }
  return {"response", ResponseKind::text, ""};
}

}  // namespace

std::vector<Asked> questions_of_trial(const CheckedExperiment& experiment) {
  std::vector<Asked> all;
  if (experiment.task == TrialTask::sorting) return all;
  all.push_back(of_task(experiment));
  if (!experiment.ask.empty()) all.back().says = experiment.ask;
  // What numbers mean is said whatever the question is.
  const bool rates = experiment.task == TrialTask::rating || experiment.task == TrialTask::confidence;
  if (rates && !experiment.lowest.empty())
    all.back().says += fmt::format(" 0 is {}, 100 is {}.", experiment.lowest, experiment.highest);
  if (experiment.task == TrialTask::magnitude_estimation && experiment.modulus)
    all.back().says += fmt::format(" The first one is {}; give others numbers in proportion.", *experiment.modulus);
  for (const ExperimentQuestion& each : experiment.questions) all.push_back({each.name, kind_of(each.kind), each.says});
  return all;
}

std::vector<Asked> closing_questions(const CheckedExperiment& experiment) {
  std::vector<Asked> all;
  for (const ExperimentQuestion& each : experiment.closing) all.push_back({each.name, kind_of(each.kind), each.says});
  return all;
}

const char* expected_words(ResponseKind kind) {
  switch (kind) {
    case ResponseKind::magnitude: return "a number above 0, as in 12, 0.5 or 1/2";
    case ResponseKind::rating: return "a number from 0 to 100";
    case ResponseKind::number: return "a number";
    case ResponseKind::text: return "a line of text";
    case ResponseKind::yes_no: return "yes or no";
    case ResponseKind::interval: return "1 or 2";
    case ResponseKind::same_different: return "same or different";
  }
  return "an answer";
}

Result<std::string> checked_response(ResponseKind kind, std::string_view typed) {
  std::string_view text = trimmed(typed);
  const auto refuse = [&](const std::string& found) {
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("expected {}, found {}", expected_words(kind), found)};
  };
  const std::string shown = text.empty() ? "nothing" : fmt::format("`{}`", visible_text(std::string(text.substr(0, 60))));
  if (text.empty()) return refuse(shown);
  const std::string word = lower(text);
  const auto one_of = [&](std::initializer_list<std::pair<const char*, const char*>> meanings) -> Result<std::string> {
    for (const auto& [spelling, meant] : meanings)
      if (word == spelling) return std::string(meant);
    return refuse(shown);
  };
  switch (kind) {
    case ResponseKind::text:
      if (text.size() > longest_answer) return refuse("a longer text than 4000 bytes");
      if (!is_utf8(text)) return refuse("text that is not UTF-8");
      return std::string(text);
    case ResponseKind::yes_no: return one_of({{"yes", "yes"}, {"y", "yes"}, {"no", "no"}, {"n", "no"}});
    case ResponseKind::interval: return one_of({{"1", "1"}, {"2", "2"}});
    case ResponseKind::same_different:
      return one_of({{"same", "same"}, {"s", "same"}, {"different", "different"}, {"d", "different"}});
    default: break;
  }
  if (kind == ResponseKind::rating && text.ends_with('%')) text = trimmed(text.substr(0, text.size() - 1));
  const auto value = number_typed(text);
  if (!value || (kind == ResponseKind::magnitude && !(*value > 0)) ||
      (kind == ResponseKind::rating && !(*value >= 0 && *value <= 100)))
    return refuse(shown);
  return fmt::format("{}", *value);
}

}  // namespace wale
