#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

/// Numbers as people write them, for the text of all verbs. JSON, tables and lines of Wale use `fmt::format`, since
/// programs read them.
namespace wale {

/// The text of a number without an exponent, if its size is 1e-6 or more and less than 1e15: a whole number with all
/// its digits, another with those of `text`. From five digits before the point on, they stand in groups of three: "32
/// 767". Blanks around the number stay as far as the groups leave room, so that columns stay aligned.
inline std::string as_people_write(std::string_view text, double value) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t end = text.find_last_not_of(' ') + 1;
  if (begin >= end) return std::string(text);
  std::string number(text.substr(begin, end - begin));
  const std::size_t width = text.size();
  if (const std::size_t e = number.find('e'); e != std::string::npos && std::isfinite(value)) {
    const int exponent = std::atoi(number.c_str() + e + 1);
    const auto digits = static_cast<int>(std::count_if(number.begin(), number.begin() + static_cast<std::ptrdiff_t>(e),
                                                       [](char c) { return c >= '0' && c <= '9'; }));
    const double unit = std::pow(10.0, exponent - digits + 1);
    if (exponent >= 0 && exponent < 15)
      number = fmt::format("{:.0f}", value == std::round(value) ? value : std::round(value / unit) * unit);
    else if (exponent < 0 && exponent >= -6)
      number = fmt::format("{:.{}f}", value, digits - 1 - exponent);
  }
  const std::size_t first = number.find_first_of("0123456789");
  std::size_t point = number.find_first_not_of("0123456789", first);
  if (point == std::string::npos) point = number.size();
  const bool plain = first != std::string::npos && (point == number.size() || number[point] == '.');
  if (plain && point - first >= 5 && number[first] != '0')  // zeros stand before a code, not a number
    for (std::size_t at = point; at > first + 3; at -= 3) number.insert(at - 3, 1, ' ');
  const std::size_t padded = begin > 0 || end < width ? width : 0, room = padded - std::min(padded, number.size());
  const std::size_t before = end < width ? std::min(begin, room) : room;
  return std::string(before, ' ') + number + std::string(room - before, ' ');
}

/// A number in an argument of `readable`.
template <typename Value>
struct ReadableNumber {
  Value value;
};

/// A number for the formatter below; anything else as it is.
template <typename Argument>
decltype(auto) with_readable_number(const Argument& argument) {
  if constexpr (std::is_arithmetic_v<Argument> && !std::is_same_v<Argument, bool> && !std::is_same_v<Argument, char>)
    return ReadableNumber<Argument>{argument};
  else
    return (argument);
}

template <typename Argument>
using Readable = decltype(with_readable_number(std::declval<const Argument&>()));

/// As `fmt::format`, with each number as people write it. Not for numbers that must be typed again, such as a seed, and
/// not for widths that are arguments.
template <typename... Arguments>
std::string readable(fmt::format_string<Readable<Arguments>...> format, const Arguments&... arguments) {
  return fmt::format(format, with_readable_number(arguments)...);
}

}  // namespace wale

template <typename Value>
struct fmt::formatter<wale::ReadableNumber<Value>> : fmt::formatter<Value> {
  template <typename Context>
  auto format(const wale::ReadableNumber<Value>& number, Context& context) const {
    fmt::memory_buffer buffer;
    fmt::format_context inner(fmt::appender(buffer), {});
    fmt::formatter<Value>::format(number.value, inner);
    const std::string text = wale::as_people_write({buffer.data(), buffer.size()}, static_cast<double>(number.value));
    return std::copy(text.begin(), text.end(), context.out());
  }
};
