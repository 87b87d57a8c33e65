#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace wale {

/// A file that an import or an image names: the name that people see, and its bytes.
struct ResolvedFile {
  std::string name;
  std::string bytes;
};

/// Why a file could not be had, in words.
struct ResolveProblem {
  std::string reason;
};

/// Supplies the bytes of imports and images. The compiler opens no files itself; whoever calls it decides where they
/// come from. `from` is the name of the file that asks.
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// A module by its dotted path, "fabric.denim".
  virtual std::variant<ResolvedFile, ResolveProblem> module(const std::string& path, const std::string& from) = 0;
  /// Any other file by its name as written, "slate.tif".
  virtual std::variant<ResolvedFile, ResolveProblem> file(const std::string& name, const std::string& from) = 0;

  /// What tells apart the libraries that modules are listed of; empty where none is worth remembering.
  virtual std::string library(const std::string& /*from*/) { return {}; }
  /// The modules that `from` could import, each once: first those of its project, or else beside it. None where files
  /// come from where nothing can be listed.
  virtual std::vector<std::string> modules(const std::string& /*from*/) { return {}; }
};

/// The name of the file that marks the folder in which a project's modules are rooted. It may be empty.
inline constexpr const char* project_marker = "wale.project";

/// Looks beside the file that asks, then in the project that it belongs to (the nearest folder above it that holds a
/// `wale.project`), then in each of the roots; files over 512 MiB, modules over 4 MiB and more than a thousand modules
/// are refused. `looked_for` gets the paths of all files that it looks for, found or not, and outlives it.
std::unique_ptr<Resolver> file_resolver(std::vector<std::string> roots, std::vector<std::string>* looked_for = nullptr);

/// Reads a whole file, or says why not (missing, a folder, unreadable, too large).
std::variant<ResolvedFile, ResolveProblem> read_file(const std::string& path);

}  // namespace wale
