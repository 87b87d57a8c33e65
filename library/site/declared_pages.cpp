#include "library/site/declared_pages.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/text/source.hpp"
#include "library/site/material_page.hpp"
#include "library/site/page_data.hpp"
#include "library/site/site_folder.hpp"
#include "wale/language_service.hpp"

namespace wale {
namespace {

constexpr std::size_t most_listed = 24;  // materials on the page of a percept

/// The text of a declaration with the comment above it, from the place of any of its words.
std::string declaration_at(const Span& span) {
  const SourceSet sources;
  if (span.source < first_embedded_source) return {};
  const std::string_view text = sources[span.source].text;
  std::size_t begin = span.begin == 0 ? 0 : text.rfind('\n', span.begin - 1) + 1;  // npos + 1 is 0
  while (begin > 1) {
    const std::size_t line = text.rfind('\n', begin - 2) + 1;
    if (!text.substr(line, begin - line).starts_with("///")) break;
    begin = line;
  }
  int depth = 0;
  const std::string_view rest = text.substr(begin);
  for (const ColouredWord& word : coloured_words(rest)) {
    if (word.kind != WordKind::symbol || word.end != word.begin + 1) continue;
    if (rest[word.begin] == '{') ++depth;
    if (rest[word.begin] == '}' && --depth == 0) return std::string(rest.substr(0, word.end));
  }
  return std::string(rest.substr(0, rest.find('\n')));
}

Markup written(const Span& span) {
  const std::string text = declaration_at(span);
  if (text.empty()) return {};
  return html(
      "<h2>As it is declared</h2>\n<pre class=\"wale\" tabindex=\"0\" role=\"region\" aria-label=\"Wale text\">"
      "<code>{}</code></pre>\n",
      highlighted(text));
}

Markup quotations(const std::vector<std::string>& quotes) {
  if (quotes.empty()) return html("<p>No passage is quoted.</p>\n");
  Markup all;
  for (const std::string& quote : quotes) all += html("<blockquote>{}</blockquote>\n", quote);
  return all;
}

Markup fact(const char* word, const Markup& value) { return html("<div><dt>{}</dt><dd>{}</dd></div>\n", word, value); }

Markup graded(Evidence evidence) {
  const std::string word = evidence_word(evidence);
  return html("<strong class=\"grade {}\">{}</strong>", word, word);
}

Markup link(const std::string& path, const std::string& word, const std::string& from) {
  return path.empty() ? html("{}", word) : html("<a href=\"{}\">{}</a>", way_to(path, from), word);
}

std::string map_title(const Map& map) { return map.name.empty() ? map.percept + " from " + map.from : map.name; }
std::string threshold_title(const Threshold& threshold) {
  return threshold.name.empty() ? threshold.cue + ", " + threshold.source : threshold.name;
}

/// A path that no other one of the set is, whatever letters are capitals.
std::string new_path(const std::string& folder, const std::string& title, std::set<std::string>& taken) {
  for (std::size_t i = 1;; ++i) {
    const std::string name = page_name(i == 1 ? title : title + "." + std::to_string(i));
    std::string small = name;
    for (char& each : small)
      if (each >= 'A' && each <= 'Z') each = static_cast<char>(each - 'A' + 'a');
    if (taken.insert(folder + small).second) return folder + "/" + name + ".html";
  }
}

/// The materials in which a percept reads most, the greatest first.
Markup strongest(const std::string& percept, const std::vector<const SiteMaterial*>& materials,
                 const std::string& path) {
  std::vector<std::pair<double, const SiteMaterial*>> found;
  for (const SiteMaterial* material : materials)
    for (const SitePercept& each : material->percepts)
      if (each.name == percept && each.reads) found.emplace_back(*each.reads, material);
  std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.first > b.first; });
  if (found.empty()) return html("<p>No material here reads any of it.</p>\n");
  Markup cards;
  for (std::size_t i = 0; i < std::min(found.size(), most_listed); ++i) cards += material_card(*found[i].second, path);
  return html("<p>{} material{} read some of it{}.</p>\n<ul class=\"cards\">\n{}</ul>\n", found.size(),
              found.size() == 1 ? "" : "s", found.size() > most_listed ? "; these the most" : "", cards);
}

SitePage percept_page(const Percept& percept, const Declarations& declarations, const DeclaredNames& names,
                      const std::vector<const SiteMaterial*>& materials) {
  SitePage page{.path = names.percept(percept.name),
                .title = percept.name,
                .description = "The percept " + percept.name + ": its scale, its maps and their evidence",
                .section = "percepts.html"};
  page.body = html("<h1>{}</h1>\n{}<dl class=\"facts\">\n", percept.name, paragraphs(percept.documentation));
  if (!percept.antonym.empty()) page.body += fact("Opposite", html("{}", percept.antonym));
  if (!percept.words.empty()) {
    std::vector<Markup> words;
    for (const std::string& each : percept.words) words.push_back(html("{}", each));
    page.body += fact("Words for much of it", joined(words, ", "));
  }
  if (!percept.carrier.empty()) page.body += fact("Carried by", html("{}", percept.carrier));
  if (percept.has_reference)
    page.body +=
        fact("Level 1", html("{} in SI units, on {}", with_digits(percept.one, 4),
                             link(names.device(percept.reference_device), percept.reference_device, page.path)));
  else
    page.body += fact("Level 1", html("none is defined: it can be ordered, not measured"));
  if (percept.near_threshold > 0)
    page.body += fact("Hardly felt below", html("level {}", with_digits(percept.near_threshold, 3)));
  page.body += html("</dl>\n<h2>Maps</h2>\n");
  Markup rows;
  declarations.each_map([&](const Map& map) {
    if (map.percept != percept.name) return;
    rows += html(
        "<tr><th scope=\"row\">{}</th><td data-label=\"slope\">{}</td><td data-label=\"anchor\">{}</td><td "
        "data-label=\"handle\">{}</td><td data-label=\"on\">{}</td><td data-label=\"source\">{}</td></tr>\n",
        link(names.of(map), map_title(map), page.path), graded(map.slope), map.tied ? graded(map.anchor) : html("none"),
        graded(map.handle), link(names.device(map.device), map.device, page.path), map.source);
  });
  page.body += rows.empty() ? html("<p>No map is known, so no level can be read.</p>\n")
                            : html(
                                  "<table><thead><tr><th scope=\"col\">map</th><th scope=\"col\">slope</th><th "
                                  "scope=\"col\">anchor</th><th scope=\"col\">handle</th><th scope=\"col\">measured "
                                  "on</th><th scope=\"col\">source</th></tr></thead>\n<tbody>{}</tbody></table>\n",
                                  rows);
  Markup thresholds;
  for (const Threshold* each : declarations.thresholds())
    if (!percept.cue.empty() && each->cue == percept.cue)
      thresholds += html("<li><a href=\"{}\">{}</a>: {}</li>\n", way_to(names.of(*each), page.path),
                         threshold_title(*each), evidence_word(each->evidence));
  if (!thresholds.empty())
    page.body += html("<h2>How small a difference people notice</h2>\n<ul>{}</ul>\n", thresholds);
  page.body += html("<h2>Materials</h2>\n{}", strongest(percept.name, materials, page.path));
  page.body += written(percept.span);
  page.data = percept_data(page, percept, declarations, names, materials);
  return page;
}

SitePage map_page(const Map& map, const DeclaredNames& names) {
  SitePage page{.path = names.of(map),
                .title = map_title(map),
                .description = "A map of " + map.percept + ": " + map.source,
                .section = "percepts.html"};
  page.body = html("<h1>{}</h1>\n<dl class=\"facts\">\n", map_title(map));
  page.body += fact("Maps", html("{} from {}", link(names.percept(map.percept), map.percept, page.path), map.from));
  page.body += fact("Source", html("{}", map.source));
  page.body += fact("Measured on", link(names.device(map.device), map.device, page.path));
  page.body += fact("Slope", graded(map.slope));
  page.body += fact("Anchor", map.tied ? graded(map.anchor) : html("none: it orders stimuli and sets no levels"));
  page.body += fact("Handle", graded(map.handle));
  for (const std::string& each : map.validity) page.body += fact("Valid", html("{}", each));
  const LawUncertainty& law = map.uncertainty;
  if (law.observers > 0) page.body += fact("People", html("{}", law.observers));
  if (law.scatter > 0)
    page.body += fact("Scatter",
                      html("{} of log10 of magnitude{}", figure(law.scatter), law.scatter_assumed ? ", assumed" : ""));
  page.body += html("</dl>\n<h2>Passages that hold its figures</h2>\n{}", quotations(map.quotes));
  page.body += written(map.span);
  page.data = map_data(page, map, names);
  return page;
}

SitePage threshold_page(const Threshold& threshold, const DeclaredNames& names) {
  SitePage page{.path = names.of(threshold),
                .title = threshold_title(threshold),
                .description = "How small a difference of " + threshold.cue + " people notice: " + threshold.source,
                .section = "percepts.html"};
  page.body = html("<h1>{}</h1>\n<dl class=\"facts\">\n", threshold_title(threshold));
  page.body += fact("Cue", html("{}", threshold.cue));
  page.body += fact("Source", html("{}", threshold.source));
  page.body += fact("Measured on", link(names.device(threshold.device), threshold.device, page.path));
  page.body += fact("Evidence", graded(threshold.evidence));
  page.body += fact("Handle", graded(threshold.handle));
  if (threshold.recognised > 0)
    page.body += fact("Recognised", html("{} sizes when each is felt alone", figure(threshold.recognised)));
  else
    page.body += fact("Weber fraction",
                      html("{} as published; {} at d’ = 1", figure(threshold.published), figure(threshold.weber)));
  if (threshold.observers > 0) page.body += fact("People", html("{}", threshold.observers));
  if (threshold.valid) page.body += fact("Valid", html("{}", threshold.valid->written));
  page.body += html("</dl>\n<h2>Passages that hold its figures</h2>\n{}", quotations(threshold.quotes));
  page.body += written(threshold.span);
  page.data = threshold_data(page, threshold, names);
  return page;
}

SitePage device_page(const DeviceDeclaration& device, const DeclaredNames& names) {
  const DeviceProfile& profile = device.profile;
  SitePage page{.path = names.device(profile.name),
                .title = profile.name,
                .description = "The device " + profile.name + ": its figures and their source",
                .section = "devices.html"};
  page.body = html("<h1>{}</h1>\n{}<dl class=\"facts\">\n", profile.name, paragraphs(device.documentation));
  page.body += fact("Source", device.source.empty() ? html("none is stated") : html("{}", device.source));
  if (!device.of_class.empty()) page.body += fact("Class", html("{}", device.of_class));
  if (profile.shaker) {
    page.body += fact("Shakes", html("up to {} m/s²", figure(profile.most())));
  } else {
    page.body += fact("Pushes", html("up to {} N along each axis, in {} steps", figure(profile.force_newton),
                                     figure(profile.force_counts)));
    page.body += fact("Workspace", html("{} across, in {} counts", in_millimetres(profile.workspace_diameter),
                                        figure(profile.position_counts)));
    page.body += fact("Moving mass", html("{} kg", figure(profile.mass)));
    page.body += fact("Damping", html("{} N s/m{}", figure(profile.damping), profile.damping_known ? "" : ", assumed"));
    page.body += fact("Friction", html("{} N{}", figure(profile.friction), profile.friction_known ? "" : ", assumed"));
  }
  page.body += fact("Rate", html("{} Hz", figure(profile.rate)));
  const auto list = [&](const char* word, const std::vector<std::string>& all) {
    std::vector<Markup> words;
    for (const std::string& each : all) words.push_back(html("{}", each));
    if (!all.empty()) page.body += fact(word, joined(words, ", "));
  };
  list("Assumed", device.assumed);
  list("Unknown", device.unknown);
  page.body += html("</dl>\n");
  page.body += written(device.span);
  page.data = device_data(page, device);
  return page;
}

}  // namespace

DeclaredNames::DeclaredNames(const Declarations& declarations) : declarations_(&declarations) {
  std::set<std::string> taken;
  declarations.percepts.each(
      [&](const std::string& name, const Percept&) { percepts_.try_emplace(name, new_path("percept", name, taken)); });
  declarations.devices.each([&](const std::string& name, const DeviceDeclaration&) {
    devices_.try_emplace(name, new_path("device", name, taken));
  });
  declarations.each_map([&](const Map& map) { maps_.try_emplace(&map, new_path("map", map_title(map), taken)); });
  for (const Threshold* each : declarations.thresholds())
    thresholds_.try_emplace(each, new_path("threshold", threshold_title(*each), taken));
}

std::string DeclaredNames::map(const std::string& record, const std::string& device, const std::string& source) const {
  std::string path;
  declarations_->each_map([&](const Map& map) {
    if (path.empty() && map.percept + " from " + map.from == record && map.device == device && map.source == source)
      path = of(map);
  });
  return path;
}

std::string DeclaredNames::of(const Map& map) const {
  const auto at = maps_.find(&map);
  return at == maps_.end() ? std::string() : at->second;
}

std::string DeclaredNames::of(const Threshold& threshold) const {
  const auto at = thresholds_.find(&threshold);
  return at == thresholds_.end() ? std::string() : at->second;
}

std::vector<SitePage> declared_pages(const Declarations& declarations, const DeclaredNames& names,
                                     const std::vector<const SiteMaterial*>& materials) {
  std::vector<SitePage> pages;
  SitePage percepts{.path = "percepts.html",
                    .title = "Percepts and maps",
                    .description = "The percepts, the maps that tie them to forces, and their evidence",
                    .section = "percepts.html"};
  Markup rows, map_rows, threshold_rows;
  declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    const auto count = std::ranges::count_if(materials, [&](const SiteMaterial* material) {
      return std::ranges::any_of(material->percepts,
                                 [&](const SitePercept& each) { return each.name == name && each.reads; });
    });
    rows += html(
        "<tr><th scope=\"row\"><a href=\"{}\">{}</a></th><td data-label=\"carried by\">{}</td><td "
        "data-label=\"materials\">{}</td></tr>\n",
        names.percept(name), name, percept.carrier, count);
    pages.push_back(percept_page(percept, declarations, names, materials));
  });
  declarations.each_map([&](const Map& map) {
    map_rows += html(
        "<tr><th scope=\"row\"><a href=\"{}\">{}</a></th><td data-label=\"maps\">{}</td><td "
        "data-label=\"evidence\">{}</td><td data-label=\"source\">{}</td></tr>\n",
        names.of(map), map_title(map), map.percept,
        graded(std::max({map.slope, map.tied ? map.anchor : map.slope, map.handle})), map.source);
    pages.push_back(map_page(map, names));
  });
  for (const Threshold* each : declarations.thresholds()) {
    threshold_rows += html(
        "<tr><th scope=\"row\"><a href=\"{}\">{}</a></th><td data-label=\"cue\">{}</td><td "
        "data-label=\"evidence\">{}</td><td data-label=\"source\">{}</td></tr>\n",
        names.of(*each), threshold_title(*each), each->cue, graded(std::max(each->evidence, each->handle)),
        each->source);
    pages.push_back(threshold_page(*each, names));
  }
  percepts.body = html(
      "<h1>Percepts and maps</h1>\n<p>A percept is what people feel; a map is an equation from a publication that says "
      "how much of it a force of some size is.</p>\n<h2>Percepts</h2>\n<table><thead><tr><th scope=\"col\">percept</th>"
      "<th scope=\"col\">carried by</th><th scope=\"col\">materials</th></tr></thead>\n<tbody>{}</tbody></table>\n"
      "<h2>Maps</h2>\n<table><thead><tr><th scope=\"col\">map</th><th scope=\"col\">maps</th><th scope=\"col\">worst "
      "evidence</th><th scope=\"col\">source</th></tr></thead>\n<tbody>{}</tbody></table>\n<h2>Thresholds</h2>\n"
      "<table><thead><tr><th scope=\"col\">threshold</th><th scope=\"col\">cue</th><th scope=\"col\">worst "
      "evidence</th>"
      "<th scope=\"col\">source</th></tr></thead>\n<tbody>{}</tbody></table>\n",
      rows, map_rows, threshold_rows);
  SitePage devices{.path = "devices.html",
                   .title = "Devices",
                   .description = "The force-feedback devices that programs are built for",
                   .section = "devices.html"};
  Markup items;
  declarations.devices.each([&](const std::string& name, const DeviceDeclaration& device) {
    items += html(
        "<tr><th scope=\"row\"><a href=\"{}\">{}</a></th><td data-label=\"source\">{}</td><td "
        "data-label=\"unknown\">{}</td></tr>\n",
        names.device(name), name, device.source, fmt::format("{}", fmt::join(device.unknown, ", ")));
    pages.push_back(device_page(device, names));
  });
  devices.body = html(
      "<h1>Devices</h1>\n<table><thead><tr><th scope=\"col\">device</th><th scope=\"col\">source</th><th "
      "scope=\"col\">unknown</th></tr></thead>\n<tbody>{}</tbody></table>\n",
      items);
  ListedPages of_percepts, of_devices;
  for (const SitePage& each : pages)
    (each.section == devices.section ? of_devices : of_percepts).emplace_back(each.title, each.path);
  percepts.data = list_data(percepts, of_percepts), devices.data = list_data(devices, of_devices);
  pages.push_back(std::move(percepts));
  pages.push_back(std::move(devices));
  return pages;
}

SitePage unknown_page(const Declarations& declarations, const DeclaredNames& names,
                      const std::vector<const SiteMaterial*>& published,
                      const std::vector<const SiteMaterial*>& left_out) {
  constexpr std::size_t most_rows = 400;  // so that the page stays small; the rest is counted
  SitePage page{.path = "unknown.html",
                .title = "What is unknown",
                .description = "What nobody has measured of these materials, maps and devices",
                .section = "unknown.html"};
  Markup rows;
  ListedPages all;
  std::size_t count = 0;
  for (const SiteMaterial* material : published)
    for (const std::string& each : material->unknown) {
      all.emplace_back(material->shown() + ": " + each, "material/" + material->page + ".html");
      if (++count > most_rows) continue;
      rows += html("<li><a href=\"material/{}.html\">{}</a>: {}</li>\n", material->page, material->shown(), each);
    }
  Markup maps, devices, kept_back;
  declarations.each_map([&](const Map& map) {
    const Evidence worst = std::max({map.slope, map.tied ? map.anchor : map.slope, map.handle});
    if (worst == Evidence::measured || worst == Evidence::published) return;
    all.emplace_back(map_title(map), names.of(map));
    maps += html("<li><a href=\"{}\">{}</a>: slope {}, anchor {}, handle {}</li>\n", names.of(map), map_title(map),
                 evidence_word(map.slope), map.tied ? evidence_word(map.anchor) : std::string("none"),
                 evidence_word(map.handle));
  });
  declarations.devices.each([&](const std::string& name, const DeviceDeclaration& device) {
    if (!device.unknown.empty())
      devices += html("<li><a href=\"{}\">{}</a>: {}</li>\n", names.device(name), name,
                      fmt::format("{}", fmt::join(device.unknown, ", ")));
  });
  for (const SiteMaterial* each : left_out)
    kept_back += html("<li>{} <small>({})</small>: {}</li>\n", each->name, each->module,
                      each->unlicensed ? each->trouble : std::string("it has an error"));
  page.body = html(
      "<h1>What is unknown</h1>\n<p>What no publication says and nobody measured. Whoever measures it can "
      "contradict these pages.</p>\n<h2>Of materials</h2>\n");
  page.body += rows.empty() ? html("<p>Nothing.</p>\n") : html("<ul>{}</ul>\n", rows);
  if (count > most_rows) page.body += html("<p>And {} more.</p>\n", count - most_rows);
  page.body += html("<h2>Of maps</h2>\n<ul>{}</ul>\n<h2>Of devices</h2>\n<ul>{}</ul>\n", maps, devices);
  if (!kept_back.empty()) page.body += html("<h2>Not on this site</h2>\n<ul>{}</ul>\n", kept_back);
  page.data = list_data(page, all);
  return page;
}

}  // namespace wale
