#include "library/site/gallery.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "library/site/material_page.hpp"
#include "library/site/page_data.hpp"
#include "library/site/site_folder.hpp"
#include "library/store/seek.hpp"

namespace wale {
namespace {

constexpr std::size_t on_a_page = 24;  // cards, whose pictures are loaded as one comes to them

std::string list_path(const std::string& base, std::size_t page) {
  return page == 0 ? base + ".html" : base + "-p" + std::to_string(page + 1) + ".html";
}

Markup cards_of(const std::vector<const SiteMaterial*>& materials, std::size_t begin, const std::string& path) {
  Markup cards;
  for (std::size_t i = begin; i < std::min(begin + on_a_page, materials.size()); ++i)
    cards += material_card(*materials[i], path);
  return html("<ul class=\"cards\">\n{}</ul>\n", cards);
}

/// "1 2 3 … 278", each a link.
Markup pager(const std::string& base, std::size_t page, std::size_t pages, const std::string& path) {
  if (pages < 2) return {};
  std::vector<Markup> links;
  std::size_t before = 0;
  for (std::size_t i = 0; i < pages; ++i) {
    const bool near = i + 2 >= page && i <= page + 2;
    if (!near && i != 0 && i + 1 != pages && i % 50 != 0) continue;
    if (i > before + 1) links.push_back(html("<li>…</li>"));
    links.push_back(i == page ? html("<li><a aria-current=\"page\" href=\"{}\">{}</a></li>",
                                     way_to(list_path(base, i), path), i + 1)
                              : html("<li><a href=\"{}\">{}</a></li>", way_to(list_path(base, i), path), i + 1));
    before = i;
  }
  return html("<nav class=\"pager\" aria-label=\"Pages of this list\"><ul>{}</ul></nav>\n", joined(links, ""));
}

/// The materials of a page of a list.
ListedPages listed(const std::vector<const SiteMaterial*>& materials, std::size_t begin) {
  ListedPages all;
  for (std::size_t i = begin; i < std::min(begin + on_a_page, materials.size()); ++i)
    all.emplace_back(materials[i]->shown(), "material/" + materials[i]->page + ".html");
  return all;
}

/// A list of any length, in pages.
void add_list(std::vector<SitePage>& pages, const std::string& base, const std::string& title, const Markup& before,
              const std::vector<const SiteMaterial*>& materials, const std::string& section) {
  const std::size_t count = std::max<std::size_t>(1, (materials.size() + on_a_page - 1) / on_a_page);
  for (std::size_t i = 0; i < count; ++i) {
    SitePage page{.path = list_path(base, i),
                  .title = i == 0 ? title : fmt::format("{}, page {}", title, i + 1),
                  .description = fmt::format("{}: {} materials to feel", title, materials.size()),
                  .section = section};
    page.body = html("<h1>{}</h1>\n{}<p>{} material{}.</p>\n", title, i == 0 ? before : Markup(), materials.size(),
                     materials.size() == 1 ? "" : "s");
    page.body += pager(base, i, count, page.path);
    page.body += cards_of(materials, i * on_a_page, page.path);
    page.body += pager(base, i, count, page.path);
    page.data = list_data(page, listed(materials, i * on_a_page));
    pages.push_back(std::move(page));
  }
}

/// A kind and all above it: "fabric.woven", "fabric".
std::vector<std::string> with_parents(std::string kind) {
  std::vector<std::string> kinds;
  while (!kind.empty()) {
    kinds.push_back(kind);
    const std::size_t dot = kind.rfind('.');
    kind = dot == std::string::npos ? "" : kind.substr(0, dot);
  }
  return kinds;
}

/// Kinds of stimuli come behind those of materials.
bool is_of_stimuli(const std::string& kind) {
  static const std::vector<std::string> stimuli = stimuli_here();
  return is_of_these(stimuli, kind, "");
}

Markup kind_links(const std::map<std::string, std::vector<const SiteMaterial*>>& kinds, const std::string& under,
                  const std::string& path) {
  Markup items, stimuli;
  for (const auto& [kind, materials] : kinds) {
    const std::size_t dot = kind.rfind('.');
    if ((dot == std::string::npos ? "" : kind.substr(0, dot)) != under) continue;
    (is_of_stimuli(kind) ? stimuli : items) +=
        html("<li><a href=\"{}\">{}</a> <small>{}</small>{}</li>\n", way_to("kind/" + page_name(kind) + ".html", path),
             kind, materials.size(), kind_links(kinds, kind, path));
  }
  items += stimuli;
  return items.empty() ? Markup() : html("<ul class=\"kinds\">{}</ul>\n", items);
}

Markup search_form(const std::set<std::string>& percepts,
                   const std::map<std::string, std::vector<const SiteMaterial*>>& kinds) {
  Markup kind_options, filters, orders;
  for (const auto& [kind, materials] : kinds) kind_options += html("<option value=\"{}\">{}</option>", kind, kind);
  for (const std::string& percept : percepts) {
    orders += html("<option value=\"{}\">{}</option>", percept, percept);
    filters += html(
        "<fieldset class=\"range\"><legend>{}</legend>"
        "<label>from <input type=\"number\" inputmode=\"decimal\" min=\"0\" max=\"2\" step=\"0.05\" "
        "data-least=\"{}\"></label> "
        "<label>to <input type=\"number\" inputmode=\"decimal\" min=\"0\" max=\"2\" step=\"0.05\" "
        "data-most=\"{}\"></label>"
        "</fieldset>\n",
        percept, percept, percept);
  }
  return html(
      "<form id=\"search\" role=\"search\" hidden>\n<p class=\"line\"><span class=\"words\"><label "
      "for=\"words\">Search</label>\n"
      "<input id=\"words\" type=\"search\" autocomplete=\"off\" spellcheck=\"false\" placeholder=\"rough ribbed "
      "cotton\"></span>\n"
      "<span><label for=\"kind\">Kind</label>\n<select id=\"kind\"><option value=\"\">all</option>{}</select></span>\n"
      "<span><label for=\"order\">Order</label>\n<select id=\"order\"><option value=\"\">best "
      "match</option>{}</select></span>\n"
      "<label class=\"reverse\"><input type=\"checkbox\" id=\"reverse\"> least first</label></p>\n"
      "<details id=\"ranges\"><summary>Levels that it reads</summary><div class=\"ranges\">{}</div></details>\n"
      "<p id=\"told\" role=\"status\"></p>\n</form>\n<div id=\"results\" hidden></div>\n",
      kind_options, orders, filters);
}

}  // namespace

std::vector<SitePage> gallery_pages(const std::vector<const SiteMaterial*>& materials) {
  std::map<std::string, std::vector<const SiteMaterial*>> kinds, modules;
  std::set<std::string> percepts;
  for (const SiteMaterial* each : materials) {
    for (const std::string& kind : with_parents(each->kind)) kinds[kind].push_back(each);
    modules[each->module].push_back(each);
    for (const SitePercept& percept : each->percepts)
      if (percept.reads) percepts.insert(percept.name);
  }
  std::erase_if(modules, [](const auto& each) { return each.second.size() < 2; });
  std::vector<SitePage> pages;

  SitePage first{
      .path = "index.html",
      .title = "Materials",
      .description = fmt::format("{} materials to feel, found by word and by how they feel", materials.size()),
      .section = "index.html"};
  first.scripts = {"site.js", "data/search.js", "search.js"};
  std::vector<Markup> tops;
  for (const bool stimuli : {false, true})
    for (const auto& [kind, all] : kinds)
      if (kind.find('.') == std::string::npos && is_of_stimuli(kind) == stimuli)
        tops.push_back(html("<li><a href=\"kind/{}.html\">{}</a></li>", page_name(kind), kind));
  first.body = html(
      "<h1>Materials</h1>\n<p class=\"about\">{} materials for force-feedback joysticks, each with its size, "
      "its relief, how it feels and on what evidence.</p>\n{}",
      materials.size(), search_form(percepts, kinds));
  first.body += html("<div id=\"browse\">\n<ul class=\"tops\" aria-label=\"Kinds\">{}</ul>\n", joined(tops, ""));
  const std::size_t count = std::max<std::size_t>(1, (materials.size() + on_a_page - 1) / on_a_page);
  first.body += cards_of(materials, 0, first.path);
  first.body += pager("all", 0, count, first.path);
  first.body += html(
      "</div>\n<noscript><p>The search needs scripts; <a href=\"all.html\">the list</a> and <a "
      "href=\"collections.html\">the collections</a> do not.</p></noscript>\n");
  first.data = list_data(first, listed(materials, 0));
  pages.push_back(std::move(first));
  add_list(pages, "all", "All materials", {}, materials, "index.html");

  SitePage collections{.path = "collections.html",
                       .title = "Collections",
                       .description = "The materials by kind and by the file that declares several",
                       .section = "collections.html"};
  collections.body = html("<h1>Collections</h1>\n<h2>By kind</h2>\n{}", kind_links(kinds, "", collections.path));
  for (const auto& [kind, all] : kinds) {
    const Markup under = kind_links(kinds, kind, "kind/x.html");
    add_list(pages, "kind/" + page_name(kind), kind, under, all, "collections.html");
  }
  Markup sets;
  ListedPages of_collections;
  for (const auto& [kind, all] : kinds) of_collections.emplace_back(kind, "kind/" + page_name(kind) + ".html");
  for (const auto& [module, all] : modules) {
    of_collections.emplace_back(module, "set/" + page_name(module) + ".html");
    sets += html("<li><a href=\"{}\">{}</a> <small>{}</small></li>\n", "set/" + page_name(module) + ".html", module,
                 all.size());
    add_list(pages, "set/" + page_name(module), module, {}, all, "collections.html");
  }
  if (!sets.empty()) collections.body += html("<h2>Files of several</h2>\n<ul class=\"kinds\">{}</ul>\n", sets);
  collections.data = list_data(collections, of_collections);
  pages.push_back(std::move(collections));
  return pages;
}

}  // namespace wale
