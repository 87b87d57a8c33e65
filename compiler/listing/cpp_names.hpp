#pragma once

#include <set>
#include <string>
#include <string_view>

namespace wale {

/// Identifiers of one C++ file: words that mean something already are never given out, and none is given out twice.
class CppNames {
 public:
  /// Knows the keywords of C++. Numbered names (`t12`, `peak0`) are left to the writer.
  CppNames();
  /// A word that means something else.
  void reserve(std::string_view word) { taken_.emplace(word); }
  /// `wanted` with whatever C++ does not allow in a name replaced, and a number behind it when it is taken.
  std::string take(std::string_view wanted);
  /// The same without asking whether it is taken.
  static std::string sanitised(std::string_view wanted);

 private:
  std::set<std::string, std::less<>> taken_;
};

}  // namespace wale
