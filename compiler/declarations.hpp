#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/dimension.hpp"
#include "compiler/syntax_tree.hpp"
#include "compiler/term.hpp"
#include "schema/device_profile.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// Where a declaration's syntax stands: its expressions are read in `tree`.
template <typename Node>
struct Declared {
  const SyntaxTree* tree = nullptr;
  const Node* node = nullptr;
};

struct Unit {
  double factor = 1;  ///< in SI
  Dimension dimension;
};

/// A percept's scale: level 1 is the magnitude of a carrier of size `one` by any map tied to it.
struct Percept {
  std::string name;
  std::string carrier;  ///< "lateral amplitude": the argument `amplitude` of the function `lateral`
  Dimension carrier_dimension;
  double one = 0;                ///< the carrier's size at level 1, SI
  std::string reference_device;  ///< on which the reference stimulus was felt
  double near_threshold = 0;     ///< level below which the percept is near or below threshold
  std::string documentation;
  Span span;
};

/// A psychophysical map: an equation between a percept's magnitude and a carrier's size, and what is known of it.
struct Map {
  std::string percept;
  std::string from;  ///< the carrier's name in the law, "amplitude"
  Terms terms;       ///< of the law, in `magnitude` and `carrier`
  TermId left = 0, right = 0;
  double valid_low = 0, valid_high = 0;  ///< of the carrier's size, SI
  double scatter = 0;
  Evidence slope = Evidence::estimated, anchor = Evidence::estimated, handle = Evidence::estimated;
  std::string device;
  std::string source;
  std::vector<std::string> validity;  ///< the conditions as written, "period 0.7 mm .. 10 mm"
  Span span;
};

struct DeviceDeclaration {
  DeviceProfile profile;
  std::string source;
  std::string documentation;
  std::vector<std::string> assumed;                                     ///< settings that nobody measured
  std::map<std::string, std::pair<const SyntaxTree*, ExprId>> realise;  ///< a force for a percept alone
  Span span;
};

/// Named levels of one percept, in the order written.
struct Levels {
  struct Level {
    std::string name;
    double value;
    Span span;
  };
  std::string percept;
  std::vector<Level> levels;
  Span span;
};

/// A simulated hand and how it explores; SI units.
struct HandDeclaration {
  std::string name;
  double mass = 0, damping = 0, stiffness = 0;
  double lateral_amplitude = 0, lateral_frequency = 0;
  double circular_radius = 0, circular_frequency = 0;
  std::string source;
  Span span;
};

/// Everything that a file may refer to by name: what the embedded files, its imports and it itself declare.
struct Declarations {
  DimensionNames names;
  std::map<std::string, Dimension> dimensions;
  std::map<std::string, Unit> units;
  std::map<std::string, Declared<Constant>> constants;
  std::map<std::string, Declared<FunctionDecl>> functions;
  std::map<std::string, Percept> percepts;
  std::vector<Map> maps;
  std::map<std::string, DeviceDeclaration> devices;
  std::vector<Levels> levels;
  std::map<std::string, HandDeclaration> hands;
  std::vector<Declared<MaterialDecl>> materials;  ///< of the file itself and its imports, in order

  /// The dimension of that name; a plain number if a broken schema/units.wale lacks it.
  Dimension dimension(const std::string& name) const {
    const auto found = dimensions.find(name);
    return found == dimensions.end() ? Dimension{} : found->second;
  }
};

}  // namespace wale
