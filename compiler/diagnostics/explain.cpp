#include "compiler/diagnostics/explain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "compiler/diagnostics/render.hpp"
#include "compiler/text/embedded_files.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

std::optional<unsigned> number_named(std::string_view name) {
  if (name.starts_with('W') || name.starts_with('w')) name.remove_prefix(1);
  unsigned number = 0;
  const auto [end, status] = std::from_chars(name.data(), name.data() + name.size(), number);
  constexpr std::size_t digits = 4;
  if (status != std::errc{} || end != name.data() + name.size() || name.size() > digits) return std::nullopt;
  return number;
}

}  // namespace

std::vector<Code> all_codes() {
  std::vector<Code> codes = {
// clang-format off
#define WALE_CODE(number, name, severity, title) Code::name,
#include "wale/codes.def"
      // clang-format on
  };
  std::ranges::sort(codes);
  return codes;
}

Result<Code> code_named(std::string_view name) {
  const auto number = number_named(name);
  std::vector<std::string> names;
  for (const Code code : all_codes()) {
    if (number && static_cast<unsigned>(code) == *number) return code;
    names.push_back(code_name(code));
  }
  const auto near = nearest_spelling(number ? fmt::format("W{:04}", *number) : std::string(name), names);
  return Error{Code::unknown_name, fmt::format("no diagnostic has the code `{}`", name),
               near ? fmt::format("did you mean `{}`?", *near) : "`wale explain` lists all codes"};
}

std::string_view explanation(Code code) {
  const std::string name = fmt::format("/{}.md", code_name(code));
  for (const EmbeddedFile& file : embedded_explanations())
    if (file.name.ends_with(name)) return file.text;
  return {};
}

std::string explanation_text(Code code) {
  std::string out = fmt::format("{}, {}: {}\n\n", code_name(code),
                                severity_of(code) == Severity::error ? "an error" : "a warning", code_title(code));
  bool inside = false;
  for (std::string_view rest = explanation(code); !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) out += line == "```wale-error" ? "Wrong:\n\n" : "Mended:\n\n";
    } else {
      out += fmt::format("{}{}\n", inside && !line.empty() ? "    " : "", line);
    }
  }
  return out;
}

std::string codes_text() {
  std::string out;
  for (const Code code : all_codes())
    out += fmt::format("{}  {:<7}  {}\n", code_name(code), severity_name(severity_of(code)), code_title(code));
  return out;
}

}  // namespace wale
