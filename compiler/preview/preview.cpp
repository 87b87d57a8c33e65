#include "compiler/preview/preview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "compiler/drawing/axis.hpp"
#include "compiler/drawing/canvas.hpp"
#include "compiler/drawing/image_library.hpp"
#include "compiler/drawing/plot.hpp"
#include "compiler/drawing/style.hpp"
#include "compiler/measure/coarseness.hpp"
#include "compiler/measure/rehearsal.hpp"
#include "compiler/preview/exhibit.hpp"
#include "compiler/preview/field.hpp"
#include "compiler/preview/marks.hpp"
#include "compiler/preview/relief.hpp"
#include "compiler/preview/spectrum_panel.hpp"

namespace wale {
namespace {

constexpr int page_width = 1600, page_height = 1000;
constexpr int page_height_with_spectrum = 1330;
constexpr double margin = 64;
constexpr PageBox picture = {margin, 196, margin + 580, 776};
constexpr PageBox upper_plot = {764, 226, page_width - margin, 456};
constexpr PageBox lower_plot = {764, 534, page_width - margin, 776};
// For two plots that each have an axis below.
constexpr PageBox upper_of_two = {764, 226, page_width - margin, 438};
constexpr PageBox lower_of_two = {764, 564, page_width - margin, 776};
constexpr PageBox tall_plot = {764, 226, page_width - margin, 776};
// A small page has the picture and one plot, and nothing else.
constexpr int small_width = 760, small_height = 300;
constexpr PageBox small_picture = {16, 16, 246, 246};
constexpr PageBox small_plot = {340, 50, small_width - 24, 230};
// The parts of a preview, each on a page of its own.
constexpr int part_side = 320, part_width = 560, part_height = 280;
constexpr PageBox part_picture = {0, 0, part_side, part_side};
constexpr PageBox part_plot = {92, 46, part_width - 18, part_height - 52};
// Below the words at the foot of the page.
constexpr PageBox spectrum_plot = {margin + 70, 1050, margin + 650, 1250};
constexpr PageBox spectrogram_plot = {margin + 770, 1050, page_width - margin, 1250};
constexpr double least_force = 1e-4;  // N; weaker forces count as none
constexpr int curve_points = 1801;
constexpr double stroking_speed = 0.1;  // m/s; of the second force curve, drawn if the program resists motion

const std::string& axis_name(const Exhibit& exhibit) { return exhibit.way_name; }

std::string position_name(const Exhibit& exhibit) {
  return fmt::format("position {}{}", exhibit.way_name.ends_with("°") ? "along " : "", exhibit.way_name);
}

/// A bar of a round length at the lower left of the picture.
void draw_scale_bar(Canvas& canvas, const PageBox& picture, double across, const Notation& notation) {
  const double shown = across * notation.per_si;
  const double length = round_number(shown / 3.5);
  const double left = picture.left, right = left + length / shown * picture.width(), at = picture.bottom + 19;
  canvas.line({left + 1, at}, {right - 1, at}, {3, style::ink});
  canvas.line({left + 1, at - 6}, {left + 1, at + 6}, {2, style::ink});
  canvas.line({right - 1, at - 6}, {right - 1, at + 6}, {2, style::ink});
  canvas.write({right + 13, at + 5.5}, fmt::format("{} {}", shown_number(length), notation.unit), style::heading);
}

void write_caption(Canvas& canvas, const PageBox& picture, const std::string& text) {
  if (picture.width() < 400) return;  // beside the scale bar there is no place for it
  canvas.write({picture.right, picture.bottom + 24.5}, text, style::label, Align::right);
}

/// Marks the line on the relief along which the curves beside it were taken, and its ends outside the picture.
void mark_section(Canvas& canvas, const PageBox& picture, const Exhibit& exhibit) {
  const PagePoint middle((picture.left + picture.right) / 2, (picture.top + picture.bottom) / 2);
  const double per_metre = picture.width() / exhibit.side;
  const PagePoint way(exhibit.way.x, -exhibit.way.y);
  const glm::dvec2 from_centre = exhibit.through - exhibit.centre;
  const PagePoint through = middle + PagePoint(from_centre.x, -from_centre.y) * per_metre;
  const PagePoint half = way * (exhibit.side / 2 * per_metre);
  const SectionRange range = section_range(exhibit);
  const auto at = [&](double distance) {
    const glm::dvec2 place = on_section(exhibit, distance) - exhibit.centre;
    return middle + PagePoint(place.x, -place.y) * per_metre;
  };
  canvas.clip(picture);
  canvas.line(at(range.from), at(range.to), {1.3, style::ink, 0.55f, 6});
  canvas.unclip();
  if (std::abs(way.x * way.y) > 1e-9) return;
  const double aside = glm::dot(from_centre, exhibit.way) * per_metre;
  for (const double side : {-1.0, 1.0}) {
    const PagePoint end = through + half * side - way * aside;
    canvas.line(end + way * (3 * side), end + way * (12 * side), {2, style::ink});
  }
}

double largest_of(const std::vector<Curve>& curves) {
  double largest = 0;
  for (const Curve& curve : curves) {
    for (double value : curve.profile.values) largest = std::max(largest, std::abs(value));
  }
  return largest;
}

Plot height_plot(const Bank& bank, const Memory& memory, const Exhibit& exhibit) {
  Plot plot;
  plot.title = fmt::format("Height along {}", axis_name(exhibit));
  plot.x_notation = length_notation(exhibit.side);
  plot.curves = {{height_along(bank, &memory, exhibit, curve_points), style::height, ""}};
  const auto& values = plot.curves[0].profile.values;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (bank.program().description().picture.relief_is_length) plot.y_notation = length_notation(*most - *least);
  plot.shaded = true;
  return plot;
}

/// Adds the force across the way, as of an oblique rib, if it is a tenth of the one along it.
void add_across(Plot& plot, Profile profile) {
  Curve across = {std::move(profile), style::height, "across it"};
  const double largest = largest_of(plot.curves), largest_across = largest_of({across});
  if (!(largest_across > std::max(0.1 * largest, least_force))) return;
  if (plot.curves.front().name.empty()) plot.curves.front().name = "along it";
  plot.curves.push_back(std::move(across));
}

Plot force_plot(const Bank& bank, const Exhibit& exhibit) {
  Plot plot;
  plot.title = fmt::format("Force along {}", axis_name(exhibit));
  plot.x_name = position_name(exhibit);
  plot.x_notation = length_notation(exhibit.side);
  plot.curves = {{force_along(bank, exhibit, 0, curve_points), style::force, "on a hand at rest"}};
  if (exhibit.resists_motion) {
    plot.curves.push_back({force_along(bank, exhibit, stroking_speed, curve_points), style::moving,
                           fmt::format("moving at {} m/s", shown_number(stroking_speed))});
  }
  add_across(plot, force_along(bank, exhibit, 0, curve_points, true));
  plot.y_notation = force_notation(largest_of(plot.curves));
  plot.balanced = true;
  return plot;
}

/// "at the centre", "at 31 mm, -4 mm": where the hand is whose force is shown against velocity.
std::string moving_place_name(const Exhibit& exhibit) {
  if (exhibit.moving_at == glm::dvec2(0)) return "at the centre";
  return fmt::format("at {} mm, {} mm", shown_number(1e3 * exhibit.moving_at.x), shown_number(1e3 * exhibit.moving_at.y));
}

Plot speed_plot(const Bank& bank, const Exhibit& exhibit) {
  Plot plot;
  plot.title = fmt::format("Force along {} against velocity, {}", axis_name(exhibit),
                           moving_place_name(exhibit));
  plot.x_name = fmt::format("velocity along {}", axis_name(exhibit));
  plot.x_notation = speed_notation(exhibit.speed);
  plot.curves = {{force_against_speed(bank, exhibit, curve_points), style::moving, ""}};
  // As of a force that turns the hand aside.
  if (!bank.program().description().vibrates())
    add_across(plot, force_against_speed(bank, exhibit, curve_points, true));
  plot.y_notation = force_notation(largest_of(plot.curves));
  plot.balanced = true;
  return plot;
}

/// How strongly a pad shakes, against velocity.
Plot shaking_plot(const Bank& bank, const Exhibit& exhibit) {
  Plot plot = speed_plot(bank, exhibit);
  plot.title = fmt::format("Amplitude of the shaking against velocity along {}", axis_name(exhibit));
  plot.y_notation = {"m/s²", 1};
  plot.balanced = false;
  return plot;
}

/// The position of the hand along its way while it rubbed.
Plot stroke_plot(const Exhibit& exhibit, const Rehearsal& rehearsal) {
  const bool along_x = rehearsal.way == glm::dvec2(1, 0);
  Plot plot;
  plot.title = fmt::format("The hand along {}, rubbing to and fro", along_x ? "x" : axis_name(exhibit));
  plot.x_notation = {"s", 1};
  Profile profile{rehearsal.times, {}};
  for (glm::vec2 place : rehearsal.places) profile.values.push_back(glm::dot(glm::dvec2(place), rehearsal.way));
  plot.curves = {{std::move(profile), style::height, ""}};
  plot.y_notation = length_notation(largest_of(plot.curves));
  plot.balanced = true;
  return plot;
}

/// The force over the same time.
Plot felt_plot(const Rehearsal& rehearsal) {
  Plot plot;
  plot.title = "Force on the hand";
  plot.x_name = "time";
  plot.x_notation = {"s", 1};
  for (int axis : {0, 1}) {
    Profile profile{rehearsal.times, {}};
    for (Force force : rehearsal.forces) profile.values.push_back(std::isfinite(force[axis]) ? force[axis] : 0);
    plot.curves.push_back(
        {std::move(profile), axis == 0 ? style::force : style::moving, axis == 0 ? "along x" : "along y"});
  }
  plot.y_notation = force_notation(largest_of(plot.curves));
  plot.balanced = true;
  return plot;
}

/// The side, in pixels, of the squares in which the picture is drawn: of the surface, or of the force.
int square_of(const Bank& bank, const PageBox& picture, bool of_surface) {
  const PatchProgram& program = bank.program().description();
  const long cost = of_surface ? cost_of(program.picture.code) : cost_of(program.enter) + cost_of(program.tick);
  return pixels_of_a_sample(static_cast<double>(cost),
                            static_cast<int>(std::lround(picture.width() * Canvas::fineness)));
}

/// Whether the left half of the page is the surface; otherwise it is the field of the force.
bool shows_surface(const Bank& bank, const Exhibit& exhibit) {
  const PatchProgram& program = bank.program().description();
  return exhibit.has_relief || program.picture.colour || !program.picture.marks.empty() || remembers(program) ||
         program.vibrates();
}

/// Whether marks stand on the field of the force: there is no surface to show, and the force is the same at all times.
bool marks_on_field(const Bank& bank, const Exhibit& exhibit) {
  const PatchProgram& program = bank.program().description();
  return !exhibit.has_relief && !program.picture.colour && !program.picture.marks.empty() && exhibit.pushes_at_rest &&
         !remembers(program) && !program.vibrates();
}

/// Whether the force is shown against velocity: the program only resists motion.
bool is_of_velocity(const Exhibit& exhibit) { return !exhibit.pushes_at_rest && exhibit.resists_motion; }

void draw_surface(Canvas& canvas, const PageBox& picture, const Bank& bank, const Exhibit& exhibit,
                  const Rehearsal& rehearsal, const ImageLibrary& images) {
  const bool in_time = remembers(bank.program().description());
  draw_relief(canvas, picture, bank, &rehearsal.memory, exhibit, images, square_of(bank, picture, true));
  if (exhibit.has_relief) mark_section(canvas, picture, exhibit);
  draw_marks(canvas, picture, exhibit, rehearsal);
  const Notation length = length_notation(exhibit.side);
  draw_scale_bar(canvas, picture, exhibit.side, length);
  std::string caption;
  if (exhibit.has_relief && exhibit.felt)
    caption = fmt::format("relief by level {:.2f}", *exhibit.felt);
  else if (exhibit.has_relief)
    caption = exhibit.period ? "lit from the upper left" : "relief, lit from the upper left";
  if (in_time) caption = fmt::format("after {} s under the hand (ring)", shown_number(rehearsal.seconds));
  if (exhibit.period) {
    caption =
        fmt::format("period {}{}{}", shown_quantity(*exhibit.period, length), caption.empty() ? "" : " · ", caption);
  }
  write_caption(canvas, picture, caption);
}

void draw_field_and_scale(Canvas& canvas, const PageBox& picture, const Bank& bank, const Exhibit& exhibit,
                          bool of_velocity) {
  const double strongest = draw_field(canvas, picture, bank, exhibit, of_velocity, square_of(bank, picture, false));
  if (of_velocity) {
    draw_scale_bar(canvas, picture, 2 * exhibit.speed, speed_notation(exhibit.speed));
  } else {
    draw_scale_bar(canvas, picture, exhibit.side, length_notation(exhibit.side));
  }
  if (strongest > 0) {
    write_caption(canvas, picture, fmt::format("force over {}, means; a full arrow is {}", of_velocity ? "velocity" : "position",
                                      shown_quantity(strongest, force_notation(strongest))));
  } else {
    // One that speeds up, stays or is elsewhere may feel one all the same.
    write_caption(canvas, picture,
                  of_velocity ? "no force " + moving_place_name(exhibit) : std::string("no force on a hand at rest"));
  }
}

/// The plots of a program without relief and memory: how it pushes, and how it resists motion.
void draw_force_plots(Canvas& canvas, const Bank& bank, const Exhibit& exhibit, bool of_velocity) {
  if (of_velocity) return draw_plot(canvas, tall_plot, speed_plot(bank, exhibit));
  Plot at_rest = force_plot(bank, exhibit);
  if (!exhibit.resists_motion) return draw_plot(canvas, tall_plot, at_rest);
  std::erase_if(at_rest.curves, [](const Curve& curve) { return curve.name.starts_with("moving"); });
  draw_plot(canvas, upper_of_two, at_rest);
  draw_plot(canvas, lower_of_two, speed_plot(bank, exhibit));
}

/// Writes a text whole, in smaller letters where it is too wide.
void write_fitting(Canvas& canvas, PagePoint at, double width, const std::string& text, Type type) {
  constexpr double least = 15;
  if (const double needed = canvas.width_of(text, type); needed > width)
    type.size = std::max(least, type.size * width / needed);
  canvas.write_within(at, width, text, type);
}

void write_words(Canvas& canvas, const Bank& bank, const PreviewText& text, const Exhibit& exhibit) {
  const double width = page_width - 2 * margin;
  const std::string& device = bank.program().description().device.name;
  const PatchSize size = bank.size();
  const std::string whole = fmt::format("{} × {} mm", shown_number(size.width * 1e3), shown_number(size.height * 1e3));
  const std::string place =
      fmt::format("{}{}",
                  exhibit.side < exhibit.patch_side
                      ? fmt::format("{} {} mm of {}", exhibit.centre == glm::dvec2(0) ? "middle" : "a part,",
                                    shown_number(exhibit.side * 1e3), whole)
                      : "patch " + whole,
                  device.empty() ? "" : " on " + device);
  canvas.write_within({margin, 104}, width, text.title, style::title);
  canvas.write_within({margin, 146}, width - 420, text.names, style::names);
  canvas.write_within({page_width - margin, 146}, 400, place, style::label, Align::right);

  const double top = 848;
  canvas.line({margin, top}, {page_width - margin, top}, {1, style::rule});
  const std::size_t count = std::min<std::size_t>(text.figures.size(), 6);
  const double column = width / static_cast<double>(std::max<std::size_t>(count, 4));
  for (std::size_t i = 0; i < count; ++i) {
    const double left = margin + static_cast<double>(i) * column;
    canvas.write_within({left, top + 30}, column - 24, text.figures[i].word, style::word);
    write_fitting(canvas, {left, top + 70}, column - 24, text.figures[i].value, style::value);
  }
  canvas.write_within({margin, 957}, width, text.evidence, style::label);
}

/// The spectrum of the force under a stroking hand; empty for a pad, and for a force that does not change on the way.
std::optional<FeltSpectrum> felt_spectrum(const Bank& bank, const Exhibit& exhibit, const HandDeclaration* hand,
                                          double seconds) {
  if (bank.program().description().vibrates()) return std::nullopt;
  const FeltStroke felt = felt_along(bank, exhibit, hand, seconds);
  FeltSpectrum spectrum = spectrum_of(felt);
  const auto& amplitudes = spectrum.amplitudes;
  if (amplitudes.empty() || !(*std::max_element(amplitudes.begin(), amplitudes.end()) > least_force))
    return std::nullopt;
  return spectrum;
}

/// The left half of the page: the surface, or the field of a force without one.
void draw_picture(Canvas& canvas, const PageBox& picture, const Bank& bank, const Exhibit& exhibit,
                  const Rehearsal& rehearsal, const ImageLibrary& images) {
  if (marks_on_field(bank, exhibit)) {
    draw_field_and_scale(canvas, picture, bank, exhibit, false);
    draw_marks(canvas, picture, exhibit, rehearsal);
  } else if (shows_surface(bank, exhibit))
    draw_surface(canvas, picture, bank, exhibit, rehearsal, images);
  else
    draw_field_and_scale(canvas, picture, bank, exhibit, is_of_velocity(exhibit));
}

void draw_shaking_plots(Canvas& canvas, const Bank& bank, const Exhibit& exhibit, const Rehearsal& rehearsal) {
  // A pad without a position shakes alike however the hand moves.
  const bool of_speed = bank.program().description().device.has_position();
  const bool both = exhibit.has_relief && of_speed;
  if (exhibit.has_relief)
    draw_plot(canvas, both ? upper_of_two : tall_plot, height_plot(bank, rehearsal.memory, exhibit));
  if (of_speed) draw_plot(canvas, both ? lower_of_two : tall_plot, shaking_plot(bank, exhibit));
}

/// The plots of a program that remembers: its surface or the hand's way, and the force over the rehearsal.
void draw_rehearsed_plots(Canvas& canvas, const Bank& bank, const Exhibit& exhibit, const Rehearsal& rehearsal) {
  if (!exhibit.has_relief) {
    draw_plot(canvas, upper_plot, stroke_plot(exhibit, rehearsal));
    return draw_plot(canvas, lower_plot, felt_plot(rehearsal));
  }
  Plot heights = height_plot(bank, rehearsal.memory, exhibit);
  heights.x_name = position_name(exhibit);
  draw_plot(canvas, upper_of_two, heights);
  draw_plot(canvas, lower_of_two, felt_plot(rehearsal));
}

/// The right half of the page.
void draw_plots(Canvas& canvas, const Bank& bank, const Exhibit& exhibit, const Rehearsal& rehearsal) {
  const PatchProgram& program = bank.program().description();
  if (program.vibrates()) return draw_shaking_plots(canvas, bank, exhibit, rehearsal);
  if (remembers(program)) return draw_rehearsed_plots(canvas, bank, exhibit, rehearsal);
  if (!exhibit.has_relief) return draw_force_plots(canvas, bank, exhibit, is_of_velocity(exhibit));
  draw_plot(canvas, upper_plot, height_plot(bank, rehearsal.memory, exhibit));
  draw_plot(canvas, lower_plot, force_plot(bank, exhibit));
}

/// The one plot of a small page: how it pushes.
Plot most_telling_plot(const Bank& bank, const Exhibit& exhibit, const Rehearsal& rehearsal) {
  const PatchProgram& program = bank.program().description();
  if (program.vibrates())
    return program.device.has_position() ? shaking_plot(bank, exhibit)
                                         : height_plot(bank, rehearsal.memory, exhibit);
  Plot plot;
  if (remembers(program)) plot = felt_plot(rehearsal);
  else if (!exhibit.has_relief && is_of_velocity(exhibit)) plot = speed_plot(bank, exhibit);
  else plot = force_plot(bank, exhibit);
  // The words have the width of half a page, and one curve needs no key.
  if (is_of_velocity(exhibit) && !exhibit.has_relief) plot.title = plot.title.substr(0, plot.title.find(','));
  for (Curve& curve : plot.curves)
    for (const std::string_view long_word : {"on a hand ", "moving "})
      if (curve.name.starts_with(long_word)) curve.name.erase(0, long_word.size());
  if (plot.curves.size() == 1) plot.curves.front().name.clear();
  return plot;
}

/// Every third point of each curve: as fine as the smaller page shows.
Plot thinned(Plot plot) {
  for (Curve& curve : plot.curves) {
    Profile few;
    for (std::size_t i = 0; i < curve.profile.at.size(); i += 3)
      few.at.push_back(curve.profile.at[i]), few.values.push_back(curve.profile.values[i]);
    curve.profile = std::move(few);
  }
  return plot;
}

/// The plots of a program, each with its name.
std::vector<std::pair<const char*, Plot>> plots_of(const Bank& bank, const Exhibit& exhibit,
                                                   const Rehearsal& rehearsal) {
  const PatchProgram& program = bank.program().description();
  std::vector<std::pair<const char*, Plot>> plots;
  if (exhibit.has_relief) {
    plots.emplace_back("height", height_plot(bank, rehearsal.memory, exhibit));
    plots.back().second.x_name = position_name(exhibit);
  }
  if (program.vibrates()) {
    if (program.device.has_position()) plots.emplace_back("shaking", shaking_plot(bank, exhibit));
  } else if (remembers(program)) {
    if (!exhibit.has_relief) plots.emplace_back("hand", stroke_plot(exhibit, rehearsal));
    plots.emplace_back("time", felt_plot(rehearsal));
  } else {
    if (exhibit.has_relief || !is_of_velocity(exhibit)) plots.emplace_back("force", force_plot(bank, exhibit));
    if (!exhibit.has_relief && exhibit.resists_motion) plots.emplace_back("velocity", speed_plot(bank, exhibit));
  }
  return plots;
}

}  // namespace

Result<Preview> draw_preview(const Bank& bank, const PreviewText& text, const Declarations& declarations,
                             const PreviewChoice& choice) {
  const auto images = image_library();
  if (!images) return images.error();
  const HandDeclaration* hand = declarations.hands.find("showing");
  const Rehearsal rehearsal = rehearse(bank, hand, choice.seconds, choice.section.along.value_or(0));
  Exhibit exhibit = exhibit_of(bank, &rehearsal.memory, choice.section);
  exhibit.felt = text.felt;
  if (choice.small) {
    auto page = new_canvas(small_width, small_height, style::paper);
    if (!page) return page.error();
    draw_picture(**page, small_picture, bank, exhibit, rehearsal, **images);
    (*page)->outline(small_picture, {1, style::rule});
    draw_plot(**page, small_plot, most_telling_plot(bank, exhibit, rehearsal));
    return Preview{*std::move(page), square_of(bank, small_picture, shows_surface(bank, exhibit))};
  }
  const std::optional<FeltSpectrum> spectrum = felt_spectrum(bank, exhibit, hand, choice.seconds.value_or(2));
  auto page = new_canvas(page_width, spectrum ? page_height_with_spectrum : page_height, style::paper);
  if (!page) return page.error();
  Canvas& canvas = **page;
  PreviewText words = text;
  if (!spectrum && !bank.program().description().vibrates())
    words.evidence += fmt::format("{}no spectrum: the force does not change on a hand that strokes along {}",
                                  words.evidence.empty() ? "" : " · ", axis_name(exhibit));
  write_words(canvas, bank, words, exhibit);
  draw_picture(canvas, picture, bank, exhibit, rehearsal, **images);
  draw_plots(canvas, bank, exhibit, rehearsal);
  canvas.outline(picture, {1, style::rule});
  if (spectrum) {
    canvas.line({margin, 985}, {page_width - margin, 985}, {1, style::rule});
    draw_spectrum(canvas, spectrum_plot, *spectrum, axis_name(exhibit));
    draw_spectrogram(canvas, spectrogram_plot, *spectrum);
  }
  return Preview{*std::move(page), square_of(bank, picture, shows_surface(bank, exhibit))};
}

Result<PreviewParts> draw_preview_parts(const Bank& bank, std::optional<double> felt,
                                        const Declarations& declarations) {
  const auto images = image_library();
  if (!images) return images.error();
  const HandDeclaration* hand = declarations.hands.find("showing");
  PreviewParts parts{.rehearsal = rehearse(bank, hand)};
  parts.exhibit = exhibit_of(bank, &parts.rehearsal.memory);
  parts.exhibit.felt = felt;
  parts.surface = shows_surface(bank, parts.exhibit) && !marks_on_field(bank, parts.exhibit);
  auto picture_page = new_canvas(part_side, part_side, style::paper);
  if (!picture_page) return picture_page.error();
  parts.picture = *std::move(picture_page);
  const int square = square_of(bank, part_picture, parts.surface);
  if (parts.surface)
    draw_relief(*parts.picture, part_picture, bank, &parts.rehearsal.memory, parts.exhibit, **images, square);
  else
    draw_field(*parts.picture, part_picture, bank, parts.exhibit, is_of_velocity(parts.exhibit), square);
  draw_marks(*parts.picture, part_picture, parts.exhibit, parts.rehearsal);
  const auto add = [&](const char* name, std::string title, const auto& draw) {
    auto page = new_canvas(part_width, part_height, style::paper);
    if (!page) return;
    draw(**page);
    parts.plots.push_back({name, std::move(title), *std::move(page)});
  };
  for (const auto& [name, plot] : plots_of(bank, parts.exhibit, parts.rehearsal))
    add(name, plot.title, [&plot = plot](Canvas& page) { draw_plot(page, part_plot, thinned(plot)); });
  if (const auto spectrum = felt_spectrum(bank, parts.exhibit, hand, 2))
    add("spectrum",
        fmt::format("Spectrum of the whole force on a hand that strokes to and fro along {}", axis_name(parts.exhibit)),
        [&](Canvas& page) { draw_spectrum(page, part_plot, *spectrum, axis_name(parts.exhibit)); });
  return parts;
}

}  // namespace wale
