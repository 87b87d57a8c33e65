#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

#include "wale/result.hpp"

namespace wale {

/// The name of a page for any text: letters, digits, `_` and `.` stay, all other bytes become `-` and two hexadecimal
/// digits. Different texts have different names. A name has at most 120 characters and is one of a file on every
/// system, so it never leaves its folder.
std::string page_name(std::string_view text);

/// Whether a path is one of a site: names of `page_name` with a `/` between each two.
bool is_site_path(std::string_view path);

/// The folder of a site while it is written. A file that is there already with the same bytes is not touched; what an
/// earlier build wrote and this one does not is removed in the end; nothing else in the folder is. A build that was
/// killed is taken up by the next one.
class SiteFolder {
 public:
  /// Opens or makes the folder. Errors, W0505: it cannot be made; it holds files and no site, since nobody's files are
  /// mixed with one; it cannot be read.
  static Result<SiteFolder> open(const std::string& folder);

  /// Writes a file of the site, whole or not at all. `path` is one of `is_site_path`. Error: W0505. Thread-safe.
  Result<> put(const std::string& path, std::string_view bytes);
  /// Keeps a file of an earlier build as it is. False if there is none. Thread-safe.
  bool keep(const std::string& path);
  /// The bytes of a file of the site; empty if there is none.
  std::string bytes_of(const std::string& path) const;

  /// What the last build left for this one; empty at first.
  std::string notes() const;
  /// Removes what is no longer part of the site, and leaves `notes` for the next build. Error: W0505.
  Result<> finish(std::string_view notes);

  std::size_t changed() const { return changed_.size(); }  ///< files that were written or removed
  std::size_t files() const { return current_.size(); }

 private:
  std::string folder_;
  std::set<std::string> earlier_, current_;
  std::set<std::string> changed_;
  std::unique_ptr<std::mutex> lock_ = std::make_unique<std::mutex>();
};

/// The paths of the files of a site, in order; empty if the folder holds none.
std::set<std::string> site_files(const std::string& folder);

}  // namespace wale
