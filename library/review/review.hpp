#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/read/cues.hpp"
#include "compiler/text/resolver.hpp"
#include "wale/result.hpp"

namespace wale {

/// A level that a reviewed material asks for.
struct ReviewedLevel {
  std::string percept;   ///< "roughness"
  double level = 0;      ///< 0 .. 1
  std::string evidence;  ///< "estimated"; empty if the author does not say how well it is known
};

/// What a reviewer wants to know of one material.
struct ReviewedMaterial {
  std::string name, title, kind;
  std::string licence;  ///< its own or its library's; empty without one
  std::vector<ReviewedLevel> levels;
  std::string nearest;  ///< the material of its kind, of those reviewed and of the library, that is least apart
  /// How far that is, in just noticeable differences of the cue that differs most; not a number if no known cue differs.
  double apart = 0;
};

/// One file of a review, with all that was found in it.
struct ReviewedFile {
  std::string file;
  SourceSet sources;
  Diagnostics diagnostics;  ///< of the language and of the library
  std::vector<ReviewedMaterial> materials;
};

struct Review {
  std::vector<ReviewedFile> files;  ///< in the order of their paths
  std::size_t errors = 0, warnings = 0, materials = 0;

  /// Whether a library can take all of them in: they have no error.
  bool accepted() const { return errors == 0; }
};

/// Reviews files, and all `.wale` files below folders, as a contribution to the library that they lie in (the nearest
/// folder above with a `wale.project`) or else to the shipped one: that each compiles, has three layers, names, sources,
/// a licence and how well each level is known; that no other material has its name and none of its kind feels the same;
/// that it lies in the folder of its kind, in the standard style. `roots` are the last folders that are searched for
/// imports. Uses all cores; the result does not depend on how many there are. Errors: W0501 for a path that cannot be
/// read, W0801 for a `wale.project` that is none, W0602 if there is no Wale file.
Result<Review> review(const std::vector<std::string>& paths, const std::vector<std::string>& roots, Sandbox sandbox);

/// For a reviewer: a line for each material behind what was found, and whether all are accepted.
std::string review_text(const Review& review);
std::string review_json(const Review& review);

}  // namespace wale
