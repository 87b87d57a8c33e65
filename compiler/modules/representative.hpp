#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// The settings of a representative block, `like` among them.
const std::vector<std::string>& representative_settings();
bool is_representative_setting(std::string_view key);

/// A setting as programs and catalogues keep it: ("called de", {"Cord", "Kord"}).
struct RepresentativeEntry {
  std::string key;  ///< with the language, if there is one
  std::vector<std::string> values;
};

/// Reads `called de "Cord"`, `kind fabric.woven`, `replaces old_name`, `source "…", "…"`. Reports what is no text, or no
/// word, where one must stand, and what is no language.
RepresentativeEntry representative_entry(const Setting& setting, const SyntaxTree& tree, Diagnostics& diagnostics);

/// ISO 639: two or three small letters.
bool is_language(std::string_view word);

/// The language of `called de "Cord"`; empty if none is named: then the words are English.
std::string_view language_of(const Setting& setting);

}  // namespace wale
