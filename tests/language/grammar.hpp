#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

/// schema/wale.grammar as a machine reads it: its rules make random sentences and recognise texts. It shares the lexer
/// with the compiler, and nothing else.
///
/// What the rules leave to prose is applied here, each place naming the sentence it comes from.
class Grammar {
 public:
  /// Throws std::runtime_error where the file does not keep its own notation.
  explicit Grammar(const std::string& text);

  /// Whether the text has no syntax error.
  bool recognises(const std::string& text) const;

  /// A random file. Longer with more `effort`; about one in three breaks a rule that stands in prose only. The white
  /// space is as odd as the language allows. `comments` receives the comments it holds, in order.
  std::string sentence(std::mt19937& random, int effort, std::vector<std::string>* comments = nullptr) const;

  /// All words in quotes, for a fuzzer's dictionary.
  std::set<std::string> words() const;

 private:
  struct Node {
    enum class Kind : std::uint8_t { word, terminal, rule, sequence, choice, optional, repetition, before };
    Kind kind;
    std::string text;         ///< of a word, terminal, rule or what stands behind
    std::vector<Node> parts;  ///< of the others
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
  std::set<std::string> continuing_;  ///< a line that ends in one goes on in the next
  std::set<std::string> evidence_;    ///< no units in a setting
  std::set<std::string> reserved_;
};
