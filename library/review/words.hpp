#pragma once

#include <string>
#include <utility>
#include <vector>

#include "compiler/expression/checked.hpp"
#include "compiler/parse/syntax_tree.hpp"
#include "library/review/review.hpp"

namespace wale {

/// The words by which people and programs look for a material.
struct MaterialWords {
  std::vector<std::string> replaces;
  std::vector<std::string> names;  ///< title and other names, in all languages, as written
};

/// Reads the representative block into `material` and reports what a library lacks of it: names, kind, sources, licence,
/// documentation (W0901 to W0903), and names in another language that say nothing new (W0909). Of what `is_apart`, no
/// contribution, only the licence is asked for. `material.licence` is that of the library before.
MaterialWords tell_words(ReviewedMaterial& material, const MaterialDecl& node, const SyntaxTree& tree, bool is_apart,
                         Diagnostics& diagnostics);

/// Reports what a library lacks of the other two layers (W0901), and levels that nobody has felt (W0915). Of a material
/// that is not `whole`, since its text has an error, only what is not written at all is told as missing.
void tell_layers(const MaterialDecl& node, const CheckedMaterial& checked, const Declarations& declarations, bool whole,
                 Diagnostics& diagnostics);

/// Reports a file that lies in another folder of its library than that of its kind (W0906). `folder` is the one below the
/// library's, empty for none.
void tell_folder(const std::string& folder, const ReviewedMaterial& material, Span span, Diagnostics& diagnostics);

/// The first word of a kind: "fabric" of "fabric.woven".
std::string branch_of(std::string_view kind);

}  // namespace wale
