#include "compiler/compare/propose_levels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compiler/solve/choose_map.hpp"
#include "compiler/solve/level_scale.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

/// More levels than people can tell apart on any device.
constexpr std::size_t most_levels = 1000;

/// Sizes from `from` to `to`, the first at `from`, each `apart` just noticeable differences above the one before: as
/// many as fit, and at most `most`.
std::vector<double> stairs(const LevelScale& scale, double from, double to, double apart, std::size_t most) {
  std::vector<double> sizes{from};
  while (sizes.size() < most) {
    const auto next = scale.step(sizes.back(), to, apart);
    if (!next) break;
    sizes.push_back(*next);
  }
  return sizes;
}

/// `count` sizes from `from` to `to` at the largest equal distance with which they fit.
std::vector<double> even_stairs(const LevelScale& scale, double from, double to, double apart, std::size_t count) {
  double fits = apart, too_far = scale.people().distance(from, to).value_or(apart) + 1;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (fits + too_far);
    (stairs(scale, from, to, middle, count).size() == count ? fits : too_far) = middle;
  }
  std::vector<double> sizes = stairs(scale, from, to, fits, count);
  sizes.back() = to;
  return sizes;
}

/// The levels rounded to `digits` after the point; the first is rounded up and the last down, so that both can be
/// rendered.
std::vector<double> rounded(const std::vector<double>& levels, int digits) {
  const double scale = std::pow(10, digits);
  constexpr double slack = 1e-9;  // keeps an end that already has no more digits
  std::vector<double> all;
  for (const double level : levels) all.push_back(std::round(level * scale) / scale);
  all.front() = std::ceil(levels.front() * scale - slack) / scale;
  all.back() = std::floor(levels.back() * scale + slack) / scale;
  return all;
}

/// The least and the greatest distance between neighbours, in just noticeable differences.
std::pair<double, double> spacing(const LevelScale& scale, const std::vector<double>& levels) {
  double least = HUGE_VAL, greatest = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const double apart =
        levels[i] > levels[i - 1]
            ? scale.people().distance(scale.size_of(levels[i - 1]), scale.size_of(levels[i])).value_or(0)
            : 0;
    least = std::min(least, apart), greatest = std::max(greatest, apart);
  }
  return {least, greatest};
}

std::string candidates(const std::string& wrong, const std::vector<std::string>& names) {
  const auto near = nearest_spelling(wrong, names);
  return near ? fmt::format("did you mean `{}`?", *near) : fmt::format("there are: {}", fmt::join(names, ", "));
}

/// Why no map sets the levels of a percept.
Error no_map(const Percept& percept, const MapChoice& choice, const std::string& device) {
  if (!percept.has_reference)
    return {Code::untied_map,
            fmt::format("expected a percept that has levels, found {}, which can only be compared", percept.name)};
  if (!choice.rivals.empty())
    return {Code::several_maps, fmt::format("{} maps of {} fit `{}`, and the device does not choose one",
                                            choice.rivals.size(), percept.name, device)};
  if (!choice.untied.empty())
    return {Code::untied_map,
            fmt::format("expected a map that can set a level of {}, found only maps that compare", percept.name)};
  return {Code::no_map, fmt::format("no map ties {} to a force on `{}`", percept.name, device)};
}

Error too_many(std::size_t steps, std::size_t most, double apart, const std::string& name) {
  const std::string far =
      apart == 1 ? "one just noticeable difference" : fmt::format("{} just noticeable differences", apart);
  if (most < 2)
    return {Code::value_out_of_range, fmt::format("no two levels of {} are {} apart on this device", name, far)};
  return {Code::value_out_of_range, fmt::format("{} levels of {} would be less than {} apart", steps, name, far),
          fmt::format("ask for {} levels at most", most)};
}

}  // namespace

std::size_t LevelProposal::recognised() const {
  if (!recognition) return most;
  return std::min(most, static_cast<std::size_t>(std::max(2.0, std::round(recognition->recognised))));
}

Result<LevelProposal> propose_recognised_levels(const std::string& percept, const std::string& device, double apart,
                                                const Declarations& declarations) {
  auto all = propose_levels(percept, device, std::nullopt, apart, declarations);
  if (!all || all->recognised() >= all->levels.size()) return all;
  return propose_levels(percept, device, all->recognised(), apart, declarations);
}

Result<LevelProposal> propose_levels(const std::string& name, const std::string& device,
                                     std::optional<std::size_t> steps, double apart, const Declarations& declarations) {
  const PerceptName meant = declarations.percept_named(name);
  if (!meant.percept)
    return Error{Code::unknown_name, fmt::format("no percept is called `{}`", name),
                 candidates(name, declarations.percept_spellings())};
  const DeviceDeclaration* on = declarations.devices.find(device);
  if (!on)
    return Error{Code::unknown_device, fmt::format("no device is called `{}`", device),
                 candidates(device, declarations.devices.spellings())};
  if (!(apart > 0)) return Error{Code::malformed_value, "the distance of levels must be above 0", {}, {"--jnd"}};
  if (steps && *steps < 2) return Error{Code::malformed_value, "expected at least two levels", {}, {"--steps"}};
  if (on->profile.shaker && !on->realise.contains(meant.percept->name))
    return Error{Code::percept_unrealised,
                 fmt::format("`{}` only vibrates, and has no rule that makes {}", device, meant.percept->name)};
  const Percept percept = carried_on(*on, *meant.percept, declarations);
  const MapChoice choice = percept.has_reference ? choose_map(percept, *on, declarations) : MapChoice{};
  if (!choice.map) return no_map(percept, choice, device);
  const LevelScale scale(percept, *choice.map, declarations, *on);
  if (!scale.people().known())
    return Error{
        Code::no_threshold,
        fmt::format("unknown: no published threshold says how small a difference of {} is noticed as `{}` renders it",
                    percept.name, device)};

  // Levels near the threshold, outside the measured range or beyond the device are not proposed.
  const double measured[] = {scale.level_of(choice.map->valid_low), scale.level_of(choice.map->valid_high)};
  const double most_level = std::isfinite(scale.most_size()) ? scale.level_of(scale.most_size()) : 1;
  const double low = std::max(std::min(measured[0], measured[1]), percept.near_threshold);
  const double high = std::min({std::max(measured[0], measured[1]), most_level, 1.0});
  const double from = scale.size_of(low), to = scale.size_of(high);
  if (!(low < high) || !std::isfinite(from) || !std::isfinite(to))
    return Error{
        Code::percept_unrealised,
        fmt::format("`{}` renders no {} within the range that {} ({})", device, percept.name,
                    choice.map->valid_assumed ? "is assumed for its map" : "was measured", choice.map->source)};

  LevelProposal proposal;
  proposal.most = stairs(scale, from, to, 1, most_levels).size();
  proposal.apart = apart, proposal.fit = stairs(scale, from, to, apart, most_levels).size();
  const std::size_t count = steps.value_or(proposal.fit);
  if (count > proposal.fit || count < 2) return too_many(count, proposal.fit, apart, name);
  std::vector<double> levels;
  for (const double size : even_stairs(scale, from, to, apart, count)) levels.push_back(scale.level_of(size));
  std::vector<double> written;
  constexpr int most_digits = 6;
  constexpr double uneven = 0.05;
  for (proposal.digits = 2; proposal.digits <= most_digits; ++proposal.digits) {
    written = rounded(levels, proposal.digits);
    const auto [least, greatest] = spacing(scale, written);
    if (least >= apart && greatest - least <= uneven * greatest) break;
  }
  proposal.digits = std::min(proposal.digits, most_digits);

  const Map& map = *choice.map;
  proposal.asked = name, proposal.percept = percept.name, proposal.reversed = meant.reversed;
  proposal.device = device, proposal.carrier = percept.argument();
  proposal.unit = declarations.names().unit(percept.carrier_dimension);
  proposal.map = &map;
  proposal.recognition = recognition(declarations, percept.cue, device);
  if (const Threshold* found = proposal.recognition)
    proposal.recognition_evidence = std::max(
        {found->evidence, found->handle, found->device == device ? Evidence::measured : Evidence::transferred});
  proposal.map_evidence = std::max({map.slope, map.anchor, map.device == device ? map.handle : Evidence::transferred});
  for (const double level : written) {
    ProposedLevel each{.level = level, .size = scale.size_of(level)};
    if (!proposal.levels.empty()) {
      const double before = proposal.levels.back().size;
      each.apart = scale.people().distance(before, each.size).value_or(0);
      each.threshold = scale.people().threshold(before, each.size);
      if (each.threshold) {
        each.evidence = scale.people().evidence(*each.threshold);
        each.outside = each.threshold->unmet(before, each.size, {}, {});
        each.floor = scale.people().floor_between(before, each.size);
        if (each.floor) each.least = scale.people().floor(*each.threshold);
      }
    }
    proposal.levels.push_back(each);
  }
  return proposal;
}

}  // namespace wale
