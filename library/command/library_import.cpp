#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/readable.hpp"
#include "library/drafts/draft.hpp"
#include "library/review/review.hpp"
#include "library/survey/survey.hpp"
#include "library/thesis_files/in_wale.hpp"
#include "schema/regular_file.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

namespace fs = std::filesystem;

struct LibraryImportOptions {
  std::vector<std::string> files, folders;
  std::string as, out, range;
  std::optional<double> mass;
  DraftOptions draft;
};

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return text;
}

/// What a file is by its name: "picture", "heights", …; empty if that does not tell.
std::string kind_by_name(const fs::path& path) {
  constexpr std::array<std::string_view, 12> pictures = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp",
                                                         ".exr", ".pgm", ".ppm",  ".webp", ".tga", ".jp2"};
  const std::string ending = lower(path.extension().string());
  if (std::ranges::find(pictures, ending) != pictures.end()) return "picture";
  if (ending == ".txt" || ending == ".asc" || ending == ".dat") return "heights";
  if (ending == ".csv") return "ratings";
  if (ending == ".depth" || ending == ".wave") return "array";
  if (ending == ".xml" && path.filename().string().starts_with("Models_")) return "model";
  return {};
}

struct Source {
  std::string path, kind;
};

/// The files that were named, and those of folders that say what they are.
Result<std::vector<Source>> sources_of(const LibraryImportOptions& options) {
  std::vector<Source> sources;
  for (const std::string& path : options.files) {
    std::error_code trouble;
    if (!fs::is_directory(path, trouble)) {
      const std::string kind = options.as.empty() ? kind_by_name(path) : options.as;
      if (kind.empty())
        return Error{.code = Code::malformed_value,
                     .sentence = "its name does not tell what it holds",
                     .mend = "say it, as in `--as heights`",
                     .place = {.name = path}};
      sources.push_back({path, kind});
      continue;
    }
    std::vector<Source> inside;
    for (fs::directory_iterator at(path, trouble), end; !trouble && at != end; at.increment(trouble)) {
      std::error_code ignored;
      if (at->is_symlink(ignored) || !at->is_regular_file(ignored)) continue;
      if (const std::string kind = kind_by_name(at->path()); !kind.empty() && (options.as.empty() || options.as == kind))
        inside.push_back({at->path().string(), kind});
    }
    if (trouble || inside.empty())
      return Error{.code = Code::unreadable_file,
                   .sentence = trouble ? trouble.message() : "no file of this folder can become a draft",
                   .mend = "name a folder of pictures, height maps, arrays, models or ratings",
                   .place = {.name = path}};
    std::ranges::sort(inside, {}, &Source::path);
    sources.insert(sources.end(), inside.begin(), inside.end());
  }
  return sources;
}

/// The name of a material for a file: that of the toolkit's models without "Models_".
std::string name_for(const std::string& path, const std::set<std::string>& taken) {
  std::string stem = fs::path(path).stem().string();
  if (stem.starts_with("Models_")) stem.erase(0, 7);
  return wale_name(lower(stem), taken);
}

Result<std::vector<Draft>> drafts_of(const Source& source, const std::vector<std::string>& percepts,
                                     const std::set<std::string>& taken, const DraftOptions& options) {
  auto bytes = read_regular_file(source.path, largest_asset);
  if (!bytes) {
    bytes.error().place.name = source.path;
    return bytes.error();
  }
  if (source.kind == "ratings") return rating_drafts(source.path, *bytes, percepts, taken, options);
  const std::string name = name_for(source.path, taken);
  auto draft = source.kind == "picture"   ? picture_draft(source.path, *bytes, name, options)
               : source.kind == "heights" ? height_map_draft(source.path, *bytes, name, options)
               : source.kind == "model"   ? texture_model_draft(source.path, *bytes, name, options)
                                          : thesis_draft(source.path, *bytes, name, options);
  if (!draft) return draft.error();
  return std::vector<Draft>{*std::move(draft)};
}

/// "roughness 0.41, stickiness 0.20"; empty if it reads none.
std::string reads_as(const Entry& entry) {
  std::string text;
  for (const EntryPercept& each : entry.felt.percepts)
    if (each.reads) text += readable("{}{} {:.2f}", text.empty() ? "" : ", ", each.name, *each.reads);
  return text;
}

/// The comment above a draft: what is missing, assumed and read.
std::string told_above(const ReviewedFile& reviewed, const Draft& draft, const std::string& reads) {
  std::string text = "// A draft. A library takes it in when this is done:\n";
  std::set<std::string> said;
  for (const Diagnostic& each : reviewed.diagnostics.all()) {
    const std::string line = visible_text(each.message + (each.help.empty() ? "" : ": " + each.help));
    if (said.insert(line).second) text += "// - " + line + "\n";
  }
  for (const std::string& each : draft.assumed) text += "// - confirm what is assumed: " + visible_text(each) + "\n";
  if (said.empty() && draft.assumed.empty()) text += "// - nothing is missing\n";
  if (!reads.empty()) text += "// As it stands it reads " + reads + ".\n";
  return text + "\n";
}

Result<> read_range(LibraryImportOptions& options) {
  if (options.range.empty()) return {};
  const std::size_t comma = options.range.find(',');
  const auto least = read_number("--range", options.range.substr(0, comma), {.least = -1e6, .most = 1e6, .example = 1});
  const auto most = read_number("--range", comma == std::string::npos ? "" : options.range.substr(comma + 1),
                                {.least = -1e6, .most = 1e6, .example = 7});
  if (!least || !most || !(*least < *most))
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("expected the least and the greatest rating, found \"{}\"", visible_text(options.range)),
                 .mend = "for example, `--range 1,7`",
                 .place = {.name = "--range"}};
  options.draft.least = *least, options.draft.most = *most;
  return {};
}

/// Writes the drafts; then what a review says of each above it.
int write_drafts(const std::vector<Draft>& drafts, const LibraryImportOptions& options, const InputFiles& inputs) {
  std::error_code trouble;
  const fs::path folder(options.out);
  if (fs::create_directories(folder, trouble); trouble || !fs::is_directory(folder))
    return refuse(Error{.code = Code::unwritable_file,
                        .sentence = "this folder cannot be made" + (trouble ? ": " + trouble.message() : std::string()),
                        .place = {.name = options.out}});
  std::vector<std::string> paths;
  const auto write = [&](const Draft& draft, const std::string& above) -> Result<> {
    return write_file((folder / (draft.name + ".wale")).string(), "wale 1\n\n" + above + standard_declarations(draft.text), inputs);
  };
  for (const Draft& each : drafts) {
    for (const FileBeside& beside : each.files)
      if (const auto written = write_file((folder / beside.name).string(), beside.bytes, inputs); !written)
        return refuse(written.error());
    if (const auto written = write(each, ""); !written) return refuse(written.error());
    paths.push_back((folder / (each.name + ".wale")).string());
  }
  ReviewRequest request;
  request.paths = paths, request.sandbox = options.draft.sandbox;
  request.roots = library_folders(options.folders, std::getenv("WALE_LIBRARY"));
  const auto reviewed = review(request);
  if (!reviewed) return refuse(reviewed.error());
  FileRequest file;
  file.roots = request.roots, file.sandbox = request.sandbox;
  const auto surveyed = survey(paths, file, SurveyDepth::feel);
  if (!surveyed) return refuse(surveyed.error());
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    const auto told = std::ranges::find(reviewed->files, paths[i], &ReviewedFile::file);
    const auto entry = std::ranges::find(surveyed->entries, drafts[i].name, &Entry::name);
    const std::string reads = entry == surveyed->entries.end() ? "" : reads_as(*entry);
    if (told == reviewed->files.end()) continue;
    if (const auto written = write(drafts[i], told_above(*told, drafts[i], reads)); !written)
      return refuse(written.error());
    print_out("{}  {}\n", visible_text(paths[i]), reads.empty() ? "reads no percept" : "reads " + reads);
  }
  print_out("{} draft{}; each says what is missing\n", drafts.size(), drafts.size() == 1 ? "" : "s");
  return done;
}

int library_import(LibraryImportOptions options) {
  if (const auto range = read_range(options); !range) return refuse(range.error());
  options.draft.mass = options.mass;
  const auto sources = sources_of(options);
  if (!sources) return refuse(sources.error());
  const std::vector<std::string> percepts = declared_everywhere()->declarations.percepts_with_levels();
  std::set<std::string> taken;
  std::error_code ignored;
  for (fs::directory_iterator at(options.out, ignored), end; !ignored && at != end; at.increment(ignored))
    taken.insert(at->path().stem().string());
  std::vector<Draft> drafts;
  InputFiles inputs;
  for (const Source& each : *sources) {
    inputs.push_back(each.path);
    auto made = drafts_of(each, percepts, taken, options.draft);
    if (!made) return refuse(made.error());
    for (Draft& draft : *made) taken.insert(draft.name), drafts.push_back(std::move(draft));
  }
  return write_drafts(drafts, options, inputs);
}

Run declare_library_import(CLI::App& verb) {
  const auto options = std::make_shared<LibraryImportOptions>();
  must_say(verb.add_option("FILE", options->files,
                           "pictures, height maps as text (.txt, .asc, .dat), arrays and waves of 1995 (.depth, .wave), models "
                           "of textures (Models_NAME.xml), ratings (.csv); or folders of them"),
           "the path of a file or of a folder")
      ->required();
  must_say(offer_output(verb, options->out, "the folder for the drafts; it is made if it does not exist"),
           "the name of a folder", "for example, `-o drafts`")
      ->type_name("DIR")
      ->required();
  offer_name(verb, "--as", options->as, {"picture", "heights", "ratings", "array", "model"},
             "what the files are, where their names do not tell");
  offer_length(verb, "--scale", options->draft.scale,
               "the side of a pixel, or the distance of two numbers of a height map, as in --scale \"0.1 mm\"");
  offer_length(verb, "--height", options->draft.height, "from black to white of a picture (default: 1 mm, an assumption)");
  offer_length(verb, "--unit", options->draft.unit, "the unit of the numbers of a height map, as in --unit \"1 um\"");
  must_say(verb.add_option("--bad", options->draft.bad,
                           "a word of a height map for what was not measured, as in --bad NaN; may be repeated")
               ->type_name("WORD")
               ->expected(1)
               ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll),
           "a word");
  offer_force(verb, "--amplitude", options->draft.amplitude, "the largest lateral force (default: 1 N, an assumption)");
  offer_length(verb, "--size", options->draft.size, "the width of an array, or the length of one wave");
  offer_number(verb, "--mass", options->mass, {.least = 1e-4, .most = 10, .example = 0.02},
               "of the tool of a model's acceleration, in kg (default: 0.02, an assumption)");
  must_say(verb.add_option("--range", options->range, "the least and the greatest rating, as in --range 1,7 (default: 0,1)")
               ->type_name("LOW,HIGH"),
           "two numbers", "for example, `--range 1,7`");
  must_say(verb.add_option("--licence", options->draft.licence, "the licence of what was measured, as in --licence CC-BY-4.0")
               ->type_name("ID"),
           "a licence");
  offer_library(verb, options->folders);
  offer_sandbox(verb, options->draft.sandbox);
  verb.footer(
      "A draft is a Wale file that says what is missing before `wale library check` takes it in.\n"
      "for example: wale library import photographs --scale \"0.1 mm\" -o drafts;\n"
      "  wale library import stone.txt --scale \"50 um\" --unit \"1 um\" --bad NaN -o drafts");
  return [options] { return library_import(*options); };
}

}  // namespace

extern const Verb library_import_verb{"library-import", "makes drafts of pictures, height maps, models and ratings",
                                      declare_library_import};

}  // namespace wale::command
