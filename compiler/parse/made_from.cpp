#include "compiler/parse/made_from.hpp"

#include <algorithm>
#include <string_view>

#include "compiler/parse/overloaded.hpp"

namespace wale {
namespace {

void add_names(ExprId expr, const SyntaxTree& tree, std::vector<Word>& names) {
  std::visit(
      Overloaded{
          [&](const NameUse& use) {
            names.push_back({use.name, tree.span(expr)});
          },
          [&](const TextLiteral& text) {
            names.push_back({text.text, tree.span(expr)});
          },
          [&](const NumberLiteral& number) {  // `0.3 denim`, `30 % denim`
            if (const auto suffix = tree.suffix(number); !suffix.empty()) names.push_back(suffix.back().name);
          },
          [&](const Call& call) {
            if (call.quoted || call.callee.text != "between") return names.push_back(call.callee);
            for (const Argument& each : tree.arguments(call).first(std::min<std::size_t>(2, call.arguments.count)))
              add_names(each.value, tree, names);
          },
          [&](const Binary& node) {
            if (node.op == BinaryOperator::add) add_names(node.left, tree, names);
            if (node.op == BinaryOperator::add || node.op == BinaryOperator::multiply)
              add_names(node.right, tree, names);
          },
          [](const auto&) {},
      },
      tree.expr(expr));
}

}  // namespace

std::optional<Word> liked_by(const Setting& setting, const SyntaxTree& tree) {
  if (setting.key.text != "like" || setting.items.size() != 1) return std::nullopt;
  const SettingItem& item = setting.items.front();
  if (item.words.size() == 1 && !item.value) return item.words.front();
  const auto* text = item.value ? std::get_if<TextLiteral>(&tree.expr(*item.value)) : nullptr;
  return text ? std::optional(Word{text->text, tree.span(*item.value)}) : std::nullopt;
}

std::vector<Word> made_from(const MaterialDecl& material, const SyntaxTree& tree) {
  std::vector<Word> names;
  if (material.derived_from) add_names(*material.derived_from, tree, names);
  for (const Setting& setting : material.representative)
    if (const auto liked = liked_by(setting, tree)) names.push_back(*liked);
  return names;
}

std::vector<Word> made_from(ExprId expr, const SyntaxTree& tree) {
  std::vector<Word> names;
  add_names(expr, tree, names);
  return names;
}

std::vector<Word> presented_by(const RecordDecl& experiment, const SyntaxTree& tree) {
  std::vector<Word> names;
  std::vector<std::string_view> factors;
  for (const Setting& setting : experiment.settings) {
    if (setting.key.text == "factor") {
      for (std::size_t i = 0; i < setting.items.size(); ++i) {
        const SettingItem& item = setting.items[i];
        if (i == 0 && !item.words.empty()) factors.push_back(item.words.front().text);
        const bool is_step = item.words.size() == 1 && item.words.front().text == "even";
        if (!item.value && item.words.size() == (i == 0 ? 2u : 1u) && !(i > 0 && is_step))
          names.push_back(item.words.back());
      }
    }
    if (setting.key.text != "stimulus" && setting.key.text != "standard") continue;
    for (const SettingItem& item : setting.items) {
      if (item.equals) add_names(*item.equals, tree, names);
      else if (item.value) add_names(*item.value, tree, names);
      else if (item.words.size() == 1) names.push_back(item.words.front());
    }
  }
  std::erase_if(names, [&](const Word& each) { return std::ranges::find(factors, each.text) != factors.end(); });
  return names;
}

}  // namespace wale
