#include <algorithm>
#include <nlohmann/json.hpp>

#include "compiler/diagnostics/render.hpp"
#include "compiler/text/json_text.hpp"

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

/// Adds a span's fields to an object; a span without a source adds nothing.
void add_span(Json& object, Span span, const SourceSet& sources) {
  if (span.source >= sources.size()) return;
  const LineColumn begin = sources.place(span);
  const LineColumn end = sources.place({span.source, span.end, span.end});
  object["file"] = sources[span.source].name;
  object["line"] = begin.line;
  object["column"] = begin.column;
  object["end_line"] = end.line;
  object["end_column"] = end.column;
  object["begin_byte"] = span.begin;
  object["end_byte"] = span.end;
}

Json json_of(const Fact& fact, const SourceSet& sources) {
  Json object = {{"name", fact.name}};
  if (const auto* text = std::get_if<std::string>(&fact.value)) {
    object["text"] = *text;
  } else if (const auto* number = std::get_if<NumberWithUnit>(&fact.value)) {
    object["value"] = number->value;
    object["unit"] = number->unit;
  } else {
    add_span(object, std::get<Span>(fact.value), sources);
  }
  return object;
}

Json json_of(const Fix& fix, const SourceSet& sources) {
  Json edits = Json::array();
  for (const Edit& edit : fix.edits) {
    Json object = Json::object();
    add_span(object, edit.span, sources);
    object["replacement"] = edit.replacement;
    edits.push_back(std::move(object));
  }
  return {{"title", fix.title}, {"safe", fix.safe}, {"edits", std::move(edits)}};
}

Json json_of(const Diagnostic& diagnostic, const SourceSet& sources) {
  Json object = {{"code", code_name(diagnostic.code)}, {"severity", severity_name(severity_of(diagnostic.code))}};
  add_span(object, diagnostic.span, sources);
  const auto add = [&](const char* name, const std::string& text) {
    if (!text.empty()) object[name] = text;
  };
  object["message"] = diagnostic.message;
  add("label", diagnostic.label);
  add("expected", diagnostic.expected);
  add("found", diagnostic.found);
  add("cause", diagnostic.cause);
  add("rule", diagnostic.rule);
  add("help", diagnostic.help);
  for (const SecondarySpan& each : diagnostic.secondary) {
    Json secondary = Json::object();
    add_span(secondary, each.span, sources);
    if (!each.label.empty()) secondary["label"] = each.label;
    object["secondary"].push_back(std::move(secondary));
  }
  for (const Fact& each : diagnostic.facts) object["facts"].push_back(json_of(each, sources));
  for (const Fix& each : diagnostic.fixes) object["fixes"].push_back(json_of(each, sources));
  return object;
}

}  // namespace

std::string render_json(const Diagnostics& diagnostics, const SourceSet& sources) {
  Json list = Json::array();
  for (const Diagnostic& each : diagnostics.all()) list.push_back(json_of(each, sources));
  std::string text = json_lines(list);
  text.pop_back();
  return text;
}

}  // namespace wale
