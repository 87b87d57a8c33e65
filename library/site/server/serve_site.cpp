// wale-site-server FOLDER PORT: serves a site of `wale library site` to this computer alone. It is a program of its
// own, since it alone needs a library for HTTP.

#include <httplib.h>
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <thread>

#include "library/site/site_folder.hpp"

namespace {

const char* type_of(const std::string& path) {
  const std::string ending = path.substr(path.rfind('.') + 1);
  if (ending == "html") return "text/html; charset=utf-8";
  if (ending == "css") return "text/css; charset=utf-8";
  if (ending == "js") return "text/javascript; charset=utf-8";
  if (ending == "json") return "application/ld+json";
  if (ending == "svg") return "image/svg+xml";
  if (ending == "png") return "image/png";
  if (ending == "jpg") return "image/jpeg";
  if (ending == "wale" || ending == "hpp") return "text/plain; charset=utf-8";
  return "application/octet-stream";
}

/// The file of the site that an address means: `/material/corduroy` is material/corduroy.html. Only files that the
/// site lists are served, so no address leads out of its folder.
std::string file_for(const std::set<std::string>& files, std::string address) {
  address.erase(0, address.find_first_not_of('/'));
  if (address.empty()) address = "index";
  for (const std::string& path : {address, address + ".html"})
    if (files.contains(path)) return path;
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: wale-site-server FOLDER PORT\n");
    return 2;
  }
  const std::string folder = argv[1];
  const int port = std::atoi(argv[2]);
  const std::set<std::string> files = wale::site_files(folder);
  if (files.empty()) {
    std::fprintf(stderr, "wale: no site of `wale library site` is in this folder\n");
    return 1;
  }
  sigset_t ends;
  sigemptyset(&ends);
  for (const int each : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&ends, each);
  pthread_sigmask(SIG_BLOCK, &ends, nullptr);  // the threads of the server too

  httplib::Server server;
  // The library's own choice would let a second server share the port in silence.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  server.set_keep_alive_timeout(2);
  server.set_read_timeout(5, 0);
  server.set_payload_max_length(1 << 16);
  server.Get(".*", [&](const httplib::Request& request, httplib::Response& response) {
    response.set_header("X-Content-Type-Options", "nosniff");
    const std::string path = file_for(files, request.path);
    std::ifstream in(std::filesystem::path(folder) / path, std::ios::binary);
    if (path.empty() || !in) {
      response.status = 404;
      response.set_content("There is no such page.\n", "text/plain; charset=utf-8");
      return;
    }
    std::ostringstream bytes;
    bytes << in.rdbuf();
    response.set_content(std::move(bytes).str(), type_of(path));
  });
  if (!server.bind_to_port("127.0.0.1", port)) {
    std::fprintf(stderr, "wale: port %d of 127.0.0.1 is not to be had; another one is chosen by --port\n", port);
    return 1;
  }
  std::printf("http://127.0.0.1:%d/ until Ctrl-C\n", port);
  std::fflush(stdout);
  std::thread serving([&] { server.listen_after_bind(); });
  int came = 0;
  sigwait(&ends, &came);
  server.stop();
  serving.join();
  return 0;
}
