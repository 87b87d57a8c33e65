#pragma once

#include <QByteArray>
#include <QString>
#include <functional>
#include <optional>
#include <glm/vec2.hpp>
#include <vector>
#include <wale/program.hpp>

#include "document/placed.hpp"

class QPagedPaintDevice;

namespace sandpaper {

/// A patch with what is drawn of it.
struct PagePatch {
  PlacedRef placed;
  glm::dvec2 size{0};                    ///< m
  std::optional<wale::Program> program;  ///< nothing while it has an error
  std::vector<float> parameters;         ///< SI
};

/// A workspace to be printed: how far its device reaches, and its patches, the last in front.
struct WorkspacePage {
  std::string name;
  double diameter = 0;  ///< m
  std::vector<PagePatch> patches;
};

/// Draws it on A4 pages of a device that was set up for them, in a resolution of 300 dots per inch without margins. False if
/// `progress` ended it.
bool draw_pages(QPagedPaintDevice& device, const WorkspacePage& page, const std::function<bool(double)>& progress);

/// As a PDF of A4 pages: the workspace from above with a scale bar, at true size where that fits and else scaled, and the
/// table of its patches. From any thread. `progress` gets 0 .. 1, and ends the work by false; then nothing is returned.
std::optional<QByteArray> pdf_of(const WorkspacePage& page, const std::function<bool(double)>& progress);

}  // namespace sandpaper
