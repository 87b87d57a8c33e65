#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/c/call.hpp"
#include "wale/program.h"
#include "wale/program.hpp"

struct WaleProgram {
  wale::Program program;
  std::vector<std::unique_ptr<WaleError>> warnings = {};
  std::string taken = {};
};

namespace wale::c {

/// The result of a call: a place for a handle. Sets it to NULL. Error: it is NULL.
template <class Handle>
Result<> clear_result(const char* argument, Handle** to) {
  if (auto given = is_place(argument, to); !given) return given;
  *to = nullptr;
  return {};
}

}  // namespace wale::c
