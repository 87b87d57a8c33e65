#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

/// The rules of schema/wale.grammar. They make random sentences and recognise texts. Only the lexer is shared with the
/// compiler.
///
/// Rules that the grammar states in prose are implemented here, and each place quotes its sentence.
class Grammar {
 public:
  /// Throws std::runtime_error where the text does not follow the notation.
  explicit Grammar(const std::string& text);

  /// Whether the text has no syntax error.
  bool recognises(const std::string& text) const;

  /// A random file with random white space. It is longer with more `effort`, and about one in three breaks a rule that
  /// the grammar states in prose. `comments` receives its comments in order.
  std::string sentence(std::mt19937& random, int effort, std::vector<std::string>* comments = nullptr) const;

  /// All words in quotes, for a fuzzer's dictionary.
  std::set<std::string> words() const;

 private:
  struct Node {
    enum class Kind : std::uint8_t { word, terminal, rule, sequence, choice, optional, repetition, before };
    Kind kind;
    std::string text;         ///< of a word, terminal, rule or `before`
    std::vector<Node> parts;  ///< of the other kinds
  };
  struct Terminal {
    std::string kind;  ///< DOTTED (perhaps a NAME), NUMBER, TEXT, NEWLINE, or the word itself
    std::string text;
  };
  using Terminals = std::vector<Terminal>;
  class Reader;
  class Recogniser;
  class Maker;

  bool terminals_of(const std::string& text, Terminals& terminals) const;

  std::map<std::string, Node> rules_;
  std::set<std::string> continuing_;  ///< a line that ends in one of these continues in the next
  std::set<std::string> evidence_;    ///< words that are never units in a setting
  std::set<std::string> reserved_;
};
