#pragma once

#include <string>
#include <vector>

#include "wale/program.hpp"

namespace wale {

struct Declarations;

/// Where in a parameter's range a percept's fate is another than it is now, the other parameters as they are.
struct FateChange {
  std::string parameter;
  double value = 0;  ///< in the parameter's own unit
  std::string unit;
  bool above = false;  ///< so above the value; otherwise below it
  Fate fate = Fate::kept;
};

/// What becomes of something at given parameters.
struct DescribedFate {
  FateRecord record;                ///< as the program has it, but for `fate`, `asked`, `given` and `reason`
  std::vector<FateChange> changes;  ///< in the order of the parameters, below before above
};

/// What becomes of each thing at a bank's parameters. The program's own record is of the defaults; of a percept that
/// was solved its setup code tells how large it is at others, and its map what level that is. What the device cuts of a
/// carrier that is no force is told by the declaration of its percept, which a program does not hold: without
/// declarations it is not.
std::vector<DescribedFate> fates_at(const Bank& bank, const Declarations* declarations);

/// "; saturated above roughness 0.82", for each change.
std::string changes_text(const DescribedFate& fate);

}  // namespace wale
