#include "library/site/read_site_file.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "compiler/cpp/print_header.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/text/json_text.hpp"
#include "library/index/content_hash.hpp"
#include "library/licence/licence.hpp"
#include "library/licence/passing_on.hpp"
#include "library/site/material_page.hpp"

namespace wale {
namespace {

constexpr std::size_t longest_source = 24 << 10;  // bytes that a page shows; the download has all

/// The text of one material's declaration, with the comment above it.
std::string declaration_of(const SyntaxTree& tree, std::string_view text, const std::string& name) {
  for (const Declaration& declaration : tree.declarations) {
    const auto* node = std::get_if<MaterialDecl>(&declaration);
    if (!node || node->name.text != name) continue;
    std::size_t begin = text.rfind('\n', node->span.begin == 0 ? 0 : node->span.begin - 1);
    begin = begin == std::string_view::npos ? 0 : begin + 1;
    while (begin > 1) {
      const std::size_t above = text.rfind('\n', begin - 2);
      const std::size_t line = above == std::string_view::npos ? 0 : above + 1;
      if (!text.substr(line, begin - line).starts_with("///")) break;
      begin = line;
    }
    return std::string(text.substr(begin, node->span.end - begin));
  }
  return {};
}

/// At most `longest_source` bytes, in whole lines.
std::string shown_source(std::string text) {
  if (text.size() <= longest_source) return text;
  text.resize(text.rfind('\n', longest_source) + 1);
  return text + "// … and so on: the download has all of it\n";
}

std::vector<std::string> what_is_unknown(const Description& told) {
  std::vector<std::string> lines;
  for (const DescribedPercept& each : told.percepts) {
    std::string line;
    if (each.unknown) line = each.name + ": no map tells the level of what it pushes";
    for (const OutsideRange& outside : each.outside)
      line += (line.empty() ? each.name + ": " : "; ") + outside_in_words(outside);
    if (line.empty() && each.evidence() == Evidence::extrapolated)
      line = each.name + ": " + (each.domain_why.empty() ? "extrapolated" : "extrapolated, " + each.domain_why);
    if (!line.empty()) lines.push_back(std::move(line));
  }
  if (told.percepts.empty())
    lines.push_back("no percept: " +
                    (told.no_percept.empty() ? std::string("no map tells what it pushes") : told.no_percept));
  return lines;
}

SiteMaterial words_of_entry(const Entry& entry) {
  SiteMaterial material;
  material.name = entry.name, material.module = entry.module, material.file = entry.file,
  material.folder = entry.folder;
  material.kind = entry.kind, material.title = entry.title, material.documentation = entry.documentation;
  material.licence = entry.licence, material.names = entry.names, material.feels = entry.feels;
  material.asks = entry.asks, material.replaces = entry.replaces, material.sources = entry.sources;
  material.content = entry.content, material.trouble = entry.trouble;
  return material;
}

void add_feel(SiteMaterial& material, const Entry& entry) {
  for (const EntryPercept& each : entry.felt.percepts)
    material.percepts.push_back({each.name, each.asked, each.reads, each.means.low, each.means.high,
                                 each.reads ? evidence_word(each.evidence()) : std::string()});
  material.cues = entry.felt.cues;
}

/// Writes the files of one material.
Result<> write_material(SiteMaterial& material, const Entry& entry, const Declarations& declarations,
                        MaterialSources sources, SiteFolder& folder) {
  const auto* begin = entry.program.data();
  const auto program = Program::load(std::span(begin, entry.program.size()));
  if (!program) {
    material.trouble = program.error().sentence;
    return {};
  }
  const Bank bank(*program);
  const Description told = describe(bank, declarations);
  auto figures = draw_site_figures(bank, told, declarations, material.page);
  if (!figures) return figures.error();
  material.width = told.patch.width, material.height = told.patch.height;
  material.side = figures->side, material.of_velocity = figures->of_velocity, material.small = figures->small;
  material.newton = told.shaking ? 0 : told.force.max_newton;
  material.unknown = what_is_unknown(told);
  sources.entry = &entry, sources.description = &told, sources.figures = &*figures;
  sources.program = &program->description();
  sources.program_path = "take/" + material.page + ".wpp", sources.header_path = "take/" + material.page + ".hpp";

  std::vector<SiteFile> files = std::move(figures->files);
  files.push_back({sources.program_path, {reinterpret_cast<const char*>(begin), entry.program.size()}});
  files.push_back({sources.header_path, print_header(*program, {})});
  const SitePage page = material_page(material, sources);
  files.push_back({page.path, framed(page)});
  files.push_back({"material/" + material.page + ".json", json_lines(material_dataset(material, sources, true))});
  for (const SiteFile& file : files) {
    if (const auto written = folder.put(file.path, file.bytes); !written) return written.error();
    material.files.push_back(file.path);
  }
  if (!sources.source.empty()) material.files.push_back(sources.source);
  return {};
}

}  // namespace

Result<SiteInputRead> read_site_file(const SiteInput& input, const FileRequest& request, const DeclaredNames& names,
                                     SiteFolder& folder,
                                     const std::function<std::string(const std::string& material)>& page_of) {
  SiteInputRead result;
  result.rests_on.emplace_back(input.path, hash_of_file(input.path));
  FileRequest watched = request;
  watched.file = input.path;
  auto read = read_entries(watched, input.module);
  const auto lose = [&](const Error& error) {
    SiteMaterial& lost = result.materials.emplace_back();
    lost.name = input.module, lost.module = input.module, lost.file = input.path, lost.trouble = error.sentence;
  };
  if (!read) {
    lose(read.error());
    return result;
  }
  result.uses_names = read->uses_names;
  for (const std::string& path : read->looked_for)
    if (path != input.path) result.rests_on.emplace_back(path, hash_of_file(path));
  if (read->opened.is_on_disk)  // the licences in them may change
    for (const std::string& path : projects_under(read->opened)) result.rests_on.emplace_back(path, hash_of_file(path));
  if (read->unparsed) {
    lose(*read->unparsed);
    return result;
  }

  OpenedFile& opened = read->opened;
  const std::string text = opened.sources[opened.source].text;
  // What is in this binary is in the public domain (library/LICENSE).
  const std::string over = opened.is_on_disk ? licence_over(input.path) : std::string("CC0-1.0");
  Diagnostics again;
  const SyntaxTree tree = parse(opened.sources, opened.source, again);
  const std::string imports = why_imports_keep_back(opened);
  // A text with an error may say what it is under where that cannot be read.
  bool all_may = imports.empty() && !opened.diagnostics.has_errors();
  for (Entry& entry : read->entries) {
    if (entry.licence.empty()) entry.licence = over;
    all_may = all_may && entry.trouble.empty() && may_be_shared(entry.licence);
  }
  std::string source;
  if (all_may && !read->entries.empty()) {
    source = "source/" + page_name(input.module) + ".wale";
    if (const auto written = folder.put(source, text); !written) return written.error();
  }
  for (const Entry& entry : read->entries) {
    SiteMaterial material = words_of_entry(entry);
    if (material.published()) {
      material.trouble = imports.empty() ? why_kept_back(entry.licence) : imports;
      material.unlicensed = !material.trouble.empty();
    }
    if (material.published()) {
      material.page = page_of(entry.name);
      add_feel(material, entry);
      MaterialSources sources{.names = &names};
      sources.source = source;
      sources.text = shown_source(read->entries.size() == 1 && all_may ? text : declaration_of(tree, text, entry.name));
      const auto written = write_material(material, entry, opened.module->declarations(), std::move(sources), folder);
      if (!written) return written.error();
    }
    if (!material.published()) {
      // Nothing but its name and the reason is known to the site.
      SiteMaterial kept_back;
      kept_back.name = material.name, kept_back.module = material.module, kept_back.file = material.file;
      kept_back.trouble = material.trouble, kept_back.unlicensed = material.unlicensed;
      kept_back.content = material.content;
      material = std::move(kept_back);
    }
    result.materials.push_back(std::move(material));
  }
  return result;
}

}  // namespace wale
