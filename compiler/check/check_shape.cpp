// The shape of a patch: a rectangle, an ellipse, a polygon or a mask.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "compiler/check/check_workspace.hpp"
#include "compiler/check/picture_argument.hpp"
#include "compiler/image/image.hpp"

namespace wale {

namespace {

using Corner = std::array<double, 2>;

constexpr std::size_t fewest_corners = 3, most_corners = 64;
/// The code from which on a sample of a mask is inside: half of full brightness.
constexpr std::uint16_t light = 32768;

const std::vector<std::string> shape_words = {"rectangle", "ellipse", "polygon", "mask"};
constexpr const char* example_of_polygon = "write, for example, `polygon(-20 mm, 0 mm, 20 mm, 0 mm, 0 mm, 30 mm)`";
constexpr const char* example_of_mask = "write, for example, `mask(\"river.png\", scale: 0.5 mm/px)`";

/// Twice the area of the triangle a, b, c; positive if they turn left.
double turn_of(const Corner& a, const Corner& b, const Corner& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Whether c lies in the box around a and b; all three are on one line.
bool is_between(const Corner& a, const Corner& b, const Corner& c) {
  return std::min(a[0], b[0]) <= c[0] && c[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= c[1] &&
         c[1] <= std::max(a[1], b[1]);
}

/// Whether the sides a b and c d have a point in common.
bool do_meet(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  const double ac = turn_of(a, b, c), ad = turn_of(a, b, d), ca = turn_of(c, d, a), cb = turn_of(c, d, b);
  if (((ac > 0) != (ad > 0)) && ((ca > 0) != (cb > 0)) && ac != 0 && ad != 0 && ca != 0 && cb != 0) return true;
  return (ac == 0 && is_between(a, b, c)) || (ad == 0 && is_between(a, b, d)) || (ca == 0 && is_between(c, d, a)) ||
         (cb == 0 && is_between(c, d, b));
}

/// Two corners of one side that another side meets, or whose next side goes back over it: the first of each; empty if
/// the polygon is simple.
std::optional<std::array<std::size_t, 2>> crossing_of(const std::vector<Corner>& corners) {
  const std::size_t count = corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Corner &a = corners[i], &b = corners[(i + 1) % count], &c = corners[(i + 2) % count];
    const bool goes_back = turn_of(a, b, c) == 0 && (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) <= 0;
    if (a == b || goes_back) return std::array{i, (i + 1) % count};
    for (std::size_t j = i + 2; j < count; ++j)
      if ((j + 1) % count != i && do_meet(a, b, corners[j], corners[(j + 1) % count])) return std::array{i, j};
  }
  return std::nullopt;
}

class ShapeChecker {
 public:
  ShapeChecker(const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings, CheckedPatch& patch)
      : tree_(*declared.tree), surroundings_(surroundings), patch_(patch), checker_(surroundings, terms_, tables_) {}

  bool check(const SettingItem& item) {
    const auto* call = item.value ? std::get_if<Call>(&tree_.expr(*item.value)) : nullptr;
    const auto* use = item.value ? std::get_if<NameUse>(&tree_.expr(*item.value)) : nullptr;
    const bool is_word = item.words.size() == 1 && !item.value, is_call = call && item.words.empty() && !call->quoted;
    if (item.equals || item.range_end || !item.trailing.empty() || (!is_word && !is_call && !use))
      return refuse(Code::wrong_type, item.span, "expected a shape",
                    "it is `rectangle`, `ellipse`, `polygon(…)` or `mask(…)`");
    const Word name = is_word ? item.words.front() : is_call ? call->callee : Word{use->name, item.span};
    if (name.text == "polygon" || name.text == "mask") {
      if (!is_call)
        return refuse(Code::missing_argument, name.span, fmt::format("`{}` needs its arguments", name.text),
                      name.text == "polygon" ? example_of_polygon : example_of_mask);
      return name.text == "polygon" ? polygon(*call, item.span) : mask(*call, item.span);
    }
    if (name.text != "rectangle" && name.text != "ellipse")
      return refuse(
          Code::unknown_name, name.span, fmt::format("no shape is called `{}`", name.text),
          did_you_mean(name.span, name.text, shape_words, "it is `rectangle`, `ellipse`, `polygon(…)` or `mask(…)`"));
    if (is_call)
      return refuse(Code::unknown_argument, item.span, fmt::format("`{}` takes no arguments", name.text),
                    fmt::format("write `shape {}`; its width and height are the `size` of the patch", name.text));
    if (name.text == "ellipse") patch_.outline = EllipseOutline{};
    return true;
  }

 private:
  bool polygon(const Call& call, Span span) {
    const std::span<const Argument> arguments = tree_.arguments(call);
    for (const Argument& each : arguments)
      if (each.name)
        return refuse(Code::unknown_argument, each.name->span, "the corners of a polygon have no names",
                      example_of_polygon);
    if (arguments.size() % 2 != 0 || arguments.size() < 2 * fewest_corners || arguments.size() > 2 * most_corners)
      return refuse(Code::wrong_type, span,
                    arguments.size() % 2 != 0 ? "each corner of a polygon is two lengths: to the right and up"
                                              : fmt::format("expected {} to {} corners, found {}", fewest_corners,
                                                            most_corners, arguments.size() / 2),
                    example_of_polygon);
    PolygonOutline outline;
    Corner half{};
    for (std::size_t i = 0; i < arguments.size(); i += 2) {
      Corner corner{};
      for (std::size_t side = 0; side < 2; ++side) {
        Scope scope;
        const auto value =
            checker_.constant(tree_, arguments[i + side].value, scope, surroundings_.declarations.dimension("length"));
        if (!value) return false;
        corner[side] = *value;
        half[side] = std::max(half[side], std::abs(*value));
      }
      outline.corners.push_back(corner);
    }
    if (const auto crossing = crossing_of(outline.corners)) {
      const auto [one, other] = *crossing;
      return refuse(Code::unusable_shape, span,
                    fmt::format("the sides of this polygon from its corners {} and {} meet", one + 1, other + 1),
                    Advice("give the corners in order, all the way round")
                        .see(tree_.span(arguments[2 * one].value), fmt::format("corner {}", one + 1))
                        .see(tree_.span(arguments[2 * other].value), fmt::format("corner {}", other + 1)));
    }
    patch_.outline = std::move(outline);
    patch_.size = std::array{2 * half[0], 2 * half[1]};
    return true;
  }

  bool mask(const Call& call, Span span) {
    const auto picture = picture_argument(call, span, "mask", example_of_mask, tree_, surroundings_, checker_);
    if (!picture) return false;
    const auto read = read_height_image(std::as_bytes(std::span(picture->file.bytes)), picture->file.name, 0,
                                        surroundings_.resolver->sandbox());
    if (!read)
      return refuse(read.error().code, picture->span, fmt::format("`{}`: {}", picture->written, read.error().sentence),
                    read.error().mend);
    return take(*read, picture->written, picture->scale, picture->span);
  }

  bool take(const HeightImage& picture, std::string file, double scale, Span span) {
    const HeightTable& table = picture.table;
    if (!surroundings_.diagnostics.take_samples(table.heights.size(), true))
      return refuse(Code::program_too_large, span, "the pictures of this file have too many samples together",
                    "make some of them smaller");
    MaskOutline outline{.file = std::move(file),
                        .columns = table.width,
                        .rows = table.height,
                        .column = scale * picture.pixels_per_column,
                        .row = scale * picture.pixels_per_row,
                        .inside = {}};
    outline.inside.reserve(table.heights.size());
    for (const std::uint16_t height : table.heights) outline.inside.push_back(height >= light);
    if (std::ranges::find(outline.inside, true) == outline.inside.end())
      return refuse(Code::unusable_shape, span, "this mask has no inside: it is dark everywhere",
                    "make the picture light where the patch is, and dark elsewhere");
    patch_.size = std::array{outline.column * static_cast<double>(outline.columns),
                                       outline.row * static_cast<double>(outline.rows)};
    patch_.outline = std::move(outline);
    return true;
  }

  bool refuse(Code code, Span span, std::string message, Advice advice) {
    surroundings_.diagnostics.report(std::move(advice).about(code, span, std::move(message)));
    return false;
  }

  const SyntaxTree& tree_;
  const Surroundings& surroundings_;
  CheckedPatch& patch_;
  Terms terms_;
  std::vector<HeightTable> tables_;
  ExpressionChecker checker_;
};

}  // namespace

bool check_shape(const SettingItem& item, const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings,
                 CheckedPatch& patch) {
  return ShapeChecker(declared, surroundings, patch).check(item);
}

}  // namespace wale
