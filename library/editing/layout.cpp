#include "library/editing/layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/compile_workspace.hpp"
#include "library/editing/comments.hpp"

namespace wale {
namespace {

std::string_view part_of(std::string_view text, Span span) { return text.substr(span.begin, span.end - span.begin); }

const Setting* setting_in(const PlacedPatch& patch, std::string_view key) {
  const auto found = std::ranges::find(patch.settings, key, [](const Setting& each) { return each.key.text; });
  return found == patch.settings.end() ? nullptr : &*found;
}

Span span_of(const PlacedStatement& placed) {
  return std::visit([](const auto& statement) { return statement.span; }, placed);
}

double unit_in_si(const Declarations& declarations, const std::string& unit) {
  const Unit* found = declarations.units.find(unit);
  return found ? found->factor : 1;
}

/// The outline in its own size.
Result<Shape> outline_of(const Outline& outline) {
  PatchSize size{1, 1, 0};
  if (const auto* mask = std::get_if<MaskOutline>(&outline))
    size = {static_cast<float>(mask->columns * mask->column), static_cast<float>(mask->rows * mask->row), 0};
  return shape_of(outline, size);
}

/// A patch without an error, as its author wrote it.
LaidOutPatch laid_out(const PlacedPatch& placed, const CheckedPatch& checked, const CheckedModule& module,
                      std::string_view text) {
  LaidOutPatch patch{.name = checked.name,
                     .made_of = checked.made_of,
                     .at = {checked.at[0], checked.at[1]},
                     .at_is_written = setting_in(placed, "at") != nullptr,
                     .rim = checked.rim};
  if (setting_in(placed, "size") && checked.size)
    patch.size = glm::dvec2((*checked.size)[0], (*checked.size)[1]);
  if (const Setting* shape = setting_in(placed, "shape"); shape && !shape->items.empty())
    patch.shape = part_of(text, shape->items.front().span);
  if (patch.shape == "rectangle") patch.shape.clear();
  if (auto outline = outline_of(checked.outline)) patch.outline = *std::move(outline);
  for (const SliderMark& each : checked.marks) {
    LaidOutMark mark{.mark = {.slider = each.slider, .is_percept = each.is_percept, .says = each.says},
                     .unit = each.unit,
                     .unit_in_si = unit_in_si(module.declarations(), each.unit)};
    if (each.low) mark.mark.low = static_cast<float>(*each.low);
    if (each.high) mark.mark.high = static_cast<float>(*each.high);
    patch.marks.push_back(std::move(mark));
  }
  return patch;
}

/// Where the documentation of a declaration begins that itself begins at `at`.
std::size_t with_documentation(std::string_view text, std::size_t at) {
  for (;;) {
    const std::size_t line = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;  // npos + 1 is 0
    if (line == 0) return at;
    const std::size_t above = line < 2 ? 0 : text.rfind('\n', line - 2) + 1;
    std::string_view words = text.substr(above, line - 1 - above);
    words.remove_prefix(std::min(words.find_first_not_of(" \t"), words.size()));
    if (!words.starts_with("///")) return at;
    at = line - words.size() - 1;
  }
}

/// Adds the patches that a picture lays out.
void add_areas(Span picture, const CheckedWorkspace& checked, Layout& layout) {
  for (const CheckedPatch& each : checked.patches) {
    if (each.statement.begin < picture.begin || each.statement.end > picture.end) continue;
    LaidOutPatch area{.name = each.name, .made_of = each.made_of, .at = {each.at[0], each.at[1]}, .rim = each.rim};
    if (auto outline = outline_of(each.outline)) area.outline = *std::move(outline);
    area.is_of_picture = true;
    layout.patches.push_back(std::move(area));
  }
}

Layout layout_of(const WorkspaceDecl& declared, const CheckedModule& module, std::string_view text) {
  Layout layout{.name = std::string(declared.name.text),
                .documentation = std::string(declared.documentation),
                .begin = with_documentation(text, declared.span.begin),
                .end = declared.span.end};
  const CheckedWorkspace* checked = module.workspace(layout.name);
  // The statements begin behind the `{`.
  std::size_t at = text.find('{', declared.span.begin) + 1;
  const std::size_t limit = declared.span.end;
  for (const PlacedStatement& placed : declared.placed) {
    const std::size_t begin = std::max<std::size_t>(span_of(placed).begin, at);
    const std::size_t end = std::max<std::size_t>(span_of(placed).end, begin);
    const std::string before = comments_in(text.substr(at, begin - at));
    const auto* written = std::get_if<PlacedPatch>(&placed);
    const auto found = [&]() -> const CheckedPatch* {
      if (!written || !checked) return nullptr;
      const auto name = written->material.name.text;
      const auto each = std::ranges::find(checked->patches, name,
                                          [](const CheckedPatch& patch) -> std::string_view { return patch.name; });
      return each == checked->patches.end() ? nullptr : &*each;
    }();
    const std::size_t line = end + end_of_line(text.substr(end, limit - end));
    const std::string behind = comments_in(text.substr(end, line - end));
    LaidOutPatch patch;
    if (found) {
      patch = laid_out(*written, *found, module, text);
      patch.inside = comments_in(text.substr(begin, end - begin)) + behind;
      patch.on_one_line = text.substr(begin, end - begin).find('\n') == std::string_view::npos;
    } else {
      if (written) patch.name = written->material.name.text;
      patch.verbatim = text.substr(begin, (behind.empty() ? end : line) - begin);
    }
    patch.before = before;
    layout.patches.push_back(std::move(patch));
    if (!written && checked) add_areas(span_of(placed), *checked, layout);
    at = behind.empty() ? end : line;
  }
  if (limit > at) layout.trailing = comments_in(text.substr(at, limit - at - 1));
  return layout;
}

/// A length in mm: to a nanometre, without the noise of binary fractions.
std::string millimetres(double metres) {
  const double rounded = std::round(metres * 1e9) / 1e6;
  return fmt::format("{} mm", rounded == 0 ? 0.0 : rounded);
}

std::string in_quotes(std::string_view text) {
  std::string quoted = "\"";
  for (const char each : text) {
    if (each == '\n') quoted += "\\n";
    else if (each == '"' || each == '\\') quoted += std::string("\\") + each;
    else quoted += each;
  }
  return quoted + "\"";
}

std::string mark_text(const LaidOutMark& mark) {
  std::string text = "mark " + mark.mark.slider;
  for (const auto& [word, end] : {std::pair{"low", mark.mark.low}, {"high", mark.mark.high}})
    if (end)
      text += fmt::format(", {} {:.6g}{}", word, *end / mark.unit_in_si, mark.unit.empty() ? "" : " " + mark.unit);
  if (!mark.mark.says.empty()) text += ", " + in_quotes(mark.mark.says);
  return text;
}

/// Lines, each two columns in.
std::string indented(std::string_view lines, std::string_view by) {
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = end_of_line(lines);
    text += std::string(by) + std::string(lines.substr(0, end)) + "\n";
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return text;
}

std::string patch_text(const LaidOutPatch& patch) {
  std::string text = indented(patch.before, "  ");
  if (!patch.verbatim.empty()) return text + "  " + patch.verbatim + "\n";
  std::vector<std::pair<std::string, std::string>> settings;
  if (patch.at_is_written || patch.at != glm::dvec2(0))
    settings.emplace_back("at", millimetres(patch.at.x) + ", " + millimetres(patch.at.y));
  if (patch.size) settings.emplace_back("size", millimetres(patch.size->x) + ", " + millimetres(patch.size->y));
  if (!patch.shape.empty()) settings.emplace_back("shape", patch.shape);
  if (patch.rim) settings.emplace_back("rim", millimetres(*patch.rim));
  text += fmt::format("  patch {} = {}", patch.name, patch.made_of);
  if (settings.empty() && patch.marks.empty() && patch.inside.empty()) return text + "\n";
  std::vector<std::string> lines;
  for (const auto& [key, value] : settings) lines.push_back(key + " " + value);
  for (const LaidOutMark& mark : patch.marks) lines.push_back(mark_text(mark));
  if (patch.on_one_line && patch.inside.empty()) return text + fmt::format(" {{ {} }}\n", fmt::join(lines, "; "));
  text += " {\n" + indented(patch.inside, "    ");
  for (const std::string& line : lines) text += "    " + line + "\n";
  return text + "  }\n";
}

}  // namespace

std::vector<Layout> layouts_in(const SyntaxTree& tree, const CheckedModule& module, std::string_view text) {
  std::vector<Layout> layouts;
  for (const Declaration& each : tree.declarations)
    if (const auto* workspace = std::get_if<WorkspaceDecl>(&each)) layouts.push_back(layout_of(*workspace, module, text));
  return layouts;
}

std::string layout_text(const Layout& layout) {
  std::string text;
  std::string_view lines = layout.documentation;
  while (!lines.empty()) {
    const std::size_t end = end_of_line(lines);
    text += "/// " + std::string(lines.substr(0, end)) + "\n";
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  text += "workspace " + layout.name + " {\n";
  for (const LaidOutPatch& each : layout.patches)
    if (!each.is_of_picture) text += patch_text(each);
  return text + indented(layout.trailing, "  ") + "}";
}

}  // namespace wale
