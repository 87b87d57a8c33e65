#include "compiler/declarations/declarations.hpp"

namespace wale {

Declarations::Declarations(const Declarations& beneath, std::shared_ptr<SharedNames> names)
    : shared_names(std::move(names)), common(&beneath) {
  dimensions.stand_on(beneath.dimensions);
  dimension_bounds.stand_on(beneath.dimension_bounds);
  units.stand_on(beneath.units);
  constants.stand_on(beneath.constants);
  functions.stand_on(beneath.functions);
  percepts.stand_on(beneath.percepts);
  classes.stand_on(beneath.classes);
  devices.stand_on(beneath.devices);
  hands.stand_on(beneath.hands);
  materials.stand_on(beneath.materials);
}

namespace {

/// The entries that every file knows first, then the file's own.
template <typename T>
std::vector<const T*> gathered(std::vector<const T*> all, const std::vector<T>& own) {
  for (const auto& each : own) all.push_back(&each);
  return all;
}

}  // namespace

std::vector<const Map*> Declarations::maps() const {
  return gathered(common ? common->maps() : std::vector<const Map*>{}, own_maps);
}

std::vector<const Threshold*> Declarations::thresholds() const {
  return gathered(common ? common->thresholds() : std::vector<const Threshold*>{}, own_thresholds);
}

std::vector<const Rule*> Declarations::rules() const {
  return gathered(common ? common->rules() : std::vector<const Rule*>{}, own_rules);
}

std::vector<const Levels*> Declarations::levels() const {
  return gathered(common ? common->levels() : std::vector<const Levels*>{}, own_levels);
}

PerceptName Declarations::percept_named(std::string_view name) const {
  if (const Percept* found = percepts.find(name)) return {found, false};
  PerceptName found;
  if (name.empty()) return found;  // as most antonyms are
  percepts.each([&](const std::string&, const Percept& percept) {
    if (percept.antonym == name) found = {&percept, true};
  });
  return found;
}

std::vector<std::string> Declarations::percepts_with_levels() const {
  std::vector<std::string> all;
  percepts.each([&](const std::string& name, const Percept& percept) {
    if (percept.has_reference) all.push_back(name);
  });
  return all;
}

std::vector<std::string> Declarations::percept_spellings() const {
  std::vector<std::string> all;
  percepts.each([&](const std::string& name, const Percept& percept) {
    all.push_back(name);
    if (!percept.antonym.empty()) all.push_back(percept.antonym);
  });
  return all;
}

}  // namespace wale
