#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace wale::command {

// The words of a command line, and what is said of those that make no sense.

/// How people write a verb: `library check` is declared as "library-check".
std::string spelt_verb(std::string name);
/// A text of CLI11's in which verbs of two words are spelt so.
std::string with_spelt_verbs(const CLI::App& app, std::string text);

/// The message for a misspelt verb or option at the beginning, which CLI11 would report as a missing verb. Returns
/// nullopt if the first word is a verb or a known option. `second` is the word after it, which may be empty.
std::optional<std::string> misspelt_verb(const CLI::App& app, const std::string& first, const std::string& second);

/// The words of the command line after the program's name. `--device=` becomes `--device` and an empty word, for an
/// option that takes a value: CLI11 would take the next option as its value.
std::vector<std::string> words_of(const CLI::App& app, int argc, char** argv);

/// The error in the words of a command, and where its options are listed.
std::string misuse_text(const CLI::App* app, const CLI::Error& error, const std::string& last_word);

}  // namespace wale::command
