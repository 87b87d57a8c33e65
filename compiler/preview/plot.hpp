#pragma once

#include <string>
#include <vector>

#include "compiler/preview/axis.hpp"
#include "compiler/preview/canvas.hpp"
#include "compiler/preview/exhibit.hpp"

namespace wale {

/// A line of a plot, in SI units, and what it is called where there are several.
struct Curve {
  Profile profile;
  Colour colour;
  std::string name;
};

/// Curves over one axis, with the words around them.
struct Plot {
  std::string title;   ///< "Force along x on a hand at rest"
  std::string x_name;  ///< "x"; written with its unit below the right end, empty for no labels below
  Notation x_notation, y_notation;
  std::vector<Curve> curves;  ///< all over the same range of x
  bool balanced = false;      ///< zero is in the middle of the y axis
  bool shaded = false;        ///< the area below the first curve is tinted
  double bound = 0;           ///< SI; a dashed line at plus and minus this, 0 for none
};

/// Draws into `box`, which is the frame of the curves: labels stand left of it and below it, the title above.
void draw_plot(Canvas& canvas, const PageBox& box, const Plot& plot);

}  // namespace wale
