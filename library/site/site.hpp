#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/text/resolver.hpp"
#include "wale/result.hpp"

namespace wale {

/// What a site is made of.
struct SiteRequest {
  std::string folder;              ///< where it is written
  std::vector<std::string> paths;  ///< Wale files, and folders with all below them; empty: the shipped library
  std::vector<std::string> roots;  ///< the last folders that are searched for imports
  std::string device;              ///< for which the programs are built
  Sandbox sandbox = Sandbox::required;
};

/// What came of it.
struct SiteReport {
  std::size_t materials = 0;  ///< with a page
  std::size_t read = 0;       ///< of these, those that were compiled and drawn: the others had not changed
  std::size_t files = 0;      ///< of the site
  std::size_t changed = 0;    ///< of these, those that were written, and those that were removed
  struct LeftOut {
    std::string material, file, why;
  };
  std::vector<LeftOut> left_out;  ///< materials without a page: with an error, or a licence that does not allow it
};

/// Writes a site: a page of each material whose licence lets everybody pass it on, lists, the plane of percepts, and a
/// page of each percept, map, threshold and device. What has not changed since the last build into that folder, with
/// all that it rests on, is neither read nor written again. The same library gives the same bytes. `tell` gets a number
/// of files that are done and their count, from any thread; it may be empty. Uses all cores.
///
/// Errors: those of `SiteFolder`; W0501 for a path that cannot be read, W0602 if there is no Wale file, W0601 for an
/// unknown device, W0806 without a library that draws. A material with an error has no page and is reported.
Result<SiteReport> write_site(const SiteRequest& request,
                              const std::function<void(std::size_t, std::size_t)>& tell = {});

}  // namespace wale
