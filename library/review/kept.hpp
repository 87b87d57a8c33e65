#pragma once

#include <map>
#include <optional>
#include <string>

#include "library/review/facts.hpp"
#include "wale/result.hpp"

namespace wale {

/// What a review has found out of files in which it found nothing wrong, so that the next one compiles only what has
/// changed. Only a build of Wale with the same compiler, maps and devices uses it.
struct KeptReview {
  struct File {
    std::string hash;  ///< of all that its facts rest on (`hash_of`)
    FileFacts facts;
  };
  std::map<std::string, File> reviewed;    ///< by path
  std::map<std::string, File> neighbours;  ///< of the library, by the name they are opened by; with cues alone

  /// The facts of a file, if nothing that they rest on has changed; otherwise null.
  static const FileFacts* unchanged(const std::map<std::string, File>& among, const std::string& path);
};

/// The hash of a file, of all that was looked for when it was compiled, and of this build of Wale.
std::string hash_of(const std::string& path, const FileFacts& facts);

/// Reads what `kept_text` wrote. A text of another build of Wale gives nothing, without an error. Errors: W0506 for
/// other texts, W0501; the place has `path`.
Result<KeptReview> read_kept(const std::string& path);
std::string kept_text(const KeptReview& kept);

}  // namespace wale
