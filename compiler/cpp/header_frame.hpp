#pragma once

#include <string>
#include <vector>

#include "compiler/cpp/cpp_names.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// What the frame of a header says of its code.
struct HeaderFrame {
  const PatchProgram& program;
  std::string name_space;
  bool live = false, live_size = false;
  std::vector<std::string> live_parameters;  ///< their names in C++
  std::size_t table_bytes = 0;
  std::size_t setup_bytes = 0;  ///< of `Setup`, if something is live
  std::size_t peaks = 0;        ///< that setup runs
};

/// The whole header around `code`: the comment at its head, the guard, the checks of the compiler's mode, the
/// arithmetic that headers share, and the namespace.
std::string framed(const HeaderFrame& frame, const std::string& code);

/// Reserves all names that headers use for themselves.
void reserve_cpp_words(CppNames& names);

}  // namespace wale
