#include "compiler/compile_workspace.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/text/readable.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

using Point = std::array<double, 2>;

/// The rim takes no more than this share of a patch's shorter side.
constexpr double widest_rim = 0.25;
/// m; a proposed place is a multiple of it.
constexpr double place_step = 1e-4;

/// Points of the outline (m, from the patch's centre) of which one is the farthest from any place outside of it: all
/// its corners, and for an ellipse enough points that none is missed by more than a micrometre.
std::vector<Point> farthest_points(const CheckedPatch& patch, const PatchSize& size) {
  const double right = 0.5 * size.width, top = 0.5 * size.height;
  if (const auto* polygon = std::get_if<PolygonOutline>(&patch.outline)) return polygon->corners;
  std::vector<Point> points;
  if (std::holds_alternative<EllipseOutline>(patch.outline)) {
    constexpr int steps = 1440;
    for (int i = 0; i < steps; ++i) {
      const double angle = 2 * std::numbers::pi * i / steps;
      points.push_back({right * std::cos(angle), top * std::sin(angle)});
    }
    return points;
  }
  if (const auto* mask = std::get_if<MaskOutline>(&patch.outline)) {
    for (std::size_t row = 0; row < mask->rows; ++row) {
      const auto begin = mask->inside.begin() + static_cast<std::ptrdiff_t>(row * mask->columns);
      const auto end = begin + static_cast<std::ptrdiff_t>(mask->columns);
      const auto first = std::find(begin, end, true);
      if (first == end) continue;
      const auto last = std::find(std::make_reverse_iterator(end), std::make_reverse_iterator(first), true).base();
      const double half_width = 0.5 * mask->column * static_cast<double>(mask->columns);
      const double half_height = 0.5 * mask->row * static_cast<double>(mask->rows);
      for (const auto column : {first - begin, last - begin})
        for (const std::size_t edge : {row, row + 1})
          points.push_back({mask->column * static_cast<double>(column) - half_width,
                            half_height - mask->row * static_cast<double>(edge)});
    }
    return points;
  }
  return {{right, top}, {right, -top}, {-right, top}, {-right, -top}};
}

/// The distance of the farthest point from the workspace's centre, m.
double reach_of(const std::vector<Point>& points, const Point& at) {
  double reach = 0;
  for (const Point& each : points) reach = std::max(reach, std::hypot(at[0] + each[0], at[1] + each[1]));
  return reach;
}

/// The largest share, up to 1, at which a growing reach is within `radius`.
template <class Reach>
double share_within(double radius, const Reach& reach_at) {
  double inside = 0, outside = 1;
  for (int i = 0; i < 60; ++i) {
    const double share = 0.5 * (inside + outside);
    (reach_at(share) <= radius ? inside : outside) = share;
  }
  return inside;
}

/// The place nearest to `at`, on the way to the centre, at which no point is farther than `radius`; empty if there is
/// none. It is rounded towards the centre.
std::optional<Point> place_within(const std::vector<Point>& points, const Point& at, double radius) {
  if (reach_of(points, {0, 0}) > radius) return std::nullopt;
  const double inside =
      share_within(radius, [&](double share) { return reach_of(points, {share * at[0], share * at[1]}); });
  Point place;
  for (std::size_t side = 0; side < 2; ++side) place[side] = place_step * std::trunc(inside * at[side] / place_step);
  // Rounding may turn the way a little.
  return reach_of(points, place) <= radius ? std::optional(place) : std::optional(Point{0, 0});
}

void warn_of_reach(const CheckedPatch& patch, const PatchSize& size, const DeviceProfile& device,
                   Diagnostics& diagnostics) {
  const double radius = 0.5 * device.workspace_diameter;
  // A patch wider than the workspace is told so (W0424).
  const auto& asked = patch.size ? patch.size : patch.material->patch;
  if (!device.has_position() || (asked && std::max((*asked)[0], (*asked)[1]) > device.workspace_diameter)) return;
  const auto points = farthest_points(patch, size);
  const double beyond = reach_of(points, patch.at) - radius;
  constexpr double told = 1e-6;  // m; sizes are rounded to floats
  if (beyond <= told) return;
  const auto place = place_within(points, patch.at, radius);
  Advice advice = place ? Advice(typeable("`at {:.4g} mm, {:.4g} mm` is within reach", 1e3 * (*place)[0] + 0.0,
                                          1e3 * (*place)[1] + 0.0))
                        : Advice("its corners are out of reach at every place; make it smaller");
  if (place && patch.at_span)
    advice = std::move(advice).fix(
        replace(*patch.at_span, typeable("at {:.4g} mm, {:.4g} mm", 1e3 * (*place)[0] + 0.0, 1e3 * (*place)[1] + 0.0),
                {}, false));
  diagnostics.report(
      std::move(advice)
          .fact("high", 1e3 * device.workspace_diameter, "mm")
          .about(Code::beyond_reach, patch.at_span ? *patch.at_span : patch.span,
                 readable("`{}` lies up to {:.3g} mm beyond the reach of `{}`, whose workspace is {:.4g} mm across",
                          patch.name, 1e3 * beyond, device.name, 1e3 * device.workspace_diameter)));
}

/// The area in which the patches of keys are felt.
void warn_of_reach(const CheckedKeys& keys, const DeviceProfile& device, Diagnostics& diagnostics) {
  if (!device.has_position()) return;
  const double radius = 0.5 * device.workspace_diameter;
  const auto reach = [&](double share) {
    return std::hypot(std::abs(keys.at[0]) + 0.5 * share * keys.area[0],
                      std::abs(keys.at[1]) + 0.5 * share * keys.area[1]);
  };
  const double beyond = reach(1) - radius;
  constexpr double told = 1e-6;  // m
  if (!(beyond > told)) return;
  const double fits = share_within(radius, reach);
  const auto millimetres = [&](double metres) { return 1e3 * place_step * std::trunc(fits * metres / place_step); };
  const double width = millimetres(keys.area[0]), height = millimetres(keys.area[1]);
  diagnostics.report(
      (width > 0 && height > 0 ? Advice(typeable("`area {:.4g} mm, {:.4g} mm` is within reach there", width, height))
                               : Advice("move it nearer to the centre, as in `at 0 mm, 0 mm`"))
          .fact("high", 1e3 * device.workspace_diameter, "mm")
          .about(Code::beyond_reach, keys.named.span,
                 readable("the area of `{}` lies up to {:.3g} mm beyond the reach of `{}`, whose workspace is {:.4g} mm "
                          "across",
                          keys.named.name, 1e3 * beyond, device.name, 1e3 * device.workspace_diameter)));
}

/// The size on the stage: the program's, with the rim of a workspace.
PatchSize size_of(const CheckedPatch& patch, const Program& program) {
  PatchSize size = program.default_size();
  const double shorter = std::min(size.width, size.height);
  size.rim = static_cast<float>(patch.rim.value_or(std::min(usual_rim, widest_rim * shorter)));
  return size;
}

/// What the compiler says of the material of a patch, at the patch: its author can change that, and not a file of the
/// library that the material is in.
Diagnostic of_patch(Diagnostic told, const CheckedPatch& patch, const Program* program, SourceId source) {
  if (told.code == Code::cut_patch && program) {
    const bool has_own_size = !std::holds_alternative<RectangleOutline>(patch.outline) &&
                              !std::holds_alternative<EllipseOutline>(patch.outline);
    const PatchSize size = program->default_size();
    told.help = has_own_size ? std::string("the rest cannot be felt there; make its shape smaller")
                             : typeable("the rest cannot be felt there; `size {:.4g} mm, {:.4g} mm` fits",
                                        1e3 * size.width, 1e3 * size.height);
  }
  if (told.span.source == source) return told;
  told.message = fmt::format("`{}`, made of `{}`: {}", patch.name, patch.made_of, told.message);
  told.span = patch.span;
  told.label.clear(), told.secondary.clear(), told.fixes.clear();
  if (told.code == Code::beyond_soft_range) told.help = "make the patch larger, or take another material";
  return told;
}

/// A rim that leaves nothing of a patch whose material or device gives the size; the others were checked before.
bool leaves_something(const CheckedPatch& patch, const PatchSize& size, Diagnostics& diagnostics) {
  const double most = 0.5 * std::min(size.width, size.height);
  if (patch.size || !patch.rim || *patch.rim <= most * (1 + 1e-6)) return true;
  diagnostics.report(Advice(typeable("give at most `rim {:.4g} mm`", 1e3 * most))
                         .about(Code::value_out_of_range, patch.span,
                                readable("a rim of {:.4g} mm leaves nothing of `{}`, whose shorter side is {:.4g} mm",
                                         1e3 * *patch.rim, patch.name, 2e3 * most)));
  return false;
}

glm::vec2 point_of(const Point& at) { return {static_cast<float>(at[0]), static_cast<float>(at[1])}; }

}  // namespace

Result<Shape> shape_of(const Outline& outline, const PatchSize& size) {
  if (std::holds_alternative<EllipseOutline>(outline)) return Shape::ellipse(0.5f * size.width, 0.5f * size.height);
  if (const auto* polygon = std::get_if<PolygonOutline>(&outline)) {
    std::vector<glm::vec2> corners;
    for (const Point& corner : polygon->corners) corners.push_back(point_of(corner));
    return Shape::polygon(corners);
  }
  if (const auto* mask = std::get_if<MaskOutline>(&outline)) {
    const std::vector<std::uint8_t> bits(mask->inside.begin(), mask->inside.end());
    const auto shape = Shape::mask(bits, mask->columns, mask->rows, static_cast<float>(mask->column));
    return shape ? Result<Shape>(shape->stretched({size.width, size.height})) : shape.error();
  }
  return Shape();
}

std::optional<std::vector<LaidPatch>> compile_workspace(const CheckedWorkspace& workspace, const CheckedModule& module,
                                                        const std::string& device, const SourceSet& sources,
                                                        SourceId source, Resolver& resolver, Diagnostics& diagnostics) {
  const DeviceDeclaration* declared = module.declarations().devices.find(device);
  std::map<std::tuple<std::string, double, double>, std::shared_ptr<const Program>> known;
  std::vector<LaidPatch> laid;
  bool good = true;
  for (const CheckedPatch& patch : workspace.patches) {
    const auto size = patch.size.value_or(std::array{0.0, 0.0});
    const auto [program, is_new] = known.try_emplace({patch.made_of, size[0], size[1]});
    if (is_new) {
      Diagnostics said;
      CheckedMaterial material = *patch.material;
      material.name = patch.name, material.span = patch.span;
      if (patch.size) material.patch = patch.size, material.patch_span = patch.size_span;
      auto compiled = compile_material(material, module, device, sources, source, resolver, said);
      if (compiled) program->second = std::make_shared<const Program>(*std::move(compiled));
      for (const Diagnostic& each : said.all())
        diagnostics.report(of_patch(each, patch, program->second.get(), source));
    }
    good = good && program->second;
    if (!program->second) continue;
    const PatchSize laid_size = size_of(patch, *program->second);
    if (!leaves_something(patch, laid_size, diagnostics)) {
      good = false;
      continue;
    }
    auto shape = shape_of(patch.outline, laid_size);
    if (!shape) {
      diagnostics.report(
          Advice("take a smaller picture").about(Code::unusable_shape, patch.span, shape.error().sentence));
      good = false;
      continue;
    }
    laid.push_back({&patch, program->second, laid_size, *std::move(shape)});
    if (declared) warn_of_reach(patch, laid.back().size, declared->profile, diagnostics);
  }
  if (declared)
    for (const CheckedKeys& keys : module.keys)
      if (keys.workspace.name == workspace.name) warn_of_reach(keys, declared->profile, diagnostics);
  return good ? std::optional(std::move(laid)) : std::nullopt;
}

Workspace workspace_of(const CheckedWorkspace& workspace, const std::vector<LaidPatch>& laid) {
  Workspace made{workspace.name, workspace.documentation, {}};
  const auto end_of = [](const std::optional<double>& end) {
    return end ? std::optional(static_cast<float>(*end)) : std::nullopt;
  };
  for (const LaidPatch& each : laid) {
    const CheckedPatch& patch = *each.patch;
    WorkspacePatch& to = made.patches.emplace_back(WorkspacePatch{
        patch.name,
        patch.made_of,
        *each.program,
        {.at = point_of(patch.at), .size = each.size, .layer = 0, .shape = each.shape},
    });
    for (const SliderMark& mark : patch.marks)
      to.marks.push_back({mark.slider, mark.is_percept, end_of(mark.low), end_of(mark.high), mark.says});
  }
  return made;
}

Result<const CheckedWorkspace*> find_workspace(const CheckedModule& module, const std::string& name,
                                               const std::string& file) {
  if (const CheckedWorkspace* workspace = module.workspace(name)) return workspace;
  std::vector<std::string> candidates;
  for (const CheckedWorkspace& each : module.workspaces) candidates.push_back(each.name);
  const auto near = nearest_spelling(name, candidates);
  return Error{.code = Code::unknown_workspace,
               .sentence = fmt::format("`{}` has no workspace `{}`", file, name),
               .mend = near                 ? fmt::format("did you mean `{}`?", *near)
                       : candidates.empty() ? std::string("add one, as in `workspace desk { patch board = oak }`")
                                            : fmt::format("it has `{}`", fmt::join(candidates, "`, `")),
               .place = {.name = "--workspace", .text = name}};
}

}  // namespace wale
