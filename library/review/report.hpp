#pragma once

#include <string>
#include <utility>

#include "compiler/diagnostics/advice.hpp"

namespace wale {

/// Adds what a review found, with its help.
inline void report(Diagnostics& diagnostics, Code code, Span span, std::string message, std::string help) {
  diagnostics.report(Advice(std::move(help)).about(code, span, std::move(message)));
}

}  // namespace wale
