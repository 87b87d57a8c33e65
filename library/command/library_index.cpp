#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/command/print.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/text/resolver.hpp"
#include "library/command/index_here.hpp"
#include "library/store/shared_roles.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct LibraryIndexOptions {
  std::vector<std::string> paths;
  std::string out, shared;
  IndexChoice choice;
  Shelf shelf;
  bool json = false, roles = false;
};

std::string report_json(const StoreReport& report, const std::string& file) {
  nlohmann::ordered_json json = {{"index", file},          {"materials", report.materials}, {"files", report.files},
                                 {"read", report.read},    {"gone", report.gone},
                                 {"only_there", report.only_there},
                                 {"troubled", nlohmann::ordered_json::array()},
                                 {"kept_back", nlohmann::ordered_json::array()}};
  for (const StoreReport::Troubled& each : report.troubled)
    json["troubled"].push_back({{"material", each.material}, {"file", each.file}, {"why", each.why}});
  for (const StoreReport::Troubled& each : report.kept_back)
    json["kept_back"].push_back({{"material", each.material}, {"file", each.file}, {"why", each.why}});
  return json_lines(json);
}

std::string plural(std::size_t count, const char* what) {
  return readable("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// A shared index has the materials of others too.
std::string counted(const StoreReport& report, bool is_shared) {
  const std::string materials = plural(report.materials, "material"), files = plural(report.files, "file");
  return is_shared ? readable("{} named, {} read anew, {} gone; the shared index has {}", files, report.read, report.gone, materials)
                   : readable("{} of {}; {} read anew, {} gone", materials, files, report.read, report.gone);
}

/// Whether the files are all of their libraries.
bool names_whole_libraries(const std::vector<std::string>& paths) {
  std::error_code ignored;
  return std::ranges::all_of(paths, [&](const std::string& path) {
    return std::filesystem::exists(std::filesystem::path(path) / project_marker, ignored);
  });
}

/// What cannot be together.
Result<> without_contradiction(const LibraryIndexOptions& options) {
  const auto refused = [](const char* option, std::string sentence, std::string mend) {
    return Error{.code = Code::malformed_value, .sentence = std::move(sentence), .mend = std::move(mend), .place = {.name = option}};
  };
  if (!options.shared.empty() && !options.out.empty())
    return refused("--index", "an index is a file or a database, and both were named", "leave out `-o` or `--index`");
  if (is_shared_address(options.out))
    return refused("-o", "this is the address of a database and no file", "write `--index` in the place of `-o`");
  if (!is_shared_address(options.shared) && (options.shelf.forgets || !options.shelf.name.empty()))
    return refused(options.shelf.forgets ? "--forget" : "--shelf", "only a shared index has what others gave it",
                   "name it: `--index postgresql://USER@HOST/DATABASE`");
  if (options.shelf.forgets && !names_whole_libraries(options.paths))
    return refused("--forget", "what is gone is known of whole libraries only",
                   "name folders with a `wale.project`, or leave out `--forget`");
  return {};
}

int make_index(LibraryIndexOptions& options) {
  if (options.roles) return print_out(roles_of_shared_index()), done;
  if (const auto fits = without_contradiction(options); !fits) return refuse(fits.error());
  warn_of_library_variable();
  const FileRequest request = request_of(options.choice);
  const auto declared = common_modules();
  if (!declared->declarations.devices.contains(request.device))
    return refuse(Error{.code = Code::unknown_device,
                        .sentence = fmt::format("nothing declares a device `{}`", visible_text(request.device)),
                        .mend = "`wale devices` lists them",
                        .place = {.name = "--device"}});
  std::vector<LibraryFile> files;
  if (options.paths.empty()) {
    const auto resolver = file_resolver(request.roots);
    files = library_files_in(*library_index(*resolver, "here"));
  } else {
    auto named = library_files_in(options.paths);
    if (!named) return refuse(named.error());
    files = *std::move(named);
  }
  std::string path = options.out.empty() ? options.shared : options.out;
  if (path.empty()) path = kept_index(request, files);
  if (path.empty())
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = "expected a file for the index, since neither XDG_CACHE_HOME nor HOME names a place",
                        .mend = "for example, `wale library index -o library.index`",
                        .place = {.name = "-o"}});
  auto store = LibraryStore::open(path, true, is_shared_address(path) ? cache_folder() : std::string());
  if (!store) return refuse(store.error());
  options.shelf.is_whole = names_whole_libraries(options.paths);
  const auto report = (*store)->bring_up_to_date(files, request, shown_progress(), options.shelf);
  if (!report) return refuse(report.error());
  if (options.json) {
    print_out(report_json(*report, without_password(path)));
  } else {
    for (const StoreReport::Troubled& each : report->troubled)
      print_error("wale: `{}` of {} cannot be felt: {}\n", visible_text(each.material), visible_text(each.file),
                  visible_text(each.why));
    for (const StoreReport::Troubled& each : report->kept_back)
      print_error("wale: `{}` of {} is not in the shared index: {}\n", visible_text(each.material), visible_text(each.file),
                  visible_text(each.why));
    if (report->only_there > 0)
      print_error("wale: {} of the shared index lie in none of these files; `--forget` forgets them\n",
                  plural(report->only_there, "material"));
    print_out("{}\n", counted(*report, is_shared_address(path)));
    print_out("{}\n", visible_text(without_password(path)));
  }
  return report->troubled.empty() && report->kept_back.empty() ? done : refused;
}

Run declare_library_index(CLI::App& verb) {
  const auto options = std::make_shared<LibraryIndexOptions>();
  must_say(verb.add_option("PATH", options->paths,
                           "Wale files, or folders with all Wale files in them (default: all that `wale find` lists here)"),
           "the path of a Wale file or of a folder");
  must_say(offer_output(verb, options->out, "the file of the index, a new one or an earlier index (default: the one in the "
                                            "user's cache that `wale find` looks in)"),
           "the name of a file", "for example, `wale library index -o library.index`");
  must_say(verb.add_option("--index", options->shared,
                           "a shared index, postgresql://USER@HOST/DATABASE, which is given these files beside those of others")
               ->type_name("ADDRESS"),
           "the address of a database", "for example, `--index postgresql://anna@haptics.example/wale`");
  must_say(verb.add_option("--shelf", options->shelf.name,
                           "the name of these files' library in the shared index (default: that of its folder)")
               ->type_name("NAME"),
           "the name of a library");
  verb.add_flag("--forget", options->shelf.forgets, "forget materials of these libraries whose files are gone");
  verb.add_flag("--roles", options->roles, "print the SQL that gives a shared index its readers, curators and owners, and end");
  verb.add_option("--device", options->choice.device,
                  "the device that the programs are built for: one of `wale devices` (default: sandpaper)")
      ->type_name("NAME");
  offer_library(verb, options->choice.folders);
  offer_sandbox(verb, options->choice.sandbox);
  offer_json(verb, options->json, "what came of it, with the materials that cannot be felt, as an object");
  verb.footer(
      "Compiles and reads each material whose file, or anything that it rests on, has changed since the last time.\n"
      "A shared index takes only what everybody may pass on.\n"
      "exit status 1: some material cannot be felt, or passed on, or some file cannot be read; all others are in the index.\n"
      "for example: wale library index;  wale library index my/library -o my.index;\n"
      "wale library index my/library --index postgresql://anna@haptics.example/wale");
  return [options] { return make_index(*options); };
}

}  // namespace

extern const Verb library_index_verb{"library-index", "makes or updates the index in which materials are found by feel",
                                     declare_library_index};

}  // namespace wale::command
