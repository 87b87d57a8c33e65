#include "compiler/format/align.hpp"

#include <algorithm>

namespace wale::formatting {
namespace {

/// Names longer than this do not move the values of their neighbours; one space follows them.
constexpr std::size_t widest_aligned_name = 12;
/// Lines longer than this do not move comments and descriptions.
constexpr std::size_t widest_aligned_line = 72;
constexpr std::size_t before_description = 2;
constexpr std::size_t before_comment = 3;

/// Aligns lines `begin` .. `end` at their stops.
using Run = std::vector<Line*>;

/// Puts spaces before the values of a run of lines.
void align_values(const Run& run) {
  std::size_t widest = 0;
  for (const Line* line : run)
    if (line->value.width <= widest_aligned_name) widest = std::max(widest, line->value.width);
  for (Line* line : run) {
    if (line->value.width >= widest) continue;
    const std::size_t spaces = widest - line->value.width;
    line->text.insert(line->value.at, spaces, ' ');
    if (line->description.at > line->value.at) line->description.at += spaces;
  }
}

void align_descriptions(const Run& run) {
  const auto width = [](const Line* line) {
    return line->indentation + width_of(line->text.substr(0, line->description.at - 1));
  };
  std::size_t widest = 0;
  for (const Line* line : run)
    if (line->description.at > 0 && width(line) <= widest_aligned_line) widest = std::max(widest, width(line));
  for (Line* line : run) {
    if (line->description.at == 0) continue;
    const std::size_t spaces = std::max(widest, width(line)) - width(line) + before_description - 1;
    line->text.insert(line->description.at, spaces, ' ');
  }
}

void align_comments(const Run& run) {
  const auto width = [](const Line* line) { return line->indentation + width_of(line->text); };
  std::size_t widest = 0;
  for (const Line* line : run)
    if (!line->comment.empty() && width(line) <= widest_aligned_line) widest = std::max(widest, width(line));
  for (Line* line : run) {
    if (line->comment.empty()) continue;
    line->text.append(std::max(widest, width(line)) - width(line) + before_comment, ' ').append(line->comment);
  }
}

/// Finds runs of lines: `joins` says whether a line with a stop may be in the run of the line before, `ends` whether a
/// line ends the run.
template <class Has, class Joins, class Ends, class Align>
void for_each_run(std::vector<Line>& lines, Has has, Joins joins, Ends ends, Align align) {
  Run run;
  for (Line& line : lines) {
    if (!run.empty() && (ends(line) || (has(line) && !joins(*run.back(), line)))) {
      align(run);
      run.clear();
    }
    if (has(line)) run.push_back(&line);
  }
  if (!run.empty()) align(run);
}

}  // namespace

std::string aligned(std::vector<Line> lines) {
  const auto has_value = [](const Line& line) { return line.value.at > 0; };
  const auto same_kind = [](const Line& a, const Line& b) { return a.value.of == b.value.of; };
  const auto ends_block = [](const Line& line) { return line.opens_block || line.closes_block; };
  const auto is_setting = [&](const Line& line) { return has_value(line) && line.value.of == "setting"; };
  const auto is_declaration = [&](const Line& line) { return has_value(line) && line.value.of != "setting"; };
  const auto ends_paragraph = [&](const Line& line) {
    const bool other = line.begins_row && !has_value(line) && !line.only_comments;
    return line.blank_before || other || ends_block(line);
  };
  for_each_run(lines, is_setting, same_kind, ends_block, align_values);
  for_each_run(lines, is_declaration, same_kind, ends_paragraph, [](const Run& run) {
    align_values(run);
    align_descriptions(run);
  });
  const auto any = [](const Line& line) { return !line.only_comments; };
  const auto neighbours = [](const Line& a, const Line&) { return !a.opens_block && !a.closes_block; };
  const auto ends_comments = [&](const Line& line) {
    return line.blank_before || line.only_comments || ends_block(line);
  };
  for_each_run(lines, any, neighbours, ends_comments, align_comments);

  std::string text;
  for (const Line& line : lines) {
    if (line.blank_before) text += '\n';
    text.append(line.indentation, ' ').append(line.text) += '\n';
  }
  return text;
}

}  // namespace wale::formatting
