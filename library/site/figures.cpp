#include "library/site/figures.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "compiler/describe/describe_figure.hpp"
#include "compiler/drawing/drawing.hpp"
#include "compiler/measure/coarseness.hpp"
#include "compiler/preview/preview.hpp"
#include "compiler/text/json_text.hpp"
#include "wale/picture.hpp"

namespace wale {
namespace {

constexpr int slope_side = 200;       // pixels of the table of slopes, which scripts light
constexpr int force_side = 96;        // places of the table of forces
constexpr int speed_count = 65;       // speeds of the table of the force against velocity
constexpr float steepest = 3;         // of the slopes as they are drawn
constexpr double least_force = 1e-4;  // N

std::string as_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string base64(std::string_view bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    unsigned group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0u);
    for (std::size_t i = 0; i < 4; ++i) text += i <= count ? digits[group >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

/// A picture that a script can read also on a page from disk, where it may not look into picture files.
Result<std::string> data_picture(const Drawing& drawing) {
  const auto bytes = encode_drawing(drawing, "table.png");
  if (!bytes) return bytes.error();
  return "data:image/png;base64," + base64(as_text(*bytes));
}

/// An SVG file whose paths have two decimals: a hundredth of a pixel. It is half as large.
std::string in_hundredths(const std::string& svg) {
  std::string text;
  text.reserve(svg.size());
  for (std::size_t at = 0; at < svg.size();) {
    const std::size_t path = std::min(svg.find(" d=\"", at), svg.size());
    const std::size_t end = path == svg.size() ? path : std::min(svg.find('"', path + 4), svg.size());
    text.append(svg, at, std::min(path + 4, svg.size()) - at);
    for (at = std::min(path + 4, svg.size()); at < end;) {
      const char each = svg[at++];
      text += each;
      if (each != '.') continue;
      for (int digits = 0; at < end && svg[at] >= '0' && svg[at] <= '9'; ++at)
        if (digits++ < 2) text += svg[at];
    }
  }
  return text;
}

/// -1 .. 1 as a byte: 128 is 0.
std::uint8_t signed_byte(double part) {
  return static_cast<std::uint8_t>(128 + std::lround(127 * std::clamp(part, -1.0, 1.0)));
}

/// Half as wide and high, each pixel the mean of four.
Drawing halved(const Drawing& drawing) {
  Drawing half{drawing.width / 2, drawing.height / 2, {}};
  const auto at = [&](int x, int y, int part) {
    return int{drawing.rgb[static_cast<std::size_t>((y * drawing.width + x) * 3 + part)]};
  };
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      for (int part = 0; part < 3; ++part)
        half.rgb.push_back(static_cast<std::uint8_t>((at(2 * x, 2 * y, part) + at(2 * x + 1, 2 * y, part) +
                                                      at(2 * x, 2 * y + 1, part) + at(2 * x + 1, 2 * y + 1, part) + 2) /
                                                     4));
  return half;
}

/// The surface as a script lights it.
struct Slopes {
  Drawing drawing;  ///< red: slope to the right, green: upwards, both over `steepest`; blue: height
  Drawing colours;  ///< of the material itself; empty if it has none
  double lowest = 0, highest = 0;
};

Slopes slopes_of(const Bank& bank, const PreviewParts& parts) {
  constexpr int side = slope_side + 2;
  const bool coloured = bank.program().description().picture.colour.has_value();
  std::vector<glm::vec2> places;
  for (int row = -1; row <= slope_side; ++row)
    for (int column = -1; column <= slope_side; ++column)
      places.push_back(pixel_position(parts.exhibit, column, row, slope_side));
  std::vector<float> heights(places.size());
  std::vector<glm::vec3> colours(coloured ? places.size() : 0);
  if (coloured)
    surface_all(bank, &parts.rehearsal.memory, places, parts.exhibit.shape, heights, colours);
  else
    surface_coarsely(bank, &parts.rehearsal.memory, places, heights);
  for (float& height : heights)
    if (!std::isfinite(height)) height = 0;
  const auto [low, high] = std::ranges::minmax_element(heights);
  Slopes slopes;
  slopes.lowest = *low, slopes.highest = *high;
  const float range = std::max(*high - *low, 1e-30f);
  const auto at = [&](int column, int row) {
    return (heights[static_cast<std::size_t>((row + 1) * side + column + 1)] - static_cast<float>(slopes.lowest)) /
           range;
  };
  std::vector<glm::vec2> all;
  for (int row = 0; row < slope_side; ++row)
    for (int column = 0; column < slope_side; ++column)
      all.emplace_back((at(column + 1, row) - at(column - 1, row)) / 2,
                       (at(column, row - 1) - at(column, row + 1)) / 2);
  // As steep as in the preview (compiler/preview/relief.cpp): by how strongly the texture is felt.
  std::vector<float> steepness;
  for (const glm::vec2 slope : all) steepness.push_back(std::hypot(slope.x, slope.y));
  const auto steep = steepness.begin() + static_cast<std::ptrdiff_t>(steepness.size() * 98 / 100);
  std::nth_element(steepness.begin(), steep, steepness.end());
  const float strength = static_cast<float>(std::clamp(std::sqrt(parts.exhibit.felt.value_or(1)), 0.15, 1.2));
  const float exaggeration = 1.2f * strength / std::max(*steep, 1e-9f);
  slopes.drawing = {slope_side, slope_side, {}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int row = static_cast<int>(i) / slope_side, column = static_cast<int>(i) % slope_side;
    slopes.drawing.rgb.push_back(signed_byte(all[i].x * exaggeration / steepest));
    slopes.drawing.rgb.push_back(signed_byte(all[i].y * exaggeration / steepest));
    slopes.drawing.rgb.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(at(column, row), 0.0f, 1.0f))));
  }
  if (!coloured) return slopes;
  slopes.colours = {slope_side, slope_side, {}};
  for (int row = 0; row < slope_side; ++row)
    for (int column = 0; column < slope_side; ++column) {
      const glm::vec3 colour = colours[static_cast<std::size_t>((row + 1) * side + column + 1)];
      for (int part = 0; part < 3; ++part)
        slopes.colours.rgb.push_back(
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(colour[part], 0.0f, 1.0f))));
    }
  return slopes;
}

/// The force on a hand at rest over the picture's square: red x, green y, over the largest.
nlohmann::ordered_json force_table(const Bank& bank, const Exhibit& exhibit, Drawing& drawing) {
  std::vector<Hand> hands;
  for (int row = 0; row < force_side; ++row)
    for (int column = 0; column < force_side; ++column) {
      Hand hand;
      hand.position = pixel_position(exhibit, column, row, force_side);
      hands.push_back(hand);
    }
  std::vector<Force> forces(hands.size());
  tick_coarsely(bank, hands, forces);
  double largest = 0;
  for (Force& force : forces) {
    if (!std::isfinite(force.x) || !std::isfinite(force.y)) force = {0, 0};
    largest = std::max({largest, std::abs(double{force.x}), std::abs(double{force.y})});
  }
  drawing = {force_side, force_side, {}};
  const double scale = largest > least_force ? largest : 1;
  for (const Force force : forces) {
    drawing.rgb.push_back(signed_byte(force.x / scale));
    drawing.rgb.push_back(signed_byte(force.y / scale));
    drawing.rgb.push_back(128);
  }
  return {{"newton", largest > least_force ? figure(largest) : 0.0}};
}

/// The force along the section on a hand that moves along it, at the picture's middle.
nlohmann::ordered_json speed_table(const Bank& bank, const Exhibit& exhibit) {
  const Profile profile = force_against_speed(bank, exhibit, speed_count);
  // What pushes at rest is in the table of places.
  const double at_rest = profile.values[speed_count / 2];
  auto newtons = nlohmann::ordered_json::array();
  for (const double value : profile.values) newtons.push_back(std::isfinite(value) ? figure(value - at_rest) : 0.0);
  return {{"fastest", figure(exhibit.speed)}, {"newton", std::move(newtons)}};
}

}  // namespace

Result<SiteFigures> draw_site_figures(const Bank& bank, const Description& description,
                                      const Declarations& declarations, const std::string& name) {
  std::optional<double> felt;
  for (const DescribedPercept& percept : description.percepts) {
    const Percept* declared = declarations.percepts.find(percept.name);
    if (declared && declared->extractor == Extractor::lateral_force && !percept.unknown)
      felt = std::max(felt.value_or(0), percept.level);
  }
  auto parts = draw_preview_parts(bank, felt, declarations);
  if (!parts) return parts.error();
  const Exhibit& exhibit = parts->exhibit;
  SiteFigures figures;
  figures.surface = parts->surface;
  figures.of_velocity = !parts->surface && !exhibit.pushes_at_rest && exhibit.resists_motion;
  figures.side = figures.of_velocity ? exhibit.speed : exhibit.side;
  figures.whole = exhibit.side >= exhibit.patch_side;
  figures.period = exhibit.period;

  const Drawing pixels = parts->picture->pixels();
  for (const auto& [path, drawing] : {std::pair(&figures.picture, pixels), std::pair(&figures.small, halved(pixels))}) {
    // A field of few colours is smaller without loss, a rough surface with it.
    std::vector<std::byte> smallest;
    for (const char* ending : {"jpg", "png"}) {
      const std::string name_so = "figure/" + name + (path == &figures.small ? "-small." : ".") + ending;
      auto bytes = encode_drawing(drawing, name_so);
      if (!bytes) return bytes.error();
      if (smallest.empty() || bytes->size() < smallest.size()) smallest = *std::move(bytes), *path = name_so;
    }
    figures.files.push_back({*path, as_text(smallest)});
  }
  for (const PlotPage& plot : parts->plots) {
    const std::string path = "figure/" + name + "-" + plot.name + ".svg";
    figures.files.push_back({path, in_hundredths(as_text(plot.page->svg()))});
    figures.plots.push_back({plot.title, path});
  }
  const Slopes slopes = slopes_of(bank, *parts);
  if (bank.program().description().picture.relief_is_length && exhibit.has_relief)
    figures.height = slopes.highest - slopes.lowest;
  if (bank.program().description().vibrates()) return figures;

  Drawing forces;
  nlohmann::ordered_json touch = {{"side", figure(exhibit.side)},
                                  {"steepest", steepest},
                                  {"way", {direction_figure(exhibit.way.x), direction_figure(exhibit.way.y)}}};
  touch["force"] = force_table(bank, exhibit, forces);
  touch["speed"] = exhibit.resists_motion ? speed_table(bank, exhibit) : nlohmann::ordered_json();
  const auto force_picture = data_picture(forces);
  if (!force_picture) return force_picture.error();
  touch["force"]["table"] = *force_picture;
  if (parts->surface) {
    const auto slope_picture = data_picture(slopes.drawing);
    if (!slope_picture) return slope_picture.error();
    touch["slopes"] = *slope_picture;
    if (slopes.colours.width > 0) {
      const auto colours = data_picture(slopes.colours);
      if (!colours) return colours.error();
      touch["colours"] = *colours;
    }
  }
  figures.touch = "touch/" + name + ".js";
  figures.files.push_back({figures.touch, "wale.take(\"touch\"," + json_text(touch) + ");\n"});
  return figures;
}

}  // namespace wale
