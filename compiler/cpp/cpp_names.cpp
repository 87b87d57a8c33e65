#include "compiler/cpp/cpp_names.hpp"

#include <algorithm>

#include "schema/visible_text.hpp"

namespace wale {
namespace {

constexpr std::string_view keywords =
    "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t "
    "char8_t class co_await co_return co_yield compl concept const const_cast consteval constexpr "
    "constinit continue decltype default delete do double dynamic_cast else enum explicit export extern "
    "false float for friend goto if inline int long mutable namespace new noexcept not not_eq nullptr "
    "operator or or_eq private protected public register requires return short signed sizeof static "
    "static_assert static_cast struct switch template this thread_local throw true try typedef typeid "
    "typename union unsigned using virtual void volatile wchar_t while xor xor_eq reinterpret_cast "
    // macros of the standard headers that are not in capitals
    "errno assert stdin stdout stderr offsetof setjmp va_start va_arg va_end va_copy linux unix ";

// C++ allows only ASCII letters in the names that people write.
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// "t12" or "peak0": lower-case letters and then digits.
bool is_numbered(std::string_view name) {
  const auto digit = std::ranges::find_if(name, is_digit);
  return digit != name.end() && std::all_of(digit, name.end(), is_digit);
}

/// Whether it has no lower-case letter, as macros have none: NAN, EOF, M_PI.
bool may_be_macro(std::string_view name) {
  return std::ranges::none_of(name, [](char c) { return c >= 'a' && c <= 'z'; });
}

}  // namespace

std::string cpp_comment(std::string_view text) {
  std::string usable(text);
  std::ranges::replace(usable, '\\', ' ');
  for (std::size_t at = usable.find("??"); at != std::string::npos; at = usable.find("??", at + 1))
    usable.insert(at + 1, " ");
  return visible_text(usable);  // whose backslashes stand before digits
}

CppNames::CppNames() {
  for (std::size_t at = 0; at < keywords.size();) {
    const std::size_t end = keywords.find(' ', at);
    reserve(keywords.substr(at, end - at));
    at = end + 1;
  }
}

std::string CppNames::sanitised(std::string_view wanted) {
  std::string name;
  for (const char c : wanted) {
    const char usable = is_letter(c) || is_digit(c) ? c : '_';
    if (usable == '_' && name.ends_with('_')) continue;  // names with two underscores in a row are reserved
    name += usable;
  }
  if (name.empty() || !is_letter(name[0])) name.insert(0, "v");
  return name;
}

std::string CppNames::take(std::string_view wanted) {
  std::string name = sanitised(wanted);
  if (is_numbered(name) || may_be_macro(name)) name += name.ends_with('_') ? "value" : "_value";
  std::string free = name;
  for (int i = 2; !taken_.emplace(free).second; ++i) free = name + (name.ends_with('_') ? "" : "_") + std::to_string(i);
  return free;
}

}  // namespace wale
