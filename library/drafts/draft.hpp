#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/text/resolver.hpp"
#include "wale/result.hpp"
#include "wale/thesis_files.hpp"

namespace wale {

/// A material that was made of something measured, and that its author has yet to complete.
struct Draft {
  std::string name;
  std::string text;  ///< declarations, which stand behind `wale 1`
  std::vector<FileBeside> files = {};
  std::vector<std::string> assumed = {};  ///< what nobody has stated, in sentences
};

/// What a person states of files that do not say it. SI units; empty if not stated.
struct DraftOptions {
  std::optional<double> scale;      ///< m per pixel, or per number of a height map
  std::optional<double> height;     ///< m: from black to white of a picture
  std::optional<double> amplitude;  ///< N: the largest lateral force
  std::optional<double> size;       ///< m: the width of an array, the length of a wave
  std::optional<double> mass;       ///< kg: of the tool of an acceleration
  std::optional<double> unit;       ///< m: of the numbers of a height map
  std::vector<std::string> bad;     ///< words of a height map for values that were not measured
  double least = 0, most = 1;       ///< of ratings, for levels 0 and 1
  std::string licence;              ///< of what was measured; empty if not stated
  Sandbox sandbox = Sandbox::required;
};

/// A photograph or a scan: its luminance is height. Decoded once, without rights, to see that it can be. Errors: those
/// of `read_height_image`; W0801 without a scale.
Result<Draft> picture_draft(const std::string& path, const std::string& bytes, const std::string& name,
                            const DraftOptions& options);

/// A height map as plain text: a row of numbers per line, parted by blanks, commas or semicolons; `#` begins a comment.
/// Values that were not measured are filled from their neighbours. Errors: W0504 for a row of another length, a word that
/// is no number and not stated as bad, and for fewer than 4 by 4, with file and row; W0801 without unit and scale.
Result<Draft> height_map_draft(const std::string& path, const std::string& text, const std::string& name,
                               const DraftOptions& options);

/// An array or a wave of the thesis. Errors: those of `read_thesis_array` and `surface_in_wale`; W0801 for what its file
/// does not say.
Result<Draft> thesis_draft(const std::string& path, const std::string& bytes, const std::string& name,
                           const DraftOptions& options);

/// A model of the Penn Haptic Texture Toolkit, `Models_NAME.xml`: its friction, and the strongest waves of the
/// acceleration that it synthesises at the middle of its speeds and forces, as lateral forces on a tool of a mass that
/// nobody has stated. Its licence forbids to pass the draft on. Errors: W0504, with the line.
Result<Draft> texture_model_draft(const std::string& path, const std::string& text, const std::string& name,
                                  const DraftOptions& options);

/// Ratings: a line of names, the first for the material, the others percepts; then a line for each material. Several
/// lines of one material are averaged; empty cells are not rated. Errors: W0504 for rows of another length, cells that
/// are no numbers or outside `least` .. `most`, and percepts that `percepts` does not have, with file and row.
Result<std::vector<Draft>> rating_drafts(const std::string& path, const std::string& text,
                                         const std::vector<std::string>& percepts, const std::set<std::string>& taken,
                                         const DraftOptions& options);

/// The representative block of a draft: its title, and what was stated of its origin.
std::string draft_names(const std::string& title, const std::string& source, const std::string& licence);

/// The error at a row of a file: "row 3: …".
Error error_in_row(const std::string& path, std::size_t row, std::string sentence, std::string mend);

/// The error about an option that was not given.
Error missing_option(const char* option, std::string sentence, std::string mend);

}  // namespace wale
