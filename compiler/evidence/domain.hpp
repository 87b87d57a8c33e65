#pragma once

#include <string>

#include "compiler/read/cues.hpp"

namespace wale {

/// Whether a stimulus is one of those that a map was measured with.
struct DomainJudgement {
  bool inside = true;
  std::string why;  ///< "a photograph, measured with gratings; beside friction, measured alone"; empty if inside
};

/// Compares a program with the domain of a record. `size` is that of the percept's carrier.
DomainJudgement judge_domain(const PerceptRecord& record, double size, const Bank& bank, const ForceReading& found);

}  // namespace wale
