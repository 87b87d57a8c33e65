#pragma once

#include <string>
#include <vector>

#include "compiler/drawing/axis.hpp"
#include "compiler/drawing/canvas.hpp"

namespace wale {

/// A quantity along a line: `at` in m or m/s, ascending.
struct Profile {
  std::vector<double> at, values;
};

/// A curve of a plot, in SI units, and its name if there are several.
struct Curve {
  Profile profile;
  Colour colour;
  std::string name;
};

/// Curves over one axis, with their labels.
struct Plot {
  std::string title;   ///< "Force along x on a hand at rest"
  std::string x_name;  ///< "x"; written with its unit below the right end; empty for no labels below
  Notation x_notation, y_notation;
  std::vector<Curve> curves;  ///< all over the same range of x
  bool balanced = false;      ///< zero is in the middle of the y axis
  bool shaded = false;        ///< the area below the first curve is tinted
  double bound = 0;           ///< SI; a dashed line at plus and minus this value, 0 for none
};

/// Draws a plot. `box` is the frame of the curves: labels are to its left and below it, the title above.
void draw_plot(Canvas& canvas, const PageBox& box, const Plot& plot);

}  // namespace wale
