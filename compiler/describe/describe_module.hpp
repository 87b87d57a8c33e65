#pragma once

#include <string>
#include <vector>

#include "compiler/expression/checked.hpp"
#include "compiler/text/source.hpp"

namespace wale {

/// An argument of a function that a file exports.
struct DescribedArgument {
  std::string name;
  std::string dimension;      ///< as declared, "length"; empty if any dimension is accepted
  std::string default_value;  ///< as written, "2.5 mm"; empty if the argument must be given
};

struct DescribedFunction {
  std::string name;
  std::vector<DescribedArgument> arguments;
  std::string documentation;
};

struct DescribedConstant {
  std::string name;
  std::string value;  ///< as written
  std::string documentation;
};

struct DescribedUnit {
  std::string name;
  std::string dimension;  ///< "length", or its units if it has no name
  double in_si = 1;
  std::string si_unit;  ///< "m"; empty for a plain number
  std::string documentation;
};

struct DescribedDimension {
  std::string name;
  std::string factors;  ///< "kg m^2 s^-2"
};

/// A device, a map, a percept and so on.
struct DescribedRecord {
  std::string what;  ///< the word that declares it: "device"
  std::string name;
};

/// The exports of a file, each kind in the order written.
struct ModuleDescription {
  std::string file;
  std::vector<DescribedFunction> functions;
  std::vector<DescribedConstant> constants;
  std::vector<DescribedUnit> units;
  std::vector<DescribedDimension> dimensions;
  std::vector<DescribedRecord> records;
  bool known_everywhere = false;  ///< every file knows it; its records are not listed

  bool empty() const {
    return functions.empty() && constants.empty() && units.empty() && dimensions.empty() && records.empty();
  }
};

/// Describes the exports of a file; for a file that every file knows, all its declarations. Materials are described by
/// `describe`. The module must have been checked without errors.
ModuleDescription describe_module(const CheckedModule& module, const SourceSet& sources);

/// The description as text for people.
std::string module_text(const ModuleDescription& description);
/// JSON: an object with an array for each kind.
std::string module_json(const ModuleDescription& description);

}  // namespace wale
