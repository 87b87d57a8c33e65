#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace wale {

/// SHA-256 of values that are taken one after another. Each is taken with its length, so that ("ab", "c") and ("a",
/// "bc") differ.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();

  ContentHash& take(std::string_view bytes);
  ContentHash& take(std::span<const std::byte> bytes);
  /// In 64 hexadecimal digits. Nothing can be taken afterwards.
  std::string digits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What names this build of Wale: the linker's build id of the program or shared library that this code is part of, in
/// hexadecimal digits, so that another compiler, map, threshold or device is another build. If the linker gave none, the
/// hash of all files of the language that are part of it.
const std::string& compiler_build();

}  // namespace wale
