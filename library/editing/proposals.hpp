#pragma once

#include "compiler/declarations/declarations.hpp"
#include "compiler/modules/library_index.hpp"
#include "wale/language_service.hpp"

namespace wale {

/// What may stand at byte `at` of a text, by the words before it. `known` are the names that the text may use.
Proposals proposals_at(std::string_view text, std::size_t at, const Declarations& known, const LibraryIndex& index);

/// The words that begin a statement directly inside a block: "" for the file, "physical", "perceptual",
/// "representative", "workspace", "placing" (of a patch in a workspace); empty for another block.
const std::vector<std::string_view>& words_of_block(std::string_view block);

/// Whether a word begins a statement or a block of the language somewhere.
bool is_statement_word(std::string_view word);

}  // namespace wale
