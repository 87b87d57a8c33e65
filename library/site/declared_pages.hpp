#pragma once

#include <map>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "library/site/frame.hpp"
#include "library/site/site_material.hpp"

namespace wale {

/// The pages of the percepts, maps, thresholds and devices that every file knows.
class DeclaredNames {
 public:
  explicit DeclaredNames(const Declarations& declarations);

  /// The path of a page, or nothing for a name without one.
  std::string percept(const std::string& name) const { return found(percepts_, name); }
  std::string device(const std::string& name) const { return found(devices_, name); }
  /// Of the map that a record of a program names, "roughness from amplitude", with its device and source.
  std::string map(const std::string& record, const std::string& device, const std::string& source) const;
  std::string of(const Map& map) const;
  std::string of(const Threshold& threshold) const;

 private:
  static std::string found(const std::map<std::string, std::string>& paths, const std::string& name) {
    const auto at = paths.find(name);
    return at == paths.end() ? std::string() : at->second;
  }
  const Declarations* declarations_;
  std::map<std::string, std::string> percepts_, devices_;
  std::map<const Map*, std::string> maps_;
  std::map<const Threshold*, std::string> thresholds_;
};

/// The pages of all of them, with what each rests on, and their lists "percepts.html" and "devices.html". `materials`
/// are those with pages.
std::vector<SitePage> declared_pages(const Declarations& declarations, const DeclaredNames& names,
                                     const std::vector<const SiteMaterial*>& materials);

/// The page of what is not known: of materials, of maps and of devices.
SitePage unknown_page(const Declarations& declarations, const DeclaredNames& names,
                      const std::vector<const SiteMaterial*>& published,
                      const std::vector<const SiteMaterial*>& left_out);

}  // namespace wale
