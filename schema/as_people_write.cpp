#include "schema/as_people_write.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace wale {
namespace {

std::string with_decimals_of(int decimals, double value) {
  std::array<char, 400> buffer{};  // the largest double has 309 digits
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals);
  return {buffer.data(), end.ptr};
}

}  // namespace

std::string as_people_write(std::string_view text, double value, Digits digits) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t end = text.find_last_not_of(' ') + 1;
  if (begin >= end) return std::string(text);
  std::string number(text.substr(begin, end - begin));
  const std::size_t width = text.size();
  if (const std::size_t e = number.find('e'); e != std::string::npos && std::isfinite(value)) {
    const int exponent = std::atoi(number.c_str() + e + 1);
    const auto significant = static_cast<int>(std::count_if(
        number.begin(), number.begin() + static_cast<std::ptrdiff_t>(e), [](char c) { return c >= '0' && c <= '9'; }));
    const double unit = std::pow(10.0, exponent - significant + 1);
    if (exponent >= 0 && exponent < 15)
      number = with_decimals_of(0, value == std::round(value) ? value : std::round(value / unit) * unit);
    else if (exponent < 0 && exponent >= -6)
      number = with_decimals_of(significant - 1 - exponent, value);
  }
  const std::size_t first = number.find_first_of("0123456789");
  std::size_t point = number.find_first_not_of("0123456789", first);
  if (point == std::string::npos) point = number.size();
  const bool plain = first != std::string::npos && (point == number.size() || number[point] == '.');
  if (digits == Digits::grouped && plain && point - first >= 5 &&
      number[first] != '0')  // zeros stand before a code, not a number
    for (std::size_t at = point; at > first + 3; at -= 3) number.insert(at - 3, 1, ' ');
  const std::size_t padded = begin > 0 || end < width ? width : 0, room = padded - std::min(padded, number.size());
  const std::size_t before = end < width ? std::min(begin, room) : room;
  return std::string(before, ' ') + number + std::string(room - before, ' ');
}

}  // namespace wale
