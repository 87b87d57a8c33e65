#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/describe/describe.hpp"
#include "wale/program.hpp"
#include "wale/result.hpp"

namespace wale {

/// A file of a site, before it is written.
struct SiteFile {
  std::string path;  ///< "figure/corduroy.jpg"
  std::string bytes;
};

/// A plot on a page of the site.
struct SitePlot {
  std::string title;  ///< "Force along x"
  std::string path;
};

/// What is drawn of a material, and what its page says of the drawing.
struct SiteFigures {
  std::vector<SiteFile> files;
  std::string picture, small;  ///< paths; the second is for lists
  std::vector<SitePlot> plots;
  std::string touch;     ///< path of the script with the surface's slopes and the table of the force; empty for a pad
  bool surface = false;  ///< the pictures are the lit surface; otherwise they are the field of the force
  double side = 0;       ///< m, of the pictures; m/s each way if `of_velocity`
  bool of_velocity = false;  ///< the field is over velocities
  bool whole = false;        ///< the pictures show the whole patch
  std::optional<double>
      height;  ///< m: from the lowest to the highest place shown; nothing if heights are plain numbers
  std::optional<double> period;  ///< m: of the relief shown
};

/// Draws a program at its defaults. `name` is a `page_name`. Error: `Code::missing_library`.
Result<SiteFigures> draw_site_figures(const Bank& bank, const Description& description,
                                      const Declarations& declarations, const std::string& name);

}  // namespace wale
