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
/// documentation (W0901 to W0903). `material.licence` is that of the library before.
MaterialWords tell_words(ReviewedMaterial& material, const MaterialDecl& node, const SyntaxTree& tree,
                         Diagnostics& diagnostics);

/// Reports what a library lacks of the other two layers (W0901), and levels that nobody has felt (W0915).
void tell_layers(const MaterialDecl& node, const CheckedMaterial& checked, const Declarations& declarations,
                 Diagnostics& diagnostics);

/// Reports a file of a library that lies in another folder than that of its kind (W0906). `library` is the library's
/// folder, empty for none.
void tell_folder(const std::string& file, const ReviewedMaterial& material, Span span, const std::string& library,
                 Diagnostics& diagnostics);

/// The first word of a kind: "fabric" of "fabric.woven".
std::string branch_of(std::string_view kind);

}  // namespace wale
