// The patches of a picture: an area for each of its colours.
#include "compiler/check/check_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compiler/areas/colour_areas.hpp"
#include "compiler/check/picture_argument.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

constexpr const char* example_of_picture = "write, for example, `picture(\"map.png\", scale: 0.3 mm/px)`";
constexpr const char* example_of_colour = "write, for example, `colour \"#c04020\" = brick`";
const std::vector<std::string> picture_settings = {"colour", "blank", "at", "rim", "tolerance", "narrowest"};
/// Of the distance of black and white, without a `tolerance`: 38 of the 255 steps of each channel, more than a JPEG of
/// usual quality changes a flat area.
constexpr double usual_tolerance = 0.15;

std::string spelled(std::uint32_t colour) { return fmt::format("#{:06x}", colour & 0xffffff); }

class PictureChecker {
 public:
  PictureChecker(const PicturePlacing& node, const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings)
      : node_(node), tree_(*declared.tree), surroundings_(surroundings), checker_(surroundings, terms_, tables_) {}

  std::vector<ColouredArea> check() {
    const std::size_t errors_before = surroundings_.diagnostics.error_count();
    for (const Setting& setting : node_.settings) read(setting);
    if (areas_.empty() && surroundings_.diagnostics.error_count() == errors_before)
      refuse(Code::missing_setting, node_.span, "no colour of this picture has a material", example_of_colour);
    if (surroundings_.diagnostics.error_count() > errors_before) return {};
    const auto picture = file();
    if (!picture || surroundings_.diagnostics.error_count() > errors_before) return {};
    auto image = read_colour_image(std::as_bytes(std::span(picture->file.bytes)), picture->file.name,
                                   surroundings_.resolver->sandbox());
    if (!image) {
      refuse(image.error().code, picture->span, fmt::format("`{}`: {}", picture->written, image.error().sentence),
             image.error().mend);
      return {};
    }
    lay_out(*picture, *image);
    return surroundings_.diagnostics.error_count() == errors_before ? std::move(areas_) : std::vector<ColouredArea>{};
  }

 private:
  // ---- the settings -----------------------------------------------------------------------------------------------

  void read(const Setting& setting) {
    const std::string key(setting.key.text);
    if (std::ranges::find(picture_settings, key) == picture_settings.end())
      return refuse(Code::unknown_setting, setting.key.span, fmt::format("a picture of a workspace has no `{}`", key),
                    did_you_mean(setting.key.span, key, picture_settings,
                                 "it has: colour, blank, at, rim, tolerance, narrowest"));
    if (setting.on)
      return refuse(Code::unexpected_token, setting.on->span, "a picture lies on every device at the same place",
                    "leave out `on` and the device");
    if (key == "colour") return read_colour(setting);
    if (key == "blank") return read_blanks(setting);
    const auto [first, is_new] = settings_.emplace(key, setting.key.span);
    if (!is_new)
      return refuse(Code::declared_twice, setting.key.span, fmt::format("`{}` is set twice", key),
                    Advice("keep one of them").see(first->second, "set here first"));
    if (key == "at") {
      if (const auto place = values(setting, 2, "length", "a picture lies at two lengths: to the right and up",
                                    "write, for example, `at -50 mm, 20 mm`"))
        at_ = {(*place)[0], (*place)[1]};
    } else if (key == "rim") {
      if (const auto rim = values(setting, 1, "length", "a rim is one length", "write, for example, `rim 1 mm`"))
        if (in_range(setting, (*rim)[0], 0, HUGE_VAL, "a rim cannot be narrower than 0",
                     "write, for example, `rim 1 mm`"))
          rim_ = (*rim)[0];
    } else if (key == "tolerance") {
      if (const auto share =
              values(setting, 1, "number", "a tolerance is one number", "write, for example, `tolerance 15 %`"))
        if (in_range(setting, (*share)[0], 0, 1, "a tolerance is from 0 to 100 %, the distance of black and white",
                     "write, for example, `tolerance 15 %`"))
          tolerance_ = (*share)[0];
    } else if (const auto width = values(setting, 1, "length", "the narrowest width of an area is one length",
                                         "write, for example, `narrowest 2 mm`")) {
      if (in_range(setting, (*width)[0], 0, HUGE_VAL, "a width cannot be less than 0",
                   "write, for example, `narrowest 2 mm`"))
        narrowest_ = (*width)[0];
    }
  }

  void read_colour(const Setting& setting) {
    const SettingItem& item = setting.items.front();
    if (setting.items.size() != 1 || !item.words.empty() || !item.value || !item.equals || item.range_end ||
        !item.trailing.empty())
      return refuse(Code::wrong_type, setting.span, "expected a colour and its material", example_of_colour);
    const auto colour = colour_of(*item.value);
    if (!colour || !is_new(*colour, *item.value)) return;
    areas_.push_back({.material = *item.equals,
                      .colour = spelled(*colour),
                      .statement = setting.span,
                      .colour_span = tree_.span(*item.value),
                      .outline = {}});
    colours_.push_back(*colour);
  }

  void read_blanks(const Setting& setting) {
    for (const SettingItem& item : setting.items) {
      if (!item.words.empty() || !item.value || item.equals || item.range_end || !item.trailing.empty()) {
        refuse(Code::wrong_type, item.span, "expected colours where no patch is",
               "write, for example, `blank \"#ffffff\"`");
        continue;
      }
      const auto colour = colour_of(*item.value);
      if (colour && is_new(*colour, *item.value)) blanks_.push_back(*colour);
    }
  }

  /// "#c04020" or "#c42".
  std::optional<std::uint32_t> colour_of(ExprId expr) {
    const auto* literal = std::get_if<TextLiteral>(&tree_.expr(expr));
    const std::string_view text = literal ? literal->text : "";
    const auto is_digit = [](unsigned char c) { return std::isxdigit(c) != 0 && c < 0x80; };
    if ((text.size() == 7 || text.size() == 4) && text[0] == '#' && std::ranges::all_of(text.substr(1), is_digit)) {
      std::string digits;
      for (const char c : text.substr(1)) digits += std::string(text.size() == 4 ? 2 : 1, c);
      return static_cast<std::uint32_t>(std::stoul(digits, nullptr, 16));
    }
    refuse(Code::wrong_type, tree_.span(expr), "a colour is a text of a # and six hexadecimal digits",
           example_of_colour);
    return std::nullopt;
  }

  bool is_new(std::uint32_t colour, ExprId expr) {
    const Span span = tree_.span(expr);
    const auto [first, is_new] = places_.emplace(colour, span);
    if (!is_new)
      refuse(Code::declared_twice, span, fmt::format("the colour \"{}\" is given twice", spelled(colour)),
             Advice("a colour has one material").see(first->second, "given here first"));
    else if (places_.size() > most_colours)
      refuse(Code::program_too_large, span, fmt::format("a picture has {} colours at most", most_colours),
             "lay out the others from a second picture");
    return is_new && places_.size() <= most_colours;
  }

  std::optional<std::vector<double>> values(const Setting& setting, std::size_t count, const char* dimension,
                                            const char* rule, const char* example) {
    const auto is_value = [](const SettingItem& item) {
      return item.value && item.words.empty() && item.trailing.empty() && !item.range_end && !item.equals;
    };
    if (setting.items.size() != count || !std::ranges::all_of(setting.items, is_value)) {
      refuse(Code::wrong_type, setting.span, rule, example);
      return std::nullopt;
    }
    const bool is_plain = std::string_view(dimension) == "number";
    std::vector<double> all;
    for (const SettingItem& item : setting.items) {
      Scope scope;
      const auto value = checker_.constant(tree_, *item.value, scope,
                                           is_plain ? Dimension{} : surroundings_.declarations.dimension(dimension));
      if (!value) return std::nullopt;
      all.push_back(*value);
    }
    return all;
  }

  bool in_range(const Setting& setting, double value, double least, double most, const char* rule,
                const char* example) {
    if (value >= least && value <= most) return true;
    refuse(Code::value_out_of_range, setting.items[0].span, rule, example);
    return false;
  }

  std::optional<PictureArgument> file() {
    const auto* call = std::get_if<Call>(&tree_.expr(node_.picture));
    if (call && !call->quoted && call->callee.text == "picture")
      return picture_argument(*call, tree_.span(node_.picture), "picture", example_of_picture, tree_, surroundings_,
                              checker_);
    refuse(Code::wrong_type, tree_.span(node_.picture), "patches come from a picture", example_of_picture);
    return std::nullopt;
  }

  // ---- the picture ------------------------------------------------------------------------------------------------

  void lay_out(const PictureArgument& picture, const ColourImage& image) {
    const double column = picture.scale * image.pixels_per_column, row = picture.scale * image.pixels_per_row;
    std::vector<std::uint32_t> all = colours_;
    all.insert(all.end(), blanks_.begin(), blanks_.end());
    const ColourAreas found = colour_areas(image, all, tolerance_);
    bool good = true;
    for (std::size_t i = 0; i < areas_.size(); ++i) good = has_pixels(i, found, picture) && good;
    if (!good) return;
    warn_of_unmatched(found, picture, image);
    const double narrowest = narrowest_.value_or(2 * rim_.value_or(usual_rim));
    if (const auto sliver = find_sliver(found, areas_.size(), narrowest / std::max(column, row)))
      return refuse_sliver(*sliver, narrowest, picture, image, column, row);
    for (std::size_t i = 0; i < areas_.size(); ++i)
      if (!outline(i, found, picture, column, row)) return;
  }

  bool has_pixels(std::size_t which, const ColourAreas& found, const PictureArgument& picture) {
    if (found.pixels[which] > 0) return true;
    const ColouredArea& area = areas_[which];
    Advice advice("write a colour that it has");
    if (found.unmatched.pixels > 0) {
      const std::string there = spelled(found.unmatched.mostly);
      advice =
          Advice(fmt::format("it has \"{}\", {:.3g} of the distance of black and white away; write that, or a larger "
                             "`tolerance`",
                             there, colour_distance(found.unmatched.mostly, colours_[which])))
              .fix(replace(area.colour_span, fmt::format("\"{}\"", there), {}, false));
    }
    refuse(Code::unusable_shape, area.colour_span,
           fmt::format("no part of `{}` has the colour \"{}\"", picture.written, area.colour), std::move(advice));
    return false;
  }

  void warn_of_unmatched(const ColourAreas& found, const PictureArgument& picture, const ColourImage& image) {
    if (found.unmatched.pixels == 0) return;
    const double share = static_cast<double>(found.unmatched.pixels) / static_cast<double>(found.areas.size());
    const std::string mostly = spelled(found.unmatched.mostly);
    surroundings_.diagnostics.report(
        Advice(fmt::format("add `colour \"{0}\" = …`, or `blank \"{0}\"` if nothing is to be felt there", mostly))
            .fact("share", share)
            .fact("colour", mostly)
            .about(Code::unmatched_colours, picture.span,
                   readable("{:.3g} % of `{}` has none of these colours: it is mostly \"{}\", as at pixel {}, {}",
                            100 * share, picture.written, mostly,
                            std::lround(found.unmatched.place.x * image.pixels_per_column),
                            std::lround(found.unmatched.place.y * image.pixels_per_row))));
  }

  void refuse_sliver(const Sliver& sliver, double narrowest, const PictureArgument& picture, const ColourImage& image,
                     double column, double row) {
    const ColouredArea& area = areas_[sliver.area];
    const double width = sliver.width_pixels * std::max(column, row);
    const double x = at_[0] + column * (sliver.place.x + 0.5 - 0.5 * image.width);
    const double y = at_[1] - row * (sliver.place.y + 0.5 - 0.5 * image.height);
    refuse(Code::narrow_area, area.colour_span,
           readable(
               "the area \"{}\" is {:.2g} mm wide at {:.4g} mm, {:.4g} mm, pixel {}, {} of `{}`, and the narrowest is "
               "{:.3g} mm",
               area.colour, 1e3 * width, 1e3 * x + 0.0, 1e3 * y + 0.0,
               std::lround(sliver.place.x * image.pixels_per_column),
               std::lround(sliver.place.y * image.pixels_per_row), picture.written, 1e3 * narrowest),
           Advice(typeable("draw it wider or leave it out there, take a `scale` of {:.2g} mm/px, or allow it by "
                           "`narrowest {:.2g} mm`",
                           1e3 * picture.scale * narrowest / width, 1e3 * std::floor(1e5 * width) / 1e5))
               .fact("width", 1e3 * width, "mm")
               .fact("x", 1e3 * x, "mm")
               .fact("y", 1e3 * y, "mm"));
  }

  /// Cuts an area out of the picture, in the box around it.
  bool outline(std::size_t which, const ColourAreas& found, const PictureArgument& picture, double column, double row) {
    ColouredArea& area = areas_[which];
    std::uint32_t left = found.width, right = 0, top = found.height, bottom = 0;
    for (std::uint32_t y = 0; y < found.height; ++y)
      for (std::uint32_t x = 0; x < found.width; ++x)
        if (found.areas[std::size_t{y} * found.width + x] == which) {
          left = std::min(left, x), right = std::max(right, x);
          top = std::min(top, y), bottom = std::max(bottom, y);
        }
    MaskOutline& mask = area.outline;
    mask.columns = right - left + 1, mask.rows = bottom - top + 1;
    if (!surroundings_.diagnostics.take_samples(mask.columns * mask.rows, true)) {
      refuse(Code::program_too_large, picture.span, "the pictures of this file have too many samples together",
             "make some of them smaller");
      return false;
    }
    mask.file = picture.written, mask.colour = area.colour;
    mask.column = column, mask.row = row;
    mask.inside.reserve(mask.columns * mask.rows);
    for (std::uint32_t y = top; y <= bottom; ++y)
      for (std::uint32_t x = left; x <= right; ++x)
        mask.inside.push_back(found.areas[std::size_t{y} * found.width + x] == which);
    area.at = {at_[0] + column * (0.5 * (left + right + 1) - 0.5 * found.width),
               at_[1] - row * (0.5 * (top + bottom + 1) - 0.5 * found.height)};
    area.rim = rim_;
    return true;
  }

  void refuse(Code code, Span span, std::string message, Advice advice) {
    surroundings_.diagnostics.report(std::move(advice).about(code, span, std::move(message)));
  }

  const PicturePlacing& node_;
  const SyntaxTree& tree_;
  const Surroundings& surroundings_;
  Terms terms_;
  std::vector<HeightTable> tables_;
  ExpressionChecker checker_;
  std::vector<ColouredArea> areas_;
  std::vector<std::uint32_t> colours_;  ///< of the areas
  std::vector<std::uint32_t> blanks_;
  std::map<std::uint32_t, Span> places_;  ///< of all colours
  std::map<std::string, Span> settings_;
  std::array<double, 2> at_{};
  std::optional<double> rim_, narrowest_;
  double tolerance_ = usual_tolerance;
};

}  // namespace

std::vector<ColouredArea> check_picture(const PicturePlacing& node, const Declared<WorkspaceDecl>& declared,
                                        const Surroundings& surroundings) {
  return PictureChecker(node, declared, surroundings).check();
}

}  // namespace wale
