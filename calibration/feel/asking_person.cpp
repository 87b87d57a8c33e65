#include "calibration/feel/asking_person.hpp"

#include <fmt/format.h>

#include <istream>
#include <ostream>

#include "compiler/typed_number.hpp"

namespace wale {

void AskingPerson::introduce(bool is_a) {
  out_ << fmt::format("{} is {}; feel it now\n", is_a ? 'A' : 'B', is_a ? a_ : b_) << std::flush;
}

void AskingPerson::begin(int trial, int interval) {
  if (interval == 1) out_ << fmt::format("trial {} of {}: the first", trial, trials_);
  if (interval == 2) out_ << " ... the second\n";
  out_ << std::flush;
}

Result<int> AskingPerson::answer(int) {
  for (std::string line;;) {
    out_ << fmt::format("which of the two was A ({})? 1 or 2, q to stop: ", a_) << std::flush;
    const bool read = static_cast<bool>(std::getline(in_, line));
    if (!read || !typed_) out_ << '\n';
    if (!read) return Error{Code::stopped, "the input ended"};
    const auto begin = line.find_first_not_of(" \t\r"), end = line.find_last_not_of(" \t\r");
    const std::string word = begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
    if (word == "1" || word == "2") return word[0] - '0';
    if (word == "q" || word == "Q") return Error{Code::stopped, "you ended it with q"};
    out_ << fmt::format("expected 1, 2 or q, {}\n", found_typed(word));
  }
}

void AskingPerson::learn(int, bool right) { out_ << (right ? "right\n" : "wrong\n") << std::flush; }

}  // namespace wale
