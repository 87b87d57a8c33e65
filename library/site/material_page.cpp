#include "library/site/material_page.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "compiler/describe/describe_figure.hpp"
#include "compiler/drawing/axis.hpp"
#include "compiler/prove/force_bound.hpp"
#include "compiler/text/readable.hpp"
#include "library/site/site_folder.hpp"

namespace wale {
namespace {

constexpr std::string_view neighbours_begin = "<!--neighbours-->", neighbours_end = "<!--/neighbours-->";

std::string in_newtons(double newtons) { return shown_quantity(newtons, force_notation(newtons)); }

/// A link if there is a page, otherwise the word.
Markup linked(const std::string& path, const std::string& word, const std::string& from) {
  return path.empty() ? html("{}", word) : html("<a href=\"{}\">{}</a>", way_to(path, from), word);
}

std::string whole_degrees_of(double radians) {
  const long angle = std::lround(radians * 180 / std::numbers::pi) % 180;
  return angle == 0 ? "x" : angle == 90 ? "y" : std::to_string(angle) + "° from x";
}

/// How the surface repeats, in a sentence.
std::string tiling(const MaterialSources& sources) {
  const auto& texture = sources.description->texture;
  const bool has_table = !sources.program->tables.empty();
  if (texture && texture->force.amplitude > 0 && texture->force.regular()) {
    std::vector<const ReliefWave*> ways;
    for (const ReliefWave& wave : texture->force.waves) {
      const bool known = std::ranges::any_of(ways, [&](const ReliefWave* each) {
        return std::abs(std::remainder(each->orientation - wave.orientation, std::numbers::pi)) < 0.05;
      });
      if (!known && wave.share > 0.05) ways.push_back(&wave);
    }
    std::string text = "repeats every ";
    if (ways.empty()) return text + in_millimetres(texture->force.period);
    for (const ReliefWave* way : ways)
      text += (way == ways.front() ? "" : " and every ") + in_millimetres(way->period) + " along " +
              whole_degrees_of(way->orientation);
    return text;
  }
  if (has_table) {
    const HeightTable& table = sources.program->tables.front();
    return fmt::format("does not repeat; made from {} × {} measured or drawn heights", table.width, table.height);
  }
  if (texture && texture->force.amplitude > 0 && texture->force.period == 0)
    return "single features; a second patch beside it begins anew";
  if (texture && texture->force.amplitude > 0)
    return "does not repeat: its formula gives every place its own force, without a seam";
  if (sources.figures->period) return "what is shown repeats every " + in_millimetres(*sources.figures->period);
  return "nothing repeats: it has no texture";
}

std::string height_words(const MaterialSources& sources) {
  if (sources.figures->height)
    return in_millimetres(*sources.figures->height) + " from its lowest to its highest place shown";
  if (sources.description->shows_relief) return "not stated: the relief is drawn by how strongly it is felt";
  return "none: it shows no relief";
}

Markup first_facts(const SiteMaterial& material, const MaterialSources& sources, const std::string& path) {
  const Description& told = *sources.description;
  Markup rows;
  const auto row = [&](const char* word, const Markup& value) {
    rows += html("<div><dt>{}</dt><dd>{}</dd></div>\n", word, value);
  };
  row("Size", html("<data value=\"{}\">{}</data> wide, <data value=\"{}\">{}</data> high", figure(told.patch.width),
                   in_millimetres(told.patch.width), figure(told.patch.height), in_millimetres(told.patch.height)));
  row("Height", html("{}", height_words(sources)));
  row("Tiles", html("{}", tiling(sources)));
  if (told.shaking)
    row("Shakes", html("{} m/s² at most", shown_number(told.shaking->max)));
  else
    row("Pushes", html("<data value=\"{}\" class=\"newton\">{}</data> at most", figure(told.force.max_newton),
                       in_newtons(told.force.max_newton)));
  if (!material.kind.empty())
    row("Kind",
        html("<a href=\"{}\">{}</a>", way_to("kind/" + page_name(material.kind) + ".html", path), material.kind));
  return html("<dl class=\"facts\">\n{}</dl>\n", rows);
}

/// The names by which people look for it.
Markup all_names(const SiteMaterial& material) {
  std::vector<Markup> words = {html("<code>{}</code>", material.name)};
  for (const EntryName& each : material.names)
    if (each.text != material.name)
      words.push_back(each.language == "en" ? html("{}", each.text)
                                            : html("<span lang=\"{}\">{}</span> <small>({})</small>", each.language,
                                                   each.text, each.language));
  for (const std::string& each : material.feels) words.push_back(html("{}", each));
  return html("<p class=\"names\">{}</p>\n", joined(words, " · "));
}

Markup picture(const SiteMaterial& material, const MaterialSources& sources, const std::string& path) {
  const SiteFigures& figures = *sources.figures;
  const std::string across = figures.of_velocity ? fmt::format("{} m/s to each side", shown_number(figures.side))
                                                 : in_millimetres(figures.side) + " wide";
  const std::string what = figures.surface       ? "Its surface in the light"
                           : figures.of_velocity ? "The force over the hand’s velocity, as arrows"
                                                 : "The force on a hand at rest, as arrows";
  const Notation length = length_notation(figures.side);
  const double bar = round_number(figures.side * length.per_si / 3);
  const Markup scale =
      figures.of_velocity
          ? Markup()
          : html(
                "<svg class=\"scale\" viewBox=\"0 0 100 6\" role=\"img\" aria-label=\"A bar of {} {}\">"
                "<path d=\"M0.5 1v4M0.5 3h{:.2f}v-2v4\"/><text x=\"{:.2f}\" y=\"4.6\">{} {}</text></svg>",
                shown_number(bar), length.unit, 100 * bar / (figures.side * length.per_si),
                100 * bar / (figures.side * length.per_si) + 2.5, shown_number(bar), length.unit);
  const Markup hand =
      figures.touch.empty() || figures.of_velocity
          ? Markup()
          : html(
                "<div class=\"touch\" data-touch=\"{}\" hidden>\n"
                "<p class=\"hint\" id=\"touch-hint\">Move the pointer over it, or choose it and press the arrow keys: "
                "{}the ring is where the force takes a light finger.</p>\n"
                "<p class=\"buttons\"><button type=\"button\" data-act=\"pull\" aria-pressed=\"true\">Pull</button>"
                "<button type=\"button\" data-act=\"sound\" aria-pressed=\"false\">Sound</button></p>\n"
                "<output class=\"felt\" aria-live=\"off\"></output></div>\n",
                way_to(figures.touch, path), figures.surface ? "light follows the pointer, and " : "");
  return html(
      "<figure class=\"relief\">\n<div class=\"stage\"><img src=\"{}\" width=\"320\" height=\"320\" alt=\"{}: {}, "
      "{}\"></div>\n<div class=\"scaleline\">{}</div>\n<figcaption>{}, {}{}.</figcaption>\n{}</figure>\n",
      way_to(figures.picture, path), material.shown(), what, across, scale, what, across,
      figures.whole || figures.of_velocity ? "" : ", a part of the patch", hand);
}

Markup percept_row(const DescribedPercept& percept, const MaterialSources& sources, const std::string& path) {
  const DeclaredNames& names = *sources.names;
  Markup asked = html("<span class=\"none\">nothing</span>");
  if (percept.asked)
    asked = html("<data value=\"{}\">{}</data>{}", figure(*percept.asked), with_decimals(*percept.asked, 2),
                 percept.claimed ? html("<br><small>{}</small>", evidence_word(*percept.claimed)) : Markup());
  Markup reads = html("<span class=\"none\">unknown</span>");
  Markup bar;
  if (!percept.unknown && std::isfinite(percept.level)) {
    reads = html("<data value=\"{}\" data-low=\"{}\" data-high=\"{}\">{}</data>", figure(percept.level),
                 figure(percept.intervals.means.low), figure(percept.intervals.means.high),
                 with_decimals(percept.level, 2));
    bar = level_bar(percept.asked, percept.level, percept.intervals.means.low, percept.intervals.means.high);
    bar += html("<p class=\"means\">{}</p>", people_words(percept));
  }
  const std::string grade = evidence_word(percept.evidence());
  Markup why;
  for (const OutsideRange& each : percept.outside) why += html("<li>{}</li>", outside_in_words(each));
  if (!percept.domain_why.empty()) why += html("<li>{}</li>", percept.domain_why);
  if (percept.near_threshold) why += html("<li>near or below the threshold of feeling</li>");
  if (percept.saturated) why += html("<li>the device gives less than this needs</li>");
  if (!why.empty()) why = html("<ul>{}</ul>", why);
  return html(
      "<tr data-percept=\"{}\"><th scope=\"row\">{}</th><td data-label=\"asked\">{}</td><td "
      "data-label=\"reads\">{}</td>"
      "<td class=\"bar\" data-label=\"95 %\">{}</td><td data-label=\"evidence\"><strong class=\"grade {}\">{}</strong>"
      "<br><small>slope {}, anchor {}, handle {}, {}<br>{}, by {} on {}</small>{}</td></tr>\n",
      percept.name, linked(names.percept(percept.name), percept.name, path), asked, reads, bar, grade, grade,
      evidence_word(percept.slope), evidence_word(percept.anchor), evidence_word(percept.handle),
      percept.domain ? "domain " + evidence_word(*percept.domain) : std::string("domain not stated"), percept.source,
      linked(names.map(percept.map, percept.device, percept.source), percept.map, path),
      linked(names.device(percept.device), percept.device, path), why);
}

Markup lost_rows(const MaterialSources& sources, const std::string& path) {
  Markup rows;
  for (const EntryPercept& percept : sources.entry->felt.percepts) {
    const bool told = std::ranges::any_of(sources.description->percepts,
                                          [&](const DescribedPercept& each) { return each.name == percept.name; });
    if (told || !percept.asked) continue;
    rows += html(
        "<tr><th scope=\"row\">{}</th><td data-label=\"asked\">{}</td><td data-label=\"reads\">none</td>"
        "<td></td><td data-label=\"evidence\">lost on {}</td></tr>\n",
        linked(sources.names->percept(percept.name), percept.name, path), with_decimals(*percept.asked, 2),
        sources.entry->device);
  }
  return rows;
}

Markup percepts(const MaterialSources& sources, const std::string& path) {
  const Description& told = *sources.description;
  Markup rows;
  for (const DescribedPercept& each : told.percepts) rows += percept_row(each, sources, path);
  rows += lost_rows(sources, path);
  if (rows.empty())
    return html(
        "<section aria-labelledby=\"feels\"><h2 id=\"feels\">How it feels</h2>\n<p>No percept can be read: "
        "{}.</p></section>\n",
        told.no_percept.empty() ? "no map tells what it pushes" : told.no_percept);
  return html(
      "<section aria-labelledby=\"feels\"><h2 id=\"feels\">How it feels</h2>\n"
      "<p>Built for {}. Asked is what the author wrote; reads is what the finished program gives.</p>\n"
      "<table class=\"percepts\"><thead><tr><th scope=\"col\">percept</th><th scope=\"col\">asked</th>"
      "<th scope=\"col\">reads</th><th scope=\"col\">where people’s means lie</th><th scope=\"col\">evidence</th></tr>"
      "</thead>\n<tbody>{}</tbody></table></section>\n",
      linked(sources.names->device(sources.entry->device), sources.entry->device, path), rows);
}

Markup plots(const MaterialSources& sources, const std::string& path) {
  Markup all;
  for (const SitePlot& plot : sources.figures->plots)
    all += html(
        "<figure class=\"plot\"><img src=\"{}\" width=\"560\" height=\"280\" loading=\"lazy\" alt=\"{}\"></figure>\n",
        way_to(plot.path, path), plot.title);
  if (all.empty()) return {};
  return html(
      "<section aria-labelledby=\"plots\"><h2 id=\"plots\">Profile, force and spectrum</h2>\n<div "
      "class=\"plots\">{}</div></section>\n",
      all);
}

Markup parameters(const Description& told) {
  if (told.parameters.empty()) return {};
  Markup rows;
  for (const Parameter& each : told.parameters) {
    const std::string unit = each.unit.empty() ? "" : " " + each.unit;
    const auto value = [&](float si) { return fmt::format("{}", shown(si, each.unit_in_si)); };
    rows += html(
        "<tr><th scope=\"row\"><code>{}</code></th><td data-label=\"default\"><data value=\"{}\">{}{}</data></td>"
        "<td data-label=\"range\">{} to {}{}</td><td data-label=\"meaning\">{}</td></tr>\n",
        each.name, value(each.value), value(each.value), unit, value(each.low), value(each.high), unit,
        each.description);
  }
  return html(
      "<section aria-labelledby=\"parameters\"><h2 id=\"parameters\">Parameters</h2>\n<table><thead><tr><th "
      "scope=\"col\">name</th><th scope=\"col\">default</th><th scope=\"col\">range</th><th "
      "scope=\"col\">meaning</th></tr></thead>\n<tbody>{}</tbody></table></section>\n",
      rows);
}

Markup stability(const Description& told) {
  if (told.shaking) return {};
  const auto assumed = told.grade.assumed_standing();
  return html(
      "<p>Alone in a loop with the device: {}{}. With any parameters it never pushes more than <data "
      "value=\"{}\">{}</data>, which is proved.</p>\n",
      standing_word(told.grade.standing),
      assumed ? readable(" ({} by assumed figures)", standing_word(*assumed)) : std::string(),
      figure(told.bound.newton), in_newtons(told.bound.newton));
}

Markup downloads(const SiteMaterial& material, const MaterialSources& sources, const std::string& path) {
  Markup rows;
  const auto row = [&](const std::string& to, const std::string& what) {
    if (!to.empty())
      rows +=
          html("<li><a href=\"{}\" download>{}</a> {}</li>\n", way_to(to, path), to.substr(to.rfind('/') + 1), what);
  };
  row(sources.source, "the file, in Wale");
  row(sources.program_path, "patch program for " + sources.entry->device + ", as wale build makes it");
  row(sources.header_path, "C++17 header for firmware");
  row("material/" + material.page + ".json", "all figures of this page");
  return html(
      "<section aria-labelledby=\"take\"><h2 id=\"take\">Take it along</h2>\n<ul class=\"downloads\">{}</ul>\n"
      "{}<p>Licence: {}.</p></section>\n",
      rows,
      sources.source.empty() ? html("<p>Its file holds other materials that may not be passed on, so only this "
                                    "declaration is shown.</p>\n")
                             : Markup(),
      material.licence);
}

Markup about(const SiteMaterial& material) {
  Markup text = paragraphs(material.documentation);
  if (!material.replaces.empty()) {
    std::vector<Markup> names;
    for (const std::string& each : material.replaces) names.push_back(html("<code>{}</code>", each));
    text += html("<p>Replaces {}.</p>\n", joined(names, ", "));
  }
  if (!material.sources.empty()) {
    Markup rows;
    for (const std::string& each : material.sources) rows += html("<li>{}</li>", each);
    text += html("<h3>Sources</h3>\n<ul>{}</ul>\n", rows);
  }
  return text;
}

}  // namespace

std::string in_millimetres(double metres) { return shown_number(metres * 1e3) + " mm"; }

Markup level_bar(const std::optional<double>& asked, const std::optional<double>& reads, double low, double high) {
  const double most = std::max({1.0, std::min(high, 2.0), reads.value_or(0), asked.value_or(0)});
  const auto at = [&](double level) { return 100 * std::clamp(level / most, 0.0, 1.0); };
  Markup inside = html("<path class=\"axis\" d=\"M0 8H100M0 5v6M{:.1f} 5v6\"/>", at(1));
  if (reads)
    inside += html("<rect class=\"means\" x=\"{:.1f}\" y=\"5\" width=\"{:.1f}\" height=\"6\"/>", at(low),
                   std::max(0.6, at(high) - at(low)));
  if (asked) inside += html("<path class=\"asked\" d=\"M{:.1f} 1v14\"/>", at(*asked));
  if (reads) inside += html("<circle class=\"reads\" cx=\"{:.1f}\" cy=\"8\" r=\"3\"/>", at(*reads));
  return html("<svg class=\"level\" viewBox=\"-4 0 108 16\" aria-hidden=\"true\" focusable=\"false\">{}</svg>", inside);
}

Markup material_card(const SiteMaterial& material, const std::string& from) {
  std::vector<Markup> levels;
  for (const SitePercept& each : material.percepts)
    if (each.reads && levels.size() < 3)
      levels.push_back(html("<span>{} {}</span>", each.name, with_decimals(*each.reads, 2)));
  return html(
      "<li class=\"card\"><a href=\"{}\"><img src=\"{}\" width=\"160\" height=\"160\" loading=\"lazy\" alt=\"\">"
      "<strong>{}</strong></a><small>{}</small><small>{}</small><small class=\"levels\">{}</small></li>\n",
      way_to("material/" + material.page + ".html", from), way_to(material.small, from), material.shown(),
      material.kind, material.of_velocity ? "force over velocity" : in_millimetres(material.side) + " wide",
      joined(levels, " "));
}

SitePage material_page(const SiteMaterial& material, const MaterialSources& sources) {
  SitePage page{.path = "material/" + material.page + ".html",
                .title = material.shown(),
                .description = fmt::format("{}, a material to feel: {} by {}", material.shown(),
                                           in_millimetres(material.width), in_millimetres(material.height)),
                .section = "index.html"};
  page.scripts = {"site.js", "touch.js"};
  page.head = html("<link rel=\"alternate\" type=\"application/ld+json\" href=\"{}\">\n{}",
                   way_to("material/" + material.page + ".json", page.path),
                   data_block(material_dataset(material, sources, false)
                                  .dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace)));
  const Description& told = *sources.description;
  page.body = html("<article>\n<h1>{}</h1>\n{}<div class=\"lead\">\n<div>{}{}</div>\n{}</div>\n", material.shown(),
                   all_names(material), first_facts(material, sources, page.path), about(material),
                   picture(material, sources, page.path));
  page.body += percepts(sources, page.path);
  page.body += plots(sources, page.path);
  page.body += stability(told);
  page.body += parameters(told);
  page.body += html("<section aria-labelledby=\"near\"><h2 id=\"near\">Neighbours by feel</h2>\n");
  page.body += trusted_markup(std::string(neighbours_begin) + std::string(neighbours_end));
  page.body += html(
      "</section>\n<section aria-labelledby=\"source\"><h2 id=\"source\">As it is written</h2>\n<pre "
      "class=\"wale\" tabindex=\"0\" role=\"region\" aria-label=\"Wale text\"><code>{}</code></pre></section>\n",
      highlighted(sources.text));
  page.body += downloads(material, sources, page.path);
  page.body += html(
      "<details><summary>All that <code>wale describe</code> says</summary>\n<pre tabindex=\"0\">{}</pre>"
      "</details>\n</article>\n",
      trusted_markup(escaped(description_text(told), true)));
  return page;
}

Markup neighbours_markup(const std::vector<SiteNeighbour>& neighbours, const std::string& path) {
  if (neighbours.empty()) return html("<p>No other material here can be compared with it.</p>\n");
  Markup cards;
  for (const SiteNeighbour& each : neighbours) {
    const std::string far =
        std::isinf(each.most) ? fmt::format("{} or more", with_digits(each.least, 2)) : with_digits(each.least, 2);
    constexpr std::size_t most_named = 2;
    std::string why;
    for (std::size_t i = 0; i < std::min(most_named, each.unknown.size()); ++i)
      why += (i == 0 ? "; no threshold is known for " : ", ") + each.unknown[i];
    if (each.unknown.size() > most_named) why += fmt::format(" and {} more", each.unknown.size() - most_named);
    cards += html(
        "<li class=\"card\"><a href=\"{}\"><img src=\"{}\" width=\"160\" height=\"160\" loading=\"lazy\" "
        "alt=\"\"><strong>{}</strong></a><small>{} just noticeable differences{}</small></li>\n",
        way_to("material/" + each.material->page + ".html", path), way_to(each.material->small, path),
        each.material->shown(), far, why);
  }
  return html(
      "<p>By the cue that differs most; below 1, people hardly tell them apart.</p>\n<ul class=\"cards\">\n{}</ul>\n",
      cards);
}

std::string with_neighbours(std::string page, const Markup& neighbours) {
  const std::size_t begin = page.find(neighbours_begin);
  const std::size_t end = page.find(neighbours_end);
  if (begin == std::string::npos || end == std::string::npos) return page;
  const std::size_t inside = begin + neighbours_begin.size();
  page.replace(inside, end - inside, neighbours.text());
  return page;
}

}  // namespace wale
