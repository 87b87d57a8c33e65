#include "compiler/declarations/declarations.hpp"

namespace wale {

Declarations::Declarations(const Declarations& beneath)
    : shared_names(std::make_shared<DimensionNames>(beneath.names())), common(&beneath) {
  dimensions.stand_on(beneath.dimensions);
  dimension_bounds.stand_on(beneath.dimension_bounds);
  units.stand_on(beneath.units);
  constants.stand_on(beneath.constants);
  functions.stand_on(beneath.functions);
  percepts.stand_on(beneath.percepts);
  devices.stand_on(beneath.devices);
  hands.stand_on(beneath.hands);
  materials.stand_on(beneath.materials);
}

std::vector<const Map*> Declarations::maps() const {
  std::vector<const Map*> all = common ? common->maps() : std::vector<const Map*>{};
  for (const auto& map : own_maps) all.push_back(&map);
  return all;
}

std::vector<const Levels*> Declarations::levels() const {
  std::vector<const Levels*> all = common ? common->levels() : std::vector<const Levels*>{};
  for (const auto& levels : own_levels) all.push_back(&levels);
  return all;
}

}  // namespace wale
