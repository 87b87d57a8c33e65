#include "compiler/check/check_workspace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "compiler/check/check_material.hpp"
#include "compiler/check/check_picture.hpp"
#include "compiler/parse/made_from.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

/// The settings of a patch, each of which may stand once, and `mark`.
const std::vector<std::string> placements = {"at", "size", "shape", "rim", "mark"};
constexpr const char* example_of_at = "write, for example, `at -50 mm, 20 mm`";
constexpr const char* example_of_size = "write, for example, `size 80 mm, 60 mm`";
constexpr const char* example_of_rim = "write, for example, `rim 1 mm`";

class WorkspaceChecker {
 public:
  WorkspaceChecker(const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings, bool whole)
      : tree_(*declared.tree),
        declared_(declared),
        surroundings_(surroundings),
        whole_(whole),
        checker_(surroundings, terms_, tables_) {}

  CheckedWorkspace check() {
    const WorkspaceDecl& node = *declared_.node;
    workspace_.name = node.name.text;
    workspace_.documentation = node.documentation;
    workspace_.span = node.name.span;
    workspace_.statement = node.span;
    for (const PlacedStatement& placed : node.placed)
      if (const auto* patch = std::get_if<PatchPlacing>(&placed)) own_names_.emplace(patch->material.name.text);
    for (const PlacedStatement& placed : node.placed) {
      if (const auto* patch = std::get_if<PatchPlacing>(&placed))
        check(*patch);
      else
        check(std::get<PicturePlacing>(placed));
    }
    return std::move(workspace_);
  }

 private:
  /// The material of a patch. Thousands of patches may be made of the same words: they are checked once if they are
  /// right, and each time if they are not, so that each patch has its errors.
  std::shared_ptr<const CheckedMaterial> checked(const MaterialDecl& material, const std::string& made_of) {
    const auto [known, is_new] = materials_.try_emplace(made_of);
    if (!is_new) return known->second;
    const std::size_t errors_before = surroundings_.diagnostics.error_count();
    auto made = std::make_shared<const CheckedMaterial>(
        check_material({&tree_, &material, declared_.home}, surroundings_, whole_));
    if (surroundings_.diagnostics.error_count() == errors_before)
      known->second = made;
    else
      materials_.erase(known);
    return made;
  }

  void check(const PatchPlacing& node) {
    const Word& name = node.material.name;
    const auto [first, is_new] = names_.emplace(std::string(name.text), name.span);
    if (!is_new)
      return report(Code::declared_twice, name.span,
                    fmt::format("`{}` has two patches `{}`", workspace_.name, name.text),
                    Advice("give one of them another name").see(first->second, "the first one"));
    const std::size_t errors_before = surroundings_.diagnostics.error_count();
    CheckedPatch patch;
    patch.statement = node.span;
    patch.made_of_span = tree_.span(*node.material.derived_from);
    patch.made_of = surroundings_.sources.text(patch.made_of_span);
    patch.name = name.text, patch.name_span = name.span;
    patch.span = node.material.span;
    patch.material = checked(node.material, patch.made_of);
    settings_.clear();
    outlined_.reset();
    for (const Setting& setting : node.settings) read(setting, patch);
    check_rim(patch);
    if (surroundings_.diagnostics.error_count() == errors_before) workspace_.patches.push_back(std::move(patch));
  }

  void read(const Setting& setting, CheckedPatch& patch) {
    const std::string key(setting.key.text);
    patch.settings.emplace_back(key, setting.span);
    if (std::ranges::find(placements, key) == placements.end())
      return report(Code::unknown_setting, setting.key.span, fmt::format("a patch of a workspace has no `{}`", key),
                    did_you_mean(setting.key.span, key, placements, "it has: at, size, shape, rim, mark"));
    if (setting.on)
      return report(Code::unexpected_token, setting.on->span, "a patch lies on every device at the same place",
                    "leave out `on` and the device");
    if (key == "mark") {
      if (auto mark = check_mark(setting, patch, declared_, surroundings_)) patch.marks.push_back(*std::move(mark));
      return;
    }
    const auto [first, is_new] = settings_.emplace(key, setting.key.span);
    if (!is_new)
      return report(Code::declared_twice, setting.key.span, fmt::format("`{}` is set twice", key),
                    Advice("keep one of them").see(first->second, "set here first"));
    if (key == "at") return read_place(setting, patch);
    if (key == "size") return read_size(setting, patch);
    if (key == "rim") return read_rim(setting, patch);
    if (setting.items.size() != 1)
      return report(Code::wrong_type, setting.span, "a patch has one shape",
                    "write, for example, `shape ellipse`, or `shape polygon(-20 mm, 0 mm, 20 mm, 0 mm, 0 mm, 30 mm)`");
    if (check_shape(setting.items.front(), declared_, surroundings_, patch)) gives_size(setting, patch);
  }

  void read_place(const Setting& setting, CheckedPatch& patch) {
    const auto place = lengths(setting, 2, "a patch lies at two lengths: to the right and up", example_of_at);
    if (!place) return;
    patch.at = {(*place)[0], (*place)[1]};
    patch.at_span = setting.span;
  }

  void read_size(const Setting& setting, CheckedPatch& patch) {
    const auto sides = lengths(setting, 2, "a size is a width and a height", example_of_size);
    if (!sides) return;
    for (std::size_t side = 0; side < 2; ++side)
      if (!((*sides)[side] > 0))
        return report(Code::value_out_of_range, setting.items[side].span,
                      "the sides of a patch must be greater than zero", example_of_size);
    if (outlined_) return two_sizes(*outlined_, setting.span);
    patch.size = std::array{(*sides)[0], (*sides)[1]};
    patch.size_span = setting.span;
  }

  void read_rim(const Setting& setting, CheckedPatch& patch) {
    const auto rim = lengths(setting, 1, "a rim is one length", example_of_rim);
    if (!rim) return;
    if ((*rim)[0] < 0)
      return report(Code::value_out_of_range, setting.items[0].span, "a rim cannot be narrower than 0", example_of_rim);
    patch.rim = (*rim)[0];
    rim_span_ = setting.items[0].span;
  }

  /// A polygon and a mask have a size of their own.
  void gives_size(const Setting& setting, CheckedPatch& patch) {
    if (std::holds_alternative<RectangleOutline>(patch.outline) ||
        std::holds_alternative<EllipseOutline>(patch.outline))
      return;
    outlined_ = setting.span;
    patch.size_span = setting.span;
    if (const auto size = settings_.find("size"); size != settings_.end()) two_sizes(setting.span, size->second);
  }

  void two_sizes(Span shape, Span size) {
    report(Code::declared_twice, size, "the shape gives the size already",
           Advice("leave `size` out, or change the corners of the polygon or the scale of the mask")
               .see(shape, "this shape has a size of its own"));
  }

  void check_rim(const CheckedPatch& patch) {
    const auto& size = patch.size ? patch.size : patch.material->patch;
    if (!patch.rim || !size) return;
    const double most = 0.5 * std::min((*size)[0], (*size)[1]);
    if (*patch.rim <= most) return;
    report(Code::value_out_of_range, rim_span_,
           readable("a rim of {:.4g} mm leaves nothing of a patch whose shorter side is {:.4g} mm", 1e3 * *patch.rim,
                    2e3 * most),
           typeable("give at most `rim {:.4g} mm`", 1e3 * most));
  }

  /// The values of a setting that is so many lengths, in m. Empty after an error, which is reported.
  std::optional<std::vector<double>> lengths(const Setting& setting, std::size_t count, const char* rule,
                                             const char* example) {
    const auto is_value = [](const SettingItem& item) {
      return item.value && item.words.empty() && item.trailing.empty() && !item.range_end && !item.equals;
    };
    if (setting.items.size() != count || !std::ranges::all_of(setting.items, is_value)) {
      report(Code::wrong_type, setting.span, rule, example);
      return std::nullopt;
    }
    std::vector<double> values;
    for (const SettingItem& item : setting.items) {
      Scope scope;
      const auto value = checker_.constant(tree_, *item.value, scope, surroundings_.declarations.dimension("length"));
      if (!value) return std::nullopt;
      values.push_back(*value);
    }
    return values;
  }

  /// Each colour of the picture is a patch. It has the name of its material, with a number where that is taken.
  void check(const PicturePlacing& node) {
    for (ColouredArea& area : check_picture(node, declared_, surroundings_)) {
      const std::size_t errors_before = surroundings_.diagnostics.error_count();
      const std::string name = free_name(area.material);
      names_.emplace(name, area.colour_span);
      MaterialDecl material;
      material.name = {name, area.colour_span};
      material.derived_from = area.material;
      material.span = area.statement;
      CheckedPatch patch;
      patch.statement = area.statement;
      patch.made_of_span = tree_.span(area.material);
      patch.made_of = surroundings_.sources.text(patch.made_of_span);
      patch.name = name, patch.name_span = area.colour_span;
      patch.span = material.span;
      patch.material = checked(material, patch.made_of);
      patch.size = std::array{area.outline.column * static_cast<double>(area.outline.columns),
                              area.outline.row * static_cast<double>(area.outline.rows)};
      patch.size_span = area.colour_span;
      patch.at = area.at;
      patch.rim = area.rim;
      patch.outline = std::move(area.outline);
      rim_span_ = area.colour_span;
      check_rim(patch);
      if (surroundings_.diagnostics.error_count() == errors_before) workspace_.patches.push_back(std::move(patch));
    }
  }

  /// "brick" for `brick` and `brick(roughness: 0.3)`, "wet_glass" for `"wet glass"`; "area" for others.
  std::string free_name(ExprId material) const {
    const auto words = made_from(material, tree_);
    std::string name;
    if (words.size() == 1)
      for (const char c : words.front().text)
        name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9' && !name.empty()) ? c : '_';
    if (name.find_first_not_of('_') == std::string::npos) name = "area";
    const auto is_taken = [&](const std::string& each) { return names_.contains(each) || own_names_.contains(each); };
    std::string free = name;
    for (int number = 2; is_taken(free); ++number) free = fmt::format("{}_{}", name, number);
    return free;
  }

  void report(Code code, Span span, std::string message, Advice advice) {
    surroundings_.diagnostics.report(std::move(advice).about(code, span, std::move(message)));
  }

  const SyntaxTree& tree_;
  const Declared<WorkspaceDecl>& declared_;
  const Surroundings& surroundings_;
  bool whole_;
  Terms terms_;
  std::vector<HeightTable> tables_;
  ExpressionChecker checker_;
  CheckedWorkspace workspace_;
  std::map<std::string, std::shared_ptr<const CheckedMaterial>> materials_;  ///< by their words
  std::map<std::string, Span, std::less<>> names_;  ///< of the patches so far
  std::set<std::string, std::less<>> own_names_;    ///< of all patches that have names in the text
  std::map<std::string, Span> settings_;            ///< of this patch so far
  std::optional<Span> outlined_;                    ///< the polygon or mask of this patch
  Span rim_span_;
};

}  // namespace

CheckedWorkspace check_workspace(const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings,
                                 bool whole) {
  return WorkspaceChecker(declared, surroundings, whole).check();
}

}  // namespace wale
