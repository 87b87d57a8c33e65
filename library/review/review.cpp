#include "library/review/review.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "compiler/compare/compare.hpp"
#include "compiler/compare/compare_files.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/diagnostics/advice.hpp"
#include "compiler/format/format.hpp"
#include "compiler/modules/library_index.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/modules/representative.hpp"
#include "compiler/parse/parse.hpp"
#include "library/review/licence.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

/// The first word of a kind: "fabric" of "fabric.woven".
std::string branch_of(std::string_view kind) { return std::string(kind.substr(0, kind.find('.'))); }

/// The Wale files that paths name, each once, in order.
Result<std::vector<std::string>> files_below(const std::vector<std::string>& paths) {
  std::set<std::string> files;
  for (const std::string& path : paths) {
    std::error_code trouble;
    if (!fs::is_directory(path, trouble)) {
      if (!fs::exists(path, trouble))
        return Error{.code = Code::unreadable_file,
                     .sentence = "there is no such file or folder",
                     .mend = "name a Wale file or a folder of them",
                     .place = {.name = path}};
      files.insert(path);
      continue;
    }
    for (fs::recursive_directory_iterator at(path, trouble), end; !trouble && at != end; at.increment(trouble))
      if (at->path().extension() == ".wale" && at->is_regular_file(trouble)) files.insert(at->path().string());
    if (trouble)
      return Error{.code = Code::unreadable_file,
                   .sentence = fmt::format("the folder cannot be read: {}", trouble.message()),
                   .mend = "make it readable",
                   .place = {.name = path}};
  }
  if (files.empty())
    return Error{.code = Code::unknown_material,
                 .sentence = "there is no Wale file here",
                 .mend = "name a `.wale` file, or a folder that holds some",
                 .place = {.name = paths.front()}};
  return std::vector<std::string>(files.begin(), files.end());
}

/// The library that a file lies in: the nearest folder above with a `wale.project`; empty if there is none.
std::string library_of(const std::string& file) {
  std::error_code ignored;
  for (fs::path folder = fs::absolute(file, ignored).parent_path(); !folder.empty(); folder = folder.parent_path()) {
    if (fs::exists(folder / project_marker, ignored)) return folder.string();
    if (folder == folder.parent_path()) break;
  }
  return {};
}

/// Whether the map of a level is simulated: the one that is named, or, without a name, each one of the percept.
bool rests_on_simulation(const AskedPercept& asked, const Declarations& declarations) {
  bool simulated = false, felt = false;
  declarations.each_map([&](const Map& map) {
    if (map.percept != asked.name || (!asked.by.empty() && map.name != asked.by)) return;
    (map.simulated() ? simulated : felt) = true;
  });
  return simulated && (!felt || !asked.by.empty());
}

/// A material of the library beside those that are reviewed.
struct Neighbour {
  std::string name, branch;
  Cues cues;
};

class Reviewer {
 public:
  Reviewer(const std::vector<std::string>& roots, Sandbox sandbox)
      : common_(common_modules()), comparer_(common_->declarations, default_device) {
    request_.roots = roots, request_.sandbox = sandbox;
  }

  Result<Review> review(const std::vector<std::string>& files) {
    std::vector<ComparedFile> read = read_cues(files, request_, common_->declarations);
    for (const ComparedFile& each : read)
      if (!each.opened) return each.opened.error();
    Review all;
    all.files.resize(files.size());
    for (std::size_t i = 0; i < files.size(); ++i) {
      all.files[i].file = files[i];
      if (const auto begun = begin(all.files[i], *read[i].opened, read[i].cues); !begun) return begun.error();
    }
    read_neighbours(files);
    for (std::size_t i = 0; i < files.size(); ++i) hold_against_others(all, i);
    for (ReviewedFile& each : all.files) {
      each.diagnostics.sort();
      all.errors += each.diagnostics.error_count();
      all.warnings += each.diagnostics.all().size() - each.diagnostics.error_count();
      all.materials += each.materials.size();
    }
    return all;
  }

 private:
  /// A material under review, and where its name stands.
  struct Entry {
    std::size_t file = 0, index = 0;
    Span name;
    std::vector<std::string> replaces;
    std::optional<Cues> cues;
  };

  void report(ReviewedFile& file, Code code, Span span, std::string message, std::string help) {
    file.diagnostics.report(Advice(std::move(help)).about(code, span, std::move(message)));
  }

  Result<> begin(ReviewedFile& file, OpenedFile& opened, const std::vector<Cues>& cues) {
    const std::size_t number = file_count_++;
    file.sources = std::move(opened.sources), file.diagnostics = std::move(opened.diagnostics);
    const std::string library = library_of(file.file);
    const auto licence = licence_of_library(library.empty() ? "." : library);
    if (!library.empty() && !licence) return licence.error();
    if (!opened.module) return {};
    Diagnostics again;  // of what has been reported
    const SyntaxTree tree = parse(file.sources, opened.source, again);
    if (const auto formatted = format(file.sources, opened.source, again);
        formatted && *formatted != file.sources[opened.source].text)
      report(file, Code::unformatted_file, Span{opened.source, 0, 0}, "the file is not in the standard style",
             fmt::format("run `wale format {}`", visible_text(file.file)));
    for (const Declaration& declaration : tree.declarations) {
      const auto* node = std::get_if<MaterialDecl>(&declaration);
      if (!node) continue;
      const auto checked = std::ranges::find(opened.module->materials, node->name.text, &CheckedMaterial::name);
      if (checked == opened.module->materials.end()) continue;
      const auto felt = std::ranges::find(cues, node->name.text, &Cues::material);
      Entry entry{.file = number, .index = file.materials.size(), .name = node->name.span, .replaces = {}, .cues = {}};
      if (felt != cues.end()) entry.cues = *felt;
      ReviewedMaterial& material = file.materials.emplace_back();
      material.name = node->name.text;
      material.licence = library.empty() ? "" : *licence;
      tell_words(file, material, entry, *node, tree);
      tell_layers(file, material, *node, *checked, opened.module->declarations());
      tell_folder(file, material, node->name.span, library);
      entries_.push_back(std::move(entry));
    }
    return {};
  }

  /// What a catalogue shows of a material: names, kind, sources, licence.
  void tell_words(ReviewedFile& file, ReviewedMaterial& material, Entry& entry, const MaterialDecl& node,
                  const SyntaxTree& tree) {
    std::set<std::string, std::less<>> has;
    bool translated = false;
    Span licence_at = node.name.span;
    Diagnostics again;
    for (const Setting& setting : node.representative) {
      if (!is_representative_setting(setting.key.text) || setting.key.text == "like") continue;
      const RepresentativeEntry said = representative_entry(setting, tree, again);
      if (said.values.empty()) continue;
      has.insert(std::string(setting.key.text));
      if (setting.key.text == "called") translated |= !language_of(setting).empty() && language_of(setting) != "en";
      if (said.key == "title") material.title = said.values.front();
      if (said.key == "kind") material.kind = said.values.front();
      if (said.key == "licence") material.licence = said.values.front(), licence_at = setting.span;
      if (said.key == "replaces") entry.replaces = said.values;
    }
    const auto lacks = [&](const char* what, std::string help) {
      report(file, Code::incomplete_material, node.name.span, fmt::format("`{}` has no {}", material.name, what),
             std::move(help));
    };
    if (!has.contains("title")) lacks("title", "write `title \"…\"` in its representative block");
    if (!has.contains("kind")) lacks("kind", "write, for example, `kind fabric.woven` in its representative block");
    if (!has.contains("called")) lacks("other name", "write, for example, `called \"corduroy\", \"ribbed cotton\"`");
    if (!translated) lacks("name in another language", "write, for example, `called de \"Cord\"`");
    if (!has.contains("source"))
      lacks("source", "write `source \"…\"`: where its figures come from, or that they are an estimate, and whose");
    if (node.documentation.empty()) lacks("documentation", "write `/// …` above it: what it is, and how it pushes");
    if (material.licence.empty())
      report(file, Code::no_licence, node.name.span, fmt::format("`{}` has no licence", material.name),
             "write `licence \"CC0-1.0\"` in it, or in the `wale.project` of the library");
    else if (!may_be_shared(material.licence)) {
      const auto near = nearest_licence(material.licence);
      report(file, Code::unfit_licence, licence_at,
             fmt::format("\"{}\" is no licence under which everybody may pass on, change and use a material",
                         visible_text(material.licence)),
             near ? fmt::format("did you mean \"{}\"?", *near)
                  : "choose one that SPDX lists and that allows it, as \"CC0-1.0\" or \"CC-BY-4.0\"");
    }
  }

  void tell_layers(ReviewedFile& file, ReviewedMaterial& material, const MaterialDecl& node,
                   const CheckedMaterial& checked, const Declarations& declarations) {
    if (checked.percepts.empty())
      report(file, Code::incomplete_material, node.name.span,
             fmt::format("`{}` does not say how it feels", material.name),
             "write a `perceptual` block with levels, as in `roughness 0.35 estimated`");
    if (!checked.force)
      report(file, Code::incomplete_material, node.name.span, fmt::format("`{}` has no physics", material.name),
             "write a `physical` block with a force");
    for (const AskedPercept& asked : checked.percepts) {
      if (asked.evidence == Evidence::simulated || rests_on_simulation(asked, declarations))
        report(file, Code::simulated_figures, asked.place(),
               fmt::format("the {} of `{}` is simulated: nobody has felt it", asked.name, material.name),
               "choose a map that people were measured for, as in `roughness 0.5, by minsky1995.figure19`");
      material.levels.push_back({asked.name, asked.level, asked.evidence ? evidence_word(*asked.evidence) : ""});
      if (!asked.evidence && !asked.blended)
        report(file, Code::incomplete_material, asked.place(),
               fmt::format("`{}` does not say how well its {} is known", material.name, asked.name),
               "write it behind the level: `measured`, `published` with a `source`, or `estimated`");
    }
  }

  void tell_folder(ReviewedFile& file, const ReviewedMaterial& material, Span span, const std::string& library) {
    if (library.empty() || material.kind.empty()) return;
    std::error_code ignored;
    const fs::path within = fs::relative(fs::absolute(file.file, ignored), library, ignored);
    if (within.empty() || within == within.filename()) return;
    const std::string folder = within.begin()->string(), branch = branch_of(material.kind);
    if (folder == branch || folder == "std") return;
    report(file, Code::elsewhere_in_library, span,
           fmt::format("a material of the kind `{}` lies in the folder `{}`", material.kind, visible_text(folder)),
           fmt::format("move the file into `{}`", branch));
  }

  /// The materials of the library that are not reviewed, of the kinds that are.
  void read_neighbours(const std::vector<std::string>& files) {
    const auto resolver = file_resolver(request_.roots);
    index_ = library_index(*resolver, files.front());
    std::set<std::string> branches, own;
    std::error_code ignored;
    for (const std::string& file : files) own.insert(fs::weakly_canonical(file, ignored).string());
    std::vector<const IndexedMaterial*> others;
    for (const IndexedMaterial& each : index_->materials()) {
      const bool reviewed = !each.shipped() && own.contains(fs::weakly_canonical(each.file, ignored).string());
      if (each.origin != Origin::hidden && !reviewed) others.push_back(&each);
    }
    others_ = others;
  }

  /// Reads the neighbours of one branch when one of its materials is held against them.
  const std::vector<Neighbour>& neighbours(const std::string& branch) {
    const auto [known, is_new] = neighbours_.try_emplace(branch);
    if (!is_new) return known->second;
    std::vector<std::string> names;
    for (const IndexedMaterial* each : others_)
      if (branch_of(each->kind) == branch)
        names.push_back(each->shipped() ? each->module + ":" + each->name : each->file + ":" + each->name);
    for (const ComparedFile& file : read_cues(names, request_, common_->declarations))
      for (const Cues& cues : file.cues) known->second.push_back({cues.material, branch, cues});
    return known->second;
  }

  /// Names that are taken, and materials that feel the same.
  void hold_against_others(Review& all, std::size_t number) {
    for (const Entry& entry : entries_) {
      if (entry.file != number) continue;
      ReviewedFile& file = all.files[number];
      ReviewedMaterial& material = file.materials[entry.index];
      tell_names(all, entry);
      if (!entry.cues || material.kind.empty()) continue;
      const std::string branch = branch_of(material.kind);
      double least = std::numeric_limits<double>::infinity();
      std::vector<std::string> same;
      const auto look = [&](const std::string& name, const Cues& cues, bool may_be_same) {
        const Distance distance = comparer_.distance(*entry.cues, cues);
        if (distance.verdict == Verdict::alike && !may_be_same) same.push_back(name);
        if (distance.verdict == Verdict::unknown || distance.noticeable >= least) return;
        least = distance.noticeable, material.nearest = name;
      };
      const auto replaced = [](const std::vector<std::string>& names, const std::string& name) {
        return std::ranges::find(names, name) != names.end();
      };
      for (const Entry& other : entries_) {
        const ReviewedMaterial& there = all.files[other.file].materials[other.index];
        if (&other == &entry || !other.cues || branch_of(there.kind) != branch) continue;
        look(there.name, *other.cues, replaced(entry.replaces, there.name) || replaced(other.replaces, material.name));
      }
      for (const Neighbour& other : neighbours(branch))
        look(other.name, other.cues, replaced(entry.replaces, other.name));
      material.apart = material.nearest.empty() ? std::numeric_limits<double>::quiet_NaN() : least;
      if (!same.empty())
        report(file, Code::feels_the_same, entry.name,
               fmt::format("nobody tells `{}` from `{}`", material.name, fmt::join(same, "` and `")),
               fmt::format("change what should tell them apart, or leave it out; `wale compare {} {}` shows the cues",
                           visible_text(file.file), same.front()));
    }
  }

  void tell_names(Review& all, const Entry& entry) {
    ReviewedFile& file = all.files[entry.file];
    const std::string& name = file.materials[entry.index].name;
    std::set<std::string> where, there;
    const auto find = [&](const std::string& sought, std::set<std::string>& into) {
      for (const Entry& other : entries_)
        if (&other != &entry && all.files[other.file].materials[other.index].name == sought)
          into.insert(all.files[other.file].file);
      for (const IndexedMaterial* other : others_)
        if (other->name == sought) into.insert(other->file);
    };
    find(name, where);
    if (!where.empty())
      report(file, Code::taken_name, entry.name, fmt::format("`{}` is also the name of a material in {}", name, listed(where)),
             "give it another name, or take the other away and write `replaces` here if its name was another");
    for (const std::string& each : entry.replaces) find(each, there);
    if (!there.empty())
      report(file, Code::still_there, entry.name,
             fmt::format("`{}` replaces a material that is still in {}", name, listed(there)),
             "take that one away, or leave out `replaces`");
  }

  static std::string listed(const std::set<std::string>& files) {
    std::vector<std::string> shown;
    for (const std::string& each : files) shown.push_back("`" + visible_text(each) + "`");
    return fmt::format("{}", fmt::join(shown, ", "));
  }

  std::shared_ptr<const CommonModules> common_;
  Comparer comparer_;
  FileRequest request_;
  std::size_t file_count_ = 0;
  std::vector<Entry> entries_;
  std::shared_ptr<const LibraryIndex> index_;
  std::vector<const IndexedMaterial*> others_;  // of `index_`
  std::map<std::string, std::vector<Neighbour>> neighbours_;
};

}  // namespace

Result<Review> review(const std::vector<std::string>& paths, const std::vector<std::string>& roots, Sandbox sandbox) {
  const auto files = files_below(paths);
  if (!files) return files.error();
  return Reviewer(roots, sandbox).review(*files);
}

}  // namespace wale
