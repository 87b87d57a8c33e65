#include <algorithm>
#include <array>
#include <utility>

#include "runtime/device/driver.hpp"

namespace wale {

#define DRIVER(name) extern const Driver name##_driver;
#include "runtime/device/drivers.def"

namespace {

constexpr std::array all_drivers = {
#define DRIVER(name) &name##_driver,
#include "runtime/device/drivers.def"
};

}  // namespace

Drivers drivers() { return all_drivers; }

std::vector<std::string> transport_names(Drivers drivers) {
  std::vector<std::string> names;
  for (const Driver* driver : drivers) names.insert(names.end(), driver->transports.begin(), driver->transports.end());
  return names;
}

bool has_transport(const Driver& driver, std::string_view transport) {
  return transport.empty() || std::ranges::find(driver.transports, transport) != driver.transports.end();
}

const Driver* find_driver(Drivers drivers, std::string_view name) {
  const auto found = std::ranges::find(drivers, name, &Driver::name);
  return found != drivers.end() ? *found : nullptr;
}

Connections Connections::open() { return {UsbContext::open()}; }

std::vector<PluggedIn> plugged_in(const Connections& connections, std::string_view asked, Drivers drivers) {
  std::vector<PluggedIn> all;
  for (const Driver* driver : drivers) {
    if (!driver->is_chosen_by_auto && driver->name != asked) continue;
    for (PluggedIn& each : driver->find(connections, nullptr)) all.push_back(std::move(each));
  }
  return all;
}

std::string in_words(const PluggedIn& plugged) {
  const std::string name = plugged.name.empty() ? "a device without a name" : plugged.name;
  if (plugged.numbers.empty()) return name + " (" + plugged.port + ")";
  return name + " (" + plugged.numbers + " at port " + plugged.port + ")";
}

}  // namespace wale
