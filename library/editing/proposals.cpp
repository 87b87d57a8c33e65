#include "library/editing/proposals.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "compiler/expression/builtin_functions.hpp"
#include "compiler/parse/lex.hpp"

namespace wale {
namespace {

using Words = std::vector<std::string_view>;

const std::map<std::string_view, Words>& blocks() {
  static const std::map<std::string_view, Words> all = {
      {"", {"class", "device", "dimension", "export", "function", "hand", "import", "let", "levels", "map", "material",
            "percept", "rule", "threshold", "unit", "wale", "workspace"}},
      {"material", {"perceptual", "physical", "representative"}},
      {"physical", {"active", "force", "height", "let", "memory", "next", "param", "patch", "show", "state"}},
      {"perceptual", {"essential"}},
      {"representative", {"called", "feels", "kind", "licence", "like", "replaces", "source", "title"}},
      {"workspace", {"patch", "patches"}},
      {"placing", {"at", "mark", "rim", "shape", "size"}},
  };
  return all;
}

/// What stands before the place where someone types.
struct Before {
  std::string_view block;            ///< a key of `blocks()`, or "other"
  bool begins = true;                ///< nothing but the typed word stands in its statement
  std::vector<std::string_view> statement;  ///< its words and symbols before that word
  bool behind_number = false, in_text = false, in_comment = false;
};

std::string_view block_within(std::string_view outer, std::string_view head) {
  if (outer.empty()) return head == "material" || head == "workspace" ? head : "other";
  if (outer == "material" && (head == "physical" || head == "perceptual" || head == "representative")) return head;
  return outer == "workspace" && head == "patch" ? "placing" : "other";
}

Before before(std::string_view text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const Tokens tokens = lex(sources, sources.add("text", std::string(text)), diagnostics);
  Before found;
  std::vector<std::string_view> open = {""};
  std::size_t end = 0;
  for (const Token& token : tokens.tokens) {
    if (token.kind == TokenKind::end) break;
    const std::string_view word = text.substr(token.begin, token.end - token.begin);
    end = token.end;
    if (token.ends_statement != StatementEnd::no && token.kind != TokenKind::left_brace) found.statement.clear();
    found.behind_number = false;
    if (token.kind == TokenKind::left_brace) {
      open.push_back(block_within(open.back(), found.statement.empty() ? "" : found.statement.front()));
      found.statement.clear();
    } else if (token.kind == TokenKind::right_brace) {
      if (open.size() > 1) open.pop_back();
    } else if (token.kind != TokenKind::semicolon) {
      found.behind_number = token.kind == TokenKind::number;
      found.statement.push_back(word);
    }
  }
  const std::string_view behind = text.substr(std::min(end, text.size()));
  found.in_comment = behind.find("//") != std::string_view::npos || behind.find("/*") != std::string_view::npos;
  if (behind.find('\n') != std::string_view::npos && !found.statement.empty() && found.statement.back() != "=" &&
      found.statement.back() != "," && found.statement.back() != "+")
    found.statement.clear(), found.behind_number = false;
  found.in_text = std::ranges::count(text.substr(text.rfind('\n') + 1), '"') % 2 == 1;
  found.block = open.back();
  found.begins = found.statement.empty();
  return found;
}

bool is_of_word(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
         letter == '_' || letter == '.';
}

class Gathering {
 public:
  Gathering(std::string_view begun, Proposals& proposals) : begun_(begun), proposals_(proposals) {}

  void add(std::string_view text, ProposalKind kind, std::string_view documentation = {}) {
    if (text.starts_with(begun_) && said_.insert({std::string(text), kind}).second)
      proposals_.words.push_back({std::string(text), kind, std::string(documentation)});
  }

  void keywords(std::string_view block) {
    for (const std::string_view word : words_of_block(block)) add(word, ProposalKind::keyword);
  }
  void percepts(const Declarations& known) {
    for (const std::string& name : known.percept_spellings()) add(name, ProposalKind::percept);
  }
  void levels(const Declarations& known, std::string_view percept) {
    const auto meant = known.percept_named(std::string(percept));
    for (const Levels* each : known.levels())
      if (each->percept == percept || (meant.percept && each->percept == meant.percept->name))
        for (const Levels::Level& level : each->levels) add(level.name, ProposalKind::level);
  }
  void units(const Declarations& known) {
    known.units.each([&](const std::string& name, const Unit&) { add(name, ProposalKind::unit); });
  }
  void materials(const Declarations& known, const LibraryIndex& index) {
    known.materials.each([&](const std::string& name, const Declared<MaterialDecl>& declared) {
      add(name, ProposalKind::material, declared.node->documentation);
    });
    for (const IndexedMaterial& each : index.materials())
      if (each.origin != Origin::hidden) add(each.name, ProposalKind::material, each.documentation);
  }
  void values(const Declarations& known, std::string_view text) {
    known.functions.each([&](const std::string& name, const Declared<FunctionDecl>& declared) {
      add(name, ProposalKind::function, declared.node->documentation);
    });
    for (const Builtin& each : builtins()) add(each.name, ProposalKind::function);
    known.constants.each([&](const std::string& name, const Declared<Constant>& declared) {
      add(name, ProposalKind::constant, declared.node->documentation);
    });
    for (const std::string_view name : {"hand", "hand.x", "hand.y", "speed", "time", "button"})
      add(name, ProposalKind::constant);
    parameters(text);
  }

 private:
  /// The names that the statements of the text give.
  void parameters(std::string_view text) {
    SourceSet sources;
    Diagnostics diagnostics;
    const Tokens tokens = lex(sources, sources.add("text", std::string(text)), diagnostics);
    constexpr std::string_view naming[] = {"param", "let", "height", "state", "memory"};
    for (std::size_t i = 0; i + 1 < tokens.tokens.size(); ++i) {
      const Token &word = tokens.tokens[i], &name = tokens.tokens[i + 1];
      if (word.kind == TokenKind::name && name.kind == TokenKind::name &&
          std::ranges::find(naming, text.substr(word.begin, word.end - word.begin)) != std::end(naming))
        add(text.substr(name.begin, name.end - name.begin), ProposalKind::parameter);
    }
  }

  std::string_view begun_;
  Proposals& proposals_;
  std::set<std::pair<std::string, ProposalKind>> said_;
};

}  // namespace

const std::vector<std::string_view>& words_of_block(std::string_view block) {
  static const Words none;
  const auto found = blocks().find(block);
  return found == blocks().end() ? none : found->second;
}

bool is_statement_word(std::string_view word) {
  return std::ranges::any_of(blocks(), [&](const auto& each) {
    return std::ranges::find(each.second, word) != each.second.end();
  });
}

Proposals proposals_at(std::string_view text, std::size_t at, const Declarations& known, const LibraryIndex& index) {
  Proposals proposals{.begin = at, .end = at};
  while (proposals.begin > 0 && is_of_word(text[proposals.begin - 1])) --proposals.begin;
  // `5mm`: the number is no part of the unit.
  while (proposals.begin < at &&
         ((text[proposals.begin] >= '0' && text[proposals.begin] <= '9') || text[proposals.begin] == '.'))
    ++proposals.begin;
  const std::string_view begun = text.substr(proposals.begin, at - proposals.begin);
  const Before found = before(text.substr(0, proposals.begin));
  if (found.in_comment || found.in_text) return proposals;
  Gathering gathering(begun, proposals);
  const std::string_view first = found.begins ? "" : found.statement.front();
  if (found.behind_number) {
    gathering.units(known);
  } else if (found.begins) {
    gathering.keywords(found.block);
    if (found.block == "perceptual") gathering.percepts(known);
  } else if (found.block == "perceptual") {
    if (first == "essential" && found.statement.size() == 1) gathering.percepts(known);
    else gathering.levels(known, first == "essential" ? found.statement[1] : first);
  } else if (first == "patch" || first == "material" || first == "like") {
    if (found.statement.size() > 2 || first == "like") gathering.materials(known, index);
  } else if (first == "shape") {
    for (const std::string_view word : {"ellipse", "mask", "polygon", "rectangle"})
      gathering.add(word, ProposalKind::keyword);
  } else if (found.block == "physical" || found.block == "other" || first == "function" || first == "let") {
    gathering.values(known, text);
  }
  std::ranges::stable_sort(proposals.words, {}, [](const Proposal& each) { return std::pair(each.kind, each.text); });
  return proposals;
}

}  // namespace wale
