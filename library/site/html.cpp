#include "library/site/html.hpp"

#include "schema/visible_text.hpp"

namespace wale {
namespace {

void replace_all(std::string& text, std::string_view sought, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(sought, at)) != std::string::npos; at += by.size())
    text.replace(at, sought.size(), by);
}

}  // namespace

Markup trusted_markup(std::string text) {
  Markup markup;
  markup.text_ = std::move(text);
  return markup;
}

std::string escaped(std::string_view text, bool lines) {
  const std::string visible = lines ? visible_lines(text) : visible_text(text);
  std::string safe;
  safe.reserve(visible.size() + visible.size() / 16);
  for (const char each : visible) {
    switch (each) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '"': safe += "&quot;"; break;
      case '\'': safe += "&#39;"; break;
      default: safe += each;
    }
  }
  return safe;
}

Markup joined(const std::vector<Markup>& parts, Template between) {
  std::string all;
  for (const Markup& part : parts) {
    if (&part != &parts.front()) all += between.text;
    all += part.text();
  }
  return trusted_markup(std::move(all));
}

std::string script_json(std::string json) {
  replace_all(json, "<", "\\u003c");
  replace_all(json, "\u2028", "\\u2028");
  replace_all(json, "\u2029", "\\u2029");
  return json;
}

Markup data_block(std::string json) {
  return trusted_markup("<script type=\"application/ld+json\">" + script_json(std::move(json)) + "</script>\n");
}

}  // namespace wale
