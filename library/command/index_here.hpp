#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compiler/command/options.hpp"
#include "library/index/probe.hpp"
#include "library/store/library_store.hpp"

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

/// The index that a verb looks in.
struct IndexHere {
  std::unique_ptr<LibraryStore> store;
  std::unique_ptr<MaterialIndex> in_memory;  ///< if nothing can be kept
  StoreReport report;

  const MaterialIndex& index() const { return store ? store->index() : *in_memory; }
};

/// Opens the index of a file as it stands; or brings the one that is kept for the library of the current folder up to
/// date, and shows how far it is on a terminal. Where none can be kept, reads the library, and says that this is why it
/// takes long. Errors: those of `LibraryStore::open` for a file that was named.
Result<IndexHere> index_here(const IndexChoice& choice);

/// The folder of indexes in the user's cache, which is made if it is not there; empty if the system names no place.
std::string cache_folder();

/// Where the index of that library is kept, a file in the user's cache; empty if the system names no place.
std::string kept_index(const IndexChoice& choice, const std::vector<LibraryFile>& files);

/// Shows on a terminal how many files have been read.
StoreProgress shown_progress();

/// What is felt of a material of the index, or of one of a Wale file of one's own: "my.wale", "my.wale:name".
struct FeltMaterial {
  std::string name;
  Cues cues;
  std::vector<std::uint32_t> is;  ///< its number, if the index has it
};

/// Errors: those of `meant_entry`, of `read_entries`, and W0602 for a material whose cues are not known, as of one that
/// only vibrates.
Result<FeltMaterial> felt_material(const MaterialIndex& index, const IndexChoice& choice, const std::string& text);

/// "1.4 differences", "at least 1.4 differences, friction unknown".
std::string distance_text(const Probe::Told& told);
nlohmann::ordered_json distance_json(const Probe::Told& told);

}  // namespace wale::command
