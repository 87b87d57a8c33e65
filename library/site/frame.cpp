#include "library/site/frame.hpp"

#include <algorithm>
#include <array>

#include "wale/language_service.hpp"

namespace wale {
namespace {

struct MenuEntry {
  const char* path;
  const char* word;
};

constexpr std::array<MenuEntry, 6> menu = {{{"index.html", "Materials"},
                                            {"collections.html", "Collections"},
                                            {"space.html", "Percept space"},
                                            {"percepts.html", "Percepts and maps"},
                                            {"devices.html", "Devices"},
                                            {"unknown.html", "What is unknown"}}};

const char* class_of(WordKind kind) {
  switch (kind) {
    case WordKind::comment: return "c";
    case WordKind::documentation: return "d";
    case WordKind::keyword: return "k";
    case WordKind::number: return "n";
    case WordKind::unit: return "u";
    case WordKind::text: return "t";
    case WordKind::name:
    case WordKind::symbol: break;
  }
  return nullptr;
}

Markup lines_of(std::string_view text) { return trusted_markup(escaped(text, true)); }

}  // namespace

std::string way_to(std::string_view path, std::string_view from) {
  std::string way;
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::ranges::count(from, '/')); ++i) way += "../";
  return way + std::string(path);
}

std::string data_path(const SitePage& page) { return page.path.substr(0, page.path.rfind('.')) + ".json"; }

std::string framed(const SitePage& page) {
  const auto way = [&](std::string_view path) { return way_to(path, page.path); };
  std::vector<Markup> entries;
  for (const MenuEntry& each : menu)
    entries.push_back(html("<li><a href=\"{}\"{}>{}</a></li>", way(each.path),
                           page.path == each.path      ? html(" aria-current=\"page\"")
                           : page.section == each.path ? html(" aria-current=\"true\"")
                                                       : Markup(),
                           each.word));
  std::vector<Markup> scripts;
  for (const std::string& path : page.scripts) scripts.push_back(html("<script src=\"{}\" defer></script>", way(path)));
  // Scripts come from files alone, so that a tag which somebody got into a text would not run.
  Markup head = page.head;
  if (!page.data.empty())
    head += html("<link rel=\"alternate\" type=\"application/ld+json\" href=\"{}\">", way(data_path(page).c_str()));
  return html(
             "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
             "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'self' file:; "
             "style-src 'self' file:; img-src 'self' file: data:; base-uri 'none'; form-action 'none'\">\n"
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
             "<meta name=\"color-scheme\" content=\"light dark\">\n"
             "<meta name=\"referrer\" content=\"no-referrer\">\n"
             "<title>{} · Wale library</title>\n<meta name=\"description\" content=\"{}\">\n"
             "<link rel=\"stylesheet\" href=\"{}\">\n<link rel=\"icon\" href=\"{}\" type=\"image/svg+xml\">\n{}{}\n"
             "</head>\n<body>\n<a class=\"skip\" href=\"#main\">To the content</a>\n"
             "<header class=\"top\"><a class=\"brand\" href=\"{}\">Wale library</a>\n"
             "<nav aria-label=\"Pages\"><ul>{}</ul></nav></header>\n"
             "<main id=\"main\" tabindex=\"-1\">\n{}</main>\n"
             "<footer class=\"foot\"><p>Every figure of feel is read from the finished program by <code>wale "
             "library site</code>. Levels run from 0, none, to 1, the percept’s reference stimulus.</p></footer>\n"
             "</body>\n</html>\n",
             page.title, page.description, way("site.css"), way("wale.svg"), head, joined(scripts, "\n"),
             way("index.html"), joined(entries, ""), page.body)
      .text();
}

Markup highlighted(std::string_view text) {
  Markup all;
  std::size_t at = 0;
  for (const ColouredWord& word : coloured_words(text)) {
    if (word.begin < at || word.end > text.size()) continue;
    all += lines_of(text.substr(at, word.begin - at));
    const Markup inside = lines_of(text.substr(word.begin, word.end - word.begin));
    const char* kind = class_of(word.kind);
    all += kind ? html("<span class=\"{}\">{}</span>", kind, inside) : inside;
    at = word.end;
  }
  all += lines_of(text.substr(at));
  return all;
}

Markup paragraphs(std::string_view documentation) {
  Markup all;
  std::string paragraph;
  const auto end_paragraph = [&] {
    if (!paragraph.empty()) all += html("<p>{}</p>\n", paragraph);
    paragraph.clear();
  };
  while (!documentation.empty()) {
    const std::size_t end = std::min(documentation.find('\n'), documentation.size());
    std::string_view line = documentation.substr(0, end);
    documentation.remove_prefix(std::min(end + 1, documentation.size()));
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
    if (line.empty()) {
      end_paragraph();
      continue;
    }
    if (!paragraph.empty()) paragraph += ' ';
    paragraph += line;
  }
  end_paragraph();
  return all;
}

}  // namespace wale
