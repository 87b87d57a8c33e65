#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/modules/declare_records.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

std::optional<Way> way_in(const SettingItem& item) {
  for (const Way way : all_ways)
    if (has_word(item, in_words(way))) return way;
  return std::nullopt;
}

/// A figure for each of the four ways, or for some of them.
using PerWay = std::array<std::optional<double>, 4>;

/// Reads the figures of a device's response that are given by ways.
class ResponseReader {
 public:
  ResponseReader(RecordReader& reader, std::vector<FigureInterval>& intervals)
      : reader_(reader), intervals_(intervals) {}

  /// `gain 0.95, 1.05` (both ways of x, then of y), `gain 0.95` (all), or `gain right 0.95, within 0.94 .. 0.96, left
  /// 0.97`, perhaps in several settings. `part` is a word that the items must have, such as `quadratic`; may be empty.
  PerWay read(const char* key, const char* dimension, std::string_view part = {}) {
    PerWay found;
    for (const Setting* setting : reader_.settings(key))
      if (!is_unknown(*setting)) read_setting(*setting, dimension, part, found);
    return found;
  }

 private:
  void read_setting(const Setting& setting, const char* dimension, std::string_view part, PerWay& found) {
    std::vector<Way> ways;  // of the last value
    std::size_t unnamed = 0;
    for (const SettingItem& item : setting.items) {
      if (has_word(item, "within")) {
        if (!ways.empty()) read_interval(setting, item, dimension, ways, part);
        continue;
      }
      ways.clear();
      if (!knows_words(setting, item, part)) continue;
      if (!part.empty() && !has_word(item, part)) continue;
      if (!item.value || item.range_end || item.equals) {
        reader_.report(Code::wrong_type, item.span, fmt::format("`{}` needs a value here", setting.key.text),
                       example_of(setting.key.text));
        continue;
      }
      if (const auto way = way_in(item)) {
        ways = {*way};
      } else if (unnamed < 2) {
        ways = unnamed == 0 ? std::vector{Way::right, Way::left} : std::vector{Way::away, Way::toward};
        ++unnamed;
      } else {
        reader_.report(Code::wrong_type, item.span, fmt::format("`{}` has more values than axes", setting.key.text),
                       example_of(setting.key.text));
        return;
      }
      const auto value = value_of(*item.value, dimension);
      for (const Way way : ways) enter(setting, way, value, found);
    }
    if (unnamed == 1)  // one value is for both axes
      for (std::size_t i = 0; i < 2; ++i) found[i + 2] = found[i + 2] ? found[i + 2] : found[i];
  }

  /// Reports a word that is neither a way nor a part of the figure, and a non-linearity without its part.
  bool knows_words(const Setting& setting, const SettingItem& item, std::string_view part) {
    bool has_part = part.empty();
    for (const auto* words : {&item.words, &item.trailing})
      for (const Word& word : *words) {
        const bool is_part = !part.empty() && (word.text == "quadratic" || word.text == "cubic");
        has_part = has_part || is_part;
        if (is_part || word.text == "assumed" ||
            std::ranges::any_of(all_ways, [&](Way way) { return word.text == in_words(way); }))
          continue;
        if (part == "cubic") return false;  // said already, with the quadratic ones
        reader_.report(Code::wrong_type, word.span,
                       fmt::format("`{}` is none of right, left, away and toward", word.text),
                       example_of(setting.key.text));
        return false;
      }
    if (!has_part && part == "quadratic")
      reader_.report(Code::wrong_type, item.span, "a non-linearity is quadratic or cubic",
                     example_of(setting.key.text));
    return has_part;
  }

  void enter(const Setting& setting, Way way, std::optional<double> value, PerWay& found) {
    auto& place = found[static_cast<std::size_t>(way)];
    if (place)
      reader_.report(Code::declared_twice, setting.span,
                     fmt::format("`{}` is set twice for {}", setting.key.text, in_words(way)), "keep one of them");
    else
      place = value;
  }

  void read_interval(const Setting& setting, const SettingItem& item, const char* dimension,
                     const std::vector<Way>& ways, std::string_view part) {
    if (const auto interval = read_within(reader_, item, dimension))
      for (const Way way : ways)
        intervals_.push_back({fmt::format("{} {}{}{}", setting.key.text, in_words(way), part.empty() ? "" : " ", part),
                              interval->first, interval->second});
  }

  std::optional<double> value_of(ExprId expr, const char* dimension) {
    return reader_.value(
        expr, std::string_view(dimension) == "number" ? Dimension{} : reader_.declarations.dimension(dimension));
  }

  static std::string example_of(std::string_view key) {
    if (key == "nonlinearity") return "write, for example, `nonlinearity right quadratic -0.05, right cubic 0.02`";
    const char* unit = key == "gain" ? "" : " N";
    return typeable("write, for example, `{} {}{}` or `{} right {}{}, within {}{} .. {}{}`", key, 0.1, unit, key, 0.1,
                    unit, 0.09, unit, 0.11, unit);
  }

  RecordReader& reader_;
  std::vector<FigureInterval>& intervals_;
};

/// Reports a figure that no device has.
void refuse_figure(RecordReader& reader, const char* key, std::string sentence, std::string mend) {
  const auto settings = reader.settings(key);
  const Span span = settings.empty() ? reader.record.name.span : settings.front()->span;
  reader.report(Code::value_out_of_range, span, std::move(sentence), std::move(mend));
}

/// The gain of each axis is the mean of both ways; each way has its share of it.
void read_gains(RecordReader& reader, ResponseReader& read, DeviceWiring& wiring) {
  const PerWay gains = read.read("gain", "number");
  for (const auto& gain : gains)
    if (gain && !(*gain >= DeviceWiring::least_gain && *gain <= DeviceWiring::most_gain))
      return refuse_figure(
          reader, "gain",
          fmt::format("a gain must be from {} to {}: the force at the handle, in newtons, for a command of 1 N",
                      DeviceWiring::least_gain, DeviceWiring::most_gain),
          "write, for example, `gain 0.95, 1.05`; if a motor pulls the wrong way, reverse it: `motors -x, y`");
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double forward = gains[2 * axis].value_or(1), backward = gains[2 * axis + 1].value_or(1);
    if (forward == backward) {
      wiring.gain[axis] = forward;
      continue;
    }
    wiring.gain[axis] = (forward + backward) / 2;
    wiring.response[2 * axis].gain = forward / wiring.gain[axis];
    wiring.response[2 * axis + 1].gain = backward / wiring.gain[axis];
  }
}

}  // namespace

std::optional<std::pair<double, double>> read_within(RecordReader& reader, const SettingItem& item,
                                                     const std::string& dimension) {
  const Dimension of = dimension == "number" ? Dimension{} : reader.declarations.dimension(dimension);
  const auto low = item.value ? reader.value(*item.value, of) : std::nullopt;
  const auto high = item.range_end ? reader.value(*item.range_end, of) : std::nullopt;
  if (low && high && *low <= *high) return std::pair(*low, *high);
  if (!item.value || !item.range_end || (low && high))
    reader.report(Code::value_out_of_range, item.span, "the 95 % interval of a figure needs a lower and an upper end",
                  "write, for example, `gain right 0.95, within 0.94 .. 0.96`");
  return std::nullopt;
}

void read_response(RecordReader& reader, const DeviceProfile& profile, DeviceWiring& wiring,
                   std::vector<FigureInterval>& intervals) {
  ResponseReader read(reader, intervals);
  read_gains(reader, read, wiring);
  const PerWay bands = read.read("dead_band", "force"), most = read.read("saturation", "force"),
               offsets = read.read("offset", "force"), quadratic = read.read("nonlinearity", "number", "quadratic"),
               cubic = read.read("nonlinearity", "number", "cubic");
  const double peak = profile.force_newton;
  if (!(peak > 0)) return;
  DeviceWiring read_so_far = wiring;
  for (const Way way : all_ways) {
    const auto i = static_cast<std::size_t>(way);
    ForceResponse& response = read_so_far.response[i];
    response.dead_band = bands[i].value_or(0);
    response.most = most[i].value_or(0);
    response.quadratic = quadratic[i].value_or(0);
    response.cubic = cubic[i].value_or(0);
    if (!(response.dead_band >= 0 && response.dead_band <= ForceResponse::most_dead_band * peak))
      return refuse_figure(reader, "dead_band",
                           readable("a dead band must be from 0 N to a quarter of the device's force, {:.6g} N",
                                    ForceResponse::most_dead_band * peak),
                           "it is the largest command that gives no force; measure it with a force gauge");
    if (most[i] &&
        !(response.most >= ForceResponse::least_most * peak && response.most <= DeviceWiring::most_gain * peak))
      return refuse_figure(
          reader, "saturation",
          readable("a saturation must be from {:.6g} N to {:.6g} N, since the device's force is {:.6g} N",
                   ForceResponse::least_most * peak, DeviceWiring::most_gain * peak, peak),
          "it is the force at the handle that no command exceeds");
    if (!(std::abs(response.quadratic) <= ForceResponse::most_bend &&
          std::abs(response.cubic) <= ForceResponse::most_bend &&
          response.least_slope_of_bends() >= ForceResponse::least_slope))
      return refuse_figure(
          reader, "nonlinearity",
          fmt::format("these bends are too strong: each is at most {} in size, and the force must everywhere grow with "
                      "the command, by {} of the gain at least",
                      ForceResponse::most_bend, ForceResponse::least_slope),
          "measure them: `wale calibrate device`");
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto& along = offsets[2 * axis];
    const auto& against = offsets[2 * axis + 1];
    if (against && against != along)
      return refuse_figure(reader, "offset",
                           "an offset is to the right and away: one to the left or toward is negative",
                           "write, for example, `offset right -0.05 N`");
    read_so_far.offset[axis] = along.value_or(0);
    if (!(std::abs(read_so_far.offset[axis]) <= AxisResponse::most_offset * peak))
      return refuse_figure(reader, "offset",
                           readable("an offset must be at most a tenth of the device's force, {:.6g} N",
                                    AxisResponse::most_offset * peak),
                           "it is the force at the handle without a command");
  }
  wiring = std::move(read_so_far);
}

}  // namespace wale
