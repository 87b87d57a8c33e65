#include "compiler/solve/choose_map.hpp"

#include <algorithm>

namespace wale {

Percept carried_on(const DeviceDeclaration& device, const Percept& percept, const Declarations& declarations) {
  if (!device.profile.shaker || !device.realise.contains(percept.name)) return percept;
  Percept shaken = percept;
  shaken.carrier = shaking_carrier(percept.name);
  shaken.carrier_dimension = declarations.dimension("acceleration");
  shaken.one = 0;  // given by the map
  shaken.extractor = Extractor::acceleration;
  shaken.period = {};
  shaken.cue = "shaking";
  shaken.exerts = 1;
  return shaken;
}

MapChoice choose_map(const Percept& percept, const DeviceDeclaration& device, const Declarations& declarations,
                     const std::string& named) {
  const auto rule = device.realise.find(percept.name);
  const std::string& by = named.empty() && rule != device.realise.end() ? rule->second.by : named;
  MapChoice choice;
  std::vector<const Map*> tied;
  tied.reserve(8);  // usually enough
  declarations.each_map([&](const Map& map) {
    if (map.percept != percept.name || (!by.empty() && map.name != by)) return;
    const bool of_carrier = map.from == percept.argument() && map.dimension == percept.carrier_dimension;
    (map.tied && of_carrier ? tied : choice.untied).push_back(&map);
  });
  // What nobody felt never takes the place of what people felt, unless it is chosen by name.
  if (std::ranges::any_of(tied, [](const Map* map) { return !map->simulated(); }) && by.empty())
    std::erase_if(tied, [](const Map* map) { return map->simulated(); });
  if (!tied.empty()) choice.untied.clear();
  const auto choose = [&](const std::vector<const Map*>& candidates) {
    if (candidates.size() == 1) choice.map = candidates.front();
    if (candidates.size() > 1) choice.rivals = candidates;
    return !candidates.empty();
  };
  const auto declared_class = [&](const std::string& name) {
    const auto* found = declarations.devices.find(name);
    return found ? found->of_class : name;  // a map may be for a whole class
  };
  const auto measured = [&](const auto& there) {
    std::vector<const Map*> all;
    std::ranges::copy_if(tied, std::back_inserter(all), there);
    return all;
  };
  const bool found = choose(measured([&](const Map* map) { return map->device == device.profile.name; })) ||
                     choose(measured([&](const Map* map) {
                       return !device.of_class.empty() && declared_class(map->device) == device.of_class;
                     })) ||
                     choose(measured([&](const Map* map) { return map->device == percept.reference_device; })) ||
                     choose(tied);
  (void)found;
  return choice;
}

}  // namespace wale
