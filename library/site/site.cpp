#include "library/site/site.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "compiler/compare/compare.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/text/json_text.hpp"
#include "library/index/content_hash.hpp"
#include "library/index/library_files.hpp"
#include "library/licence/passing_on.hpp"
#include "library/site/assets.hpp"
#include "library/site/gallery.hpp"
#include "library/site/material_page.hpp"
#include "library/site/read_site_file.hpp"
#include "library/site/space.hpp"
#include "library/store/read_library.hpp"
#include "library/store/seek.hpp"
#include "runtime/machine/parallel.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t neighbours_shown = 6;
constexpr std::string_view library_in_notes = "<library>/";

std::string without_capitals(std::string text) {
  for (char& each : text)
    if (each >= 'A' && each <= 'Z') each = static_cast<char>(each - 'A' + 'a');
  return text;
}

/// The names of the materials of a file; nothing is checked.
std::vector<std::string> names_in(const std::string& path) {
  std::string text;
  for (const EmbeddedFile& each : embedded_files())
    if (each.name == path) text = each.text;
  if (const auto found = read_file(path, largest_source)) text = found->bytes;
  SourceSet sources;
  Diagnostics ignored;
  LibraryIndex index;
  index.add("", path, parse(sources, sources.add(path, std::move(text)), ignored));
  std::vector<std::string> names;
  for (const IndexedMaterial& each : index.materials()) names.push_back(each.name);
  return names;
}

/// What the last build noted of a file.
struct Noted {
  SiteInputRead read;
  std::string named;   ///< as `FileHashes` has it
  std::string others;  ///< of all that files are called, if it uses names of others
};

/// One build of a site.
class SiteBuild {
 public:
  SiteBuild(const SiteRequest& request, SiteFolder folder, const std::function<void(std::size_t, std::size_t)>& tell)
      : request_(request),
        folder_(std::move(folder)),
        tell_(tell),
        common_(common_modules()),
        names_(common_->declarations) {
    file_request_.device = request.device, file_request_.roots = request.roots, file_request_.sandbox = request.sandbox;
    for (const EmbeddedFile& each : embedded_site()) base_.take(each.name).take(each.text);
    base_digits_ = base_.take(compiler_build()).take(request.device).digits();
  }

  Result<SiteReport> build(const std::vector<SiteInput>& inputs) {
    inputs_ = inputs;
    const std::string first = inputs_.empty() ? std::string() : inputs_.front().path, project = project_over(first);
    std::error_code ignored;
    root_ = (project.empty() ? fs::absolute(first, ignored).parent_path() : fs::path(project)).lexically_normal();
    take_notes();
    name_pages();
    if (const auto read = read_files(); !read) return read.error();
    gather();
    if (const auto written = write_neighbours(); !written) return written.error();
    if (const auto written = write_lists(); !written) return written.error();
    if (const auto ended = folder_.finish(notes_text()); !ended) return ended.error();
    report_.materials = published_.size(), report_.files = folder_.files(), report_.changed = folder_.changed();
    return report_;
  }

 private:
  /// A path as the notes have it, which are published with the site: a whole one begins at the library and not at the
  /// root of this machine.
  std::string in_notes(const std::string& path) const {
    if (!fs::path(path).is_absolute()) return path;
    const fs::path way = fs::path(path).lexically_normal().lexically_relative(root_);
    return way.empty() ? path : std::string(library_in_notes) + way.string();
  }
  std::string of_notes(const std::string& noted) const {
    if (!noted.starts_with(library_in_notes)) return noted;
    return (root_ / noted.substr(library_in_notes.size())).lexically_normal().string();
  }

  /// The notes of the last build, if it was of the same compiler, assets and device; others are of no use, and what
  /// somebody else wrote there is none of ours.
  void take_notes() {
    const Json notes = Json::parse(folder_.notes(), nullptr, false);
    if (notes.is_discarded()) return;
    std::map<std::string, std::string> given;
    for (const SiteInput& input : inputs_) given.emplace(in_notes(input.path), input.path);
    try {
      if (notes.at("base") != base_digits_) return;
      for (const auto& [path, file] : notes.at("files").items()) {
        const auto input = given.find(path);
        if (input == given.end()) continue;
        Noted noted;
        file.at("named").get_to(noted.named), file.at("others").get_to(noted.others), file.at("uses_names").get_to(noted.read.uses_names);
        for (const Json& each : file.at("rests_on"))
          noted.read.rests_on.emplace_back(of_notes(each.at(0).get<std::string>()), each.at(1).get<std::string>());
        for (const Json& each : file.at("materials")) {
          noted.read.materials.push_back(site_material_of(each));
          noted.read.materials.back().file = input->second;
        }
        noted_.emplace(input->second, std::move(noted));
      }
      for (const auto& [page, hash] : notes.at("neighbours").items())
        neighbours_.emplace(page, hash.get<std::string>());
    } catch (const Json::exception&) {
      noted_.clear(), neighbours_.clear();
    }
  }

  /// Whether a file and all that it rests on are as the last build had them.
  bool is_unchanged(const SiteInput& input, const Noted& noted) const {
    if (noted.read.uses_names && noted.others != others_) return false;
    return std::ranges::all_of(noted.read.rests_on,
                               [](const auto& each) { return hash_of_file(each.first) == each.second; }) &&
           std::ranges::all_of(noted.read.materials,
                               [&](const SiteMaterial& material) { return material.module == input.module; });
  }

  /// What the names in a file mean changes when others are called otherwise, and not when they feel otherwise.
  void hash_names() {
    std::vector<std::string> paths;
    std::vector<KnownFile> known(inputs_.size());
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      paths.push_back(inputs_[i].path);
      const auto noted = noted_.find(inputs_[i].path);
      if (noted == noted_.end() || noted->second.read.materials.empty()) continue;
      const auto& [read, named, others] = noted->second;
      known[i] = {read.materials.front().module, rests_on_text(read.rests_on, named), others};
    }
    FileHashes hashes = hashes_of(inputs_, paths, [&](std::size_t which) { return &known[which]; });
    others_ = std::move(hashes.others), named_ = std::move(hashes.named);
  }

  /// Gives each material the name of its page: its own, where no other one has it on a system without capitals.
  void name_pages() {
    hash_names();
    unchanged_.assign(inputs_.size(), 0);
    std::vector<std::vector<std::string>> names(inputs_.size());
    in_parallel(inputs_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto noted = noted_.find(inputs_[i].path);
        unchanged_[i] = noted != noted_.end() && is_unchanged(inputs_[i], noted->second);
        if (!unchanged_[i]) {
          names[i] = names_in(inputs_[i].path);
          continue;
        }
        for (const SiteMaterial& each : noted->second.read.materials) names[i].push_back(each.name);
      }
    });
    // One that is called like its file comes before others of its name.
    struct Named {
      bool is_other = false;
      std::size_t input = 0;
      std::string name;
    };
    std::vector<Named> all;
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      for (const std::string& name : names[i]) {
        const std::string& module = inputs_[i].module;
        all.push_back({module.substr(module.rfind('.') + 1) != name, i, name});
      }
    std::ranges::stable_sort(all, [](const Named& a, const Named& b) { return a.is_other < b.is_other; });
    std::set<std::string> taken;
    for (const Named& each : all) {
      std::string page = page_name(each.name);
      for (std::size_t again = 1; !taken.insert(without_capitals(page)).second; ++again)
        page = page_name(inputs_[each.input].module + "." + each.name + (again > 1 ? "." + std::to_string(again) : ""));
      pages_.try_emplace({each.input, each.name}, page);
    }
  }

  std::string page_of(std::size_t input, const std::string& name) const {
    const auto found = pages_.find({input, name});
    return found == pages_.end() ? page_name(inputs_[input].module + "." + name) : found->second;
  }

  /// Whether the files of an unchanged input are all there, under the names that they have now.
  bool is_kept(std::size_t input, const SiteInputRead& read) {
    for (const SiteMaterial& material : read.materials) {
      if (!material.published()) continue;
      if (material.page != page_of(input, material.name)) return false;
      for (const std::string& path : material.files)
        if (!folder_.keep(path)) return false;
    }
    return true;
  }

  Result<> read_files() {
    read_.resize(inputs_.size());
    std::atomic<std::size_t> next{0}, done{0}, read_count{0};
    std::optional<Error> trouble;
    std::mutex lock;
    in_parallel(inputs_.size(), [&](std::size_t, std::size_t) {
      for (std::size_t i; (i = next.fetch_add(1)) < inputs_.size();) {
        if (unchanged_[i] && is_kept(i, noted_.at(inputs_[i].path).read)) {
          read_[i] = noted_.at(inputs_[i].path).read;
        } else {
          auto read = read_site_file(inputs_[i], file_request_, names_, folder_,
                                     [&](const std::string& name) { return page_of(i, name); });
          const std::lock_guard guard(lock);
          if (!read && !trouble) trouble = read.error();
          if (!read) {  // a file that cannot be written, or no image library: nothing else can be done
            next = inputs_.size();
            continue;
          }
          read_[i] = *std::move(read);
          read_count += static_cast<std::size_t>(std::ranges::count_if(read_[i].materials, &SiteMaterial::published));
          for (const SiteMaterial& each : read_[i].materials) neighbours_.erase(each.page);
        }
        const std::size_t count = ++done;
        if (tell_) tell_(count, inputs_.size());
      }
    });
    report_.read = read_count;
    if (trouble) return *trouble;
    return {};
  }

  void gather() {
    for (const SiteInputRead& read : read_)
      for (const SiteMaterial& material : read.materials) {
        if (material.published()) {
          published_.push_back(&material);
          continue;
        }
        left_out_.push_back(&material);
        report_.left_out.push_back({material.name, material.file, material.trouble});
      }
    std::ranges::stable_sort(published_, [&](const SiteMaterial* a, const SiteMaterial* b) {
      const auto key = [&](const SiteMaterial& each) {
        const std::string title = without_capitals(each.shown());
        // Stimuli, those without a title, and numbered ones stand behind the others.
        const bool is_numbered = each.title.empty() || (title[0] >= '0' && title[0] <= '9');
        const bool is_stimulus = is_of_these(stimuli_, each.kind, each.module);
        return std::tuple(is_stimulus, is_numbered, title, each.page);
      };
      return key(*a) < key(*b);
    });
  }

  std::vector<SiteNeighbour> neighbours_of(const SiteMaterial& material, const Comparer& comparer) const {
    std::vector<std::pair<float, const SiteMaterial*>> near;
    if (!material.cues) return {};
    const bool is_stimulus = is_of_these(stimuli_, material.kind, material.module);
    for (const SiteMaterial* other : published_) {
      if (other == &material || !other->cues) continue;
      if (!is_stimulus && is_of_these(stimuli_, other->kind, other->module)) continue;
      const Distance distance = comparer.distance(*material.cues, *other->cues);
      // Where no known cue differs and an unknown one does, nothing says how near they are.
      if (distance.verdict != Verdict::unknown) near.emplace_back(distance.noticeable, other);
    }
    const std::size_t count = std::min(neighbours_shown, near.size());
    std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(count),
                              [](const auto& a, const auto& b) {
                                return std::pair(a.first, std::string_view(a.second->page)) <
                                       std::pair(b.first, std::string_view(b.second->page));
                              });
    std::vector<SiteNeighbour> neighbours;
    for (std::size_t i = 0; i < count; ++i) {
      SiteNeighbour& neighbour = neighbours.emplace_back();
      neighbour.material = near[i].second, neighbour.least = neighbour.most = near[i].first;
      for (const CueDifference& cue : comparer.compare(*material.cues, *near[i].second->cues).cues)
        if (!cue.noticeable && cue.a != cue.b) {
          neighbour.most = std::numeric_limits<float>::infinity();
          neighbour.unknown.emplace_back(cue_table()[static_cast<std::size_t>(cue.kind)].name);
        }
    }
    return neighbours;
  }

  /// Puts the neighbours into the pages, of which only those change that have others than before.
  Result<> write_neighbours() {
    const Comparer comparer(common_->declarations, request_.device);
    std::optional<Error> trouble;
    std::mutex lock;
    in_parallel(published_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::string path = "material/" + published_[i]->page + ".html";
        const Markup near = neighbours_markup(neighbours_of(*published_[i], comparer), path);
        const std::string hash = ContentHash().take(near.text()).digits();
        {
          const std::lock_guard guard(lock);
          const auto before = neighbours_.find(published_[i]->page);
          const bool same = before != neighbours_.end() && before->second == hash;
          neighbours_[published_[i]->page] = hash;
          if (same) continue;
        }
        const auto written = folder_.put(path, with_neighbours(folder_.bytes_of(path), near));
        const std::lock_guard guard(lock);
        if (!written && !trouble) trouble = written.error();
      }
    });
    std::set<std::string> pages;
    for (const SiteMaterial* each : published_) pages.insert(each->page);
    std::erase_if(neighbours_, [&](const auto& each) { return !pages.contains(each.first); });
    if (trouble) return *trouble;
    return {};
  }

  Result<> write_lists() {
    std::vector<SiteFile> files = search_files(published_);
    std::vector<SitePage> pages = gallery_pages(published_);
    std::ranges::move(declared_pages(common_->declarations, names_, published_), std::back_inserter(pages));
    pages.push_back(unknown_page(common_->declarations, names_, published_, left_out_));
    for (const SitePage& page : pages) {
      files.push_back({page.path, framed(page)});
      if (!page.data.empty()) files.push_back({data_path(page), page.data});
    }
    auto space = space_files(felt_plane(published_, Comparer(common_->declarations, request_.device)), published_);
    if (!space) return space.error();
    std::ranges::move(*space, std::back_inserter(files));
    for (const EmbeddedFile& each : embedded_site())
      files.push_back({std::string(each.name.substr(each.name.rfind('/') + 1)), std::string(each.text)});
    for (const SiteFile& file : files)
      if (const auto written = folder_.put(file.path, file.bytes); !written) return written.error();
    return {};
  }

  std::string notes_text() const {
    Json notes = {{"base", base_digits_}, {"files", Json::object()}, {"neighbours", neighbours_}};
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      Json file = {{"named", named_[i]},
                   {"others", read_[i].uses_names ? others_ : ""},
                   {"uses_names", read_[i].uses_names},
                   {"rests_on", Json::array()},
                   {"materials", Json::array()}};
      for (const auto& [path, hash] : read_[i].rests_on) file["rests_on"].push_back({in_notes(path), hash});
      for (const SiteMaterial& each : read_[i].materials) {
        file["materials"].push_back(to_json(each));
        file["materials"].back()["file"] = in_notes(each.file);
      }
      notes["files"][in_notes(inputs_[i].path)] = std::move(file);
    }
    return json_text(notes);
  }

  const SiteRequest& request_;
  SiteFolder folder_;
  const std::function<void(std::size_t, std::size_t)>& tell_;
  std::shared_ptr<const CommonModules> common_;
  DeclaredNames names_;
  const std::vector<std::string> stimuli_ = stimuli_here();
  FileRequest file_request_;
  ContentHash base_;
  std::string base_digits_, others_;
  fs::path root_;  ///< of the library in which the first file lies
  std::vector<SiteInput> inputs_;
  std::vector<std::string> named_;  ///< by input, as `FileHashes` has it
  std::vector<char> unchanged_;     ///< by input
  std::map<std::pair<std::size_t, std::string>, std::string> pages_;
  std::map<std::string, Noted> noted_;
  std::map<std::string, std::string> neighbours_;  ///< hash of the neighbours that stand on a page
  std::vector<SiteInputRead> read_;
  std::vector<const SiteMaterial*> published_, left_out_;
  SiteReport report_;
};

}  // namespace

Result<SiteReport> write_site(const SiteRequest& request, const std::function<void(std::size_t, std::size_t)>& tell) {
  const auto common = common_modules();
  if (!common->declarations.devices.contains(request.device)) {
    const auto near = nearest_spelling(request.device, common->declarations.devices.spellings());
    return Error{.code = Code::unknown_device,
                 .sentence = fmt::format("no device is called `{}`", request.device),
                 .mend = near ? fmt::format("did you mean `{}`?", *near) : "`wale devices` lists them",
                 .place = {.name = "--device", .text = request.device}};
  }
  const auto inputs = library_files_in(request.paths);
  if (!inputs) return inputs.error();
  auto folder = SiteFolder::open(request.folder);
  if (!folder) return folder.error();
  return SiteBuild(request, *std::move(folder), tell).build(*inputs);
}

}  // namespace wale
