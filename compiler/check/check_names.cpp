#include "compiler/check/check_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compiler/expression/builtin_functions.hpp"
#include "compiler/expression/other_languages.hpp"
#include "compiler/parse/overloaded.hpp"

namespace wale {

namespace {

std::string_view before_dot(std::string_view name) { return name.substr(0, name.find('.')); }

/// Reads one function's body and checks that each name is known there.
class BodyReader {
 public:
  BodyReader(const SyntaxTree& tree, const FunctionDecl& function, const Surroundings& surroundings)
      : tree_(tree), function_(function), surroundings_(surroundings), names_(surroundings.declarations) {}

  void read(ExprId expr) {
    std::visit(Overloaded{
                   [&](const NumberLiteral& node) {
                     for (const auto& part : tree_.suffix(node))
                       if (!names_.units.contains(part.name.text) && !has_meaning(part.name.text))
                         unknown_unit(part.name);
                   },
                   [&](const NameUse& node) {
                     if (!has_meaning(node.name) && node.name != "open") unknown_name({node.name, tree_.span(expr)});
                   },
                   [&](const Unary& node) { read(node.operand); },
                   [&](const Part& node) { read(node.whole); },
                   [&](const Binary& node) {
                     read(node.left);
                     read(node.right);
                   },
                   [&](const Call& node) {
                     const auto& name = node.callee.text;
                     if (!names_.functions.contains(name) && !is_builtin_function(name) && !is_argument(name) &&
                         !names_.constants.contains(name))
                       unknown_function(node.callee, node.arguments.count);
                     for (const auto& argument : tree_.arguments(node)) read(argument.value);
                   },
                   [&](const Conditional& node) {
                     read(node.condition);
                     read(node.yes);
                     read(node.no);
                   },
                   [&](const auto&) {},
               },
               tree_.expr(expr));
  }

 private:
  bool is_argument(std::string_view name) const {
    return std::ranges::any_of(function_.parameters, [&](const auto& formal) { return formal.name.text == name; });
  }
  bool has_meaning(std::string_view name) const {
    const std::string_view whole = before_dot(name);
    return is_argument(whole) || names_.constants.contains(whole) || names_hand_or_patch(whole);
  }

  // With the same messages as `ExpressionChecker`, so that the same error found at a call is a duplicate and shown
  // once.
  void unknown_name(const Word& word) {
    if (names_.private_names.contains(word.text)) return;  // reported where the function is called
    if (names_.units.contains(word.text))
      return report(word, Code::unknown_name, fmt::format("`{}` is a unit, and a unit follows a number", word.text),
                    fmt::format("write `1 {}`", word.text));
    if (names_.functions.contains(word.text) || is_builtin_function(word.text))
      return report(word, Code::unknown_name, fmt::format("`{}` is a function and needs its arguments", word.text),
                    fmt::format("write `{}(…)`", word.text));
    if (surroundings_.diagnostics.is_full()) return;
    std::vector<std::string> known = names_.constants.spellings();
    for (const auto& formal : function_.parameters) known.emplace_back(formal.name.text);
    known.insert(known.end(), {"hand", "velocity", "acceleration", "time", "button"});
    const auto ours = instead_of_value(word.text);
    report(word, Code::unknown_name, fmt::format("nothing here is called `{}`", word.text),
           ours ? Advice(std::string(*ours))
                : did_you_mean(word.span, word.text, known,
                               "a function can use its arguments, constants and the hand; make this an argument"));
  }
  void unknown_unit(const Word& word) {
    if (surroundings_.diagnostics.is_full()) return;
    report(word, Code::unknown_unit, fmt::format("nothing declares a unit `{}`", word.text),
           unit_mend(word, names_, surroundings_));
  }
  void unknown_function(const Word& word, std::size_t arguments) {
    if (names_.private_names.contains(word.text) || surroundings_.diagnostics.is_full()) return;
    const auto known = functions_that_take(names_, arguments);
    const auto ours = instead_of_function(word.text);
    report(word, Code::unknown_name, fmt::format("no function is called `{}`", word.text),
           ours ? Advice(std::string(*ours))
                : did_you_mean(word.span, word.text, known,
                               "schema/LANGUAGE.md lists them; `function name(…) = …` declares one"));
  }

  void report(const Word& word, Code code, std::string message, Advice advice) {
    surroundings_.diagnostics.report(std::move(advice).about(code, word.span, std::move(message)));
  }

  const SyntaxTree& tree_;
  const FunctionDecl& function_;
  const Surroundings& surroundings_;
  const Declarations& names_;
};

/// Collects every word of a file that may use a name. The name that a declaration gives is not a use.
class UsedNames {
 public:
  explicit UsedNames(const SyntaxTree& tree) {
    for (const auto& expr : tree.exprs)
      std::visit(Overloaded{
                     [&](const NumberLiteral& node) {
                       for (const auto& part : tree.suffix(node)) add(part.name.text);
                     },
                     [&](const NameUse& node) { add(node.name); },
                     [&](const Call& node) { add(node.callee.text); },
                     [](const auto&) {},
                 },
                 expr);
    for (const auto& declaration : tree.declarations)
      std::visit(
          Overloaded{
              [&](const UnitDecl& node) { add(node.dimension); },
              [&](const FunctionDecl& node) {
                for (const auto& formal : node.parameters) add(formal.dimension);
              },
              [&](const RecordDecl& node) {
                if (node.keyword.text != "percept" && node.keyword.text != "device" && node.keyword.text != "hand")
                  add(node.name.text);
                for (const auto& setting : node.settings) add(setting);
              },
              [&](const MaterialDecl& node) {
                for (const auto& setting : node.representative) add(setting);
                for (const auto& percept : node.perceptual) add(percept.name.text), add(percept.level_name);
                for (const auto& statement : node.physical) {
                  if (const auto* state = std::get_if<StateStatement>(&statement.what)) add(state->dimension);
                  if (const auto* memory = std::get_if<MemoryStatement>(&statement.what)) add(memory->dimension);
                }
              },
              [&](const WorkspaceDecl& node) {
                for (const PlacedStatement& placed : node.placed)
                  std::visit(
                      [&](const auto& each) {
                        for (const auto& setting : each.settings) add(setting);
                      },
                      placed);
              },
              [](const auto&) {},
          },
          declaration);
  }

  bool contains(std::string_view name) const { return names_.contains(name); }

 private:
  void add(std::string_view name) {
    names_.insert(name);
    names_.insert(before_dot(name));
  }
  void add(const std::optional<Word>& word) {
    if (word) add(word->text);
  }
  void add(const Setting& setting) {
    add(setting.on);
    for (const auto& item : setting.items)
      for (const auto& word : item.words) add(word.text);
  }

  std::set<std::string_view> names_;  ///< views into the tree
};

/// Whether a file has declarations that could be unused: most files have only materials.
bool may_leave_unused(const SyntaxTree& tree) {
  return std::ranges::any_of(tree.declarations, [](const Declaration& each) {
    return std::holds_alternative<Import>(each) || std::holds_alternative<UnitDecl>(each) ||
           std::holds_alternative<Constant>(each) || std::holds_alternative<FunctionDecl>(each);
  });
}

template <typename T>
bool uses_any(const Names<T>& names, const UsedNames& used) {
  return std::ranges::any_of(names.own(), [&](const auto& entry) {
    return entry.second.exported && !entry.second.imported && used.contains(entry.first);
  });
}

bool uses_any(const Declarations& from, const UsedNames& used) {
  const auto exported = [](const auto& each) { return each.exported; };
  return uses_any(from.dimensions, used) || uses_any(from.units, used) || uses_any(from.constants, used) ||
         uses_any(from.functions, used) || uses_any(from.percepts, used) || uses_any(from.devices, used) ||
         uses_any(from.hands, used) || uses_any(from.materials, used) || std::ranges::any_of(from.own_maps, exported) ||
         uses_any(from.classes, used) || std::ranges::any_of(from.own_thresholds, exported) ||
         std::ranges::any_of(from.own_rules, exported) || std::ranges::any_of(from.own_levels, exported);
}

template <typename T>
void warn_of_unused(const Names<T>& names, SourceId source, const UsedNames& used, const char* kind,
                    Diagnostics& diagnostics) {
  for (const auto& [name, entry] : names.own())
    if (!entry.exported && !entry.imported && entry.declared.source == source && !used.contains(name))
      diagnostics.report({.code = Code::unused_name,
                          .span = entry.declared,
                          .message = fmt::format("the {} `{}` is never used", kind, name),
                          .help = fmt::format("use it, remove it, or write `export` before it for other files")});
}

/// Removes the import of that module, and its line if nothing else is on it.
std::vector<Fix> leave_out(Span module, const SourceSet& sources) {
  constexpr std::string_view keyword = "import", blanks = " \t\r";
  const std::string_view text = sources[module.source].text;
  const std::size_t before = text.find_last_not_of(blanks, module.begin - 1);
  const std::size_t begin = before + 1 - keyword.size();
  if (before == std::string_view::npos || before + 1 < keyword.size() || text.substr(begin, keyword.size()) != keyword)
    return {};
  const std::size_t rest = std::min(text.find_first_not_of(blanks, module.end), text.size());
  const bool ends_line = rest == text.size() || text[rest] == '\n';
  const bool begins_line = begin == 0 || text[begin - 1] == '\n';
  const std::size_t end = ends_line && begins_line ? std::min(rest + 1, text.size()) : module.end;
  return {replace({module.source, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)}, "",
                  "remove the import", false)};
}

}  // namespace

void check_functions(const SyntaxTree& tree, const Surroundings& surroundings) {
  for (const auto& declaration : tree.declarations)
    if (const auto* function = std::get_if<FunctionDecl>(&declaration)) {
      BodyReader reader(tree, *function, surroundings);
      reader.read(function->body);
    }
}

void warn_of_unused_declarations(const ModuleSet& modules, const Surroundings& surroundings) {
  const Module& own = *modules.modules.back();
  if (!may_leave_unused(own.tree)) return;
  const UsedNames used(own.tree);
  warn_of_unused(own.declarations.constants, own.tree.source, used, "constant", surroundings.diagnostics);
  warn_of_unused(own.declarations.functions, own.tree.source, used, "function", surroundings.diagnostics);
  warn_of_unused(own.declarations.units, own.tree.source, used, "unit", surroundings.diagnostics);
  for (const auto& declaration : own.tree.declarations)
    if (const auto* import = std::get_if<Import>(&declaration))
      if (const auto found = modules.imports.find(import); found != modules.imports.end())
        if (!uses_any(found->second->declarations, used))
          surroundings.diagnostics.report(
              Advice("remove the import")
                  .fix(leave_out(import->module.span, surroundings.sources))
                  .about(Code::unused_import, import->module.span,
                         fmt::format("nothing from `{}` is used here", import->module.text)));
}

}  // namespace wale
