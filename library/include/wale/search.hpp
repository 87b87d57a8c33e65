#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// A level of a percept that is sought, or a range of levels.
struct PerceptRange {
  std::string percept;       ///< "roughness", or the other end of its scale, "smoothness"
  double low = 0, high = 0;  ///< 0 .. 1; equal: materials near this level; otherwise only those that read within
};

/// What is sought among the materials of a library. All conditions must hold.
struct SearchOptions {
  std::string kind = {};                    ///< "fabric", which has "fabric.woven" too; empty: any
  std::vector<PerceptRange> percepts = {};  ///< levels that the programs read as; empty: any
  /// A material that the others are to feel like, by its name or a Wale file of one's own ("my.wale"); empty: any.
  std::string near = {};
  std::size_t most = 0;     ///< so many are given; 0: of `search` by feel and `nearest` 20, of `between` 10, by words all
  std::string device = {};  ///< on which they are compared, by its profile; empty: `default_device`, or that of the named index
  /// Told while the library is read for its index, which the first search by feel of a library needs and which takes from
  /// seconds to minutes: how many files are read, of how many. It returns whether to go on. Called by other threads,
  /// one at a time; it does not call the library. What it throws ends the search, which throws it then.
  std::function<bool(std::size_t done, std::size_t all)> progress = {};
};

/// How much two materials differ to the hand, in just noticeable differences at d' = 1. What is not known widens it.
struct FeltDistance {
  double low = 0;                         ///< the largest difference that is known
  double high = 0;                        ///< infinite if nothing bounds it
  std::vector<std::string> unknown = {};  ///< the cues or percepts that widen it: "friction"
  std::string plainest = {};              ///< the cue or percept that differs most; empty if none differs
};

/// A material that was found. `module + ":" + name` is a name by which `Library::find` compiles it.
struct Match {
  std::string name;    ///< "corduroy"
  std::string module;  ///< the file that declares it, as an import names it: "fabric.corduroy"
  std::string file;    ///< its path, "library/fabric/corduroy.wale"; shipped ones are in the binary
  std::string title;   ///< may be empty
  std::string kind;    ///< "fabric.woven"; may be empty
  /// Where it has the sought words, "name", "replaces", "title", "called", "kind", "feels" or "documentation", and its
  /// text there. Both are empty if no words were sought.
  std::string found_by, found_in;
  /// Of its words, by BM25; the greater the better. 0 if it has all of them as they stand: then the place orders.
  double score = 0;
  /// By feel: from what was sought; of `between`, from the first of the two materials.
  std::optional<FeltDistance> distance = {};
  std::optional<FeltDistance> from_other = {};  ///< of `between`: from the second
};

/// What a search found.
struct SearchResult {
  /// The best first; empty if there is none. By feel, the least that they can differ by orders them (`low`, of `between`
  /// to both), where each cue that is unknown counts as one difference more.
  std::vector<Match> matches;
  /// What the owner should know: `newer_file` if the named index is of another build of Wale, whose maps may give other
  /// levels; `unwritable_file` if no index can be kept, so that the library is read again by each process; by words,
  /// `unknown_name` if nothing was found: why, and a word that was perhaps meant.
  std::vector<Error> warnings = {};
};

}  // namespace wale
