#include "compiler/typed_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// A number at the beginning of a text, and the text after it.
template <class Number>
struct Leading {
  Number number;
  std::string_view rest;
};

template <class Number>
std::optional<Leading<Number>> leading_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  return Leading<Number>{number, text.substr(static_cast<std::size_t>(end - text.data()))};
}

template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  const auto leading = leading_number<Number>(text);
  return leading && leading->rest.empty() ? std::optional(leading->number) : std::nullopt;
}

Error unexpected(const std::string& option, const std::string& text, const std::string& expected,
                 const std::string& example) {
  return {.code = Code::malformed_value,
          .sentence = fmt::format("expected {}, {}", expected, found_typed(text)),
          .mend = fmt::format("for example, `{} {}`", option, example),
          .place = {.name = option, .text = text}};
}

/// Seconds in a unit of time, 1 for no unit; empty for other words.
std::optional<double> seconds_in(std::string_view unit) {
  if (unit.empty() || unit == "s") return 1;
  if (unit == "ms") return 1e-3;
  if (unit == "min") return 60;
  if (unit == "h") return 3600;
  return std::nullopt;
}

std::string bounds_of(const NumberRange& range) {
  const bool has_least = std::isfinite(range.least), has_most = std::isfinite(range.most);
  if (has_least && has_most && !range.above_least)
    return readable("a number from {:.6g} to {:.6g}", range.least, range.most);
  std::string bounds = "a number";
  if (has_least) bounds += readable(" {} {:.6g}", range.above_least ? "above" : "of at least", range.least);
  if (has_most) bounds += readable("{} at most {:.6g}", has_least ? " and" : " of", range.most);
  return bounds;
}

}  // namespace

std::string found_typed(const std::string& text) {
  return text.empty() ? "found nothing" : fmt::format("found \"{}\"", text);
}

Result<std::uint64_t> read_count(const std::string& option, const std::string& text, const CountRange& range) {
  const auto count = whole_number<std::uint64_t>(text);
  if (count && *count >= range.least && *count <= range.most) return *count;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool is_too_large = !count && !text.empty() && std::ranges::all_of(text, is_digit);
  const bool has_most = is_too_large || range.most != std::numeric_limits<std::uint64_t>::max();
  return unexpected(option, text,
                    has_most ? fmt::format("a whole number from {} to {}", range.least, range.most)
                             : fmt::format("a whole number of {} or more", range.least),
                    std::to_string(range.example));
}

Result<double> read_number(const std::string& option, const std::string& text, const NumberRange& range) {
  const auto number = whole_number<double>(text);
  if (number && std::isfinite(*number) && *number <= range.most &&
      (range.above_least ? *number > range.least : *number >= range.least))
    return *number;
  return unexpected(option, text, bounds_of(range), typeable("{:.6g}", range.example));
}

Result<double> read_duration(const std::string& option, const std::string& text, const DurationRange& range) {
  if (range.endless && text == "inf") return HUGE_VAL;
  if (const auto leading = leading_number<double>(text)) {
    std::string_view unit = leading->rest;
    unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
    const auto seconds = seconds_in(unit);
    const double duration = leading->number * seconds.value_or(0);
    if (seconds && std::isfinite(duration) && duration > 0 && duration <= range.most) return duration;
  }
  return unexpected(option, text,
                    fmt::format("a duration above 0{}, in s, ms, min or h{}",
                                std::isfinite(range.most) ? readable(" and of at most {:.6g} s", range.most) : "",
                                range.endless ? ", or inf" : ""),
                    typeable("\"{:.6g} s\"", range.example));
}

}  // namespace wale
