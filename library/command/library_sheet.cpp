#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/readable.hpp"
#include "library/survey/contact_sheet.hpp"
#include "library/survey/survey.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct LibrarySheetOptions {
  std::vector<std::string> paths, folders;
  std::string out;
  Sandbox sandbox = Sandbox::required;
};

/// What a sheet is of, without the way there, which is of no use to others: "stones" of "shelf/stones/".
std::string titled(const std::vector<std::string>& paths) {
  std::error_code ignored;
  std::filesystem::path first =
      std::filesystem::absolute(paths.empty() ? "." : paths.front(), ignored).lexically_normal();
  if (!first.has_filename()) first = first.parent_path();
  return first.filename().string() + (paths.size() > 1 ? " and more" : "");
}

int library_sheet(const LibrarySheetOptions& options) {
  warn_of_library_variable();
  if (is_written_as_it_comes(options.out))
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = "expected the name of a file, since there may be several pages",
                        .mend = "for example, `-o sheet.png`",
                        .place = {.name = "-o"}});
  FileRequest request;
  request.roots = library_folders(options.folders, std::getenv("WALE_LIBRARY")), request.sandbox = options.sandbox;
  const auto surveyed = survey(options.paths, request, SurveyDepth::programs);
  if (!surveyed) return refuse(surveyed.error());
  for (const Error& each : surveyed->unread) warn(each);
  const auto common = declared_everywhere();
  const std::vector<SheetPage> pages = sheet_pages(surveyed->entries);
  if (pages.empty()) return refuse("no file here has a material");
  const std::string what = titled(options.paths);
  bool has_text = true;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const std::string title = fmt::format("{}{}", visible_text(what),
                                          pages.size() > 1 ? readable(", page {} of {}", i + 1, pages.size()) : "");
    const auto page = draw_sheet(pages[i], title, common->declarations);
    if (!page) return refuse(page.error());
    has_text = (*page)->has_text();
    const std::string name = page_name(options.out, i + 1, pages.size());
    const auto bytes = encode_page(**page, name);
    if (!bytes) return refuse(bytes.error());
    const auto written = write_file(name, {reinterpret_cast<const char*>(bytes->data()), bytes->size()}, surveyed->read);
    if (!written) return refuse(written.error());
    print_out("{}\n", visible_text(name));
  }
  if (!has_text) print_error("wale: no font is installed, so the sheets have no words (Debian: fonts-dejavu-core)\n");
  int status = surveyed->unread.empty() ? done : refused;
  for (const Entry& each : surveyed->entries)
    if (each.program.empty()) {
      print_error("wale: {}: `{}` cannot be built: {}\n", visible_text(each.file), each.name, visible_text(each.trouble));
      status = refused;
    }
  return status;
}

Run declare_library_sheet(CLI::App& verb) {
  const auto options = std::make_shared<LibrarySheetOptions>();
  must_say(verb.add_option("FILE", options->paths,
                           "paths of Wale files, or of folders with all Wale files in them (default: the current folder, or the shipped library if it has none)"),
           "the path of a Wale file or of a folder");
  must_say(offer_output(verb, options->out,
                        "the picture to write, as in sheet.png, or .svg; of several pages, sheet_01.png and so on"),
           "the name of the file to write", "for example, `-o sheet.png`")
      ->required();
  offer_library(verb, options->folders);
  offer_sandbox(verb, options->sandbox);
  verb.footer(
      "Up to 24 materials a page, by kind, each with its size in mm. Exit status 1: some could not be built, or files read.\n"
      "for example: wale library sheet my/library -o sheet.png");
  return [options] { return library_sheet(*options); };
}

}  // namespace

extern const Verb library_sheet_verb{"library-sheet", "draws previews of all materials of a library, by kind",
                                     declare_library_sheet};

}  // namespace wale::command
