#include "compiler/solve/basis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/solve/choose_map.hpp"

namespace wale {
namespace {

float finite(double value) {
  constexpr double most = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -most, most));
}

}  // namespace

PerceptRecord record_by(const Map& map, const Percept& percept, const DeviceDeclaration& device,
                        const Declarations& declarations) {
  PerceptRecord record;
  record.name = percept.name;
  record.carrier = percept.carrier;
  record.unit =
      percept.extractor == Extractor::acceleration ? "m/s^2" : declarations.names().unit(percept.carrier_dimension);
  record.extractor = percept.extractor;
  if (std::isfinite(percept.period.high)) {
    record.period_low = static_cast<float>(percept.period.low);
    record.period_high = static_cast<float>(percept.period.high);
  }
  record.near_threshold = static_cast<float>(percept.near_threshold);
  record.one = static_cast<float>(map.one.value_or(percept.one));
  record.valid_low = static_cast<float>(map.valid_low);
  record.valid_high = static_cast<float>(map.valid_high);
  record.uncertainty = map.uncertainty;
  record.slope = map.slope, record.anchor = map.anchor;
  record.handle = is_of(map, device) ? map.handle : Evidence::transferred;
  record.map = map.percept + " from " + map.from;
  record.device = map.device;
  record.source = map.source;
  record.basis.valid_assumed = map.valid_assumed;
  record.basis.domain = map.domain;
  for (const Condition& each : map.conditions)
    record.basis.ranges.push_back({.quantity = each.quantity,
                                   .low = finite(each.range.low),
                                   .high = finite(each.range.high),
                                   .unit = each.unit,
                                   .unit_in_si = each.unit_in_si,
                                   .assumed = each.assumed});
  return record;
}

}  // namespace wale
