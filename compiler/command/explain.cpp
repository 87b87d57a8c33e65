#include "compiler/diagnostics/explain.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"

namespace wale::command {
namespace {

struct ExplainOptions {
  std::string code;  ///< empty to list all
};

int explain(const ExplainOptions& options) {
  if (options.code.empty()) {
    print_out(codes_text());
    return done;
  }
  const auto code = code_named(options.code);
  if (!code) return refuse(code.error());
  print_out(explanation_text(*code));
  return done;
}

Run declare_explain(CLI::App& verb) {
  const auto options = std::make_shared<ExplainOptions>();
  must_say(verb.add_option("CODE", options->code, "a code such as W0301 (default: lists all codes)"),
           "a code such as W0301", "leave out the code to list all");
  verb.footer("for example: wale explain W0301");
  return [options] { return explain(*options); };
}

}  // namespace

extern const Verb explain_verb{
    "explain", "explains the code of a diagnostic; for errors in the text of a file, with an example", declare_explain};

}  // namespace wale::command
