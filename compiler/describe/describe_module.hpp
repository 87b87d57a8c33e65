#pragma once

#include <string>
#include <vector>

#include "compiler/expression/checked.hpp"
#include "compiler/text/source.hpp"

namespace wale {

/// An argument of a function that a file offers.
struct DescribedArgument {
  std::string name;
  std::string dimension;      ///< as declared, "length"; empty where any will do
  std::string default_value;  ///< as written, "2.5 mm"; empty where it must be given
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
  std::string dimension;  ///< "length", or its units where it has no name
  double in_si = 1;
  std::string si_unit;  ///< "m"; empty for a plain number
  std::string documentation;
};

struct DescribedDimension {
  std::string name;
  std::string factors;  ///< "kg m^2 s^-2"
};

/// What a file offers to those that import it, each kind in the order written.
struct ModuleDescription {
  std::string file;
  std::vector<DescribedFunction> functions;
  std::vector<DescribedConstant> constants;
  std::vector<DescribedUnit> units;
  std::vector<DescribedDimension> dimensions;

  bool empty() const { return functions.empty() && constants.empty() && units.empty() && dimensions.empty(); }
};

/// Describes what the file itself exports; of the files that every file knows, all that they declare. Materials are
/// `describe`'s. The module has been checked without errors.
ModuleDescription describe_module(const CheckedModule& module, const SourceSet& sources);

/// As people read it.
std::string module_text(const ModuleDescription& description);
/// An object with an array for each kind.
std::string module_json(const ModuleDescription& description);

}  // namespace wale
