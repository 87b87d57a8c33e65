#pragma once

#include <QByteArray>
#include <QString>
#include <functional>
#include <optional>
#include <glm/vec2.hpp>
#include <vector>
#include <wale/program.hpp>

#include "document/placed.hpp"

class QPrinter;

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

/// Prints it on A4 pages, as `pdf_of` has them. From any thread. False if `progress` ended it, and then nothing is
/// printed, or if the printer does not take it.
bool print_pages(QPrinter& printer, const WorkspacePage& page, const std::function<bool(double)>& progress);

/// As a PDF of A4 pages: the workspace from above with a scale bar, at true size where that fits and else scaled, and
/// the table of its patches. From any thread. `progress` gets 0 .. 1, and ends the work by false; then nothing is
/// returned.
std::optional<QByteArray> pdf_of(const WorkspacePage& page, const std::function<bool(double)>& progress);

}  // namespace sandpaper
