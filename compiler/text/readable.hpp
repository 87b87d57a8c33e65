#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

#include "schema/as_people_write.hpp"

/// Numbers as people write them, for the text of all verbs. JSON, tables and lines of Wale use `fmt::format`, since
/// programs read them.
namespace wale {

/// A number in an argument of `readable`.
template <typename Value, Digits digits>
struct ReadableNumber {
  Value value;
};

/// A number for the formatter below; anything else as it is.
template <Digits digits, typename Argument>
decltype(auto) with_readable_number(const Argument& argument) {
  if constexpr (std::is_arithmetic_v<Argument> && !std::is_same_v<Argument, bool> && !std::is_same_v<Argument, char>)
    return ReadableNumber<Argument, digits>{argument};
  else
    return (argument);
}

template <Digits digits, typename Argument>
using Readable = decltype(with_readable_number<digits>(std::declval<const Argument&>()));

/// As `fmt::format`, with each number as people write it. Not for numbers that must be typed again, such as a seed, and
/// not for widths that are arguments.
template <typename... Arguments>
std::string readable(fmt::format_string<Readable<Digits::grouped, Arguments>...> format,
                     const Arguments&... arguments) {
  return fmt::format(format, with_readable_number<Digits::grouped>(arguments)...);
}

/// The same for text that holds what is typed again, as a line of Wale or an option: no exponents, and no groups.
template <typename... Arguments>
std::string typeable(fmt::format_string<Readable<Digits::together, Arguments>...> format,
                     const Arguments&... arguments) {
  return fmt::format(format, with_readable_number<Digits::together>(arguments)...);
}

}  // namespace wale

template <typename Value, wale::Digits digits>
struct fmt::formatter<wale::ReadableNumber<Value, digits>> : fmt::formatter<Value> {
  template <typename Context>
  auto format(const wale::ReadableNumber<Value, digits>& number, Context& context) const {
    fmt::memory_buffer buffer;
    fmt::format_context inner(fmt::appender(buffer), {});
    fmt::formatter<Value>::format(number.value, inner);
    const std::string text =
        wale::as_people_write({buffer.data(), buffer.size()}, static_cast<double>(number.value), digits);
    return std::copy(text.begin(), text.end(), context.out());
  }
};
