#include "compiler/evidence/percept_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/measure/coarseness.hpp"
#include "compiler/measure/measure.hpp"
#include "compiler/read/cues.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double mostly_elsewhere = 0.75;  // of a relief's amplitude: less of it in the band is told as the cause

bool is_still(Extractor extractor) {
  switch (extractor) {
    case Extractor::lateral_force:
    case Extractor::steepness:
    case Extractor::periodicity:
    case Extractor::stiffness:
    case Extractor::wall_stiffness:
    case Extractor::wall_damping: return true;
    default: return false;
  }
}

bool is_of_wall(Extractor extractor) {
  return extractor == Extractor::wall_stiffness || extractor == Extractor::wall_damping;
}

/// The percept that a record is of, as far as a reading needs it.
Percept read_as(const PerceptRecord& record) {
  Percept percept{.name = record.name, .extractor = record.extractor};
  if (record.period_high > 0) percept.period = {record.period_low, record.period_high};
  return percept;
}

double bound(float value) {
  return std::abs(value) < std::numeric_limits<float>::max() ? value : std::copysign(infinite, value);
}

/// The period in the middle of what a relief has in a percept's band, m; of all of it if the band has next to nothing.
/// 0 without one.
double period_of(const Relief& relief, const PeriodBand& band, bool in_band) {
  if (!in_band && relief.period > 0) return relief.period;
  std::vector<Relief::Part> parts;
  double all = 0, part = 0;
  for (const Relief::Part& each : relief.parts)
    if (!in_band || (each.period >= band.low && each.period < band.high)) parts.push_back(each), all += each.share;
  std::ranges::sort(parts, {}, &Relief::Part::period);
  for (const Relief::Part& each : parts)
    if ((part += each.share) >= 0.5 * all) return each.period;
  return 0;
}

}  // namespace

std::string in_words(const OutsideRange& outside) {
  const bool below = outside.value < outside.low;
  const double bound = below ? outside.low : outside.high;
  return readable("{} {:.3g}{}{}, {} {} {:.3g}", outside.quantity, outside.value / outside.unit_in_si,
                  outside.unit.empty() ? "" : " ", outside.unit, outside.assumed ? "assumed" : "measured",
                  below ? "from" : "to", bound / outside.unit_in_si);
}

std::string outside_in_words(const OutsideRange& outside) {
  return fmt::format("outside {} ({})", outside.assumed ? "the range assumed for its map" : "what was measured",
                     in_words(outside));
}

std::vector<OutsideRange> outside_of(const PerceptRecord& record, double size, const Bank& bank,
                                     const ForceReading& found, const Declarations& declarations) {
  std::vector<OutsideRange> outside;
  const auto judge = [&](const OutsideRange& range) {
    const double error = range.quantity == "period" ? reading_of_period : reading;
    if (range.value < range.low * (1 - error) || range.value > range.high * (1 + error)) outside.push_back(range);
  };
  if (size > 0)
    judge({.quantity = record.carrier.substr(record.carrier.find(' ') + 1),
           .value = size,
           .low = record.valid_low,
           .high = record.valid_high,
           .unit = record.unit,
           .assumed = record.basis.valid_assumed});
  if (record.basis.ranges.empty()) return outside;
  Sizes sizes = sizes_of(cues_of(bank, found), speed_of_strokes(declarations));
  if (record.extractor == Extractor::lateral_force) {
    const double period = period_of(found.relief(), band_of(read_as(record), declarations), size > 0);
    sizes.erase("period");
    if (period > 0) sizes["period"] = period;
  }
  for (const MeasuredRange& range : record.basis.ranges)
    if (const auto value = sizes.find(range.quantity); value != sizes.end())
      judge({.quantity = range.quantity,
             .value = std::abs(value->second),
             .low = bound(range.low),
             .high = bound(range.high),
             .unit = range.unit,
             .unit_in_si = range.unit_in_si,
             .assumed = range.assumed});
  return outside;
}

double most_given(const Bank& bank, const Declarations& declarations) {
  const DeviceProfile& device = bank.program().description().device;
  if (!device.shaker) return device.most();
  constexpr float steady = 1e-3f;
  const MeasuredShaking shaking = measure_shaking(bank, declarations.hands.find("normal"));
  if (!(shaking.highest > 0) || shaking.highest - shaking.lowest > steady * shaking.highest) return device.most();
  return std::min(device.most(), device.shaker->acceleration(1, shaking.highest));
}

PerceptReading percept_reading(const Bank& bank, std::size_t index, const ForceReading& found,
                               const Declarations& declarations) {
  const PatchProgram& program = bank.program().description();
  const PerceptRecord& record = program.percepts[index];
  PerceptReading told;
  told.aimed = amplitude(bank, index);
  told.aimed_level = predict(bank, index, static_cast<float>(told.aimed)).level;
  told.readable = record.extractor != Extractor::none && record.extractor != Extractor::acceleration &&
                  (is_still(record.extractor) || !leaves_out_motion(program));
  if (told.readable) {
    told.size = carrier_of(found, read_as(record), declarations).value_or(0);
    // What is read of a carrier is as good as its reader: nearer than that it is the size itself.
    if (std::abs(told.size - told.aimed) <= reading * std::abs(told.aimed)) told.size = told.aimed;
    // Where the device's limit cuts a force that other forces fill, what is left of it cannot be told from them.
    // Walls and springs are read by their whole law.
    const bool by_law = (is_of_wall(record.extractor) && found.wall) ||
                        (record.extractor == Extractor::stiffness && found.stiffness != 0);
    const bool cut =
        is_still(record.extractor) && !by_law && found.still.largest >= (1 - reading) * program.device.most();
    const bool by_itself = record.unit == "N" && told.aimed >= program.device.most() * record.basis.share;
    if (cut && !by_itself && record.basis.summand && told.size != told.aimed) told.readable = false;
  }
  if (!told.readable) {
    // The device's limit cuts only carriers in the unit of its output.
    const bool limited = record.unit == (program.vibrates() ? "m/s^2" : "N");
    told.size = limited ? std::min(told.aimed, most_given(bank, declarations) * record.basis.share) : told.aimed;
  }
  // A force that pushes the hand on has no level of what opposes it.
  if (told.size > 0 || (told.size < 0 && told.aimed < 0)) {
    const Prediction prediction = predict(bank, index, static_cast<float>(told.size));
    told.level = prediction.level, told.magnitude = prediction.magnitude;
  }
  told.outside = outside_of(record, told.size, bank, found, declarations);
  // A relief of other periods than those of the map is there to be felt, and nobody knows as what.
  told.unknown = told.readable && told.size == 0 && told.aimed > 0 && record.extractor == Extractor::lateral_force &&
                 found.relief().amplitude >= least_force && !outside_ranges(record, told).empty();
  // Nor has a drag a level that no one friction or viscosity tells.
  const bool drags = record.extractor == Extractor::damping || record.extractor == Extractor::opposing_force;
  told.unknown |= told.readable && told.size == 0 && told.aimed > 0 && drags && found.opposing.by_no_figure();
  told.unknown |= told.readable && told.size == 0 && told.aimed > 0 && record.extractor == Extractor::inertia &&
                  !found.inertia.is_one();
  if (told.unknown) told.level = told.magnitude = std::numeric_limits<double>::quiet_NaN();
  return told;
}

bool differs(const PerceptRecord& record, double aimed, double asked, double size, double level) {
  if (!std::isfinite(asked) || !std::isfinite(level)) return false;
  if (std::abs(level - asked) <= record.basis.tolerance) return false;
  const double least = std::min(level, asked), most = std::max(level, asked);
  if (least > 0 && std::log10(most / least) <= record.uncertainty.scatter) return false;
  const double small = std::min(aimed, size), large = std::max(aimed, size);
  if (record.weber > 0 && small > 0 && std::log(large / small) <= std::log1p(record.weber)) return false;
  return large - small > record.floor;
}

bool stands_outside(const PerceptRecord& record, const ForceReading& found) {
  return is_of_wall(record.extractor) && !found.wall && found.still.largest < least_force;
}

std::string cause_of_difference(const PerceptRecord& record, const PerceptReading& reading, const ForceReading& found,
                                const Declarations& declarations) {
  if (stands_outside(record, found))
    return record.extractor == Extractor::wall_damping
               ? "no wall is in the patch for it to damp: add one that pushes back, as `firm(1000 N/m)` does"
               : "its wall stands outside of the patch";
  if (record.extractor == Extractor::lateral_force) {
    const Relief& relief = found.relief();
    const PeriodBand band = band_of(read_as(record), declarations);
    if (relief.amplitude > 0 && relief.within(band) < mostly_elsewhere * record.basis.share * relief.amplitude)
      return readable("{} of its relief has periods outside {:.3g} .. {:.3g} mm",
                      relief.within(band) < least_of_relief * relief.amplitude ? "all" : "a part",
                      1e3 * record.period_low, 1e3 * record.period_high);
  }
  if (record.extractor == Extractor::vibration && found.sway.amplitude >= least_force &&
      found.vibration.amplitude < least_force)
    return readable("it goes slower than {:.0f} Hz, which is a sway and no vibration", slowest_vibration);
  if (!record.basis.summand) return "its force is changed after it was solved";
  if (record.alone) return "the device or the shape of the force changes it";
  return reading.size < reading.aimed ? "another force takes from it" : "another force adds to it";
}

std::vector<OutsideRange> outside_ranges(const PerceptRecord& record, const PerceptReading& told) {
  std::vector<OutsideRange> ranges;
  for (const OutsideRange& each : told.outside)
    if (!record.carrier.ends_with(" " + each.quantity)) ranges.push_back(each);
  return ranges;
}

std::string why_approximated(const PerceptRecord& record, const PerceptReading& told, double asked,
                             const ForceReading& found, const Declarations& declarations) {
  if (!told.readable) return {};
  if (const auto outside = outside_ranges(record, told); !outside.empty()) return outside_in_words(outside.front());
  if (told.unknown) return "what resists the hand is told by no one figure, so its level is unknown";
  if (differs(record, told.aimed, asked, told.size, told.level))
    return cause_of_difference(record, told, found, declarations);
  return told.size == 0 && asked > 0 ? "too little of it to be felt, so none is read" : "";
}

ReadParts parts_for(Extractor extractor) {
  const bool none = extractor == Extractor::none || extractor == Extractor::acceleration;
  return {.still = !none && is_still(extractor), .moving = !none && !is_still(extractor)};
}

ReadParts parts_for(const PatchProgram& program) {
  ReadParts parts{.still = false, .moving = false};
  for (const PerceptRecord& record : program.percepts) {
    const ReadParts of_it = parts_for(record.extractor);
    parts.still |= of_it.still, parts.moving |= of_it.moving;
  }
  return parts;
}

}  // namespace wale
