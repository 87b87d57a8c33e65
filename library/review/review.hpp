#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/text/resolver.hpp"
#include "library/review/facts.hpp"
#include "library/review/kept.hpp"
#include "wale/result.hpp"

namespace wale {

/// What a reviewer wants to know of one material.
struct ReviewedMaterial {
  std::string name, title, kind;
  std::string licence;  ///< its own or its library's; empty without one
  MaterialFacts facts;
  std::string nearest;  ///< the material of its kind, of those reviewed and of the library, that is least apart
  /// How far that is, in just noticeable differences of the cue that differs most; not a number if no known cue differs.
  double apart = 0;
  std::string nearest_kind;  ///< of a kind that no other material has: the kind of others that may be meant; mostly empty
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
  std::size_t unchanged = 0;  ///< files that were not compiled, since nothing that they rest on has changed
  KeptReview kept;            ///< for the next review

  /// Whether a library can take all of them in: they have no error.
  bool accepted() const { return errors == 0; }
};

struct ReviewRequest {
  std::vector<std::string> paths;  ///< of files, and of folders with all their `.wale` files
  std::vector<std::string> roots;  ///< the last folders that are searched for imports
  Sandbox sandbox = Sandbox::required;
  const KeptReview* since = nullptr;  ///< an earlier review; null to compile everything
};

/// Reviews files as a contribution to the library that they lie in (the nearest folder above with a `wale.project`) or
/// else to the shipped one: that each compiles for a device of every class, has three layers, names, sources, a licence
/// and how well each level is known; that it reads as it asks, can be drawn and is held by device and hand; that no other
/// material has its name or is called the same, and none of its kind feels the same; that it lies in the folder of its
/// kind, in the standard style. In folders that the library says are apart (`LibraryProject`), names, sources, levels,
/// kinds and what feels the same are not asked for. Uses all cores; the result does not depend on how many there are. Errors: those of
/// `contribution_of` and `read_facts`, W0801 for a `wale.project` that is none.
Result<Review> review(const ReviewRequest& request);

/// Whether a code is about what a library takes in, W09xx, and not about the language.
bool is_of_library(Code code);

/// For a reviewer, what a minute is enough for: what a library misses, W09xx, at most sixty lines; a line for each
/// material, at most forty, or else for each in which something was found, and one for each kind; and whether all are
/// accepted.
std::string review_text(const Review& review);
std::string review_json(const Review& review);

}  // namespace wale
