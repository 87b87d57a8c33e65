#include "library/index/probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/solve/choose_map.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// As the columns have them.
Cues in_single_precision(Cues cues) {
  for (auto& value : cues.values)
    if (value) value = static_cast<float>(*value);
  return cues;
}

std::optional<float> value_in(const FeltColumns& columns, std::size_t row, const std::string& quantity) {
  const auto number = columns.number_of(quantity);
  if (!number) return std::nullopt;
  const auto numbers = columns.quantities(row);
  const auto at = std::ranges::lower_bound(numbers, *number);
  if (at == numbers.end() || *at != *number) return std::nullopt;
  return columns.values(row)[static_cast<std::size_t>(at - numbers.begin())];
}

}  // namespace

void ValueLimit::narrow(const SizeRange& range, bool absent_may) {
  low = std::max(low, range.low), high = std::min(high, range.high);
  may_be_absent = may_be_absent && absent_may;
}

NearProbe::NearProbe(const Comparer& comparer, const Cues& target)
    : comparer_(comparer), target_(in_single_precision(target)) {}

std::optional<DistanceInterval> NearProbe::distance(const FeltColumns& columns, std::size_t row, Cues& scratch) const {
  columns.cues(row, scratch);
  return comparer_.interval(target_, scratch);
}

void NearProbe::narrow(const FeltColumns& columns, double most, std::vector<ValueLimit>& limits) const {
  for (const CueFacts& facts : cue_table()) {
    const auto number = columns.number_of(cue_quantity(facts.kind));
    const SizeRange range = comparer_.within(facts.kind, target_, most);
    if (number) limits[*number].narrow(range, !facts.exerts || range.holds(0));
  }
}

Probe::Told NearProbe::tell(const FeltColumns& columns, std::size_t row) const {
  Cues cues{.material = {}, .device = target_.device, .values = {}};
  columns.cues(row, cues);
  const Comparison comparison = comparer_.compare(target_, cues);
  Told told;
  for (const CueDifference& each : comparison.cues)
    if (!each.noticeable) told.unknown.emplace_back(cue_table()[static_cast<std::size_t>(each.kind)].name);
  if (const CueDifference* plainest = comparison.plainest(); plainest && *plainest->noticeable > 0)
    told.low = *plainest->noticeable, told.plainest = cue_table()[static_cast<std::size_t>(plainest->kind)].name;
  told.high = told.unknown.empty() ? told.low : unbounded;
  return told;
}

BetweenProbe::BetweenProbe(const Comparer& comparer, const Cues& one, const Cues& other)
    : one_(comparer, one),
      other_(comparer, other),
      apart_(comparer.interval(in_single_precision(one), in_single_precision(other)).low) {}

std::optional<DistanceInterval> BetweenProbe::distance(const FeltColumns& columns, std::size_t row,
                                                       Cues& scratch) const {
  const auto from_one = one_.distance(columns, row, scratch), from_other = other_.distance(columns, row, scratch);
  if (!(from_one->low < apart_) || !(from_other->low < apart_)) return std::nullopt;
  return from_one->rank() < from_other->rank() ? from_other : from_one;
}

void BetweenProbe::narrow(const FeltColumns& columns, double most, std::vector<ValueLimit>& limits) const {
  one_.narrow(columns, std::min(most, apart_), limits);
  other_.narrow(columns, std::min(most, apart_), limits);
}

Probe::Told BetweenProbe::tell(const FeltColumns& columns, std::size_t row) const {
  Told one = one_.tell(columns, row), other = other_.tell(columns, row);
  const double high = std::max(one.high, other.high);
  const auto rank = [](const Told& each) { return each.low + static_cast<double>(each.unknown.size()); };
  Told told = rank(one) < rank(other) ? std::move(other) : std::move(one);
  told.high = high;
  return told;
}

std::optional<DistanceInterval> BothProbe::distance(const FeltColumns& columns, std::size_t row, Cues& scratch) const {
  const auto one = one_->distance(columns, row, scratch);
  const auto other = one ? other_->distance(columns, row, scratch) : std::nullopt;
  if (!other) return std::nullopt;
  return DistanceInterval{std::max(one->low, other->low), one->unknown + other->unknown};
}

void BothProbe::narrow(const FeltColumns& columns, double most, std::vector<ValueLimit>& limits) const {
  one_->narrow(columns, most, limits);
  other_->narrow(columns, most, limits);
}

Probe::Told BothProbe::tell(const FeltColumns& columns, std::size_t row) const {
  Told one = one_->tell(columns, row), other = other_->tell(columns, row);
  if (one.low < other.low) std::swap(one, other);
  one.high = std::max(one.high, other.high);
  one.unknown.insert(one.unknown.end(), other.unknown.begin(), other.unknown.end());
  return one;
}

Result<std::unique_ptr<LevelProbe>> LevelProbe::make(const std::vector<SoughtLevel>& levels,
                                                     const Declarations& declarations, const std::string& device) {
  auto probe = std::make_unique<LevelProbe>();
  const DeviceDeclaration* const built_for = declarations.devices.find(device);
  for (const SoughtLevel& sought : levels) {
    const Percept* meant = nullptr;
    bool reversed = false;
    std::vector<std::string> names;
    declarations.percepts.each([&](const std::string& name, const Percept& percept) {
      names.push_back(name);
      if (!percept.antonym.empty()) names.push_back(percept.antonym);
      if (name == sought.percept || (!percept.antonym.empty() && percept.antonym == sought.percept))
        meant = &percept, reversed = name != sought.percept;
    });
    if (!meant) {
      const auto near = nearest_spelling(sought.percept, names);
      return Error{.code = Code::unknown_name,
                   .sentence = fmt::format("no percept is called `{}`", sought.percept),
                   .mend = near ? fmt::format("did you mean `{}`?", *near) : "",
                   .place = {.name = "--" + sought.percept}};
    }
    const Map* const map =
        built_for && meant->has_reference ? choose_map(*meant, *built_for, declarations).map : nullptr;
    const auto law = map ? std::optional<Law>(std::in_place, *map, *meant) : std::nullopt;
    const auto size_of = [&](double level) {
      return level <= 0 ? 0.0 : law && law->reaches(level) ? law->carrier_of(level) : std::nan("");
    };
    Part part{.percept = meant->name,
              .low = reversed ? 1 - sought.high : sought.low,
              .high = reversed ? 1 - sought.low : sought.high,
              .size = 0,
              .none = 0,
              .full = size_of(1),
              .absent_is_unknown = meant->absent_is_unknown,
              .asked_as = sought.percept,
              .people = Discrimination(declarations, meant->cue, device, meant->exerts)};
    part.size = size_of(part.low);
    if (!part.is_range() && !std::isfinite(part.size))
      return Error{.code = Code::unknown_name,
                   .sentence = fmt::format("`{}` has no map that gives the level {} on `{}`", sought.percept,
                                           sought.low, device),
                   .mend = fmt::format("give a range, as in `--{} {}..{}`", sought.percept,
                                       std::max(0.0, sought.low - 0.1), std::min(1.0, sought.low + 0.1)),
                   .place = {.name = "--" + sought.percept}};
    probe->parts_.push_back(std::move(part));
  }
  return probe;
}

template <typename Visit>
void LevelProbe::each_part(const FeltColumns& columns, std::size_t row, const Visit& visit) const {
  for (const Part& part : parts_) {
    const auto level = value_in(columns, row, level_quantity(part.percept));
    const auto size = value_in(columns, row, size_quantity(part.percept));
    visit(part, level, size);
  }
}

std::optional<DistanceInterval> LevelProbe::distance(const FeltColumns& columns, std::size_t row, Cues&) const {
  DistanceInterval found;
  bool sought = true;
  each_part(columns, row, [&](const Part& part, std::optional<float> level, std::optional<float> size) {
    const double reads = level.value_or(part.absent_is_unknown ? std::nan("") : 0);
    if (part.is_range()) {
      sought = sought && reads >= part.low && reads <= part.high;  // false for an unknown level
      return;
    }
    const auto apart = std::isnan(reads) ? std::nullopt : part.people.distance(part.size, size.value_or(0));
    if (!apart) ++found.unknown;
    found.low = std::max(found.low, apart.value_or(0));
  });
  return sought ? std::optional(found) : std::nullopt;
}

void LevelProbe::narrow(const FeltColumns& columns, double most, std::vector<ValueLimit>& limits) const {
  for (const Part& part : parts_) {
    const auto level = columns.number_of(level_quantity(part.percept));
    const auto size = columns.number_of(size_quantity(part.percept));
    if (part.is_range()) {
      if (level) limits[*level].narrow({part.low, part.high}, part.low <= 0 && !part.absent_is_unknown);
    } else if (size) {
      // A material without the size may have an unknown level.
      limits[*size].narrow(part.people.within(part.size, most), true);
    }
  }
}

Probe::Told LevelProbe::tell(const FeltColumns& columns, std::size_t row) const {
  Told told;
  each_part(columns, row, [&](const Part& part, std::optional<float> level, std::optional<float> size) {
    if (part.is_range()) return;
    const bool is_unknown = level ? std::isnan(*level) : part.absent_is_unknown;
    const auto apart = is_unknown ? std::nullopt : part.people.distance(part.size, size.value_or(0));
    if (apart) {
      if (*apart > told.low) told.low = *apart, told.plainest = part.percept;
      told.high = std::max(told.high, *apart);
      return;
    }
    // Its level lies somewhere between none and all of it.
    told.unknown.push_back(part.asked_as);
    for (const double end : {part.none, part.full})
      told.high = std::max(told.high, part.people.distance(part.size, end).value_or(unbounded));
  });
  told.high = std::max(told.high, told.low);
  return told;
}

}  // namespace wale
