#include "document/placed.hpp"

#include <QLocale>
#include <algorithm>
#include <cctype>
#include <optional>
#include <set>

namespace sandpaper {
namespace {

struct Argument {
  std::string name, whole;  ///< "roughness", "roughness: 0.3"; the name is empty for one by its place
};

/// A name or one call, in its parts.
struct Parts {
  std::string material;
  std::vector<Argument> arguments;
};

std::string trimmed(std::string text) {
  const auto is_blank = [](unsigned char letter) { return std::isspace(letter) != 0; };
  text.erase(text.begin(), std::ranges::find_if_not(text, is_blank));
  while (!text.empty() && is_blank(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

bool is_of_name(char letter) {
  return std::isalnum(static_cast<unsigned char>(letter)) || letter == '_' || letter == '.';
}

/// Where the text in quotes or the parenthesis that begins at `at` ends, behind its last character; npos if it does
/// not.
std::size_t behind(const std::string& text, std::size_t at) {
  if (text[at] == '"') {
    for (++at; at < text.size(); ++at) {
      if (text[at] == '\\') ++at;
      else if (text[at] == '"') return at + 1;
    }
    return std::string::npos;
  }
  for (++at; at < text.size();) {
    if (text[at] == ')') return at + 1;
    at = text[at] == '"' || text[at] == '(' ? behind(text, at) : at + 1;
    if (at == std::string::npos) return at;
  }
  return std::string::npos;
}

Argument argument(const std::string& part) {
  const std::string whole = trimmed(part);
  std::size_t end = 0;
  while (end < whole.size() && is_of_name(whole[end])) ++end;
  const std::string name = whole.substr(0, end);
  while (end < whole.size() && std::isspace(static_cast<unsigned char>(whole[end]))) ++end;
  const bool is_named = !name.empty() && end < whole.size() && whole[end] == ':';
  return {is_named ? name : "", whole};
}

std::optional<Parts> parts_of(const std::string& made_of) {
  const std::string text = trimmed(made_of);
  if (text.empty()) return std::nullopt;
  std::size_t end = 0;
  if (text.front() == '"') end = behind(text, 0);
  else while (end < text.size() && is_of_name(text[end])) ++end;
  if (end == 0 || end == std::string::npos || std::isdigit(static_cast<unsigned char>(text.front())))
    return std::nullopt;
  Parts parts{text.substr(0, end), {}};
  while (end < text.size() && std::isspace(static_cast<unsigned char>(text[end]))) ++end;
  if (end == text.size()) return parts;
  if (text[end] != '(' || behind(text, end) != text.size() || parts.material == "between") return std::nullopt;
  for (std::size_t at = end + 1, begin = at; at < text.size();) {
    if (text[at] == ',' || at + 1 == text.size()) {
      const Argument each = argument(text.substr(begin, at - begin));
      if (!each.whole.empty()) parts.arguments.push_back(each);
      begin = ++at;
    } else {
      at = text[at] == '"' || text[at] == '(' ? behind(text, at) : at + 1;
    }
  }
  return parts;
}

std::string joined(const Parts& parts) {
  if (parts.arguments.empty()) return parts.material;
  std::string text = parts.material + "(";
  for (std::size_t i = 0; i < parts.arguments.size(); ++i) text += (i ? ", " : "") + parts.arguments[i].whole;
  return text + ")";
}

/// A name of the language like another text, "oak", "oak_2", …
std::string free_name(const std::string& like, const std::set<std::string>& taken) {
  std::string base;
  for (const char letter : like.substr(0, like.find('(')))
    base += std::isalnum(static_cast<unsigned char>(letter)) ? letter : '_';
  // The words of the language cannot be names, and a name does not begin with a digit.
  static const std::set<std::string> reserved = {"if", "then", "else", "in", "on", "from", "and", "or", "not"};
  while (!base.empty() && base.back() == '_') base.pop_back();
  if (base.empty() || reserved.contains(base) || std::isdigit(static_cast<unsigned char>(base.front())))
    base = "patch_" + base;
  while (!base.empty() && base.back() == '_') base.pop_back();
  std::string name = base;
  for (int i = 2; taken.contains(name); ++i) name = base + "_" + std::to_string(i);
  return name;
}

}  // namespace

std::optional<std::string> with_argument(const std::string& made_of, const std::string& name,
                                         const std::string& value) {
  auto parts = parts_of(made_of);
  if (!parts) return std::nullopt;
  const auto found = std::ranges::find(parts->arguments, name, &Argument::name);
  const Argument wanted{name, name + ": " + value};
  if (found == parts->arguments.end()) parts->arguments.push_back(wanted);
  else *found = wanted;
  return joined(*parts);
}

std::string without_argument(const std::string& made_of, const std::string& name) {
  auto parts = parts_of(made_of);
  if (!parts) return made_of;
  std::erase_if(parts->arguments, [&](const Argument& each) { return each.name == name; });
  return joined(*parts);
}

std::string written(double si, const std::string& unit, double unit_in_si) {
  QLocale c = QLocale::c();
  c.setNumberOptions(QLocale::OmitGroupSeparator);
  const std::string number = c.toString(si / (unit_in_si == 0 ? 1 : unit_in_si), 'g', 5).toStdString();
  return unit.empty() ? number : number + " " + unit;
}

std::string Contents::surroundings() const {
  if (name.empty()) return head + "\n" + tail;
  std::string own = "workspace " + name + " {\n", plain;
  if ((head + "\n" + tail).find("\ngroups ") != std::string::npos) {
    plain = "material " + name + "_without_materials { physical { force = vector(0 N, 0 N) } }\n";
    for (const PlacedRef& each : placed)
      if (each->is_changeable()) own += "patch " + each->patch.name + " = " + name + "_without_materials\n";
  }
  return head + "\n" + plain + own + "}\n" + tail;
}

const Placed* Contents::find(std::uint64_t id) const {
  const auto found = std::ranges::find(placed, id, [](const PlacedRef& each) { return each->id; });
  return found == placed.end() ? nullptr : found->get();
}

std::string Contents::new_name(const std::string& like) const {
  std::set<std::string> taken;
  for (const PlacedRef& each : placed) taken.insert(each->patch.name);
  return free_name(like, taken);
}

std::set<std::string> Contents::declared() const {
  std::set<std::string> taken = {name};
  for (const std::string* text : {&head, &tail}) {
    // In no comment and no text, a name stands behind the word that declares it.
    std::string before;
    for (const wale::ColouredWord& word : wale::coloured_words(*text)) {
      if (word.kind == wale::WordKind::comment || word.kind == wale::WordKind::documentation) continue;
      const std::string each = text->substr(word.begin, word.end - word.begin);
      static const std::set<std::string> declaring = {"material", "workspace", "movie", "keys",    "groups",
                                                      "function", "let",       "unit",  "percept", "device"};
      if (declaring.contains(before)) taken.insert(each);
      before = each;
    }
  }
  return taken;
}

std::string Contents::new_declared_name(const std::string& like) const { return free_name(like, declared()); }

wale::Layout Contents::layout() const {
  wale::Layout layout{.name = name, .documentation = documentation, .trailing = trailing, .written = written};
  for (const PlacedRef& each : placed) layout.patches.push_back(each->patch);
  return layout;
}

}  // namespace sandpaper
