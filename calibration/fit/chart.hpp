#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

#include "calibration/fit/study_fit.hpp"
#include "compiler/drawing/canvas.hpp"

namespace wale {

/// Points or a line of a chart.
struct ChartSeries {
  std::vector<glm::dvec2> points;
  bool line = false;
  Colour colour;
  std::string name;  ///< for the key; may be empty
  std::vector<std::string> labels;  ///< beside the points; may be empty
};

/// A chart of a fit. On a logarithmic axis, points at or below zero are left out.
struct Chart {
  std::string file;  ///< "law", without an ending
  std::string title, x_name, y_name;
  bool log_x = false, log_y = false;
  std::vector<ChartSeries> series;
  std::vector<std::string> x_words;  ///< at 0, 1, 2, … instead of numbers; may be empty
};

/// Draws it on a page of 900 by 600 pixels. Errors: those of `new_canvas`.
Result<std::unique_ptr<Canvas>> draw_chart(const Chart& chart);

/// The charts of a study: raw answers, means with the law, residuals, the observers' exponents; psychometric functions;
/// ratings; the tree of sorts, their map and their groups; settings; words.
std::vector<Chart> charts_of(const StudyFit& fit, FitModel model);

}  // namespace wale
