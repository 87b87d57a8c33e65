#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/image/image.hpp"

namespace wale {

/// Where a pixel of a picture belongs: the index of a colour that was looked for, or `nobody`.
using AreaId = std::uint8_t;
inline constexpr AreaId nobody = 255;
/// The most colours that are looked for in a picture.
inline constexpr std::size_t most_colours = 64;

/// A pixel, column and row from the top left.
struct PixelPlace {
  std::uint32_t x = 0, y = 0;
};

/// The part of a picture that has none of the colours.
struct UnmatchedColours {
  std::size_t pixels = 0;
  std::uint32_t mostly = 0;  ///< 0xRRGGBB: the commonest among them, as the mean of those that are much like it
  PixelPlace place;          ///< the first pixel of that colour
};

/// The pixels of a picture by their colours.
struct ColourAreas {
  std::uint32_t width = 0, height = 0;
  std::vector<AreaId> areas;        ///< row by row from the top
  std::vector<std::size_t> pixels;  ///< of each colour
  UnmatchedColours unmatched;       ///< transparent pixels are nobody's, and do not count
};

/// The distance of two colours (0xRRGGBB; alpha is ignored) as a share of that of black and white: straight through
/// red, green and blue as files store them.
double colour_distance(std::uint32_t a, std::uint32_t b);

/// Finds the areas of up to `most_colours` colours, 0xRRGGBB. A pixel belongs to the nearest colour if that is no
/// further than `tolerance`. An edge is drawn with mixtures of the colours on its sides, and a compressed picture has
/// traces of them around it: a pixel on an edge that is such a mixture, or nearly has one of the two colours, belongs
/// to the nearer side, also where it happens to look like a third colour. A pixel that is more than half transparent is
/// nobody's.
ColourAreas colour_areas(const ColourImage& picture, const std::vector<std::uint32_t>& colours, double tolerance);

/// A part of an area that is narrower than it should be.
struct Sliver {
  AreaId area = nobody;
  PixelPlace place;         ///< in its widest place if it is an island, else in the middle of its first narrow part
  double width_pixels = 0;  ///< there
};

/// The first sliver, row by row from the top, among the areas with an index below `count`: an island that is nowhere
/// `narrowest` pixels wide, or a tongue that is narrower over more than twice its width. Acute corners, of 24 degrees
/// or more, and necks are none.
std::optional<Sliver> find_sliver(const ColourAreas& areas, std::size_t count, double narrowest);

}  // namespace wale
