#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// A file that an import or an image names: its name for messages, and its bytes.
struct ResolvedFile {
  std::string name;
  std::string bytes;
};

/// The largest file of a picture or a table in bytes: 4096 x 4096 pixels, the most that a patch can use, in four
/// channels of 32 bits, and 1 MiB of other data.
inline constexpr std::size_t largest_asset = (std::size_t{16} * 4096 * 4096) + (1 << 20);
/// The largest file of any kind that is read whole, in bytes: patch programs are the largest.
inline constexpr std::size_t largest_file = std::size_t{512} << 20;

/// The texts that a compilation imports have at most so many bytes together, 40 times those of the whole shipped
/// library and twice those of the largest file. A text may take a hundred times its size in memory: so they take less
/// than 1 GB.
inline constexpr std::size_t most_imported = std::size_t{8} << 20;
/// The bytes of pictures and tables that a compilation reads, however often the same: a few seconds of reading. What it
/// keeps of them is bounded by `Budget`.
inline constexpr std::size_t most_assets = std::size_t{2} << 30;

/// Whether an untrusted picture may be decoded where the system offers no sandbox for the decoder.
enum class Sandbox { required, if_possible };

/// A module in a folder that imports search.
struct ListedModule {
  std::string name;  ///< "fabric.denim"
  std::string path;
};

/// Supplies the bytes of imports and images. The compiler opens no files itself: its caller decides where they come
/// from. `from` is the name of the importing file. Errors: W0501, with a sentence that fits after "cannot be read:",
/// and W0509, with a sentence of its own.
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// A module by its dotted path, "fabric.denim".
  virtual Result<ResolvedFile> module(const std::string& path, const std::string& from) = 0;
  /// The name that `module` would give to its file, which is not read; empty if that is not known before.
  virtual std::string module_name(const std::string& /*path*/, const std::string& /*from*/) { return {}; }
  /// Any other file, by its name as written: "slate.tif".
  virtual Result<ResolvedFile> file(const std::string& name, const std::string& from) = 0;

  /// How the pictures that `file` supplies may be decoded.
  virtual Sandbox sandbox() const { return Sandbox::required; }

  /// Files whose exported devices every file knows, unless it declares or imports others of the same names.
  virtual std::vector<ResolvedFile> devices() { return {}; }

  /// A key for the library that `modules` lists: equal keys mean equal lists. If it is empty, the list must not be
  /// cached.
  virtual std::string library(const std::string& /*from*/) { return {}; }
  /// The modules that `from` could import, each once. Those of its project come first, or, without a project, those
  /// beside it. Empty if the source of the files cannot be listed.
  virtual std::vector<std::string> modules(const std::string& /*from*/) { return {}; }
  /// A module for the index of the library: it is not imported, and does not count as such.
  virtual Result<ResolvedFile> listed_module(const std::string& path, const std::string& from);
  /// The files that imports do not find, since a folder searched earlier has a module of the same name.
  virtual std::vector<ListedModule> hidden_modules(const std::string& /*from*/) { return {}; }
  /// The folders that `modules` should list and cannot, since this user may not read them.
  virtual std::vector<std::string> unreadable_folders(const std::string& /*from*/) { return {}; }
};

/// The name of the file that marks the root folder of a project's modules. The file may be empty.
inline constexpr const char* project_marker = "wale.project";

/// Looks beside the importing file, then in its project (the nearest folder above it with a `wale.project`), then in
/// each of the roots. Refuses files over `largest_asset`, modules over 4 MiB, more than a thousand modules or
/// `most_imported` bytes of them, more than `most_assets` bytes of other files, and all that are not regular files. The
/// sizes are looked at before anything is read. `looked_for` receives the paths of all files that it looks for, found
/// or not; it must outlive the resolver. `devices` is the result of `Resolver::devices`.
std::unique_ptr<Resolver> file_resolver(std::vector<std::string> roots, std::vector<std::string>* looked_for = nullptr,
                                        Sandbox sandbox = Sandbox::required, std::vector<ResolvedFile> devices = {});

/// Reads a whole file of at most `largest` bytes. Errors: W0501 if it is missing, unreadable, larger, or no regular
/// file, such as a folder, a pipe or a device; `place` names it.
Result<ResolvedFile> read_file(const std::string& path, std::size_t largest = largest_file);

}  // namespace wale
