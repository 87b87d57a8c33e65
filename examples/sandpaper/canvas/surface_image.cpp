#include "canvas/surface_image.hpp"

#include <algorithm>
#include <cmath>
#include <vector>
#include <wale/picture.hpp>
#include <wale/program.hpp>

namespace sandpaper {
namespace {

constexpr glm::vec2 light{-0.7f, 0.7f};  // from where the surface is lit

std::vector<glm::vec2> places_of(glm::vec2 size, QSize pixels) {
  std::vector<glm::vec2> places;
  places.reserve(static_cast<std::size_t>(pixels.width()) * pixels.height());
  for (int row = 0; row < pixels.height(); ++row)
    for (int column = 0; column < pixels.width(); ++column)
      places.emplace_back(((column + 0.5f) / pixels.width() - 0.5f) * size.x,
                          (0.5f - (row + 0.5f) / pixels.height()) * size.y);
  return places;
}

float finite(float x) { return std::isfinite(x) ? x : 0; }

/// The forces of a program on a hand at rest, as a relief that a hand would feel: their potential is not known, so the
/// component along the light is shown.
std::vector<float> forces_along(const wale::Bank& bank, const std::vector<glm::vec2>& places,
                                std::vector<glm::vec2>& forces) {
  std::vector<wale::Hand> hands(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) hands[i].position = hands[i].workspace = places[i];
  forces.resize(places.size());
  wale::tick_all(bank, hands, forces);
  std::vector<float> along(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) along[i] = finite(-(forces[i].x * light.x + forces[i].y * light.y));
  return along;
}

/// The size below which all but a hundredth of the values lie, at least a tiny one.
float usual_size(std::vector<float> values) {
  for (float& each : values) each = std::abs(each);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(0.99 * (values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return std::max(*place, 1e-12f);
}

/// How the heights rise towards the light, from pixel to pixel. What rises towards it faces away from it and is dark.
std::vector<float> slopes(const std::vector<float>& heights, QSize pixels) {
  const int width = pixels.width(), height = pixels.height();
  const auto at = [&](int column, int row) {
    return heights[static_cast<std::size_t>(std::clamp(row, 0, height - 1)) * width + std::clamp(column, 0, width - 1)];
  };
  std::vector<float> slope(heights.size());
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      slope[static_cast<std::size_t>(row) * width + column] =
          light.x * (at(column + 1, row) - at(column - 1, row)) + light.y * (at(column, row - 1) - at(column, row + 1));
  return slope;
}

QRgb rgb(glm::vec3 colour, float brightness) {
  const auto part = [&](float x) {
    return static_cast<int>(std::lround(255 * std::clamp(finite(x) * brightness, 0.f, 1.f)));
  };
  return qRgb(part(colour.x), part(colour.y), part(colour.z));
}

}  // namespace

bool surface_remembers(const wale::PatchProgram& program) {
  const unsigned first = program.first_state(), end = first + static_cast<unsigned>(program.states.size());
  const auto is_state = [&](unsigned number) { return number >= first && number < end; };
  const auto& picture = program.picture;
  const auto& shown = picture.colour;
  return is_state(picture.relief) || (shown && std::ranges::any_of(*shown, is_state)) ||
         std::ranges::any_of(picture.code, [&](const wale::Instruction& each) {
           return each.operation == static_cast<std::uint8_t>(wale::Operation::recall) || is_state(each.a) ||
                  is_state(each.b) || is_state(each.c);
         });
}

QColor colour_of(const std::string& made_of) {
  unsigned hash = 2166136261u;
  for (const unsigned char each : made_of.substr(0, made_of.find('('))) hash = (hash ^ each) * 16777619u;
  return QColor::fromHsv(static_cast<int>(hash % 360), 60, 215);
}

QImage surface_image(const wale::Bank& bank, const wale::Memory* memory, glm::vec2 size, const wale::Shape& shape,
                     QSize pixels, Look look, QColor plain) {
  QImage image(pixels.expandedTo({1, 1}), QImage::Format_RGB32);
  const std::vector<glm::vec2> places = places_of(size, image.size());
  std::vector<float> heights(places.size());
  std::vector<glm::vec3> colours;
  const wale::Picture& picture = bank.program().description().picture;
  if (picture.colour) colours.resize(places.size());
  wale::surface_all(bank, memory, places, shape, heights, colours);
  for (float& each : heights) each = finite(each);
  const auto [low, high] = std::ranges::minmax_element(heights);
  const float lowest = *low, range = *high - *low;
  std::vector<glm::vec2> forces;
  std::vector<float> rise;
  if (look == Look::force_field) forces_along(bank, places, forces);
  else if (look == Look::relief) rise = range > 0 ? slopes(heights, image.size()) : forces_along(bank, places, forces);
  const float strongest = rise.empty() ? 1 : usual_size(rise);
  float hardest = 1e-12f;
  for (const glm::vec2 each : forces) hardest = std::max(hardest, finite(std::hypot(each.x, each.y)));
  const glm::vec3 own(plain.redF(), plain.greenF(), plain.blueF());
  for (std::size_t i = 0; i < places.size(); ++i) {
    QRgb& pixel = reinterpret_cast<QRgb*>(image.scanLine(static_cast<int>(i) / image.width()))[i % image.width()];
    switch (look) {
      case Look::relief:
        pixel = rgb(colours.empty() ? own : colours[i], 0.85f - 0.3f * std::clamp(rise[i] / strongest, -1.f, 1.f));
        break;
      case Look::blind: pixel = qRgb(200, 200, 200); break;
      case Look::depth: pixel = rgb(glm::vec3(1), range > 0 ? (heights[i] - lowest) / range : 0.5f); break;
      case Look::force_field: {
        const float push = finite(std::hypot(forces[i].x, forces[i].y)) / hardest;
        const double angle = std::atan2(finite(forces[i].y), finite(forces[i].x)) / (2 * 3.14159265358979);
        pixel = QColor::fromHsvF(static_cast<float>(angle < 0 ? angle + 1 : angle) * 0.999f, 0.7f, push).rgb();
      }
    }
  }
  return image;
}

glm::dvec2 inner_place(const wale::Shape& outline, glm::dvec2 size) {
  constexpr int places = 16;
  const wale::Shape shape = outline.stretched(glm::vec2(size));
  glm::dvec2 best{0};
  float farthest = -1;
  for (int i = 0; i < places * places; ++i) {
    const glm::dvec2 at = size * glm::dvec2((i % places + 0.5) / places - 0.5, (i / places + 0.5) / places - 0.5);
    const float distance = shape.edge(glm::vec2(at)).metres;
    if (distance > farthest) farthest = distance, best = at;
  }
  return best;
}

}  // namespace sandpaper
