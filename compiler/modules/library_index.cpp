#include "compiler/modules/library_index.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <mutex>
#include <set>

#include "compiler/modules/representative.hpp"
#include "compiler/parse/overloaded.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/text/embedded_files.hpp"
#include "schema/home_process.hpp"

namespace wale {
namespace {

/// The texts and words of a setting as they are written, words with their dots.
std::vector<std::string> texts_in(const Setting& setting, const SyntaxTree& tree) {
  std::vector<std::string> texts;
  for (const SettingItem& item : setting.items) {
    const auto* literal = item.value ? std::get_if<TextLiteral>(&tree.expr(*item.value)) : nullptr;
    if (literal) texts.emplace_back(literal->text);
    if (!item.value && !item.words.empty()) texts.emplace_back(item.words.front().text);
  }
  return texts;
}

bool same_but_for_capitals(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Adds one file to the index. Its errors are ignored here and reported when it is compiled.
void read_into(LibraryIndex& index, const std::string& module, const std::string& name, std::string text,
               Origin origin) {
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add(name, std::move(text));
  index.add(module, name, parse(sources, source, diagnostics), origin);
}

/// "library/std/friction.wale" -> "std.friction".
std::string module_of(std::string_view embedded) {
  constexpr std::string_view folder = "library/", ending = ".wale";
  std::string module(embedded.substr(folder.size(), embedded.size() - folder.size() - ending.size()));
  std::ranges::replace(module, '/', '.');
  return module;
}

/// The word that declares a record, for as long as the program runs; "declaration" for one that is misspelt.
std::string_view record_word(const RecordDecl& record) {
  static constexpr std::string_view words[] = {"percept", "map",    "threshold", "rule",
                                               "class",   "device", "levels",    "hand"};
  const auto found = std::ranges::find(words, record.keyword.text);
  return found == std::end(words) ? "declaration" : *found;
}

LibraryIndex read_all(Resolver& resolver, const std::string& from) {
  LibraryIndex index;
  std::set<std::string> known;
  std::size_t left = most_indexed;
  for (const std::string& module : resolver.modules(from)) {
    if (left == 0) {
      index.leave_out(module);
      continue;
    }
    auto found = resolver.listed_module(module, from);
    if (!found || !known.insert(module).second) continue;
    left -= std::min(left, found->bytes.size());
    read_into(index, module, found->name, std::move(found->bytes), Origin::own);
  }
  for (const ListedModule& hidden : resolver.hidden_modules(from)) {
    if (left == 0) {
      index.leave_out(hidden.path);
      continue;
    }
    auto read = read_file(hidden.path, largest_source);
    if (!read) continue;
    left -= std::min(left, read->bytes.size());
    read_into(index, hidden.name, read->name, std::move(read->bytes), Origin::hidden);
  }
  for (const EmbeddedFile& file : embedded_files())
    if (!file.common && known.insert(module_of(file.name)).second)
      read_into(index, module_of(file.name), std::string(file.name), std::string(file.text), Origin::shipped);
  return index;
}

}  // namespace

void LibraryIndex::add(const std::string& module, const std::string& file, const SyntaxTree& tree, Origin origin) {
  const auto add_export = [&](const auto& node, std::string_view what) {
    if (origin == Origin::hidden) return;  // no import finds it
    if (node.exported) exports_.push_back({std::string(node.name.text), module, what});
  };
  // A map's own name is a setting: behind `map` stands the percept.
  const auto add_record = [&](const RecordDecl& node) {
    const std::string_view what = record_word(node);
    if (what != "map") return add_export(node, what);
    for (const Setting& setting : node.settings)
      if (node.exported && setting.key.text == "name")
        for (std::string& name : texts_in(setting, tree)) exports_.push_back({std::move(name), module, what});
  };
  for (const Declaration& declaration : tree.declarations) {
    std::visit(Overloaded{
                   [&](const DimensionDecl& node) { add_export(node, "dimension"); },
                   [&](const UnitDecl& node) { add_export(node, "unit"); },
                   [&](const Constant& node) { add_export(node, "constant"); },
                   [&](const FunctionDecl& node) { add_export(node, "function"); },
                   [&](const RecordDecl& node) { add_record(node); },
                   [](const auto&) {},
               },
               declaration);
    const auto* material = std::get_if<MaterialDecl>(&declaration);
    if (!material) continue;
    IndexedMaterial& entry = materials_.emplace_back();
    entry.name = material->name.text, entry.module = module, entry.file = file;
    entry.documentation = material->documentation, entry.origin = origin;
    for (const PerceptStatement& asked : material->perceptual) entry.asks.emplace_back(asked.name.text);
    for (const Setting& setting : material->representative) {
      std::vector<std::string> texts = texts_in(setting, tree);
      const std::string_view key = setting.key.text;
      if (key == "called") {
        const std::string_view language = language_of(setting);
        if (language.empty())
          entry.called = std::move(texts);
        else
          entry.called_in.emplace_back(language, std::move(texts));
      } else if (key == "replaces")
        entry.replaces = std::move(texts);
      else if (key == "source")
        entry.sources = std::move(texts);
      else if (key == "licence" && !texts.empty())
        entry.licence = std::move(texts.front());
      else if (key == "feels")
        entry.feels = std::move(texts);
      else if (key == "title" && !texts.empty())
        entry.title = std::move(texts.front());
      else if (key == "kind" && !texts.empty())
        entry.kind = std::move(texts.front());
    }
  }
}

const ExportedName* LibraryIndex::exported(std::string_view name) const {
  const auto found = std::ranges::find(exports_, name, &ExportedName::name);
  return found == exports_.end() ? nullptr : &*found;
}

std::vector<const IndexedMaterial*> LibraryIndex::meant_by(std::string_view text) const {
  if (text.empty()) return {};  // a material without a title is not called ""
  std::vector<const IndexedMaterial*> found;
  const auto take = [&](const auto& meant) {
    for (const IndexedMaterial& each : materials_)
      if (meant(each)) found.push_back(&each);
    return !found.empty();
  };
  const auto same = [&](const std::string& word) { return same_but_for_capitals(word, text); };
  if (take([&](const IndexedMaterial& each) { return each.name == text; })) return found;
  if (take([&](const IndexedMaterial& each) { return std::ranges::find(each.replaces, text) != each.replaces.end(); }))
    return found;
  const auto is_called = [&](const IndexedMaterial& each) {
    return same(each.title) || std::ranges::any_of(each.called, same) ||
           std::ranges::any_of(each.called_in, [&](const auto& names) { return std::ranges::any_of(names.second, same); });
  };
  if (take(is_called)) return found;
  if (take([&](const IndexedMaterial& each) { return each.kind == text; })) return found;
  std::string dotted(text);  // `MODULE:NAME` too
  std::ranges::replace(dotted, ':', '.');
  take([&](const IndexedMaterial& each) { return each.module == text || each.module + "." + each.name == dotted; });
  return found;
}

std::vector<std::string> LibraryIndex::spellings() const {
  std::set<std::string> all;
  for (const IndexedMaterial& each : materials_) {
    all.insert(each.name);
    all.insert(each.called.begin(), each.called.end());
    all.insert(each.replaces.begin(), each.replaces.end());
    for (const auto& [language, names] : each.called_in) all.insert(names.begin(), names.end());
    if (!each.title.empty()) all.insert(each.title);
    if (!each.kind.empty()) all.insert(each.kind);
  }
  return {all.begin(), all.end()};
}

std::shared_ptr<const LibraryIndex> library_index(Resolver& resolver, const std::string& from) {
  struct Known {
    std::mutex mutex;
    std::map<std::string, std::shared_ptr<const LibraryIndex>> indices;
  };
  static PerProcess<Known> all;
  Known& known = *all;
  const std::string library = resolver.library(from);
  const std::scoped_lock lock(known.mutex);
  std::shared_ptr<const LibraryIndex>& index = known.indices[library];
  if (!index || library.empty()) index = std::make_shared<const LibraryIndex>(read_all(resolver, from));
  return index;
}

}  // namespace wale
