#include "compiler/check/override_statements.hpp"

#include <fmt/format.h>

#include <string>

#include "compiler/parse/overloaded.hpp"

namespace wale {

namespace {

/// The key by which a later statement replaces this one: the name of a parameter, a value or a layer of force;
/// "x'" for the update of x; "force =", "patch =" and "active =" for those statements; empty for a mark of the picture.
std::string replaced_by(const PhysicalStatement& statement) {
  return std::visit(
      Overloaded{
          [](const ForceStatement& node) { return node.name ? std::string(node.name->text) : std::string("force ="); },
          [](const PatchStatement&) { return std::string("patch ="); },
          [](const ActiveStatement&) { return std::string("active ="); },
          [](const UpdateStatement& node) { return fmt::format("{}'", node.name.text); },
          [](const ShowStatement&) { return std::string(); },
          [](const auto& node) { return std::string(node.name.text); },
      },
      statement.what);
}

template <typename Statement>
bool is(const AssembledStatement& assembled) {
  return std::holds_alternative<Statement>(assembled.statement->what);
}

void erase(std::vector<AssembledStatement>& all, std::vector<bool>& own, std::size_t i) {
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
  own.erase(own.begin() + static_cast<std::ptrdiff_t>(i));
}

}  // namespace

void override_statements(const Declared<MaterialDecl>& declared, std::vector<AssembledStatement>& all) {
  if (all.empty()) {  // as nearly always: there is nothing to replace
    all.reserve(declared.node->physical.size());
    for (const auto& statement : declared.node->physical) all.push_back({&statement, declared.tree, declared.home, {}});
    return;
  }
  std::vector<bool> own(all.size(), false);
  std::vector<AssembledStatement> fresh;
  bool shows_cleared = false;
  for (const auto& statement : declared.node->physical) {
    const AssembledStatement assembled{&statement, declared.tree, declared.home, {}};
    const std::string key = replaced_by(statement);
    if (key.empty() && !shows_cleared) {  // the material's own picture replaces the other one
      shows_cleared = true;
      for (std::size_t i = all.size(); i-- > 0;)
        if (is<ShowStatement>(all[i]) && i < own.size() && !own[i]) erase(all, own, i);
    }
    std::size_t place = all.size();
    for (std::size_t i = 0; i < all.size() && !key.empty(); ++i)
      if (!own[i] && (replaced_by(*all[i].statement) == key || (key == "force =" && is<ForceStatement>(all[i])))) {
        place = i;
        break;
      }
    if (place == all.size()) {
      fresh.push_back(assembled);
      continue;
    }
    all[place] = assembled;
    own[place] = true;
    if (key == "force =")  // the whole force: its layers go with it
      for (std::size_t i = all.size(); i-- > place + 1;)
        if (!own[i] && is<ForceStatement>(all[i])) erase(all, own, i);
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(place), fresh.begin(), fresh.end());
    own.insert(own.begin() + static_cast<std::ptrdiff_t>(place), fresh.size(), true);
    fresh.clear();
  }
  all.insert(all.end(), fresh.begin(), fresh.end());
}

}  // namespace wale
