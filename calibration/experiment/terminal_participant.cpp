#include "calibration/experiment/terminal_participant.hpp"

#include <fmt/format.h>

#include <istream>
#include <ostream>

#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"

namespace wale {

void TerminalParticipant::begin(const Trial& trial, std::size_t of, int interval, int intervals) {
  if (interval == 1) {
    out_ << (trial.block == 0 ? "practice, " : "")
         << (of == 0 ? fmt::format("trial {}", trial.number) : fmt::format("trial {} of {}", trial.number, of)) << '\n';
  }
  if (intervals > 1) out_ << (interval == 1 ? "  the first ...\n" : "  the second ...\n");
  out_ << std::flush;
}

void TerminalParticipant::felt(const Presented&, const FeltSize&) {}

Result<std::string> TerminalParticipant::say(const Question& question) {
  std::string says = visible_lines(question.says);
  switch (question.kind) {
    case Question::Kind::page: says += "\n(Enter goes on) "; break;
    case Question::Kind::consent: says += "\nDo you agree? yes or no: "; break;
    case Question::Kind::rest: says = readable("Rest for {:.3g} minutes. Enter goes on. ", question.seconds / 60); break;
    default: says += " "; break;
  }
  out_ << says << std::flush;
  std::string line;
  const bool read = static_cast<bool>(std::getline(in_, line));
  if (!read || !typed_) out_ << '\n' << std::flush;
  if (!read) return Error{.code = Code::stopped, .sentence = "the input ended"};
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  if (line == "q" || line == "Q") return Error{.code = Code::stopped, .sentence = "you ended it with q"};
  return line;
}

void TerminalParticipant::refuse(const std::string& why) { out_ << visible_lines(why) << '\n' << std::flush; }
void TerminalParticipant::tell(const std::string& what) { out_ << visible_lines(what) << '\n' << std::flush; }

}  // namespace wale
