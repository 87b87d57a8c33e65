#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/text/resolver.hpp"
#include "library/command/misused_option.hpp"
#include "schema/regular_file.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"
#include "wale/thesis_files.hpp"

namespace wale::command {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_bytes = 1 << 28;  // bytes; an array that is a relief has fewer

struct ImportOptions {
  std::vector<std::string> files;
  std::string as;    ///< array, wave, movie or shuffle; empty: by the file
  std::string name;  ///< of what one file becomes
  std::optional<double> size, amplitude;
  std::string out;
  Choice into;  ///< the file that is added to
};

/// A file of the thesis, and the visual representation beside it.
struct Named {
  std::string path, bytes;
  ThesisFileKind kind = ThesisFileKind::array;
  bool is_wave = false;
  std::optional<ThesisArray> shading;

  bool is_surface() const {
    return kind == ThesisFileKind::surface || kind == ThesisFileKind::array || kind == ThesisFileKind::wave;
  }
};

std::string without_ending(const std::string& path) { return path.substr(0, path.rfind('.')); }

/// Reads the files, and puts each visual representation to the surface map of the same name.
Result<std::vector<Named>> read_all(const ImportOptions& options) {
  std::vector<Named> files;
  std::map<std::string, std::pair<std::string, ThesisArray>> shadings;  // by the path without its ending
  for (const std::string& path : options.files) {
    auto bytes = read_regular_file(path, largest_bytes);
    if (!bytes) {
      bytes.error().place.name = path;
      return bytes.error();
    }
    Named file{path, *std::move(bytes)};
    file.kind = options.as == "movie"      ? ThesisFileKind::movie
                : options.as == "shuffle"  ? ThesisFileKind::shuffle
                : !options.as.empty()      ? ThesisFileKind::array
                                           : kind_of_thesis_file(path, file.bytes);
    file.is_wave = options.as == "wave" || file.kind == ThesisFileKind::wave;
    if (file.kind == ThesisFileKind::workspace) return unread_thesis_workspace(path);
    if (file.kind == ThesisFileKind::shading) {
      auto shading = read_thesis_array(std::as_bytes(std::span(file.bytes)), path);
      if (!shading) return shading.error();
      shadings.insert_or_assign(without_ending(path), std::pair(path, *std::move(shading)));
    } else {
      files.push_back(std::move(file));
    }
  }
  for (Named& each : files)
    if (each.kind == ThesisFileKind::surface)
      if (const auto found = shadings.find(without_ending(each.path)); found != shadings.end()) {
        each.shading = std::move(found->second.second);
        shadings.erase(found);
      }
  if (!shadings.empty()) {
    const std::string& path = shadings.begin()->second.first;
    return Error{.code = Code::damaged_file,
                 .sentence = "this is how a surface looks, and the surface itself is not among the files",
                 .mend = fmt::format("name both, `wale import {0}.depth {0}.shade`; or take its bytes as heights by `--as array`",
                                     visible_text(without_ending(path))),
                 .place = {.name = path}};
  }
  return files;
}

/// The error about what a file of the thesis does not say and no option said.
std::optional<Error> missing_figure(const ImportOptions& options, const Named& file, const ThesisArray& array) {
  const std::string shown = visible_text(file.path);
  if (!options.size && file.is_wave)
    return misused_option("--size", fmt::format("expected the length of one wave of `{}`, which its file does not say", shown),
                          "for example, `--size \"2.5 mm\"`");
  if (!options.size)
    return misused_option("--size", fmt::format("expected the width of `{}`, which its file does not say", shown),
                          fmt::format("for example, `--size \"{:g} mm\"`: {} cells of 0.37 mm, a pixel of the thesis's screen",
                                      1000 * thesis_cell * array.width, array.width));
  if (!options.amplitude)
    return misused_option("--amplitude", fmt::format("expected the largest lateral force of `{}`, which its file does not say", shown),
                          "for example, `--amplitude \"1 N\"`");
  return std::nullopt;
}

/// What one file becomes, beside names that are taken.
Result<ThesisInWale> made_of(const Named& file, const ImportOptions& options, const std::set<std::string>& workspaces,
                             const std::set<std::string>& taken) {
  const std::string base = fs::path(file.path).filename().string();
  const std::string name = wale_name(options.name.empty() ? base : options.name, taken);
  if (file.is_surface()) {
    const auto array = read_thesis_array(std::as_bytes(std::span(file.bytes)), file.path);
    if (!array) return array.error();
    if (auto missing = missing_figure(options, file, *array)) return *std::move(missing);
    const ThesisSurfaceOptions surface{
        .name = name, .file = base, .amplitude = *options.amplitude, .cell = *options.size / array->width, .period = *options.size};
    auto made = file.is_wave ? wave_in_wale(*array, surface)
                             : surface_in_wale(*array, surface, file.shading ? &*file.shading : nullptr);
    if (!made) made.error().place.name = file.path;
    return made;
  }
  const ThesisShowOptions show{.name = name, .file = base, .workspaces = workspaces, .taken = taken};
  if (file.kind == ThesisFileKind::movie) {
    const auto movie = read_thesis_movie(file.bytes, file.path);
    return movie ? movie_in_wale(*movie, show) : Result<ThesisInWale>(movie.error());
  }
  const auto shuffle = read_thesis_shuffle(file.bytes, file.path);
  return shuffle ? shuffle_in_wale(*shuffle, show) : Result<ThesisInWale>(shuffle.error());
}

/// Pictures that belong beside the text. Those that this command has written go again unless the text is there too.
class Pictures {
 public:
  Pictures(fs::path folder, const InputFiles& inputs) : folder_(std::move(folder)), inputs_(inputs) {}
  ~Pictures() {
    for (const std::string& each : written_) {
      std::error_code ignored;
      fs::remove(each, ignored);
    }
  }
  Pictures(const Pictures&) = delete;
  Pictures& operator=(const Pictures&) = delete;

  /// Whether a file of that name has other bytes.
  bool has_other(const FileBeside& file) const {
    std::error_code ignored;
    const std::string path = path_of(file);
    if (!fs::exists(path, ignored)) return false;
    const auto there = read_regular_file(path, largest_bytes);
    return !there || *there != file.bytes;
  }
  Result<> write(const FileBeside& file) {
    std::error_code ignored;
    const std::string path = path_of(file);
    if (fs::exists(path, ignored)) return {};  // with the same bytes
    if (const auto written = write_file(path, file.bytes, inputs_); !written) return written.error();
    written_.push_back(path);
    return {};
  }
  void keep() { written_.clear(); }

 private:
  std::string path_of(const FileBeside& file) const { return (folder_ / file.name).string(); }

  fs::path folder_;
  const InputFiles& inputs_;
  std::vector<std::string> written_;
};

Result<> has_sense(const ImportOptions& options) {
  if (!options.name.empty() && options.name != wale_name(options.name, {}))
    return misused_option("--name", fmt::format("expected a name of the language, found \"{}\"", options.name),
                          fmt::format("for example, `{}`", wale_name(options.name, {})));
  if (!options.name.empty() && options.files.size() > 1 &&
      !(options.files.size() == 2 && std::ranges::any_of(options.files, [](const auto& each) { return has_ending(each, ".shade"); })))
    return misused_option("--name", fmt::format("expected one file, since there is one name, found {}", options.files.size()),
                          "leave out --name: each has the name of its file");
  return {};
}

/// The options that no file has a use for, or that lack.
Result<> fits(const ImportOptions& options, const std::vector<Named>& files) {
  const bool some_surface = std::ranges::any_of(files, &Named::is_surface);
  if (!some_surface && (options.size || options.amplitude))
    return misused_option(options.size ? "--size" : "--amplitude", "there is no array and no wave among the files",
                          "leave it out, or say what the file is by --as");
  if (some_surface && options.into.file.empty() && is_written_as_it_comes(options.out.empty() ? "-" : options.out))
    return misused_option("-o", "expected the name of the Wale file to write, since a picture comes beside it",
                          fmt::format("for example, `-o {}.wale`", wale_name(files.front().path, {})));
  return {};
}

int import(const ImportOptions& options) {
  if (const auto sense = has_sense(options); !sense) return refuse(sense.error());
  const auto files = read_all(options);
  if (!files) return refuse(files.error());
  if (const auto fit = fits(options, *files); !fit) return refuse(fit.error());

  // What is there already.
  const std::string target = options.into.file.empty() ? options.out : options.into.file;
  std::string text = "wale 1\n\n";
  std::set<std::string> workspaces, taken;
  if (!options.into.file.empty()) {
    auto bytes = read_file(options.into.file);
    if (!bytes) return refuse(bytes.error());
    const auto opened = open(options.into);
    if (!opened) return opened.status();
    if (opened->program)
      return refuse(misused_option("--into", "expected a Wale file, found a patch program", "name the Wale file that it was built from"));
    text = std::move(bytes->bytes);
    while (text.ends_with("\n")) text.pop_back();
    text += "\n\n";
    for (const auto& each : opened->module->materials) taken.insert(each.name);
    for (const auto& each : opened->module->workspaces) workspaces.insert(each.name);
    for (const auto& each : opened->module->movies) taken.insert(each.named.name);
    for (const auto& each : opened->module->keys) taken.insert(each.named.name);
    for (const auto& each : opened->module->groups) taken.insert(each.named.name);
    taken.insert(workspaces.begin(), workspaces.end());
  }
  InputFiles inputs = options.files;
  inputs.insert(inputs.end(), options.into.inputs->begin(), options.into.inputs->end());
  std::erase(inputs, options.into.file);
  Pictures pictures(fs::path(target).parent_path(), inputs);
  std::string said, noted;
  for (const Named& file : *files) {
    auto made = made_of(file, options, workspaces, taken);
    while (made && std::ranges::any_of(made->files, [&](const FileBeside& each) { return pictures.has_other(each); })) {
      taken.insert(made->name);
      made = made_of(file, options, workspaces, taken);
    }
    if (!made) return refuse(made.error());
    for (const FileBeside& each : made->files)
      if (const auto written = pictures.write(each); !written) return refuse(written.error());
    text += made->text + "\n";
    taken.insert(made->name);
    said += fmt::format("{}  {}\n", visible_text(file.path), made->name);
    if (!made->note.empty()) noted += fmt::format("wale: {}: {}\n", visible_text(file.path), made->note);
    // Workspaces that a movie has declared are there for the next one.
    const std::string declared = "workspace ";
    for (auto at = made->text.find(declared); at != std::string::npos; at = made->text.find(declared, at + 1)) {
      if (at > 0 && made->text[at - 1] != '\n') continue;
      const auto begin = at + declared.size();
      workspaces.insert(made->text.substr(begin, made->text.find_first_of(" {", begin) - begin));
    }
    taken.insert(workspaces.begin(), workspaces.end());
  }
  while (text.ends_with("\n\n")) text.pop_back();

  // What comes out is a file without errors, also where another file's names met these.
  FileRequest request = options.into.request();
  auto checked = open_named({.name = target.empty() ? "imported.wale" : target, .bytes = text}, request);
  if (!checked) return refuse(checked.error());
  if (checked->diagnostics.has_errors()) {
    print_diagnostics(stderr, checked->diagnostics, checked->sources);
    return refused;
  }
  const auto written = options.into.file.empty() ? write_file(target.empty() ? "-" : target, text, inputs) : replace_file(target, text);
  if (!written) return refuse(written.error());
  pictures.keep();
  if (!noted.empty()) print_error(noted);
  if (!is_written_as_it_comes(target.empty() ? "-" : target)) print_out(said);
  return done;
}

Run declare_import(CLI::App& verb) {
  const auto options = std::make_shared<ImportOptions>();
  must_say(verb.add_option("FILE", options->files,
                           "files of the Sandpaper of 1995: arrays (.depth, with how each looks in .shade), waves (.wave), movies "
                           "and shuffles; each becomes a declaration of the name of its file"),
           "the path of a file")
      ->required();
  offer_name(verb, "--as", options->as, {"array", "wave", "movie", "shuffle"},
             "what the files are, where their names and bytes do not say: a wave without the ending .wave looks like an array");
  offer_length(verb, "--size", options->size, "the width of an array, or the length of one wave, as in --size \"40 mm\"");
  offer_force(verb, "--amplitude", options->amplitude,
              "the largest lateral force of an array or a wave, as in --amplitude \"1 N\"");
  must_say(verb.add_option("--name", options->name, "the name of what one file becomes (default: the file's)")->type_name("NAME"), "a name");
  auto* out = must_say(offer_output(verb, options->out,
                                    "the Wale file to write (default: standard output, for movies and shuffles); the pictures of arrays and "
                                    "waves come beside it"),
                       "the name of the file to write", "for example, `-o imported.wale`");
  must_say(verb.add_option("--into", options->into.file,
                           "adds to this Wale file instead; a frame of a movie is the workspace of that name in it")
               ->type_name("FILE"),
           "the path of a Wale file")
      ->excludes(out);
  offer_library(verb, options->into.folders);
  verb.footer(
      "for example: wale import ramp.depth --size \"40 mm\" --amplitude \"1 N\" -o ramp.wale;  wale import demo.movie --into kitchen.wale");
  return [options] { return import(*options); };
}

}  // namespace

extern const Verb import_verb{"import", "makes Wale of arrays, waves, movies and shuffles of the Sandpaper of 1995", declare_import};

}  // namespace wale::command
