#include "library/review/review.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "compiler/compare/compare.hpp"
#include "compiler/diagnostics/advice.hpp"
#include "compiler/format/format.hpp"
#include "compiler/modules/library_index.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/text/embedded_files.hpp"
#include "library/review/contribution.hpp"
#include "library/licence/licence.hpp"
#include "library/licence/passing_on.hpp"
#include "library/review/report.hpp"
#include "library/review/words.hpp"
#include "runtime/machine/parallel.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

/// The library that a file lies in: the nearest folder above with a `wale.project`; empty if there is none.
std::string library_of(const std::string& file) {
  std::error_code ignored;
  for (fs::path folder = fs::absolute(file, ignored).parent_path(); !folder.empty(); folder = folder.parent_path()) {
    if (fs::exists(folder / project_marker, ignored)) return folder.string();
    if (folder == folder.parent_path()) break;
  }
  return {};
}

/// The folder of a file within its library: "wood" of "wood/oak.wale"; empty for a file that lies in none.
std::string folder_within(const std::string& file, const std::string& library) {
  std::error_code ignored;
  if (library.empty()) return {};
  const fs::path within = fs::relative(fs::absolute(file, ignored), library, ignored);
  return within.empty() || within == within.filename() ? std::string() : within.begin()->string();
}

/// Whether the text of a material has an error, or what stands outside of all materials has one, which it may rest on.
bool has_error_at(const Diagnostics& diagnostics, const MaterialDecl& material, const SyntaxTree& tree) {
  const auto lies_in = [](const Span& span, const Span& in) {
    return span.source == in.source && span.begin >= in.begin && span.end <= in.end;
  };
  return std::ranges::any_of(diagnostics.all(), [&](const Diagnostic& each) {
    if (severity_of(each.code) != Severity::error || is_of_library(each.code)) return false;
    return std::ranges::none_of(tree.declarations, [&](const Declaration& declaration) {
      const auto* other = std::get_if<MaterialDecl>(&declaration);
      return other && other != &material && lies_in(each.span, other->span);
    });
  });
}

/// Whether a folder holds the sources of the shipped library, perhaps another version of them than this binary: then
/// the binary's are no materials beside those of the folder.
bool is_source_of_shipped(const std::string& library) {
  if (library.empty()) return false;
  std::size_t all = 0, here = 0;
  std::error_code ignored;
  constexpr std::string_view root = "library/";
  for (const EmbeddedFile& each : embedded_files())
    if (std::string_view(each.name).starts_with(root))
      ++all, here += fs::exists(fs::path(library) / std::string_view(each.name).substr(root.size()), ignored);
  return 2 * here > all;
}

/// Whether a path means something on one machine only.
bool is_of_one_machine(std::string_view path) {
  const bool has_drive = path.size() > 2 && path[1] == ':' && (path[2] == '\\' || path[2] == '/');
  return path.starts_with('/') || path.starts_with("\\\\") || has_drive;
}

/// Reports pictures and tables that are named by where they lie on the author's machine.
void tell_paths(const SyntaxTree& tree, Diagnostics& diagnostics) {
  for (const Expr& each : tree.exprs) {
    const auto* call = std::get_if<Call>(&each);
    if (!call) continue;
    for (const Argument& argument : tree.arguments(*call))
      if (const auto* text = std::get_if<TextLiteral>(&tree.expr(argument.value)); text && is_of_one_machine(text->text))
        report(diagnostics, Code::unfit_file, tree.span(argument.value),
               fmt::format("`{}` is a path that only one machine has", visible_text(text->text)),
               "put the file beside this one, and name it from here");
  }
}

/// A word as `find` compares it: capitals do not matter.
std::string folded(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Errors that are about this machine and not about a file.
bool is_of_machine(Code code) {
  return code == Code::missing_library || code == Code::short_of_resources || code == Code::no_sandbox;
}

/// Calls `work` once for each of 0 .. count - 1, on as many threads as there are cores.
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  in_parallel(count, [&](std::size_t, std::size_t) {
    for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) work(i);
  });
}

/// A material of the library beside those that are reviewed.
struct Neighbour {
  std::string name;
  Cues cues;
};

class Reviewer {
 public:
  explicit Reviewer(const ReviewRequest& request)
      : request_(request),
        common_(common_modules()),
        comparer_(common_->declarations, default_device),
        others_classes_(devices_of_other_classes(common_->declarations, default_device)) {}

  Result<Review> review(const Contribution& contribution) {
    Review all;
    const std::vector<std::string>& files = contribution.files;
    std::vector<std::optional<Result<FactsReading>>> readings(files.size());
    std::vector<const FileFacts*> unchanged(files.size());
    for_each_in_parallel(files.size(), [&](std::size_t i) {
      if (request_.since) unchanged[i] = KeptReview::unchanged(request_.since->reviewed, files[i]);
      if (!unchanged[i]) readings[i] = read_facts(facts_request(files[i], {}, false));
    });
    for (std::size_t i = 0; i < files.size(); ++i) {
      ReviewedFile& file = all.files.emplace_back();
      file.file = files[i];
      if (readings[i] && !*readings[i] && is_of_machine(readings[i]->error().code)) return readings[i]->error();
      if (const auto begun = begin(file, readings[i], unchanged[i], all.kept); !begun) return begun.error();
      all.unchanged += unchanged[i] != nullptr;
    }
    if (!files.empty()) find_others(files);
    for (const UnfitFile& each : contribution.unfit) {
      ReviewedFile& file = all.files.emplace_back();
      file.file = each.path;
      report(file.diagnostics, Code::unfit_file, {file.sources.add(each.path, ""), 0, 0},
             fmt::format("`{}` cannot be part of a library: {}", visible_text(each.path), each.why),
             "leave it out, or put a plain file in its place");
    }
    for (const Entry& entry : entries_) {
      tell_names(all, entry);
      if (const auto held = hold_against_others(all, entry); !held) return held.error();
    }
    all.kept.neighbours = std::move(kept_neighbours_);
    std::ranges::sort(all.files, {}, &ReviewedFile::file);
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
    MaterialWords words;
    bool is_apart = false;  ///< in a folder whose materials are no contributions
  };

  FactsRequest facts_request(const std::string& file, const std::string& material, bool cues_alone) const {
    FactsRequest request;
    request.file.file = file, request.file.roots = request_.roots, request.file.sandbox = request_.sandbox;
    request.material = material, request.cues_alone = cues_alone;
    if (!cues_alone) request.others = others_classes_;
    return request;
  }

  /// Tells of one file what needs no other one.
  Result<> begin(ReviewedFile& file, std::optional<Result<FactsReading>>& reading, const FileFacts* unchanged,
                 KeptReview& kept) {
    const std::size_t number = file_count_++;
    const std::string library = library_of(file.file);
    const auto project = library.empty() ? Result<LibraryProject>(LibraryProject()) : project_of_library(library);
    if (!project) return project.error();
    const bool is_apart = project->is_apart(folder_within(file.file, library));
    SourceId source = 0;
    const CheckedModule* module = nullptr;
    const FileFacts* facts = unchanged;
    std::string imports;  // of an unchanged file they let it be passed on, or it would not have been kept
    if (reading && !*reading) {
      const Error& error = reading->error();
      file.diagnostics.report({.code = error.code,
                               .span = {file.sources.add(file.file, ""), 0, 0},
                               .message = fmt::format("`{}`: {}", visible_text(file.file), error.sentence),
                               .help = error.mend});
      return {};
    }
    if (reading) {
      OpenedFile& opened = (*reading)->opened;
      imports = why_imports_keep_back(opened);
      file.sources = std::move(opened.sources), file.diagnostics = std::move(opened.diagnostics);
      source = opened.source, module = &*opened.module, facts = &(*reading)->facts;
    } else {
      auto text = read_file(file.file, largest_source);
      if (!text) return text.error();
      source = file.sources.add(file.file, std::move(text->bytes));
    }
    Diagnostics again;  // of what has been reported
    const SyntaxTree tree = parse(file.sources, source, again);
    tell_paths(tree, file.diagnostics);
    for (const Declaration& declaration : tree.declarations)
      if (const auto* node = std::get_if<MaterialDecl>(&declaration); node && !imports.empty())
        report(file.diagnostics, Code::unfit_licence, node->name.span,
               fmt::format("`{}` may not be passed on: {}", node->name.text, visible_text(imports)),
               "rest it on what everybody may pass on, or leave it out");
    for (const Declaration& declaration : tree.declarations)
      if (const auto* node = std::get_if<MaterialDecl>(&declaration); node && module)
        if (const auto checked = std::ranges::find(module->materials, node->name.text, &CheckedMaterial::name);
            checked != module->materials.end())
          if (!is_apart)
            tell_layers(*node, *checked, module->declarations(), !has_error_at(file.diagnostics, *node, tree),
                        file.diagnostics);
    if (file.diagnostics.all().empty() && !facts->uses_names)
      kept.reviewed[file.file] = {hash_of(file.file, *facts), *facts};

    if (const auto formatted = format(file.sources, source, again);
        formatted && *formatted != file.sources[source].text)
      report(file.diagnostics, Code::unformatted_file, Span{source, 0, 0}, "the file is not in the standard style",
             fmt::format("run `wale format {}`", visible_text(file.file)));
    for (const Declaration& declaration : tree.declarations) {
      const auto* node = std::get_if<MaterialDecl>(&declaration);
      if (!node) continue;
      const auto told = std::ranges::find(facts->materials, node->name.text, &MaterialFacts::name);
      if (told == facts->materials.end()) continue;
      Entry entry{.file = number, .index = file.materials.size(), .name = node->name.span, .words = {}, .is_apart = false};
      ReviewedMaterial& material = file.materials.emplace_back();
      material.name = node->name.text, material.facts = *told;
      material.licence = project->licence;
      entry.is_apart = is_apart;
      entry.words = tell_words(material, *node, tree, is_apart, file.diagnostics);
      if (!is_apart) tell_folder(folder_within(file.file, library), material, node->name.span, file.diagnostics);
      entries_.push_back(std::move(entry));
    }
    return {};
  }

  /// Finds the materials of the library that are not reviewed.
  void find_others(const std::vector<std::string>& files) {
    const auto resolver = file_resolver(request_.roots);
    index_ = library_index(*resolver, files.front());
    const bool without_shipped = is_source_of_shipped(library_of(files.front()));
    std::set<std::string> own;
    std::error_code ignored;
    for (const std::string& file : files) own.insert(fs::weakly_canonical(file, ignored).string());
    for (const IndexedMaterial& each : index_->materials()) {
      if (each.origin == Origin::hidden || (each.shipped() && without_shipped)) continue;
      if (each.shipped() ||
          (fs::exists(each.file, ignored) && !own.contains(fs::weakly_canonical(each.file, ignored).string())))
        others_.push_back(&each);
    }
  }

  /// By which a material of the library is kept.
  static std::string key_of(const IndexedMaterial& material) {
    return (material.shipped() ? material.module : material.file) + ":" + material.name;
  }

  /// The cues of the library's materials of one branch, read when one of them is held against them.
  Result<const std::vector<Neighbour>*> neighbours(const std::string& branch) {
    const auto [known, is_new] = neighbours_.try_emplace(branch);
    if (!is_new) return &known->second;
    std::vector<const IndexedMaterial*> there;
    for (const IndexedMaterial* each : others_)
      if (branch_of(each->kind) == branch) there.push_back(each);
    std::vector<KeptReview::File> read(there.size());
    for_each_in_parallel(there.size(), [&](std::size_t i) {
      const IndexedMaterial& material = *there[i];
      const std::string key = key_of(material), path = material.shipped() ? key : material.file;
      if (request_.since)
        if (const FileFacts* facts = KeptReview::unchanged(request_.since->neighbours, key)) {
          read[i] = {request_.since->neighbours.at(key).hash, *facts};
          return;
        }
      auto reading = read_facts(facts_request(path, material.name, true));
      if (!reading) return;  // whose author hears of it, not who offers another
      read[i].facts = std::move(reading->facts);
      read[i].facts.looked_for.push_back(path);
      if (!read[i].facts.uses_names) read[i].hash = hash_of(key, read[i].facts);
    });
    for (std::size_t i = 0; i < there.size(); ++i) {
      for (const MaterialFacts& each : read[i].facts.materials)
        if (each.cues) known->second.push_back({each.name, *each.cues});
      if (!read[i].hash.empty()) kept_neighbours_[key_of(*there[i])] = std::move(read[i]);
    }
    return &known->second;
  }

  /// Materials that feel the same.
  Result<> hold_against_others(Review& all, const Entry& entry) {
    ReviewedFile& file = all.files[entry.file];
    ReviewedMaterial& material = file.materials[entry.index];
    material.apart = std::numeric_limits<double>::quiet_NaN();
    if (!material.facts.cues || material.kind.empty()) return {};
    const std::string branch = branch_of(material.kind);
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::string> same;
    std::string first_same;  // as a command finds it from here
    const auto look = [&](const std::string& name, const Cues& cues, bool may_be_same, const std::string& file_of_it) {
      const Distance distance = comparer_.distance(*material.facts.cues, cues);
      if (distance.verdict == Verdict::alike && !may_be_same) {
        if (same.empty()) first_same = file_of_it.empty() ? name : visible_text(file_of_it) + ":" + name;
        same.push_back(name);
      }
      if (distance.verdict == Verdict::unknown || distance.noticeable >= least) return;
      least = distance.noticeable, material.nearest = name;
    };
    const auto replaced = [](const std::vector<std::string>& names, const std::string& name) {
      return std::ranges::find(names, name) != names.end();
    };
    for (const Entry& other : entries_) {
      const ReviewedMaterial& there = all.files[other.file].materials[other.index];
      if (&other == &entry || !there.facts.cues || branch_of(there.kind) != branch) continue;
      look(there.name, *there.facts.cues,
           replaced(entry.words.replaces, there.name) || replaced(other.words.replaces, material.name),
           all.files[other.file].file);
    }
    const auto beside = neighbours(branch);
    if (!beside) return beside.error();
    for (const Neighbour& other : **beside) look(other.name, other.cues, replaced(entry.words.replaces, other.name), "");
    if (!material.nearest.empty()) material.apart = least;
    else if (const auto near = nearest_kind(all, entry)) material.nearest_kind = *near;
    if (!same.empty() && !entry.is_apart)
      report(file.diagnostics, Code::feels_the_same, entry.name,
             fmt::format("nobody tells `{}` from `{}`", material.name, fmt::join(same, "` and `")),
             fmt::format("change what should tell them apart, or leave it out; `wale compare {}:{} {}` shows the cues",
                         visible_text(file.file), material.name, first_same));
    return {};
  }

  /// Names that are taken, in any language.
  void tell_names(Review& all, const Entry& entry) {
    ReviewedFile& file = all.files[entry.file];
    const std::string& name = file.materials[entry.index].name;
    const auto find = [&](const std::string& sought) {
      std::set<std::string> into;
      for (const Entry& other : entries_)
        if (&other != &entry && all.files[other.file].materials[other.index].name == sought)
          into.insert(all.files[other.file].file);
      for (const IndexedMaterial* other : others_)
        if (other->name == sought) into.insert(other->file);
      return into;
    };
    if (std::ranges::find(entry.words.replaces, name) != entry.words.replaces.end())
      report(file.diagnostics, Code::still_there, entry.name, fmt::format("`{}` replaces itself", name),
             "leave out `replaces`, or give the new one another name");
    const auto where = find(name);
    if (!where.empty() && !entry.is_apart)
      report(file.diagnostics, Code::taken_name, entry.name,
             fmt::format("`{}` is also the name of a material in {}", name, listed(where)),
             "give it another name, or take the other away and write `replaces` here if its name was another");
    std::set<std::string> there;
    for (const std::string& each : entry.words.replaces) there.merge(find(each));
    if (!there.empty())
      report(file.diagnostics, Code::still_there, entry.name,
             fmt::format("`{}` replaces a material that is still in {}", name, listed(there)),
             "take that one away, or leave out `replaces`");
    tell_rivals(all, entry, name);
    if (!entry.is_apart) tell_shared_words(all, entry, name);
  }

  /// Others that replace the same name, which then means none of them.
  void tell_rivals(Review& all, const Entry& entry, const std::string& name) {
    ReviewedFile& file = all.files[entry.file];
    for (const std::string& old : entry.words.replaces) {
      std::set<std::string> rivals;
      const auto look = [&](const std::vector<std::string>& replaces, const std::string& other, const std::string& there) {
        if (std::ranges::find(replaces, old) != replaces.end())
          rivals.insert(fmt::format("`{}` in `{}`", other, visible_text(there)));
      };
      for (const Entry& other : entries_)
        if (&other != &entry)
          look(other.words.replaces, all.files[other.file].materials[other.index].name, all.files[other.file].file);
      for (const IndexedMaterial* other : others_) look(other->replaces, other->name, other->file);
      if (!rivals.empty())
        report(file.diagnostics, Code::taken_name, entry.name,
               fmt::format("`{}` replaces `{}`, and so does {}", name, visible_text(old), fmt::join(rivals, " and ")),
               "let one of them replace it: a name that several replace means none of them");
    }
  }

  /// The kind that a material of an unknown one may mean: a misspelt one, or the longest whose words it has without
  /// dots, as `wovenfabric` has those of `fabric.woven`. Nothing if another material has its kind's first word.
  std::optional<std::string> nearest_kind(const Review& all, const Entry& entry) const {
    const std::string& own = all.files[entry.file].materials[entry.index].kind;
    std::set<std::string> kinds;
    for (const Entry& each : entries_)
      if (&each != &entry) kinds.insert(all.files[each.file].materials[each.index].kind);
    for (const IndexedMaterial* each : others_) kinds.insert(each->kind);
    kinds.erase("");
    std::string meant;
    for (const std::string& each : kinds) {
      if (branch_of(each) == branch_of(own)) return std::nullopt;
      bool has_all = true;
      for (std::size_t begin = 0, end = 0; begin <= each.size(); begin = end + 1) {
        end = std::min(each.find('.', begin), each.size());
        has_all = has_all && own.find(each.substr(begin, end - begin)) != std::string::npos;
      }
      if (has_all && each.size() > meant.size()) meant = each;
    }
    if (auto near = nearest_spelling(own, {kinds.begin(), kinds.end()})) return near;
    return meant.empty() ? std::nullopt : std::optional(meant);
  }

  void tell_shared_words(Review& all, const Entry& entry, const std::string& name) {
    fill_words(all);
    ReviewedFile& file = all.files[entry.file];
    std::set<std::string> own, shared, owners;
    for (const std::string& each : entry.words.names) own.insert(folded(each));
    for (const std::string& word : own) {
      const auto found = words_.find(word);
      if (found == words_.end()) continue;
      for (const std::string& owner : found->second)
        if (owner != name && std::ranges::find(entry.words.replaces, owner) == entry.words.replaces.end())
          shared.insert("\"" + visible_text(word) + "\""), owners.insert("`" + owner + "`");
    }
    if (!shared.empty())
      report(file.diagnostics, Code::shared_word, entry.name,
             fmt::format("`{}` is called {}, and so is {}", name, fmt::join(shared, ", "), fmt::join(owners, ", ")),
             "leave out the word where it fits less, or put another one in its place");
  }

  /// Which materials have a word as their name, title or other name.
  void fill_words(const Review& all) {
    if (!words_.empty()) return;
    const auto add = [&](const std::string& word, const std::string& owner) {
      if (!word.empty()) words_[folded(word)].insert(owner);
    };
    for (const Entry& each : entries_) {
      const std::string& owner = all.files[each.file].materials[each.index].name;
      add(owner, owner);
      for (const std::string& word : each.words.names) add(word, owner);
    }
    for (const IndexedMaterial* each : others_) {
      add(each->name, each->name), add(each->title, each->name);
      for (const std::string& word : each->called) add(word, each->name);
      for (const auto& [language, names] : each->called_in)
        for (const std::string& word : names) add(word, each->name);
    }
  }

  static std::string listed(const std::set<std::string>& files) {
    std::vector<std::string> shown;
    for (const std::string& each : files) shown.push_back("`" + visible_text(each) + "`");
    return fmt::format("{}", fmt::join(shown, ", "));
  }

  const ReviewRequest& request_;
  std::shared_ptr<const CommonModules> common_;
  Comparer comparer_;
  std::vector<std::string> others_classes_;
  std::size_t file_count_ = 0;
  std::vector<Entry> entries_;
  std::shared_ptr<const LibraryIndex> index_;
  std::vector<const IndexedMaterial*> others_;  // of `index_`
  std::map<std::string, std::vector<Neighbour>> neighbours_;
  std::map<std::string, KeptReview::File> kept_neighbours_;
  std::map<std::string, std::set<std::string>> words_;
};

}  // namespace

Result<Review> review(const ReviewRequest& request) {
  const auto contribution = contribution_of(request.paths);
  if (!contribution) return contribution.error();
  return Reviewer(request).review(*contribution);
}

}  // namespace wale
