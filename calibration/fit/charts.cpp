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

std::vector<Chart> of_sorting(const SortingFit& sorting) {
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
  return {std::move(tree)};
}

}  // namespace

std::vector<Chart> charts_of(const StudyFit& fit, FitModel model) {
  if (fit.magnitudes) return of_magnitudes(fit, model);
  if (!fit.thresholds.empty()) return of_thresholds(fit);
  if (fit.confidence) return of_confidence(*fit.confidence);
  if (fit.sorting) return of_sorting(*fit.sorting);
  return {};
}

}  // namespace wale
