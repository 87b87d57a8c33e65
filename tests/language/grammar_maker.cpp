// Random files from the rules of the grammar.

#include <algorithm>
#include <stdexcept>

#include "tests/language/grammar.hpp"

class Grammar::Maker {
 public:
  Maker(const Grammar& grammar, std::mt19937& random) : grammar_(grammar), random_(random) { measure(); }

  std::vector<std::string> run(int effort) {
    effort_ = effort;
    make(grammar_.rules_.at("file"));
    return std::move(words_);
  }

 private:
  static constexpr int endless = 1'000'000;

  /// Finds the smallest depth of a sentence of each rule.
  void measure() {
    for (const auto& [name, node] : grammar_.rules_) heights_[name] = endless;
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [name, node] : grammar_.rules_) {
        const int height = std::min(endless, 1 + height_of(node));
        changed = changed || height < heights_[name];
        heights_[name] = std::min(heights_[name], height);
      }
    }
  }

  int height_of(const Node& node) const {
    switch (node.kind) {
      case Node::Kind::rule: return heights_.at(node.text);
      case Node::Kind::sequence: {
        int height = 0;
        for (const Node& part : node.parts) height = std::max(height, height_of(part));
        return height;
      }
      case Node::Kind::choice: {
        int height = endless;
        for (const Node& part : node.parts) height = std::min(height, height_of(part));
        return height;
      }
      default: return 0;
    }
  }

  bool chance(unsigned one_in) { return random_() % one_in == 0; }

  void make(const Node& node) {
    switch (node.kind) {
      case Node::Kind::word: words_.push_back(node.text); break;
      case Node::Kind::terminal: words_.push_back(terminal(node.text)); break;
      case Node::Kind::before: break;
      case Node::Kind::rule:
        --effort_;
        ++depth_;
        make(grammar_.rules_.at(node.text));
        --depth_;
        break;
      case Node::Kind::sequence:
        for (const Node& part : node.parts) make(part);
        break;
      case Node::Kind::choice: {
        const Node* chosen = &node.parts[random_() % node.parts.size()];
        // A `before` makes no text itself, so the text that it requires seldom follows.
        while (chosen->kind == Node::Kind::before && !chance(60)) chosen = &node.parts[random_() % node.parts.size()];
        if (tired())
          chosen = &*std::min_element(node.parts.begin(), node.parts.end(),
                                      [&](const Node& a, const Node& b) { return height_of(a) < height_of(b); });
        make(*chosen);
        break;
      }
      case Node::Kind::optional:
        if (!tired() && chance(3)) make(node.parts[0]);
        break;
      case Node::Kind::repetition:
        // The outermost repetition is that of the file. It continues while there is effort left.
        while (!tired() && (depth_ <= 1 || chance(2))) make(node.parts[0]);
        break;
    }
  }

  bool tired() const { return effort_ <= 0 || depth_ > 40; }

  std::string terminal(const std::string& kind) {
    static const std::vector<std::string> names = {"a",        "b",  "x", "wale", "k",    "map",   "force", "material",
                                                   "function", "mm", "N", "ribs", "unit", "limit", "words", "hand"};
    static const std::vector<std::string> numbers = {"2", "0.5", "24", "1e-3", "3.25", "100", "7E2"};
    const auto any = [&](const std::vector<std::string>& list) { return list[random_() % list.size()]; };
    if (kind == "NAME") return any(names);
    if (kind == "DOTTED") return chance(4) ? any(names) + "." + any(names) : any(names);
    if (kind == "NUMBER") return words_.size() == 1 ? "1" : any(numbers);  // the version
    if (kind == "WHOLE") return any({"2", "3", "1"});
    if (kind == "TEXT") return any({"\"\"", "\"slate.png\"", "\"a \\\"b\\\" µ // c /* d\""});
    if (kind == "NEWLINE") return "\n";
    throw std::runtime_error("wale.grammar names no token " + kind);
  }

  const Grammar& grammar_;
  std::mt19937& random_;
  std::map<std::string, int> heights_;
  std::vector<std::string> words_;
  int effort_ = 0;
  int depth_ = 0;
};

std::string Grammar::sentence(std::mt19937& random, int effort, std::vector<std::string>* comments) const {
  const auto words = Maker(*this, random).run(effort);
  const auto chance = [&](unsigned one_in) { return random() % one_in == 0; };
  static const std::set<std::string> loose = {"(", ")", ",", "{", "}", ";"};  // these need no space on either side
  std::string text;
  std::size_t parentheses = 0;
  int noted = 0;
  const auto note = [&](bool to_the_end) {
    if (comments == nullptr) return std::string(" ");
    const std::string mark = std::to_string(++noted) + (chance(2) ? " of these" : "");
    comments->push_back(mark);
    const char* line[] = {"//", "// ", "///", "/// ", "////"};
    if (to_the_end)
      return (chance(3) ? "\n" : " ") + (line[random() % 5] + ("<" + mark + ">")) + (chance(2) ? " \n" : "\n");
    return " /*<" + mark + (chance(3) && parentheses > 0 ? ">\n  */" : ">*/") + (chance(2) ? " " : "");
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string &word = words[i], next = i + 1 < words.size() ? words[i + 1] : "\n";
    text += word == "\n" ? "" : word;
    if (word == "(") ++parentheses;
    if (word == ")" && parentheses > 0) --parentheses;
    // A newline may stand where it is white space, and must stand where it ends a statement.
    const bool free = parentheses > 0 || next == "then" || next == "else" || next == "{" || word == "{" ||
                      word == "}" || word == ";" || continuing_.count(word) > 0;
    if (word == "\n" || next == "\n" || free) {
      const bool must = next == "\n";
      if (word != "\n" && must) {
        if (chance(4))
          text += note(true);
        else
          text += chance(6) ? "\n\n\n" : "\n";
      } else if (chance(12)) {
        text += note(true);
      } else if (chance(12)) {
        text += "\n";
      } else if (!(chance(3) && (loose.count(word) > 0 || loose.count(next) > 0))) {
        text += " ";
      }
    } else if (comments != nullptr && chance(20)) {
      text += note(false);
    } else if (!(chance(3) && (loose.count(word) > 0 || loose.count(next) > 0))) {
      text += chance(8) ? "  \t" : " ";
    }
  }
  return text;
}
