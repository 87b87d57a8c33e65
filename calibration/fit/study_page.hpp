#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calibration/fit/study_fit.hpp"

namespace wale {

/// A picture of a page, as a PNG or SVG file.
struct PagePicture {
  std::string title, type;  ///< "image/png"
  std::vector<std::byte> bytes;
};

/// A material of the library whose size for its level the new map changes.
struct MovedMaterial {
  std::string name;
  double level = 0;              ///< that it asks for
  double before = 0, after = 0;  ///< sizes of the carrier, SI
  std::string unit;
  double noticeable = 0;  ///< just noticeable differences between the two; 0: not known
  double now_reads = 0;   ///< the level of the size before, by the new map
};

/// What a page shows besides the fit.
struct StudyPageParts {
  std::vector<PagePicture> stimuli, charts;
  std::string stimuli_note;          ///< why there are none, or fewer than stimuli
  std::vector<MovedMaterial> moved;  ///< by more than one just noticeable difference
  std::string moved_note;            ///< how many materials were looked at, or why none
};

/// One HTML page that needs no other file and loads none: design, stimuli, raw data, fits, residuals, exclusions, the
/// record and what it changes. All that comes from files is escaped. The same parts give the same bytes.
std::string study_page(const Study& study, const StudyFit& fit, const FitRequest& request, const std::string& record,
                       const StudyPageParts& parts);

}  // namespace wale
