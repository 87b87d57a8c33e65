#pragma once

#include <string>
#include <vector>

#include "calibration/experiment/felt_size.hpp"
#include "calibration/experiment/trial_session.hpp"

namespace wale {

/// What a participant is asked.
struct Question {
  enum class Kind {
    page,     ///< instructions: any answer goes on
    consent,  ///< yes or no
    trial,    ///< `asked` about `trial`
    closing,  ///< `asked` after the last trial
    sort,     ///< the next command of a sort
    adjust,   ///< the next command of an adjustment
    rest,     ///< a break of `seconds`: any answer goes on
  };
  Kind kind = Kind::page;
  std::string says;
  const Asked* asked = nullptr;
  const Trial* trial = nullptr;
  const Sort* sort = nullptr;
  double seconds = 0;
};

/// Who feels and answers: a person at a terminal, or a planted observer. All calls come from one thread.
class Participant {
 public:
  virtual ~Participant() = default;
  /// An interval of a trial comes next: `interval` of `intervals`, from 1, trial `trial` of about `of` (0: not known).
  virtual void begin(const Trial& trial, std::size_t of, int interval, int intervals) = 0;
  /// It is over. `felt` is what it did to the hand.
  virtual void felt(const Presented& presented, const FeltSize& felt) = 0;
  /// The answer as typed. An error ends the session, which may go on later: W0706.
  virtual Result<std::string> say(const Question& question) = 0;
  /// An answer cannot be taken, and is asked for again.
  virtual void refuse(const std::string& why) = 0;
  /// Something to know, which needs no answer.
  virtual void tell(const std::string& what) = 0;
};

}  // namespace wale
