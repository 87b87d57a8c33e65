// Arrays and waves as materials.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "library/thesis_files/in_wale.hpp"
#include "schema/visible_text.hpp"
#include "wale/thesis_files.hpp"

namespace wale {
namespace {

constexpr unsigned least_side = 4;                 // cells: a spline needs them
constexpr std::size_t most_relief_cells = 1 << 24;        // what a relief may have
constexpr unsigned longest_wave_side = 4000;       // with its margins it is not resized
constexpr unsigned margin = 12;                    // cells around a wave from its other side: a spline forgets by a factor 3.7 a cell
constexpr double softest = 0.1, hardest = 2;       // ends of the amplitude's range, of the given amplitude

Error wrong_size(const ThesisSurfaceOptions& options, std::string sentence, std::string mend) {
  return {.code = Code::image_size, .sentence = std::move(sentence), .mend = std::move(mend), .place = {.name = options.file}};
}

Result<> positive(const char* what, double value, std::string mend) {
  if (std::isfinite(value) && value > 0) return {};
  return Error{.code = Code::malformed_value,
               .sentence = fmt::format("expected a figure above 0 for the {}, found {:g}", what, value),
               .mend = std::move(mend),
               .place = {.name = what}};
}

Result<> usable(const ThesisArray& array, const ThesisSurfaceOptions& options) {
  if (const auto written = write_thesis_array(array); !written) return written.error();
  return positive("amplitude", options.amplitude, "say how hard it pushes: the thesis prints no factor from heights to force");
}

/// A picture in binary PGM.
std::string picture(unsigned width, unsigned height, const auto& cell) {
  std::string bytes = fmt::format("P5\n{} {}\n255\n", width, height);
  bytes.reserve(bytes.size() + std::size_t{width} * height);
  for (unsigned row = 0; row < height; ++row)
    for (unsigned column = 0; column < width; ++column) bytes += static_cast<char>(cell(column, row));
  return bytes;
}

bool is_flat(const ThesisArray& array) {
  return std::ranges::all_of(array.cells, [&](std::uint8_t each) { return each == array.cells.front(); });
}

bool rows_are_alike(const ThesisArray& array) {
  for (std::size_t i = array.width; i < array.cells.size(); ++i)
    if (array.cells[i] != array.cells[i - array.width]) return false;
  return true;
}

std::string flat_note(double amplitude) {
  return fmt::format("all of its cells are alike, so it pushes nothing, and the amplitude of {:.6g} N is left out", amplitude);
}

std::string amplitude_line(double amplitude) {
  return fmt::format("    param amplitude = {:.6g} N in {:.6g} N .. {:.6g} N \"largest lateral force\"\n", amplitude, softest * amplitude, hardest * amplitude);
}

}  // namespace

Result<ThesisInWale> surface_in_wale(const ThesisArray& surface, const ThesisSurfaceOptions& options, const ThesisArray* shading) {
  if (const auto checked = usable(surface, options); !checked) return checked.error();
  if (const auto checked = positive("cell", options.cell, "a pixel of the thesis's screen is 0.37 mm"); !checked) return checked.error();
  if (surface.width < least_side || surface.height < least_side || surface.cells.size() > most_relief_cells)
    return wrong_size(options, fmt::format("expected 4 by 4 to 2^24 cells for a relief, found {} by {}", surface.width, surface.height),
                      "a wave may be narrower; a larger array can be cut");
  if (shading && (shading->width != surface.width || shading->height != surface.height))
    return wrong_size(options, fmt::format("expected a shading of {} by {} cells as its surface, found {} by {}", surface.width,
                                           surface.height, shading->width, shading->height),
                      "name the visual representation of this surface, or none");
  ThesisInWale made{.name = options.name, .text = {}};
  const auto relief = [&](const std::string& file) {
    return fmt::format("relief(\"{}\", scale: {:.6g} mm/px, height: 1 mm)", file, 1000 * options.cell);
  };
  made.files.push_back({options.name + ".pgm", picture(surface.width, surface.height, [&](unsigned x, unsigned y) {
                          return surface.cells[std::size_t{y} * surface.width + x];
                        })});
  const bool flat = is_flat(surface);
  std::string text = fmt::format(
      "/// The array `{}` of the thesis's Sandpaper, {} by {} cells of {:.6g} mm. Its height in mm only shows: the amplitude is what\n"
      "/// pushes, downhill.\nmaterial {} {{\n  physical {{\n    patch {:.6g} mm, {:.6g} mm\n",
      visible_text(options.file), surface.width, surface.height, 1000 * options.cell, options.name, 1000 * options.cell * surface.width,
      1000 * options.cell * surface.height);
  if (!flat) text += amplitude_line(options.amplitude);
  text += "    let cells = " + relief(options.name + ".pgm") + "\n";
  if (shading) text += "    let shades = " + relief(options.name + "_shade.pgm") + "\n";
  text += "    height surface = cells(hand)\n";
  text += flat ? "    force = vector(0 N, 0 N)\n" : "    force = lateral(surface, amplitude: amplitude)\n";
  text += "    show relief(surface)\n";
  if (shading) {
    text += "    show colour(shades(hand) / 1 mm, shades(hand) / 1 mm, shades(hand) / 1 mm)\n";
    made.files.push_back({options.name + "_shade.pgm", picture(shading->width, shading->height, [&](unsigned x, unsigned y) {
                            return 255 - shading->cells[std::size_t{y} * shading->width + x];  // there 0 is white
                          })});
  }
  if (flat) made.note = flat_note(options.amplitude);
  made.text = standard_declarations(text + "  }\n}\n");
  return made;
}

Result<ThesisInWale> wave_in_wale(const ThesisArray& wave, const ThesisSurfaceOptions& options) {
  if (const auto checked = usable(wave, options); !checked) return checked.error();
  if (const auto checked = positive("period", options.period, "say how long a wave is: its file does not"); !checked) return checked.error();
  if (wave.width > longest_wave_side || wave.height > longest_wave_side)
    return wrong_size(options, fmt::format("expected at most {0} by {0} cells for a wave, found {1} by {2}", longest_wave_side, wave.width, wave.height),
                      "take it as an array");
  const bool flat = is_flat(wave), alike = rows_are_alike(wave);
  ThesisInWale made{.name = options.name, .text = {}};
  // Rows and columns beyond the edges are those of the other side, so that the spline goes on smoothly.
  const auto wrapped = [](unsigned at, unsigned count) { return (at + (margin / count + 1) * count - margin) % count; };
  made.files.push_back({options.name + ".pgm", picture(wave.width + 2 * margin, wave.height + 2 * margin, [&](unsigned x, unsigned y) {
                          return wave.cells[std::size_t{wrapped(y, wave.height)} * wave.width + wrapped(x, wave.width)];
                        })});
  const double period = 1000 * options.period;
  std::string text = fmt::format("/// The wave `{}` of the thesis's Sandpaper, {} by {} cells: its width is one period. Its height in mm only shows: the\n"
                                 "/// amplitude is what pushes, downhill.\nmaterial {} {{\n  physical {{\n",
                                 visible_text(options.file), wave.width, wave.height, options.name);
  text += fmt::format("    param period = {:.6g} mm in {:.6g} mm .. {:.6g} mm \"from wave to wave\"\n", period, period / 4, 4 * period);
  if (!flat) text += amplitude_line(options.amplitude);
  text += fmt::format("    let cells = relief(\"{0}.pgm\", scale: 1 mm/px, height: 1 mm)\n    let across = x * ({1} mm / period)\n", options.name, wave.width);
  if (!alike) text += fmt::format("    let upwards = y * ({} mm / period)\n", wave.width);
  const std::string row = alike ? "0 mm" : fmt::format("upwards - {0} mm * round(upwards / {0} mm)", wave.height);
  text += fmt::format("    height surface = cells(vector(across - {0} mm * round(across / {0} mm), {1}))\n", wave.width, row);
  text += flat ? "    force = vector(0 N, 0 N)\n" : "    force = lateral(surface, amplitude: amplitude)\n";
  if (flat) made.note = flat_note(options.amplitude);
  made.text = standard_declarations(text + "    show relief(surface)\n  }\n}\n");
  return made;
}

}  // namespace wale
