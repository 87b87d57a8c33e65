// Reads the rules of schema/wale.grammar, and converts a Wale file to the terminals of these rules.

#include <regex>
#include <sstream>
#include <stdexcept>

#include "compiler/parse/lex.hpp"
#include "tests/language/grammar.hpp"

class Grammar::Reader {
 public:
  explicit Reader(const std::string& body) : body_(body) {}

  Node choice() {
    Node node{Node::Kind::choice, {}, {sequence()}};
    while (take("|")) node.parts.push_back(sequence());
    return node.parts.size() == 1 ? Node(node.parts[0]) : node;
  }
  bool at_end() { return peek().empty(); }

 private:
  Node sequence() {
    Node node{Node::Kind::sequence, {}, {}};
    for (std::string next = peek(); !next.empty() && next != "|" && next != ")" && next != "]" && next != "}";
         next = peek())
      node.parts.push_back(factor());
    return node.parts.size() == 1 ? Node(node.parts[0]) : node;
  }

  Node factor() {
    if (take("(")) return closed(choice(), ")");
    if (take("[")) return {Node::Kind::optional, {}, {closed(choice(), "]")}};
    if (take("{")) return {Node::Kind::repetition, {}, {closed(choice(), "}")}};
    const std::string token = peek();
    at_ += token.size();
    if (token[0] == '\'' || token[0] == '"') return {Node::Kind::word, token.substr(1, token.size() - 2), {}};
    if (token[0] == '<') {
      const auto quote = token.find('\'');
      return {Node::Kind::before, quote == std::string::npos ? "" : token.substr(quote + 1, 1), {}};
    }
    return {std::isupper(token[0]) ? Node::Kind::terminal : Node::Kind::rule, token, {}};
  }

  Node closed(Node node, const std::string& bracket) {
    if (!take(bracket)) throw std::runtime_error("wale.grammar: expected " + bracket + " in " + body_);
    return node;
  }

  std::string peek() {
    while (at_ < body_.size() && std::isspace(static_cast<unsigned char>(body_[at_]))) ++at_;
    if (at_ == body_.size()) return "";
    const char c = body_[at_];
    if (c == '\'' || c == '"' || c == '<') {
      const auto close = body_.find(c == '<' ? '>' : c, at_ + 1);
      if (close == std::string::npos) throw std::runtime_error("wale.grammar: expected a closing " + std::string(1, c));
      return body_.substr(at_, close - at_ + 1);
    }
    if (std::string("()[]{}|").find(c) != std::string::npos) return std::string(1, c);
    std::size_t end = at_;
    while (end < body_.size() && (std::isalnum(static_cast<unsigned char>(body_[end])) || body_[end] == '_')) ++end;
    if (end == at_) throw std::runtime_error("wale.grammar: unexpected character `" + std::string(1, c) + "`");
    return body_.substr(at_, end - at_);
  }

  bool take(const std::string& token) {
    if (peek() != token) return false;
    at_ += token.size();
    return true;
  }

  std::string body_;
  std::size_t at_ = 0;
};

namespace {

/// A line without its comment; quotes may hold slashes.
std::string without_comment(const std::string& line) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (quote == 0 && line.compare(i, 2, "//") == 0) return line.substr(0, i);
    if (quote == 0 && (line[i] == '\'' || line[i] == '"'))
      quote = line[i];
    else if (line[i] == quote)
      quote = 0;
  }
  return line;
}

std::set<std::string> words_in(const std::string& text) {
  std::set<std::string> words;
  std::istringstream stream(std::regex_replace(text, std::regex("[`\n]"), " "));
  for (std::string word; stream >> word;) words.insert(word);
  return words;
}

/// The words that a sentence of the prose lists: its first group.
std::set<std::string> listed(const std::string& prose, const std::string& pattern) {
  std::smatch match;
  if (!std::regex_search(prose, match, std::regex(pattern)))
    throw std::runtime_error("wale.grammar has no sentence like: " + pattern);
  return words_in(match[1]);
}

}  // namespace

Grammar::Grammar(const std::string& text) {
  std::map<std::string, std::string> bodies;
  std::string prose, current;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("//")) prose += line.substr(2) + " ";
    const std::string rule = without_comment(line);
    static const std::regex heading("^([A-Za-z_]+) *= (.*)$");
    std::smatch match;
    if (std::regex_match(rule, match, heading)) {
      current = match[1];
      if (bodies.count(current) > 0) throw std::runtime_error("wale.grammar has two rules " + current);
      bodies[current] = match[2];
    } else if (!current.empty()) {
      bodies[current] += " " + rule;
    }
  }
  // Rules in capitals are tokens, which the lexer reads.
  for (const auto& [name, body] : bodies) {
    if (std::isupper(static_cast<unsigned char>(name[0]))) continue;
    Reader reader(body);
    rules_.emplace(name, reader.choice());
    if (!reader.at_end()) throw std::runtime_error("wale.grammar: too many brackets in " + body);
  }
  continuing_ = listed(prose, "Newlines are white space.* and behind (.*?)\\. Empty statements");
  evidence_ = listed(std::regex_replace(prose, std::regex(" and |,"), " "),
                     "In a setting the words ((?:\\w+\\s+)+)are never units");
  reserved_ = listed(prose, "Reserved words: ((?:\\w+ )+)");
  for (const char* needed : {"file", "suffix", "value", "item", "setting", "percept", "end"})
    if (rules_.count(needed) == 0) throw std::runtime_error("wale.grammar has no rule " + std::string(needed));
}

std::set<std::string> Grammar::words() const {
  std::set<std::string> words = reserved_;
  words.insert(evidence_.begin(), evidence_.end());
  std::vector<const Node*> open;
  for (const auto& [name, node] : rules_) open.push_back(&node);
  while (!open.empty()) {
    const Node* node = open.back();
    open.pop_back();
    if (node->kind == Node::Kind::word) words.insert(node->text);
    for (const Node& part : node->parts) open.push_back(&part);
  }
  return words;
}

/// False when the text has lexical errors.
bool Grammar::terminals_of(const std::string& text, Terminals& terminals) const {
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  const auto source = sources.add("text", text);
  const wale::Tokens tokens = lex(sources, source, diagnostics);
  if (diagnostics.has_errors()) return false;
  std::size_t parentheses = 0;
  for (const wale::Token& token : tokens.tokens) {
    std::string spelling = text.substr(token.begin, token.end - token.begin);
    if (spelling == "+-") spelling = "±";
    const std::string previous = terminals.empty() ? ";" : terminals.back().kind;
    // "Newlines are white space inside ( ), before `then` and `else`, and behind …"; "A '{' may stand in the line below
    // its heading"; "Empty statements are nothing"; "A section or a record needs no end behind its '}'".
    const bool nothing_here = previous == "{" || previous == "}" || previous == ";" || previous == "NEWLINE";
    const bool white_space = parentheses > 0 || spelling == "then" || spelling == "else" || spelling == "{" ||
                             continuing_.count(previous) > 0;
    if (token.starts_line && !nothing_here && !white_space && token.kind != wale::TokenKind::end)
      terminals.push_back({"NEWLINE", ""});
    switch (token.kind) {
      case wale::TokenKind::end: terminals.push_back({"", ""}); break;
      case wale::TokenKind::name: terminals.push_back({"DOTTED", spelling}); break;
      case wale::TokenKind::number: terminals.push_back({"NUMBER", spelling}); break;
      case wale::TokenKind::text: terminals.push_back({"TEXT", spelling}); break;
      case wale::TokenKind::semicolon:
        if (nothing_here || terminals.back().kind == "NEWLINE") break;
        [[fallthrough]];
      default: terminals.push_back({spelling, spelling});
    }
    if (spelling == "(") ++parentheses;
    if (spelling == ")" && parentheses > 0) --parentheses;
  }
  return true;
}
