// Recognises files by the rules of the grammar: tries every derivation of every rule at every place, and stores
// results.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>

#include "tests/language/grammar.hpp"

class Grammar::Recogniser {
 public:
  Recogniser(const Grammar& grammar, const Terminals& input) : grammar_(grammar), input_(input) {}

  bool run() {
    for (const std::size_t end : read_rule("file", 0, {}))
      if (input_[end].kind.empty()) return true;
    return false;
  }

 private:
  using Ends = std::set<std::size_t>;
  struct Context {
    bool setting = false, force = false, suffix = false;
  };

  bool is(std::size_t at, const std::string& kind) const { return at < input_.size() && input_[at].kind == kind; }

  Ends read_rule(const std::string& name, std::size_t at, Context context) {
    context.setting = context.setting || name == "setting" || name == "percept";
    context.force = context.force || name == "force";
    const auto key = std::make_tuple(name, at, context.setting, context.force);
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    Ends ends;
    if ((name == "setting" || name == "percept") && begins_declaration(at)) {
      // "No statement in a block begins as a declaration does, with `material NAME =` or `function NAME (`."
    } else if (name == "placement" && is(at, "DOTTED") && input_[at].text == "patch" && matches("NAME", at + 1, {}) &&
               is(at + 2, "=")) {
      // "No placement begins as a patch does, with `patch NAME =`."
    } else if (name == "suffix") {
      ends = read_suffix(at, context);
    } else if (name == "value" && is(at, "DOTTED") && !begins_value(at + 1)) {
      // "A name in an item is a word of its own unless `(`, `*`, `/`, `^` or `..` follows: then it begins the value."
    } else if (name == "percept" && is(at, "DOTTED") && input_[at].text == "essential" && is(at + 1, "DOTTED")) {
      // "`essential` before a name is that word": it may not be left out then and read as a percept's name.
      Node rest = grammar_.rules_.at(name);
      rest.parts.erase(rest.parts.begin());
      ends = read(rest, at + 1, context);
    } else {
      ends = read(grammar_.rules_.at(name), at, context);
    }
    return known_[key] = ends;
  }

  bool begins_declaration(std::size_t at) const {
    if (!is(at, "DOTTED") || !is(at + 1, "DOTTED")) return false;
    return (input_[at].text == "material" && is(at + 2, "=")) || (input_[at].text == "function" && is(at + 2, "("));
  }

  bool begins_value(std::size_t at) const {
    return is(at, "(") || is(at, "*") || is(at, "/") || is(at, "^") || is(at, "..");
  }

  /// "The names behind a number, as many as there are": the longest suffix is read.
  Ends read_suffix(std::size_t at, Context context) {
    const Node& factor = grammar_.rules_.at("suffix").parts.at(0);
    context.suffix = true;
    for (;;) {
      Ends ends = read(factor, at, context);
      // A power belongs to the name before it; otherwise the name is not part of the suffix.
      std::erase_if(ends, [&](std::size_t end) {
        return end == at || (is(end, "^") && (is(end - 1, "DOTTED") || is(end - 1, "%")));
      });
      if (ends.empty()) return {at};
      at = *ends.rbegin();
    }
  }

  bool matches(const std::string& terminal, std::size_t at, Context context) const {
    if (at >= input_.size()) return false;
    const Terminal& here = input_[at];
    if (terminal == "WHOLE") {
      const double value = std::atof(here.text.c_str());
      return here.kind == "NUMBER" && value == std::floor(value) && value <= 99;
    }
    if (terminal == "NAME") return here.kind == "DOTTED" && here.text.find('.') == std::string::npos;
    if (here.kind != terminal) return false;
    // "A name before `(` or `:`, a reserved word, the words of evidence in a setting or behind a level and the word
    // `limit` in a force are no part of it."
    if (context.suffix && terminal == "DOTTED")
      return !is(at + 1, "(") && !is(at + 1, ":") && !(context.setting && grammar_.evidence_.count(here.text) > 0) &&
             !(context.force && here.text == "limit");
    // "the version: 1", and nothing may stand between it and `wale`.
    if (terminal == "NUMBER" && at == 1) return std::atof(here.text.c_str()) == 1;
    return true;
  }

  bool matches_word(const std::string& word, std::size_t at, Context context) const {
    if (at >= input_.size() || input_[at].text != word || input_[at].kind == "TEXT") return false;
    return !(context.suffix && word == "%" && (is(at + 1, "(") || is(at + 1, ":")));
  }

  Ends read(const Node& node, std::size_t at, Context context) {
    switch (node.kind) {
      case Node::Kind::word: return matches_word(node.text, at, context) ? Ends{at + 1} : Ends{};
      case Node::Kind::terminal: return matches(node.text, at, context) ? Ends{at + 1} : Ends{};
      case Node::Kind::before: return is(at, node.text) ? Ends{at} : Ends{};
      case Node::Kind::rule: return read_rule(node.text, at, context);
      case Node::Kind::choice: {
        Ends ends;
        for (const Node& part : node.parts) ends.merge(read(part, at, context));
        return ends;
      }
      case Node::Kind::sequence: {
        Ends ends{at};
        for (const Node& part : node.parts) {
          Ends next;
          for (const std::size_t end : ends) next.merge(read(part, end, context));
          ends = std::move(next);
        }
        return ends;
      }
      case Node::Kind::optional: {
        Ends ends = read(node.parts[0], at, context);
        ends.insert(at);
        return ends;
      }
      case Node::Kind::repetition: {
        Ends ends{at}, open{at};
        while (!open.empty()) {
          const std::size_t from = *open.begin();
          open.erase(open.begin());
          for (const std::size_t end : read(node.parts[0], from, context))
            if (ends.insert(end).second) open.insert(end);
        }
        return ends;
      }
    }
    return {};
  }

  const Grammar& grammar_;
  const Terminals& input_;
  std::map<std::tuple<std::string, std::size_t, bool, bool>, Ends> known_;
};

bool Grammar::recognises(const std::string& text) const {
  Terminals terminals;
  return terminals_of(text, terminals) && Recogniser(*this, terminals).run();
}
