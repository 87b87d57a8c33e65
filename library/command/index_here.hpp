#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compiler/command/options.hpp"
#include "library/index/probe.hpp"
#include "library/store/kept_index.hpp"

namespace wale::command {

/// In which index a verb looks.
struct IndexChoice {
  /// A file, or the address of a shared one, that is taken as it stands; empty: one of the library that imports find here.
  std::string file;
  std::string device = default_device;
  std::vector<std::string> folders;
  Sandbox sandbox = Sandbox::required;
};

/// --index INDEX, --library DIR and --unsandboxed-pictures.
void offer_index(CLI::App& verb, IndexChoice& choice);

/// How the files of that choice are read.
FileRequest request_of(const IndexChoice& choice);

/// `open_index` for a verb: shows how far it is, and prints warnings.
Result<IndexHere> index_here(const IndexChoice& choice, const std::vector<std::string>& meant = {});

/// Says on the error stream that a library is being read for its index, or for what else, if that takes longer than a
/// moment: how far it is on a terminal, otherwise once.
StoreProgress shown_progress(const std::string& what = "index");

/// "1.4 differences", "at least 1.4 differences, friction unknown".
std::string distance_text(const Probe::Told& told);
nlohmann::ordered_json distance_json(const Probe::Told& told);

}  // namespace wale::command
