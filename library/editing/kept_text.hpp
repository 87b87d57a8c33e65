#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wale/language_service.hpp"

namespace wale {

/// A setting of a patch as the standard style has it: its key, and the whole line.
using SettingLines = std::vector<std::pair<std::string, std::string>>;

/// A patch of a workspace in the text that it was read from.
struct WrittenPatch {
  /// A part of the statement that can be written anew alone.
  struct Part {
    std::string key;   ///< "name", "made_of", or that of a setting
    std::string says;  ///< in the standard style; empty for a setting that needs not be written
    std::size_t begin = 0, end = 0;  ///< bytes of `text`
  };
  std::string lead;  ///< white space and comments before the statement
  std::string text;  ///< the statement, with the comment behind it on its line
  std::vector<Part> parts;
  SettingLines settings;    ///< what they said
  std::size_t end = 0;      ///< bytes of `text`: where the statement ends
  bool has_braces = false;
  std::string before, inside, verbatim;  ///< those of the patch
};

/// A workspace in the text that it was read from.
struct WrittenLayout {
  std::string head, rest;  ///< up to its `{`, and behind the last statement, with its `}`
  std::string name, documentation, trailing;
  std::vector<std::shared_ptr<const WrittenPatch>> patches;
};

/// The text of a patch in which only that is changed which the patch says otherwise now, with what stands before it;
/// nothing if it has to be written anew. `settings` are those of the patch now.
std::string edited(const WrittenPatch& written, const LaidOutPatch& patch, const SettingLines& settings);

/// Whether a piece of text begins on a line of its own.
bool begins_a_line(std::string_view piece);

}  // namespace wale
