#pragma once

#include <memory>
#include <string>
#include <vector>

#include "schema/result.hpp"

namespace wale {

/// A file that an import or an image names: its name for messages, and its bytes.
struct ResolvedFile {
  std::string name;
  std::string bytes;
};

/// A module in a folder that imports search.
struct ListedModule {
  std::string name;  ///< "fabric.denim"
  std::string path;
};

/// Supplies the bytes of imports and images. The compiler opens no files itself: its caller decides where they come
/// from. `from` is the name of the importing file. Errors: W0501, with a sentence that fits after "cannot be read:".
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// A module by its dotted path, "fabric.denim".
  virtual Result<ResolvedFile> module(const std::string& path, const std::string& from) = 0;
  /// Any other file, by its name as written: "slate.tif".
  virtual Result<ResolvedFile> file(const std::string& name, const std::string& from) = 0;

  /// A key for the library that `modules` lists: equal keys mean equal lists. If it is empty, the list must not be
  /// cached.
  virtual std::string library(const std::string& /*from*/) { return {}; }
  /// The modules that `from` could import, each once. Those of its project come first, or, without a project, those
  /// beside it. Empty if the source of the files cannot be listed.
  virtual std::vector<std::string> modules(const std::string& /*from*/) { return {}; }
  /// The files that imports do not find, since a folder searched earlier has a module of the same name.
  virtual std::vector<ListedModule> hidden_modules(const std::string& /*from*/) { return {}; }
};

/// The name of the file that marks the root folder of a project's modules. The file may be empty.
inline constexpr const char* project_marker = "wale.project";

/// Looks beside the importing file, then in its project (the nearest folder above it with a `wale.project`), then in
/// each of the roots. Refuses files over 512 MiB, modules over 4 MiB and more than 1000 modules. `looked_for`, if
/// given, receives the paths of all files that it looks for, found or not; it must outlive the resolver.
std::unique_ptr<Resolver> file_resolver(std::vector<std::string> roots, std::vector<std::string>* looked_for = nullptr);

/// Reads a whole file. Errors: W0501 if it is missing, a folder, unreadable or larger than 512 MiB; `place` names it.
Result<ResolvedFile> read_file(const std::string& path);

}  // namespace wale
