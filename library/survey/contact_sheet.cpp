#include "library/survey/contact_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <optional>

#include "compiler/drawing/style.hpp"
#include "compiler/preview/preview.hpp"
#include "library/review/words.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

constexpr int page_width = 1640, columns = 4, most_rows = 6;
constexpr double margin = 30, gap = 20, top = 84, heading = 44, row_height = 216;
constexpr double picture_width = 380, picture_height = 150;  // half the pixels of a small preview each way

/// A small preview of one material.
struct Print {
  std::optional<Drawing> picture;
  std::string size;     ///< "60 × 60 mm"
  std::string trouble;  ///< why there is no picture
};

Print print_of(const Entry& entry, const Declarations& declarations) {
  if (entry.program.empty()) return {std::nullopt, "", entry.trouble.empty() ? "it cannot be built" : entry.trouble};
  const auto program = Program::load(entry.program);
  if (!program) return {std::nullopt, "", program.error().sentence};
  const Bank bank(*program);
  PreviewChoice choice;
  choice.small = true;
  const auto drawn = draw_preview(bank, preview_text(bank, declarations), declarations, choice);
  if (!drawn) return {std::nullopt, "", drawn.error().sentence};
  const PatchSize size = bank.size();
  return {drawn->page->pixels(),
          fmt::format("{} × {} mm", shown_number(1e3 * size.width), shown_number(1e3 * size.height)), ""};
}

std::vector<Colour> colours_of(const Drawing& drawing) {
  std::vector<Colour> colours;
  colours.reserve(drawing.rgb.size() / 3);
  for (std::size_t i = 0; i + 2 < drawing.rgb.size(); i += 3)
    colours.push_back({static_cast<float>(drawing.rgb[i]) / 255, static_cast<float>(drawing.rgb[i + 1]) / 255,
                       static_cast<float>(drawing.rgb[i + 2]) / 255});
  return colours;
}

std::size_t rows_of(const SheetKind& kind) { return (kind.entries.size() + columns - 1) / columns; }

void draw_print(Canvas& canvas, PagePoint at, const Entry& entry, const Print& print) {
  const PageBox box = {at.x, at.y, at.x + picture_width, at.y + picture_height};
  if (print.picture && print.picture->width == picture_width * Canvas::fineness) {
    canvas.place(box, colours_of(*print.picture));
  } else {
    canvas.outline(box, {1, style::rule});
    canvas.write_within({at.x + 12, at.y + 80}, picture_width - 24, print.trouble, style::label);
  }
  canvas.write_within({at.x + 8, box.bottom + 20}, picture_width - 16, entry.name, style::heading);
  canvas.write_within({at.x + 8, box.bottom + 41}, picture_width - 16,
                      print.size + (entry.title.empty() || print.size.empty() ? "" : " · ") + entry.title, style::label);
}

}  // namespace

std::vector<SheetPage> sheet_pages(const std::vector<Entry>& entries) {
  std::map<std::string, std::vector<const Entry*>> kinds;
  for (const Entry& each : entries) kinds[each.kind.empty() ? "without a kind" : branch_of(each.kind)].push_back(&each);
  std::vector<SheetPage> pages;
  std::size_t left = 0;  // rows of the last page
  for (auto& [kind, all] : kinds) {
    std::ranges::stable_sort(all, {}, &Entry::name);
    for (std::size_t begin = 0; begin < all.size();) {
      if (left == 0) pages.emplace_back(), left = most_rows;
      const std::size_t count = std::min(all.size() - begin, left * columns);
      SheetKind& part = pages.back().kinds.emplace_back();
      part.kind = kind;
      part.entries.assign(all.begin() + static_cast<std::ptrdiff_t>(begin),
                          all.begin() + static_cast<std::ptrdiff_t>(begin + count));
      begin += count, left -= rows_of(part);
    }
  }
  return pages;
}

Result<std::unique_ptr<Canvas>> draw_sheet(const SheetPage& page, const std::string& title,
                                           const Declarations& declarations) {
  std::vector<const Entry*> all;
  double height = top + margin;
  for (const SheetKind& kind : page.kinds) {
    all.insert(all.end(), kind.entries.begin(), kind.entries.end());
    height += heading + static_cast<double>(rows_of(kind)) * row_height;
  }
  auto made = new_canvas(page_width, static_cast<int>(height), style::paper);
  if (!made) return made.error();
  std::vector<Print> prints(all.size());
  std::atomic<std::size_t> next{0};
  in_parallel(all.size(), [&](std::size_t, std::size_t) {
    for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < all.size();)
      prints[i] = print_of(*all[i], declarations);
  });
  Canvas& canvas = **made;
  canvas.write_within({margin, 56}, page_width - 2 * margin, title, {Face::serif, 34, style::ink});
  double y = top;
  std::size_t print = 0;
  for (const SheetKind& kind : page.kinds) {
    canvas.line({margin, y + 6}, {page_width - margin, y + 6}, {1, style::rule});
    canvas.write_within({margin, y + 32}, page_width - 2 * margin, kind.kind, style::names);
    y += heading;
    for (std::size_t i = 0; i < kind.entries.size(); ++i, ++print) {
      const double x = margin + static_cast<double>(i % columns) * (picture_width + gap);
      draw_print(canvas, {x, y + static_cast<double>(i / columns) * row_height}, *kind.entries[i], prints[print]);
    }
    y += static_cast<double>(rows_of(kind)) * row_height;
  }
  return made;
}

std::string page_name(const std::string& file, std::size_t number, std::size_t count) {
  if (count <= 1) return file;
  const std::filesystem::path path(file);
  const int digits = static_cast<int>(std::max<std::size_t>(2, std::to_string(count).size()));
  return (path.parent_path() /
          fmt::format("{}_{:0{}}{}", path.stem().string(), number, digits, path.extension().string()))
      .string();
}

}  // namespace wale
