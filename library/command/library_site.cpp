#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "library/command/index_here.hpp"
#include "library/site/site.hpp"
#include "schema/companion.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct LibrarySiteOptions {
  SiteRequest request;
  std::vector<std::string> folders;
  bool json = false;
  std::optional<std::uint64_t> port;
  bool serves = false;
};

/// Where `wale library serve` keeps the site if no folder is named; empty if the system names no place for such.
std::string kept_site() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (cache && *cache) return std::string(cache) + "/wale/site";
  return home && *home ? std::string(home) + "/.cache/wale/site" : std::string();
}

std::string report_json(const SiteReport& report) {
  nlohmann::ordered_json json = {{"materials", report.materials},
                                 {"read", report.read},
                                 {"files", report.files},
                                 {"changed", report.changed},
                                 {"left_out", nlohmann::ordered_json::array()}};
  for (const SiteReport::LeftOut& each : report.left_out)
    json["left_out"].push_back({{"material", each.material}, {"file", each.file}, {"why", each.why}});
  return json_lines(json);
}

/// Writes the site and says what came of it.
Result<SiteReport> build_site(LibrarySiteOptions& options) {
  options.request.roots = library_folders(options.folders, std::getenv("WALE_LIBRARY"));
  std::mutex lock;
  const StoreProgress shown = shown_progress("site");
  const auto report = write_site(options.request, [&](std::size_t done, std::size_t all) {
    const std::lock_guard guard(lock);
    shown(done, all);
  });
  return report;
}

void tell_left_out(const SiteReport& report) {
  for (const SiteReport::LeftOut& each : report.left_out)
    print_error("wale: `{}` of {} has no page: {}\n", visible_text(each.material), visible_text(each.file),
                visible_text(each.why));
}

int library_site(LibrarySiteOptions& options) {
  warn_of_library_variable();
  const auto report = build_site(options);
  if (!report) return refuse(report.error());
  if (options.json) {
    print_out(report_json(*report));
  } else {
    tell_left_out(*report);
    print_out("{}\n", readable("{} material{}, {} of them read anew; {} of {} files changed", report->materials,
                               report->materials == 1 ? "" : "s", report->read, report->changed, report->files));
    print_out("{}\n", visible_text((std::filesystem::path(options.request.folder) / "index.html").string()));
  }
  return report->left_out.empty() ? done : refused;
}

/// Becomes the server, a program of its own, since it alone needs a library for HTTP. Returns only after an error.
int become_server(const std::string& folder, std::uint64_t port) {
  const std::string number = std::to_string(port);
  finish_output(done);
  for (const std::string& path : companion_paths("wale-site-server")) {
    if (access(path.c_str(), X_OK) != 0) continue;
    const char* const words[] = {path.c_str(), folder.c_str(), number.c_str(), nullptr};
    execv(path.c_str(), const_cast<char* const*>(words));
    return refuse(Error{.code = Code::missing_library,
                        .sentence = fmt::format("the server cannot be started: {}", std::strerror(errno)),
                        .place = {.name = path}});
  }
  return refuse(
      Error{.code = Code::missing_library,
            .sentence = "this Wale was built without its server, `wale-site-server`",
            .mend = fmt::format("open {}, which needs none; or install libcpp-httplib-dev and build Wale again",
                                visible_text((std::filesystem::path(folder) / "index.html").string()))});
}

int library_serve(LibrarySiteOptions& options) {
  warn_of_library_variable();
  if (options.request.folder.empty()) options.request.folder = kept_site();
  if (options.request.folder.empty())
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = "expected a folder for the site, since neither XDG_CACHE_HOME nor HOME names one",
                        .mend = "for example, `wale library serve -o site`",
                        .place = {.name = "-o"}});
  const auto report = build_site(options);
  if (!report) return refuse(report.error());
  tell_left_out(*report);
  constexpr std::uint64_t usual_port = 8020;
  return become_server(options.request.folder, options.port.value_or(usual_port));
}

void offer_site(CLI::App& verb, LibrarySiteOptions& options) {
  must_say(verb.add_option("PATH", options.request.paths,
                           "Wale files, or folders with all Wale files in them (default: the shipped library)"),
           "the path of a Wale file or of a folder");
  verb.add_option("--device", options.request.device,
                  "the device that the programs are built for: one of `wale devices` (default: sandpaper)")
      ->type_name("NAME");
  offer_library(verb, options.folders);
  offer_sandbox(verb, options.request.sandbox);
}

Run declare_library_site(CLI::App& verb) {
  const auto options = std::make_shared<LibrarySiteOptions>();
  options->request.device = default_device;
  offer_site(verb, *options);
  must_say(offer_output(verb, options->request.folder, "the folder of the site, a new one or one of an earlier site"),
           "the name of a folder", "for example, `wale library site -o site`")
      ->required();
  offer_json(verb, options->json, "what came of it, with the materials that have no page, as an object");
  verb.footer(
      "A browser opens index.html in it from the disk; any web server can publish it. What has not changed is not\n"
      "written again. Materials with an error, or whose licence does not let everybody pass them on, have no page.\n"
      "exit status 1: some of them, or a file that cannot be read, have none.\n"
      "for example: wale library site -o site;  wale library site my/library -o site");
  return [options] { return library_site(*options); };
}

Run declare_library_serve(CLI::App& verb) {
  const auto options = std::make_shared<LibrarySiteOptions>();
  options->request.device = default_device, options->serves = true;
  offer_site(verb, *options);
  must_say(offer_output(verb, options->request.folder,
                        "the folder of the site, as for `wale library site` (default: one in the user's cache)"),
           "the name of a folder");
  offer_count(verb, "--port", options->port, {.least = 1, .most = 65535, .example = 8020},
              "the port on 127.0.0.1 (default: 8020)");
  verb.footer(
      "Writes the site as `wale library site` does, and serves it to this computer alone until Ctrl-C.\n"
      "for example: wale library serve;  wale library serve my/library --port 8080");
  return [options] { return library_serve(*options); };
}

}  // namespace

extern const Verb library_site_verb{"library-site", "writes the site on which the materials of a library are found",
                                    declare_library_site};
extern const Verb library_serve_verb{"library-serve", "writes that site and serves it to this computer",
                                     declare_library_serve};

}  // namespace wale::command
