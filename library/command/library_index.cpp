#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "library/command/index_here.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct LibraryIndexOptions {
  std::vector<std::string> paths;
  std::string out;
  IndexChoice choice;
  bool json = false;
};

std::string report_json(const StoreReport& report, const std::string& file) {
  nlohmann::ordered_json json = {{"index", file},          {"materials", report.materials}, {"files", report.files},
                                 {"read", report.read},    {"gone", report.gone},
                                 {"troubled", nlohmann::ordered_json::array()}};
  for (const StoreReport::Troubled& each : report.troubled)
    json["troubled"].push_back({{"material", each.material}, {"file", each.file}, {"why", each.why}});
  return json_lines(json);
}

int make_index(LibraryIndexOptions& options) {
  warn_of_library_variable();
  FileRequest request;
  request.device = options.choice.device, request.sandbox = options.choice.sandbox;
  request.roots = library_folders(options.choice.folders, std::getenv("WALE_LIBRARY"));
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
  const std::string path = options.out.empty() ? kept_index(options.choice, files) : options.out;
  if (path.empty())
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = "expected a file for the index, since neither XDG_CACHE_HOME nor HOME names a place",
                        .mend = "for example, `wale library index -o library.index`",
                        .place = {.name = "-o"}});
  auto store = LibraryStore::open(path, true);
  if (!store) return refuse(store.error());
  const auto report = (*store)->bring_up_to_date(files, request, shown_progress());
  if (!report) return refuse(report.error());
  if (options.json) {
    print_out(report_json(*report, path));
  } else {
    for (const StoreReport::Troubled& each : report->troubled)
      print_error("wale: `{}` of {} cannot be felt: {}\n", visible_text(each.material), visible_text(each.file),
                  visible_text(each.why));
    print_out("{}\n", readable("{} material{} of {} file{}; {} read anew, {} gone", report->materials,
                               report->materials == 1 ? "" : "s", report->files, report->files == 1 ? "" : "s",
                               report->read, report->gone));
    print_out("{}\n", visible_text(path));
  }
  return report->troubled.empty() ? done : refused;
}

Run declare_library_index(CLI::App& verb) {
  const auto options = std::make_shared<LibraryIndexOptions>();
  must_say(verb.add_option("PATH", options->paths,
                           "Wale files, or folders with all Wale files in them (default: all that `wale find` lists here)"),
           "the path of a Wale file or of a folder");
  must_say(offer_output(verb, options->out, "the file of the index, a new one or an earlier index (default: the one in the "
                                            "user's cache that `wale find` looks in)"),
           "the name of a file", "for example, `wale library index -o library.index`");
  verb.add_option("--device", options->choice.device,
                  "the device that the programs are built for: one of `wale devices` (default: sandpaper)")
      ->type_name("NAME");
  offer_library(verb, options->choice.folders);
  offer_sandbox(verb, options->choice.sandbox);
  offer_json(verb, options->json, "what came of it, with the materials that cannot be felt, as an object");
  verb.footer(
      "Compiles and reads each material whose file, or anything that it rests on, has changed since the last time.\n"
      "exit status 1: some material cannot be felt.\n"
      "for example: wale library index;  wale library index my/library -o my.index");
  return [options] { return make_index(*options); };
}

}  // namespace

extern const Verb library_index_verb{"library-index", "makes or updates the index in which materials are found by feel",
                                     declare_library_index};

}  // namespace wale::command
