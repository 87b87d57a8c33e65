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

/// What names this build of Wale, in hexadecimal digits: the hash of the objects of machine, reader and compiler with all
/// that is embedded in them, so that another compiler, map, threshold or device is another build. The command line and
/// the library for programs of one build have the same.
const std::string& compiler_build();

}  // namespace wale
