#pragma once

#include <string>
#include <vector>

#include "library/index/entry.hpp"
#include "wale/result.hpp"

namespace wale {

/// All materials below some paths.
struct Survey {
  std::vector<Entry> entries;  ///< in the order of their files; one with an error has `trouble` and no program
  std::vector<Error> unread;   ///< files that could not be opened, and texts in which no material can be read
  /// The files that all this rests on and that are there: of the materials, what they import, pictures. Nothing may be
  /// written over them.
  std::vector<std::string> read = {};
};

/// What a survey reads of each program.
enum class SurveyDepth {
  programs,  ///< nothing: it is only compiled
  feel,      ///< percepts and cues
};

/// Compiles all materials of files and of folders with all their `.wale` files, on all cores; the result does not depend
/// on how many there are. Without paths it is the current folder, or, if that has no Wale file, the shipped library.
/// `request.file` counts for nothing. Errors: those of `contribution_of`.
Result<Survey> survey(const std::vector<std::string>& paths, const FileRequest& request, SurveyDepth depth);

}  // namespace wale
