#pragma once

#include <string>
#include <vector>

#include "compiler/read/read.hpp"
#include "wale/program.hpp"

namespace wale {

/// A value of a parameter at which a percept's fate changes while the other parameters keep their values.
struct FateChange {
  std::string parameter;
  double value = 0;  ///< in the parameter's own unit
  std::string unit;
  bool above = false;  ///< the fate holds above the value; otherwise below it
  Fate fate = Fate::kept;
};

/// The fate of a percept, or of a part of the physics, at given parameters.
struct DescribedFate {
  /// the program's record, with `fate`, `asked`, `given` and `reason` at these parameters
  FateRecord record;
  std::vector<FateChange> changes;  ///< in the order of the parameters, `below` before `above`
};

/// The fates of all percepts and of the physics at a bank's parameters. The program's records hold the fates for
/// the defaults. At other parameters, the setup code gives the size of a solved percept, and its map the level.
/// Whether the device limits a carrier that is not a force follows from the declaration of its percept. `found` is the
/// reading of the bank, as far as its percepts need it: what they read may be another level.
std::vector<DescribedFate> fates_at(const Bank& bank, const ForceReading& found, const Declarations& declarations);
/// The same; reads what it needs.
std::vector<DescribedFate> fates_at(const Bank& bank, const Declarations& declarations);

/// "saturated above roughness 0.82; lost below wale 1 mm": the changes in a line; empty without any.
std::string changes_text(const DescribedFate& fate);

}  // namespace wale
