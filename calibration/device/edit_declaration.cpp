#include "calibration/device/edit_declaration.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>

#include "compiler/parse/parse.hpp"

namespace wale {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The part of the text that a setting takes: its whole line with the comment after it, where it is alone there.
std::pair<std::size_t, std::size_t> part_of(std::string_view text, const Span& span) {
  std::size_t begin = span.begin, end = span.end;
  while (begin > 0 && is_blank(text[begin - 1])) --begin;
  const bool begins_line = begin == 0 || text[begin - 1] == '\n';
  while (end < text.size() && is_blank(text[end])) ++end;
  const bool parts_others = end < text.size() && text[end] == ';';
  if (parts_others) ++end;
  while (end < text.size() && is_blank(text[end])) ++end;
  const bool is_comment = text.substr(end).starts_with("//");
  if (begins_line && is_comment) end = std::min(text.find('\n', end), text.size());
  if (begins_line && (end == text.size() || text[end] == '\n')) return {begin, std::min(end + 1, text.size())};
  return {span.begin, end};
}

/// The key of a line that is a setting.
std::string_view key_of(std::string_view setting) { return setting.substr(0, setting.find(' ')); }

}  // namespace

Result<std::string> with_settings(const std::string& bytes, const std::string& name,
                                  const std::vector<std::string>& settings, const std::vector<std::string>& also) {
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add("devices.wale", bytes);
  const SyntaxTree tree = parse(sources, source, diagnostics);
  if (diagnostics.has_errors())
    return Error{.code = Code::malformed_value, .sentence = "the file has errors", .mend = "`wale check` shows them"};
  const RecordDecl* record = nullptr;
  for (const auto& declaration : tree.declarations)
    if (const auto* each = std::get_if<RecordDecl>(&declaration))
      if (each->keyword.text == "device" && each->name.text == name) record = each;
  if (record == nullptr || record->settings.empty())
    return Error{.code = Code::unknown_device, .sentence = "the file declares no device `" + name + "`"};

  const auto goes = [&](std::string_view key) {
    return std::ranges::any_of(settings, [&](const std::string& each) { return key_of(each) == key; }) ||
           std::ranges::find(also, key) != also.end();
  };
  std::string text = bytes;
  // From the end on, so that the places before stay true. The new lines follow the last setting.
  const std::uint32_t last = record->settings.back().span.end;
  std::size_t line_end = std::min(bytes.find('\n', last), bytes.size());
  std::string lines;
  for (const std::string& each : settings) lines += "\n  " + each;
  if (const std::size_t brace = bytes.find('}', last); brace < line_end) {  // `source "…" }`
    line_end = last;
    lines += "\n";
  }
  text.insert(line_end, lines);
  for (auto setting = record->settings.rbegin(); setting != record->settings.rend(); ++setting) {
    if (!goes(setting->key.text)) continue;
    const auto [begin, end] = part_of(std::string_view(bytes).substr(0, line_end), setting->span);
    text.erase(begin, end - begin);
  }
  return text;
}

}  // namespace wale
