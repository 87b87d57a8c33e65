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

const CodeEntry& entry(Code code) {
  for (const CodeEntry& each : entries) {
    if (each.code == code) return each;
  }
  return entries[0];  // every enumerator is in the table, so this is never reached
}

}  // namespace

std::string code_name(Code code) {
  std::string digits = std::to_string(static_cast<unsigned>(code));
  return "W" + std::string(4 - digits.size(), '0') + digits;
}

std::string code_title(Code code) { return entry(code).title; }

Severity severity_of(Code code) { return entry(code).severity; }

}  // namespace wale
