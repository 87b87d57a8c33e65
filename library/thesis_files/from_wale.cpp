// The surface and the colours of a material as arrays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wale/picture.hpp"
#include "wale/thesis_files.hpp"

namespace wale {
namespace {

constexpr std::size_t most_cells = 1 << 24;

/// The middles of the cells, m from the patch's centre, row by row from the top.
Result<std::vector<glm::vec2>> places_of(const ThesisSampling& sampling) {
  if (sampling.width == 0 || sampling.height == 0 || !std::isfinite(sampling.cell) || !(sampling.cell > 0))
    return Error{.code = Code::malformed_value, .sentence = "expected a cell or more, with a size above 0", .place = {.name = "cells"}};
  const std::size_t cells = std::size_t{sampling.width} * sampling.height;
  if (cells > most_cells)
    return Error{.code = Code::image_size,
                 .sentence = fmt::format("expected at most 2^24 cells, found {} by {}", sampling.width, sampling.height),
                 .mend = "take fewer cells, or larger ones",
                 .place = {.name = "cells"}};
  std::vector<glm::vec2> places;
  places.reserve(cells);
  for (int row = 0; row < sampling.height; ++row)
    for (int column = 0; column < sampling.width; ++column)
      places.push_back(glm::vec2((column - (sampling.width - 1) / 2.0) * sampling.cell, ((sampling.height - 1) / 2.0 - row) * sampling.cell));
  return places;
}

Error nothing_to_sample(const Bank& bank, std::string sentence, std::string mend) {
  return {.code = Code::flat_height,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = bank.program().description().material}};
}

std::uint8_t byte_of(double share) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))); }

}  // namespace

Result<ThesisArray> surface_of(const Bank& bank, const ThesisSampling& sampling) {
  const auto places = places_of(sampling);
  if (!places) return places.error();
  std::vector<float> heights(places->size());
  surface_all(bank, nullptr, *places, heights);
  const auto beyond = [&](std::string sentence, std::string mend) {
    return Error{.code = Code::value_out_of_range, .sentence = std::move(sentence), .mend = std::move(mend), .place = {.name = "heights"}};
  };
  for (const float each : heights)
    if (!std::isfinite(each)) return beyond("the surface is not a number somewhere", "sample fewer cells around its middle");
  const auto [least, most] = std::ranges::minmax(heights);
  const auto [low, high] = sampling.heights.value_or(std::pair<double, double>(least, most));
  if (!sampling.heights && !(least < most))
    return nothing_to_sample(bank, "the material shows a flat surface, so there is nothing to sample",
                             "say `show relief(height)` in its physical block, or which heights are 0 and 255");
  // Half a step beyond is still the last one.
  const double slack = (high - low) / 510;
  if (sampling.heights && (!(low < high) || least < low - slack || most > high + slack))
    return beyond(fmt::format("expected heights from {:g} to {:g}, found {:g} to {:g}", low, high, least, most),
                  "let the surface's own least and greatest height be 0 and 255, or give a wider range");
  ThesisArray array{sampling.width, sampling.height, {}};
  for (const float each : heights) array.cells.push_back(byte_of((each - low) / (high - low)));
  return array;
}

Result<ThesisArray> shading_of(const Bank& bank, const ThesisSampling& sampling) {
  const auto places = places_of(sampling);
  if (!places) return places.error();
  if (!bank.program().description().picture.colour)
    return nothing_to_sample(bank, "the material shows no colour, so there is nothing to sample",
                             "say `show colour(red, green, blue)` in its physical block");
  std::vector<float> heights(places->size());
  std::vector<glm::vec3> colours(places->size());
  surface_all(bank, nullptr, *places, heights, colours);
  ThesisArray array{sampling.width, sampling.height, {}};
  for (const glm::vec3& each : colours)  // Rec. 709, as a relief weighs a picture's colours
    array.cells.push_back(static_cast<std::uint8_t>(255 - byte_of(0.2126 * each.r + 0.7152 * each.g + 0.0722 * each.b)));
  return array;
}

}  // namespace wale
