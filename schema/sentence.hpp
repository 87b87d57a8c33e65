#pragma once

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

#include "wale/result.hpp"

namespace wale {

/// A part of a sentence: text, or a number. Quantities are shown as people write them; counts of bytes, registers or
/// instructions with their digits together, since a programmer searches for them. It refers to its text.
class SentencePart {
 public:
  SentencePart(std::string_view text) : text_(text) {}
  SentencePart(const std::string& text) : text_(text) {}
  SentencePart(const char* text) : text_(text) {}
  SentencePart(const char& letter) : text_(&letter, 1) {}
  SentencePart(std::floating_point auto number) : kind_(Kind::quantity), quantity_(static_cast<double>(number)) {}
  SentencePart(std::signed_integral auto number) : kind_(Kind::integer), integer_(number) {}
  SentencePart(std::unsigned_integral auto number) : kind_(Kind::count), count_(number) {}

  void append_to(std::string& sentence) const;

 private:
  enum class Kind { text, quantity, integer, count };
  Kind kind_ = Kind::text;
  union {
    std::string_view text_;
    double quantity_;
    long long integer_;
    unsigned long long count_;
  };
};

/// Joins the parts.
std::string sentence_of(std::initializer_list<SentencePart> parts);

template <typename... Parts>
std::string sentence(const Parts&... parts) {
  return sentence_of({SentencePart(parts)...});
}

/// Ends reading or verifying with an error whose sentence is made of the parts. It is thrown and caught within one
/// public function, which returns it: callers never see the exception.
[[noreturn]] void fail_with(Code code, std::initializer_list<SentencePart> parts);

template <typename... Parts>
[[noreturn]] void fail(Code code, const Parts&... parts) {
  fail_with(code, {SentencePart(parts)...});
}

/// As `fail` with `damaged_file`.
template <typename... Parts>
[[noreturn]] void damaged(const Parts&... parts) {
  fail(Code::damaged_file, parts...);
}

}  // namespace wale
