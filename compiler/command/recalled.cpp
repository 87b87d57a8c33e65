#include "compiler/command/recalled.hpp"

#include <fmt/format.h>

#include <string>

#include "compiler/command/print.hpp"

namespace wale::command {

void print_recalled(const std::set<const Threshold*>& thresholds) {
  std::set<std::string> lines;  // the pointers' own order differs from run to run
  for (const Threshold* each : thresholds)
    lines.insert(fmt::format("wale: warning[{}]: the threshold of {} was recalled and not looked up ({})\n",
                             code_name(Code::unverified_basis), each->cue, each->source));
  for (const std::string& line : lines) print_error(line);
}

}  // namespace wale::command
