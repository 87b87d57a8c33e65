#pragma once

#include <iosfwd>

#include "calibration/experiment/participant.hpp"

namespace wale {

/// Asks in lines of text. `q` and the end of the input end the session: W0706.
class TerminalParticipant final : public Participant {
 public:
  /// `typed`: a person types, so the screen already shows the line ends; otherwise `out` gets line ends.
  TerminalParticipant(std::istream& in, std::ostream& out, bool typed) : in_(in), out_(out), typed_(typed) {}

  void begin(const Trial& trial, std::size_t of, int interval, int intervals) override;
  void felt(const Presented& presented, const FeltSize& felt) override;
  Result<std::string> say(const Question& question) override;
  void refuse(const std::string& why) override;
  void tell(const std::string& what) override;

 private:
  std::istream& in_;
  std::ostream& out_;
  bool typed_;
};

}  // namespace wale
