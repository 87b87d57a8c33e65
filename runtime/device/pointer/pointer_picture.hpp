#pragma once

#include <glm/vec2.hpp>
#include <string>

namespace wale::pointer {

/// Maps the workspace to a terminal: in the middle, as large as fits above the last line, which is for messages.
class WorkspaceView {
 public:
  /// `cell_height`: height of a cell over its width.
  WorkspaceView(double workspace_diameter, int columns, int rows, double cell_height);

  int columns() const { return columns_; }
  int rows() const { return rows_; }  ///< of the picture, without the last line
  /// The position in m from the workspace's centre, x to the right, y up, of a position in cells from the upper left
  /// corner.
  glm::dvec2 place(glm::dvec2 cells) const;
  glm::dvec2 cells(glm::dvec2 place) const;

 private:
  int columns_, rows_;
  double cell_height_, cells_per_metre_;
};

struct PointerScene {
  double workspace_diameter = 0;  ///< m
  glm::dvec2 patch{0};            ///< m, width and height of the patch in the middle
  glm::dvec2 hand{0};             ///< m
  glm::dvec2 force{0};            ///< N
  double full_newton = 1;         ///< N, whose arrow is a third of the workspace
};

/// The scene as text for a terminal: every cell of the rows above the last line. The cursor ends at the beginning of
/// the last line.
std::string draw(const PointerScene& scene, const WorkspaceView& view);

}  // namespace wale::pointer
