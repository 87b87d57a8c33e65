#include <cairo-svg.h>
#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>

#include "compiler/drawing/cairo/functions.hpp"
#include "schema/utf8.hpp"

namespace wale::cairo {
namespace {

// The first of these families that is installed; the last ones are whatever the system has of their kind.
constexpr const char* sans_families = "DejaVu Sans,Liberation Sans,Noto Sans,sans-serif";
constexpr const char* serif_families = "DejaVu Serif,Liberation Serif,Noto Serif,serif";
constexpr std::size_t longest_text = 500;  // bytes: more of a line is never seen, and measuring it takes as long

template <auto release>
struct Release {
  template <typename Handle>
  void operator()(Handle* handle) const {
    release(handle);
  }
};
using Surface = std::unique_ptr<cairo_surface_t, Release<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Release<cairo_destroy>>;
using Layout = std::unique_ptr<PangoLayout, Release<g_object_unref>>;
using FontDescription = std::unique_ptr<PangoFontDescription, Release<pango_font_description_free>>;
using FontOptions = std::unique_ptr<cairo_font_options_t, Release<cairo_font_options_destroy>>;

/// The text as a font can draw it: control characters become spaces, and bytes that are not UTF-8 question marks.
std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size() && result.size() < longest_text;) {
    const Character letter = decode(text, at);
    if (!letter.valid) {
      result += '?';
    } else if (letter.code < 0x20 || (letter.code >= 0x7f && letter.code < 0xa0)) {
      result += ' ';
    } else {
      result += text.substr(at, letter.bytes);
    }
    at += letter.bytes;
  }
  return result;
}

bool has_fonts() {
  const FcFontSet* fonts = FcConfigGetFonts(FcConfigGetCurrent(), FcSetSystem);
  return fonts && fonts->nfont > 0;
}

/// An SVG file whose parts are numbered in their order. Cairo numbers some of them by all that the process has drawn,
/// so that the same page would not have the same bytes.
std::string numbered_in_order(const std::string& svg) {
  const auto name_at = [&](std::size_t from) {
    std::size_t end = from;
    while (end < svg.size() && (std::isalnum(static_cast<unsigned char>(svg[end])) || svg[end] == '-')) ++end;
    return svg.substr(from, end - from);
  };
  constexpr std::string_view defined = "id=\"";
  std::map<std::string, std::string> names;
  std::map<std::string, int> counts;
  for (std::size_t at = svg.find(defined); at != std::string::npos; at = svg.find(defined, at + 1)) {
    const std::string name = name_at(at + defined.size());
    const std::string kind = name.substr(0, name.find_first_of("0123456789"));
    if (!names.contains(name)) names[name] = kind + std::to_string(++counts[kind]);
  }
  std::string result;
  for (std::size_t i = 0; i < svg.size(); ++i) {
    result += svg[i];
    if (svg[i] != '#' && !std::string_view(result).ends_with(defined)) continue;
    const std::string name = name_at(i + 1);
    const auto known = names.find(name);
    if (known == names.end()) continue;
    result += known->second, i += name.size();
  }
  return result;
}

class CairoCanvas final : public Canvas {
 public:
  CairoCanvas(int width, int height, Colour paper) : width_(width), height_(height), has_text_(has_fonts()) {
    const cairo_rectangle_t page{0, 0, static_cast<double>(width), static_cast<double>(height)};
    page_.reset(cairo_recording_surface_create(CAIRO_CONTENT_COLOR, &page));
    context_.reset(cairo_create(page_.get()));
    cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
    fill({0, 0, page.width, page.height}, paper);
  }

  void fill(const PageBox& box, Colour colour) override {
    cairo_rectangle(context_.get(), box.left, box.top, box.width(), box.height());
    use(colour, 1);
    cairo_fill(context_.get());
  }

  void stroke(std::span<const PagePoint> points, const Pen& pen) override {
    if (points.empty()) return;
    path(points);
    // A point alone is a dot.
    if (points.size() == 1) cairo_line_to(context_.get(), points[0].x, points[0].y);
    use(pen.colour, pen.opacity);
    cairo_set_line_width(context_.get(), pen.width);
    cairo_set_line_cap(context_.get(), pen.dash > 0 ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
    cairo_set_dash(context_.get(), &pen.dash, pen.dash > 0 ? 1 : 0, 0);
    cairo_stroke(context_.get());
  }

  void area(std::span<const PagePoint> corners, Colour colour, float opacity) override {
    path(corners);
    cairo_close_path(context_.get());
    use(colour, opacity);
    cairo_fill(context_.get());
  }

  void clip(const PageBox& box) override {
    cairo_rectangle(context_.get(), box.left, box.top, box.width(), box.height());
    cairo_clip(context_.get());
  }
  void unclip() override { cairo_reset_clip(context_.get()); }

  void write(PagePoint at, std::string_view text, const Type& type, Align align) override {
    if (has_text_) show(*layout_of(text, type), at, type, align);
  }

  void write_within(PagePoint at, double width, std::string_view text, const Type& type, Align align) override {
    if (!has_text_) return;
    const Layout layout = layout_of(text, type);
    pango_layout_set_width(layout.get(), static_cast<int>(width * PANGO_SCALE));
    pango_layout_set_ellipsize(layout.get(), PANGO_ELLIPSIZE_END);
    show(*layout, at, type, align);
  }

  double width_of(std::string_view text, const Type& type) const override {
    return has_text_ ? width_of(*layout_of(text, type)) : 0;
  }

  bool has_text() const override { return has_text_; }

  Drawing pixels() const override {
    const Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_, height_));
    paint_on(image.get());
    cairo_surface_flush(image.get());
    const unsigned char* from = cairo_image_surface_get_data(image.get());
    const int stride = cairo_image_surface_get_stride(image.get());
    Drawing drawing{width_, height_, {}};
    drawing.rgb.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 3);
    for (int row = 0; row < height_; ++row)
      for (int column = 0; column < width_; ++column) {
        std::uint32_t pixel = 0;
        std::memcpy(&pixel, from + std::ptrdiff_t{row} * stride + std::ptrdiff_t{column} * 4, sizeof pixel);
        for (const int shift : {16, 8, 0}) drawing.rgb.push_back(static_cast<std::uint8_t>(pixel >> shift));
      }
    return drawing;
  }

  std::vector<std::byte> svg() const override {
    std::string file;
    const auto append = [](void* to, const unsigned char* bytes, unsigned count) {
      static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), count);
      return CAIRO_STATUS_SUCCESS;
    };
    const Surface surface(cairo_svg_surface_create_for_stream(append, &file, width_, height_));
    cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
    paint_on(surface.get());
    cairo_surface_finish(surface.get());
    const std::string ordered = numbered_in_order(file);
    const auto* first = reinterpret_cast<const std::byte*>(ordered.data());
    return {first, first + ordered.size()};
  }

 private:
  void place_picture(const PageBox& box, std::span<const Colour> pixels, int columns, int rows, bool squares) override {
    const Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, columns, rows));
    unsigned char* to = cairo_image_surface_get_data(image.get());
    const int stride = cairo_image_surface_get_stride(image.get());
    const auto byte = [](float value) {
      return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
    };
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const Colour& colour = pixels[static_cast<std::size_t>(row * columns + column)];
        const std::uint32_t pixel = byte(colour.red) << 16 | byte(colour.green) << 8 | byte(colour.blue);
        std::memcpy(to + std::ptrdiff_t{row} * stride + std::ptrdiff_t{column} * 4, &pixel, sizeof pixel);
      }
    cairo_surface_mark_dirty(image.get());
    cairo_save(context_.get());
    cairo_rectangle(context_.get(), box.left, box.top, box.width(), box.height());
    cairo_clip(context_.get());
    cairo_translate(context_.get(), box.left, box.top);
    cairo_scale(context_.get(), box.width() / columns, box.height() / rows);
    cairo_set_source_surface(context_.get(), image.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(context_.get()), squares ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
    // What lies beyond the picture's edge does not shine into its outermost pixels.
    cairo_pattern_set_extend(cairo_get_source(context_.get()), CAIRO_EXTEND_PAD);
    cairo_paint(context_.get());
    cairo_restore(context_.get());
  }

  void use(Colour colour, float opacity) {
    cairo_set_source_rgba(context_.get(), colour.red, colour.green, colour.blue, opacity);
  }

  void path(std::span<const PagePoint> points) {
    cairo_new_path(context_.get());
    for (const PagePoint& point : points) cairo_line_to(context_.get(), point.x, point.y);
  }

  Layout layout_of(std::string_view text, const Type& type) const {
    Layout layout(pango_cairo_create_layout(context_.get()));
    // Letters have the same widths at every scale and on every screen.
    const FontOptions options(cairo_font_options_create());
    cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(pango_layout_get_context(layout.get()), options.get());
    pango_context_set_round_glyph_positions(pango_layout_get_context(layout.get()), FALSE);
    const FontDescription font(pango_font_description_new());
    pango_font_description_set_family(font.get(), type.face == Face::serif ? serif_families : sans_families);
    pango_font_description_set_absolute_size(font.get(), type.size * PANGO_SCALE);
    pango_layout_set_font_description(layout.get(), font.get());
    pango_layout_set_single_paragraph_mode(layout.get(), TRUE);
    const std::string shown = printable(text);
    pango_layout_set_text(layout.get(), shown.data(), static_cast<int>(shown.size()));
    return layout;
  }

  static double width_of(PangoLayout& layout) {
    PangoRectangle extent{};
    pango_layout_get_extents(&layout, nullptr, &extent);
    return static_cast<double>(extent.width) / PANGO_SCALE;
  }

  void show(PangoLayout& layout, PagePoint at, const Type& type, Align align) {
    const double width = align == Align::left ? 0 : width_of(layout);
    const double left = align == Align::left ? at.x : align == Align::centre ? at.x - width / 2 : at.x - width;
    use(type.colour, 1);
    cairo_move_to(context_.get(), left, at.y);
    pango_cairo_show_layout_line(context_.get(), pango_layout_get_line_readonly(&layout, 0));
  }

  void paint_on(cairo_surface_t* surface) const {
    const Context context(cairo_create(surface));
    cairo_set_source_surface(context.get(), page_.get(), 0, 0);
    cairo_paint(context.get());
  }

  int width_, height_;
  bool has_text_;
  Surface page_;
  Context context_;
};

}  // namespace

std::unique_ptr<Canvas> new_canvas(int width, int height, Colour paper) {
  return std::make_unique<CairoCanvas>(width, height, paper);
}

}  // namespace wale::cairo
