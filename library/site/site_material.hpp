#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compiler/read/cues.hpp"
#include "library/index/entry.hpp"
#include "library/site/figures.hpp"

namespace wale {

/// A percept of a material, as lists and the map of the site need it.
struct SitePercept {
  std::string name;
  std::optional<double> asked, reads;  ///< levels
  double low = 0, high = 0;            ///< where 95 % of the means of other groups lie, if `reads`
  std::string evidence;                ///< "measured"; empty where nothing is read
};

/// What the other pages of the site know of a material; kept from build to build.
struct SiteMaterial {
  std::string page;  ///< name of its page: "corduroy"
  std::string name, module, file, folder, kind, title, documentation, licence;
  std::vector<EntryName> names;
  std::vector<std::string> feels, asks, replaces, sources;
  std::string content;      ///< hash of all that it rests on
  std::string trouble;      ///< why it has no page: its error, or its licence; empty if it has one
  bool unlicensed = false;  ///< `trouble` is about the licence

  std::vector<SitePercept> percepts;
  std::optional<Cues> cues;
  double width = 0, height = 0;  ///< m, of the patch
  double side = 0;               ///< m, of its picture; m/s if that is over velocities
  bool of_velocity = false;
  double newton = 0;                 ///< the largest force at its defaults; 0 for a pad
  std::string small;                 ///< path of the picture for lists
  std::vector<std::string> unknown;  ///< what is not known of it, a line each
  std::vector<std::string> files;    ///< paths of all files that are its own, the page among them

  bool published() const { return trouble.empty(); }
  /// Its title, or else its name.
  const std::string& shown() const { return title.empty() ? name : title; }
};

nlohmann::ordered_json to_json(const SiteMaterial& material);
/// Throws nlohmann's exceptions for JSON that is none of `to_json`.
SiteMaterial site_material_of(const nlohmann::ordered_json& json);

}  // namespace wale
