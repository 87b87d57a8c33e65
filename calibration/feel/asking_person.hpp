#pragma once

#include <iosfwd>
#include <string>

#include "calibration/feel/blind_comparison.hpp"

namespace wale {

/// Asks in lines of text. Answers are 1 or 2; `q` and the end of the input end the session: W0706. After any other line
/// it asks again.
class AskingPerson final : public BlindPerson {
 public:
  /// `typed`: a person types the answers, so the screen already shows the line ends; otherwise `out` gets line ends.
  AskingPerson(std::istream& in, std::ostream& out, std::string a, std::string b, int trials, bool typed)
      : in_(in), out_(out), a_(std::move(a)), b_(std::move(b)), trials_(trials), typed_(typed) {}

  void introduce(bool is_a) override;
  void begin(int trial, int interval) override;
  Result<int> answer(int trial) override;
  void learn(int trial, bool right) override;

 private:
  std::istream& in_;
  std::ostream& out_;
  std::string a_, b_;
  int trials_;
  bool typed_;
};

}  // namespace wale
