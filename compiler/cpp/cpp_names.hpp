#pragma once

#include <set>
#include <string>
#include <string_view>

namespace wale {

/// Somebody's text for a place after `//`, in one line that stays a comment: no line break, no backslash and no
/// trigraph of one, which would join the next line to it, and nothing that hides or reorders what a reader sees.
std::string cpp_comment(std::string_view text);

/// The identifiers of one C++ file. Words with a meaning are never given out, and no identifier is given out twice.
class CppNames {
 public:
  /// Knows the keywords of C++. Numbered names (`t12`, `peak0`) are reserved for the writer.
  CppNames();
  /// Reserves a word that has another meaning.
  void reserve(std::string_view word) { taken_.emplace(word); }
  /// `wanted` with the characters that C++ does not allow replaced, and a number appended if it is taken.
  std::string take(std::string_view wanted);
  /// The same without checking whether it is taken.
  static std::string sanitised(std::string_view wanted);

 private:
  std::set<std::string, std::less<>> taken_;
};

}  // namespace wale
