#include "wale/code.hpp"

namespace wale {
namespace {

struct CodeEntry {
  Code code;
  Severity severity;
  const char* title;
};

constexpr CodeEntry entries[] = {
#define WALE_CODE(number, name, severity, title) {Code::name, Severity::severity, title},
#include "wale/codes.def"
};

/// Null for a number that is none of the enumerators: that of a newer code, or a mistake.
const CodeEntry* entry(Code code) {
  for (const CodeEntry& each : entries) {
    if (each.code == code) return &each;
  }
  return nullptr;
}

}  // namespace

std::string code_name(Code code) {
  std::string digits = std::to_string(static_cast<unsigned>(code));
  return "W" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
}

std::string code_title(Code code) {
  const CodeEntry* known = entry(code);
  return known == nullptr ? "" : known->title;
}

Severity severity_of(Code code) {
  const CodeEntry* known = entry(code);
  return known == nullptr ? Severity::error : known->severity;
}

}  // namespace wale
