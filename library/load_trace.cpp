#include "library/load_trace.hpp"

#include <fmt/format.h>

#include "compiler/text/resolver.hpp"

namespace wale {

std::variant<Trace, Refusal> load_trace(const std::string& path) {
  const auto read = read_file(path);
  if (!read) return Refusal{fmt::format("`{}` cannot be read: {}", path, read.error().sentence), {}};
  auto trace = read_trace(read->bytes);
  if (const auto* error = std::get_if<TraceError>(&trace))
    return Refusal{fmt::format("{}:{}: expected {}, found {}", path, error->line, error->expected, error->found), {}};
  return std::get<Trace>(std::move(trace));
}

}  // namespace wale
