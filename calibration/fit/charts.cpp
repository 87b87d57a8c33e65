#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "calibration/fit/chart.hpp"
#include "compiler/drawing/style.hpp"

namespace wale {
namespace {

using namespace analysis;

constexpr Colour colours[] = {style::force, style::moving,       style::height,
                              style::quiet, {0.25f, 0.5f, 0.3f}, {0.5f, 0.2f, 0.45f}};
Colour colour_of(std::size_t number) { return colours[number % std::size(colours)]; }

/// More points than this hide each other.
constexpr std::size_t most_points = 4000;

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " (" + unit + ")";
}

std::vector<Chart> of_magnitudes(const StudyFit& fit, FitModel model) {
  const MagnitudeAnalysis& analysis = *fit.magnitudes;
  const Trials& trials = fit.trials;
  const SizeValues& size = *trials.size_named(analysis.size);
  const auto at = static_cast<std::size_t>(&size - trials.sizes.data());
  const ChosenLaw law = chosen_law(analysis, model);
  const auto predicted = [&](double of) { return law.constant.value + law.exponent.value * std::log10(of); };
  const std::string x = with_unit(analysis.size, analysis.unit);
  std::vector<Chart> charts;

  Chart raw{.file = "answers", .title = "All answers", .x_name = x, .y_name = "answer", .log_x = true, .log_y = true};
  const std::size_t step = 1 + trials.size() / most_points;
  raw.series.resize(trials.observers.size());
  for (std::size_t i = 0; i < trials.size(); i += step)
    raw.series[trials.observer[i]].points.push_back({size.values[i], trials.answer[i]});
  for (std::size_t i = 0; i < raw.series.size(); ++i)
    raw.series[i].colour = colour_of(i), raw.series[i].name = trials.observers[i];
  charts.push_back(std::move(raw));

  Chart means{.file = "law",
              .title = fmt::format("Means of the stimuli, and the law: exponent {:.3g}", law.exponent.value),
              .x_name = x,
              .y_name = "magnitude",
              .log_x = true,
              .log_y = true};
  Chart residuals{.file = "residuals",
                  .title = "Means of the stimuli about the law",
                  .x_name = x,
                  .y_name = "log10 of magnitude over the law's",
                  .log_x = true};
  ChartSeries points{.colour = style::force, .name = "means"},
      line{.line = true, .colour = style::moving, .name = "law"}, rest = points;
  for (const StimulusMean& each : analysis.thesis.means) {
    points.points.push_back({each.sizes[at], std::pow(10, each.mean)});
    rest.points.push_back({each.sizes[at], each.mean - predicted(each.sizes[at])});
  }
  for (const double each : {analysis.low, analysis.high}) line.points.push_back({each, std::pow(10, predicted(each))});
  means.series = {std::move(points), std::move(line)};
  rest.name.clear();
  residuals.series = {std::move(rest),
                      {.points = {{analysis.low, 0}, {analysis.high, 0}}, .line = true, .colour = style::moving}};
  charts.push_back(std::move(means)), charts.push_back(std::move(residuals));

  Chart observers{.file = "observers",
                  .title = "Exponents of single observers",
                  .x_name = "observers in the order of their exponents",
                  .y_name = "exponent"};
  std::vector<double> exponents;
  for (const ObserverLaw& each : analysis.observers)
    if (std::isfinite(each.exponent)) exponents.push_back(each.exponent);
  std::ranges::sort(exponents);
  ChartSeries own{.colour = style::force};
  for (std::size_t i = 0; i < exponents.size(); ++i) own.points.push_back({static_cast<double>(i + 1), exponents[i]});
  const auto n = static_cast<double>(exponents.size());
  observers.series = {std::move(own),
                      {.points = {{1, law.exponent.value}, {n, law.exponent.value}},
                       .line = true,
                       .colour = style::moving,
                       .name = "all"}};
  charts.push_back(std::move(observers));
  return charts;
}

std::vector<Chart> of_thresholds(const StudyFit& fit) {
  std::vector<Chart> charts;
  const std::string x =
      fit.is_fraction ? fit.over + ", difference over the standard" : with_unit(fit.over, fit.over_unit);
  for (const ThresholdFit& each : fit.thresholds) {
    Chart chart{
        .file = fmt::format("threshold-{}", charts.size() + 1),
        .title = (each.standard.empty() ? "" : each.standard + ": ") + fmt::format("threshold {:.3g}", each.all.value),
        .x_name = x,
        .log_x = true};
    ChartSeries points{.colour = style::force, .name = "answers"},
        line{.line = true, .colour = style::moving, .name = "fit"};
    if (fit.task == "two_interval") {
      chart.y_name = "share of right answers";
      for (const Level& level : each.levels)
        points.points.push_back({level.size, static_cast<double>(level.right) / static_cast<double>(level.trials)});
      const double low = std::log(each.levels.front().size), high = std::log(each.levels.back().size);
      for (int i = 0; i <= 100; ++i) {
        const double at = std::exp(low + (high - low) * i / 100);
        line.points.push_back({at, each.law.at(at)});
      }
    } else {
      chart.y_name = "d'";
      for (const auto& [difference, d] : each.sensitivities) {
        points.points.push_back({difference, d.d_prime});
        line.points.push_back({difference, each.law.d_prime(difference)});
      }
    }
    chart.series = {std::move(points), std::move(line)};
    charts.push_back(std::move(chart));
  }
  return charts;
}

std::vector<Chart> of_confidence(const ConfidenceAnalysis& analysis) {
  Chart chart{.file = "ratings",
              .title = "Ratings of the stimuli: means, and one standard deviation",
              .x_name = "stimuli in the order of their means",
              .y_name = "rating"};
  ChartSeries means{.colour = style::force};
  for (std::size_t i = 0; i < analysis.stimuli.size(); ++i) {
    const RatedStimulus& each = analysis.stimuli[i];
    const auto at = static_cast<double>(i + 1);
    means.points.push_back({at, each.mean});
    if (std::isfinite(each.deviation))
      chart.series.push_back({.points = {{at, each.mean - each.deviation}, {at, each.mean + each.deviation}},
                              .line = true,
                              .colour = style::rule});
  }
  chart.series.push_back(std::move(means));
  Chart histogram{.file = "histogram",
                  .title = "How often each tenth of the scale was used",
                  .x_name = "rating",
                  .y_name = "ratings"};
  ChartSeries steps{.line = true, .colour = style::force};
  for (std::size_t i = 0; i < analysis.histogram.size(); ++i)
    for (const std::size_t end : {i, i + 1})
      steps.points.push_back({10.0 * static_cast<double>(end), static_cast<double>(analysis.histogram[i])});
  histogram.series = {std::move(steps)};
  return {std::move(chart), std::move(histogram)};
}

/// The corners of the convex region of some points as they are drawn, closed; of two points their line.
std::vector<glm::dvec2> hull_of(std::vector<glm::dvec2> points, bool log_x, bool log_y) {
  const auto drawn = [&](glm::dvec2 at) { return glm::dvec2(log_x ? std::log(at.x) : at.x, log_y ? std::log(at.y) : at.y); };
  std::ranges::sort(points, [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  if (points.size() < 3) return points;
  std::vector<glm::dvec2> hull;
  for (const bool back : {false, true}) {
    const std::size_t first = hull.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec2 at = points[back ? points.size() - 1 - i : i];
      while (hull.size() > first + 1) {
        const glm::dvec2 a = drawn(hull[hull.size() - 2]), b = drawn(hull.back()), c = drawn(at);
        if ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0) break;
        hull.pop_back();
      }
      hull.push_back(at);
    }
    if (!back) hull.pop_back();
  }
  return hull;
}

std::vector<Chart> of_sorting(const StudyFit& fit) {
  const SortingFit& sorting = *fit.sorting;
  Chart tree{.file = "tree",
             .title = "Single linkage of the sorts",
             .x_name = "stimuli",
             .y_name = "sorts in which they were apart"};
  const std::vector<std::size_t> order = leaves_in_order(sorting.single);
  std::vector<glm::dvec2> tops(sorting.stimuli.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    tops[order[i]] = {static_cast<double>(i), 0};
    tree.x_words.push_back(sorting.stimuli[order[i]]);
  }
  for (const Merge& each : sorting.single) {
    const glm::dvec2 a = tops[each.first], b = tops[each.second];
    tree.series.push_back(
        {.points = {a, {a.x, each.distance}, {b.x, each.distance}, b}, .line = true, .colour = style::force});
    tops.push_back({(a.x + b.x) / 2, each.distance});
  }
  std::vector<Chart> charts = {std::move(tree)};
  const auto grouped = [&](Chart chart, const std::vector<glm::dvec2>& places, const Grouping& clusters, std::size_t groups) {
    for (std::size_t group = 0; group < groups; ++group) {
      ChartSeries series{.colour = colour_of(group), .name = fmt::format("group {}", group + 1)};
      for (std::size_t i = 0; i < places.size(); ++i)
        if (clusters[i] == group) series.points.push_back(places[i]), series.labels.push_back(sorting.stimuli[i]);
      ChartSeries hull{.points = hull_of(series.points, chart.log_x, chart.log_y), .line = true, .colour = colour_of(group)};
      if (hull.points.size() > 1) chart.series.push_back(std::move(hull));
      chart.series.push_back(std::move(series));
    }
    charts.push_back(std::move(chart));
  };
  std::vector<glm::dvec2> mapped;
  if (sorting.map) {
    for (Eigen::Index i = 0; i < sorting.map->points.rows(); ++i)
      mapped.push_back({sorting.map->points(i, 0), sorting.map->points(i, 1)});
    grouped({.file = "map",
             .title = fmt::format("Seldom apart, near each other: stress {:.2g}", sorting.map->stress),
             .x_name = "first dimension",
             .y_name = "second dimension"},
            mapped, sorting.clusters, sorting.groups);
  }
  // The groups of the sorts into two, three and four, over the sizes of the stimuli where two are known, else on the map.
  const Trials& trials = fit.trials;
  std::vector<glm::dvec2> placed = mapped;
  Chart plane{.x_name = "first dimension", .y_name = "second dimension"};
  if (trials.sizes.size() >= 2) {
    placed.clear();
    for (const std::size_t trial : sorting.trials)
      placed.push_back({trials.sizes[1].values[trial], trials.sizes[0].values[trial]});
    plane.x_name = with_unit(trials.sizes[1].name, trials.sizes[1].unit);
    plane.y_name = with_unit(trials.sizes[0].name, trials.sizes[0].unit);
    plane.log_x = std::ranges::all_of(placed, [](const auto& each) { return each.x > 0; });
    plane.log_y = std::ranges::all_of(placed, [](const auto& each) { return each.y > 0; });
  }
  if (!placed.empty())
    for (const GroupsFit& each : sorting.by_groups) {
      Chart chart = plane;
      chart.file = fmt::format("groups-{}", each.groups);
      chart.title = fmt::format("{} groups of {} sorts; {} of them are the same", each.groups, each.sorts,
                                std::ranges::count(each.distances, 0u));
      grouped(std::move(chart), placed, each.clusters, each.groups);
    }
  return charts;
}

std::vector<Chart> of_settings(const StudyFit& fit) {
  Chart chart{.file = "settings",
              .title = "Settings, and their geometric means with 95 %",
              .x_name = "standards",
              .y_name = with_unit(fit.over, fit.over_unit),
              .log_y = true};
  ChartSeries single{.colour = style::force, .name = "settings"}, equal{.colour = style::moving, .name = "all observers"};
  for (std::size_t i = 0; i < fit.settings.size(); ++i) {
    const SettingsFit& each = fit.settings[i];
    const auto at = static_cast<double>(i);
    chart.x_words.push_back(each.standard.empty() ? "standard" : each.standard);
    for (const ObserverSettings& own : each.settings.observers)
      for (const double setting : own.settings) single.points.push_back({at, setting});
    equal.points.push_back({at, each.settings.equal});
    const Interval& interval = each.settings.equal_interval;
    if (interval.low > 0 && std::isfinite(interval.high))
      chart.series.push_back({.points = {{at, interval.low}, {at, interval.high}}, .line = true, .colour = style::moving});
  }
  chart.series.push_back(std::move(single)), chart.series.push_back(std::move(equal));
  return {std::move(chart)};
}

std::vector<Chart> of_descriptions(const DescriptionFit& described) {
  Chart chart{.file = "words",
              .title = described.is_coded ? "In how many descriptions each code is" : "In how many descriptions each word is",
              .y_name = "descriptions"};
  ChartSeries points{.colour = style::force};
  const auto words = by_frequency(described.is_coded ? described.all.codes : described.all.words);
  for (std::size_t i = 0; i < std::min<std::size_t>(12, words.size()); ++i) {
    const auto at = static_cast<double>(i), count = static_cast<double>(words[i].second);
    chart.x_words.push_back(words[i].first);
    chart.series.push_back({.points = {{at, 0}, {at, count}}, .line = true, .colour = style::rule});
    points.points.push_back({at, count});
  }
  chart.series.push_back(std::move(points));
  return {std::move(chart)};
}

}  // namespace

std::vector<Chart> charts_of(const StudyFit& fit, FitModel model) {
  if (fit.magnitudes) return of_magnitudes(fit, model);
  if (!fit.thresholds.empty()) return of_thresholds(fit);
  if (fit.confidence) return of_confidence(*fit.confidence);
  if (fit.sorting) return of_sorting(fit);
  if (!fit.settings.empty()) return of_settings(fit);
  if (fit.descriptions) return of_descriptions(*fit.descriptions);
  return {};
}

}  // namespace wale
