#include "document/arranging.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sandpaper {
namespace {

constexpr double beside = 0.005;  // m, how far a copy lies from its original

/// How far a patch has to go to lie within a disc around the centre, with all of its corners if it is not too large.
glm::dvec2 way_within(glm::dvec2 at, glm::dvec2 half, double radius) {
  // Towards the centre along the straight way, in steps of bisection: the corners' distances fall on it.
  const auto outside = [&](glm::dvec2 place) {
    return std::hypot(std::abs(place.x) + half.x, std::abs(place.y) + half.y) > radius;
  };
  if (!outside(at)) return {0, 0};
  if (outside({0, 0})) return -at;
  double low = 0, high = 1;  // share of the way that remains
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (outside(at * middle) ? high : low) = middle;
  }
  return at * low - at;
}

}  // namespace

void align(Document& document, Alignment alignment, const SizeOf& size_of) {
  const bool is_x = alignment == Alignment::left || alignment == Alignment::right || alignment == Alignment::centre_x;
  const int axis = is_x ? 0 : 1;
  const double side = alignment == Alignment::left || alignment == Alignment::bottom  ? -0.5
                      : alignment == Alignment::right || alignment == Alignment::top ? 0.5
                                                                                      : 0;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const PlacedRef& each : document.contents().placed)
    if (document.chosen().contains(each->id) && each->is_laid_out()) {
      const double line = each->patch.at[axis] + side * size_of(*each)[axis];
      least = std::min(least, line), most = std::max(most, line);
    }
  if (least > most) return;
  const double line = side < 0 ? least : side > 0 ? most : (least + most) / 2;
  document.change_placed(Document::tr("Align"), document.chosen(), [&](Placed& placed) {
    if (!placed.locked) placed.patch.at[axis] = line - side * size_of(placed)[axis];
  });
}

int fit(Document& document, double diameter, const SizeOf& size_of) {
  std::set<std::uint64_t> ids;
  for (const PlacedRef& each : document.contents().placed)
    if (each->is_changeable() && !each->locked && (document.chosen().empty() || document.chosen().contains(each->id)) &&
        way_within(each->patch.at, 0.5 * size_of(*each), diameter / 2) != glm::dvec2(0))
      ids.insert(each->id);
  document.change_placed(Document::tr("Fit into reach"), ids, [&](Placed& placed) {
    placed.patch.at += way_within(placed.patch.at, 0.5 * size_of(placed), diameter / 2);
  });
  return static_cast<int>(ids.size());
}

void duplicate(Document& document) {
  std::vector<wale::LaidOutPatch> copies;
  for (const PlacedRef& each : document.contents().placed)
    if (document.chosen().contains(each->id) && each->is_changeable()) {
      wale::LaidOutPatch copy = each->patch;
      copy.before.clear(), copy.inside.clear();  // comments are about the original
      copy.at += glm::dvec2(beside, -beside);
      copies.push_back(std::move(copy));
    }
  if (copies.empty()) return;
  const auto ids = document.add(Document::tr("Duplicate"), std::move(copies));
  document.choose({ids.begin(), ids.end()});
}

}  // namespace sandpaper
