#include "library/editing/layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/compile_workspace.hpp"
#include "compiler/format/format.hpp"
#include "library/editing/comments.hpp"
#include "library/editing/kept_text.hpp"

namespace wale {
namespace {

std::string_view part_of(std::string_view text, Span span) { return text.substr(span.begin, span.end - span.begin); }

const Setting* setting_in(const PatchPlacing& patch, std::string_view key) {
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
LaidOutPatch laid_out(const PatchPlacing& placed, const CheckedPatch& checked, const CheckedModule& module,
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

SettingLines setting_lines(const LaidOutPatch& patch);

/// A statement of a workspace in its text: from `at`, where the one before it ended, to `next`, where it ends itself
/// with its comment.
std::shared_ptr<const WrittenPatch> written_of(const PlacedStatement& placed, const LaidOutPatch& patch,
                                               const SyntaxTree& tree, std::string_view text, std::size_t at,
                                               std::size_t next) {
  const Span span = span_of(placed);
  const std::size_t begin = std::max<std::size_t>(span.begin, at);
  auto written = std::make_shared<WrittenPatch>();
  written->lead = text.substr(at, begin - at), written->text = text.substr(begin, next - begin);
  written->before = patch.before, written->inside = patch.inside, written->verbatim = patch.verbatim;
  const auto* statement = std::get_if<PatchPlacing>(&placed);
  if (!statement || !patch.verbatim.empty()) return written;
  const auto part = [&](const std::string& key, Span of, const std::string& says) {
    written->parts.push_back({key, says, of.begin - begin, of.end - begin});
  };
  written->end = span.end - begin;
  written->settings = setting_lines(patch);
  part("name", statement->material.name.span, patch.name);
  if (statement->material.derived_from) part("made_of", tree.span(*statement->material.derived_from), patch.made_of);
  std::vector<bool> told(written->settings.size(), false);
  for (const Setting& each : statement->settings) {
    const std::string key(each.key.text);
    std::string says;
    for (std::size_t i = 0; i < told.size() && says.empty(); ++i)
      if (!told[i] && written->settings[i].first == key) told[i] = true, says = written->settings[i].second;
    part(key, each.span, says);
  }
  written->has_braces = written->text.substr(0, written->end).ends_with('}');
  return written;
}

Layout layout_of(const WorkspaceDecl& declared, const CheckedModule& module, const SyntaxTree& tree,
                 std::string_view text) {
  Layout layout{.name = std::string(declared.name.text),
                .documentation = std::string(declared.documentation),
                .begin = with_documentation(text, declared.span.begin),
                .end = declared.span.end};
  const CheckedWorkspace* checked = module.workspace(layout.name);
  // The statements begin behind the `{`.
  std::size_t at = text.find('{', declared.span.begin) + 1;
  auto kept = std::make_shared<WrittenLayout>();
  kept->head = text.substr(layout.begin, at - layout.begin);
  const std::size_t limit = declared.span.end;
  for (const PlacedStatement& placed : declared.placed) {
    const std::size_t begin = std::max<std::size_t>(span_of(placed).begin, at);
    const std::size_t end = std::max<std::size_t>(span_of(placed).end, begin);
    const std::string before = comments_in(text.substr(at, begin - at));
    const auto* written = std::get_if<PatchPlacing>(&placed);
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
    patch.written = written_of(placed, patch, tree, text, at, behind.empty() ? end : line);
    kept->patches.push_back(patch.written);
    layout.patches.push_back(std::move(patch));
    if (!written && checked) add_areas(span_of(placed), *checked, layout);
    at = behind.empty() ? end : line;
  }
  if (limit > at) layout.trailing = comments_in(text.substr(at, limit - at - 1));
  kept->rest = text.substr(at, std::max(limit, at) - at);
  kept->name = layout.name, kept->documentation = layout.documentation, kept->trailing = layout.trailing;
  // Without its brace at the end it is a text with an error.
  if (kept->rest.ends_with('}')) layout.written = std::move(kept);
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

SettingLines setting_lines(const LaidOutPatch& patch) {
  SettingLines lines;
  const auto line = [&](const std::string& key, const std::string& value) {
    lines.emplace_back(key, key + " " + value);
  };
  if (patch.at_is_written || patch.at != glm::dvec2(0))
    line("at", millimetres(patch.at.x) + ", " + millimetres(patch.at.y));
  if (patch.size) line("size", millimetres(patch.size->x) + ", " + millimetres(patch.size->y));
  if (!patch.shape.empty()) line("shape", patch.shape);
  if (patch.rim) line("rim", millimetres(*patch.rim));
  for (const LaidOutMark& mark : patch.marks) lines.emplace_back("mark", mark_text(mark));
  return lines;
}

std::string patch_text(const LaidOutPatch& patch) {
  std::string text = indented(patch.before, "  ");
  if (!patch.verbatim.empty()) return text + "  " + patch.verbatim + "\n";
  text += fmt::format("  patch {} = {}", patch.name, patch.made_of);
  std::vector<std::string> lines;
  for (const auto& [key, line] : setting_lines(patch)) lines.push_back(line);
  if (lines.empty() && patch.inside.empty()) return text + "\n";
  if (patch.on_one_line && patch.inside.empty()) return text + fmt::format(" {{ {} }}\n", fmt::join(lines, "; "));
  text += " {\n" + indented(patch.inside, "    ");
  for (const std::string& line : lines) text += "    " + line + "\n";
  return text + "  }\n";
}

/// The line that begins a workspace, with its documentation.
std::string head_text(const Layout& layout) {
  std::string text;
  std::string_view lines = layout.documentation;
  while (!lines.empty()) {
    const std::size_t end = end_of_line(lines);
    text += "/// " + std::string(lines.substr(0, end)) + "\n";
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return text + "workspace " + layout.name + " {";
}

/// A workspace in the standard style, with `lines` in it.
std::string standard_workspace(const std::string& head, const std::string& lines) {
  static const std::string header = "wale 1\n\n";
  std::string text = head + "\n" + lines + "}";
  SourceSet sources;
  Diagnostics diagnostics;
  const auto formatted = format(sources, sources.add("workspace", header + text + "\n"), diagnostics);
  if (!formatted || !formatted->starts_with(header)) return text;
  text = formatted->substr(header.size());
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

/// One patch in the standard style, behind the line before it.
std::string standard_patch(const LaidOutPatch& patch) {
  const std::string head = "workspace w {", text = standard_workspace(head, patch_text(patch));
  return text.substr(head.size(), text.size() - head.size() - 2);  // without the last "\n}"
}

}  // namespace

std::vector<Layout> layouts_in(const SyntaxTree& tree, const CheckedModule& module, std::string_view text) {
  std::vector<Layout> layouts;
  for (const Declaration& each : tree.declarations)
    if (const auto* workspace = std::get_if<WorkspaceDecl>(&each))
      layouts.push_back(layout_of(*workspace, module, tree, text));
  return layouts;
}

std::string layout_text(const Layout& layout) {
  const WrittenLayout* written = layout.written.get();
  if (!written) {
    std::string lines;
    for (const LaidOutPatch& each : layout.patches)
      if (!each.is_of_picture) lines += patch_text(each);
    return standard_workspace(head_text(layout), lines + indented(layout.trailing, "  "));
  }
  const bool same_head = layout.name == written->name && layout.documentation == written->documentation;
  std::string text = same_head ? written->head : head_text(layout);
  const WrittenPatch* before = nullptr;  // the statement that the text ends with, if it was read
  const auto followed = [&](const WrittenPatch* next) {
    const auto& all = written->patches;
    const auto place = [&](const WrittenPatch* of) {
      return std::ranges::find(all, of, [](const auto& each) { return each.get(); });
    };
    const auto first = before ? place(before) : all.end();
    if (!before) return all.empty() ? next == nullptr : next == all.front().get();
    if (first == all.end()) return false;
    return first + 1 == all.end() ? next == nullptr : next == (first + 1)->get();
  };
  bool kept_before = same_head;
  for (const LaidOutPatch& each : layout.patches) {
    if (each.is_of_picture) continue;
    std::string piece = each.written ? edited(*each.written, each, setting_lines(each)) : std::string();
    const bool kept = !piece.empty();
    if (!kept) piece = standard_patch(each);
    // On the line of another statement it may stand only behind the one that it stood behind.
    const bool in_place = kept && kept_before && followed(each.written.get());
    if (!in_place && !begins_a_line(piece)) piece = "\n  " + piece;
    text += piece;
    before = kept ? each.written.get() : nullptr, kept_before = kept;
  }
  if (layout.trailing != written->trailing) return text + "\n" + indented(layout.trailing, "  ") + "}";
  const bool in_place = kept_before && followed(nullptr);
  return text + (in_place || begins_a_line(written->rest) ? "" : "\n") + written->rest;
}

}  // namespace wale
