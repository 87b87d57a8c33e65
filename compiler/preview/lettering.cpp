#include "compiler/preview/lettering.hpp"

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "schema/utf8.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> font_folders() {
  std::vector<fs::path> folders = {"/usr/share/fonts", "/usr/local/share/fonts"};
  if (const char* home = std::getenv("HOME")) {
    folders.push_back(fs::path(home) / ".local/share/fonts");
    folders.push_back(fs::path(home) / ".fonts");
  }
  return folders;
}

/// The file of that name anywhere below a folder; empty if there is none.
fs::path find_below(const fs::path& folder, std::string_view file_name) {
  std::error_code error;
  auto entry = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->path().filename() == file_name) return entry->path();
  }
  return {};
}

}  // namespace

struct Font::Face {
  std::vector<unsigned char> file;
  stbtt_fontinfo info{};

  /// Calls `set(glyph, x)` with each letter's glyph and its position; returns the position after the last.
  template <typename Set>
  double lay_out(std::string_view text, double size, Set set) const {
    const double scale = stbtt_ScaleForMappingEmToPixels(&info, static_cast<float>(size));
    double x = 0;
    int before = 0;
    for (std::size_t at = 0; at < text.size();) {
      const Character letter = decode(text, at);
      at += letter.bytes;
      const int glyph = stbtt_FindGlyphIndex(&info, static_cast<int>(letter.code));
      if (before) x += scale * stbtt_GetGlyphKernAdvance(&info, before, glyph);
      set(glyph, x);
      int advance = 0, bearing = 0;
      stbtt_GetGlyphHMetrics(&info, glyph, &advance, &bearing);
      x += scale * advance;
      before = glyph;
    }
    return x;
  }
};

Font Font::find(std::span<const std::string_view> file_names) {
  Font font;
  for (std::string_view name : file_names) {
    for (const fs::path& folder : font_folders()) {
      const fs::path path = find_below(folder, name);
      if (path.empty()) continue;
      auto face = std::make_shared<Face>();
      std::ifstream stream(path, std::ios::binary);
      face->file.assign(std::istreambuf_iterator<char>(stream), {});
      if (face->file.size() < 1000 || !stbtt_InitFont(&face->info, face->file.data(), 0)) continue;
      font.face_ = std::move(face);
      return font;
    }
  }
  return font;
}

double Font::width_of(std::string_view text, double size) const {
  return face_ ? face_->lay_out(text, size, [](int, double) {}) : 0;
}

void Font::draw(std::string_view text, double size, double left, double baseline,
                const std::function<void(int x, int y, float opacity)>& cover) const {
  if (!face_) return;
  const stbtt_fontinfo& info = face_->info;
  const float scale = stbtt_ScaleForMappingEmToPixels(&info, static_cast<float>(size));
  std::vector<unsigned char> bitmap;
  face_->lay_out(text, size, [&](int glyph, double x) {
    const double start = left + x, column = std::floor(start), row = std::floor(baseline);
    const auto shift_x = static_cast<float>(start - column), shift_y = static_cast<float>(baseline - row);
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    stbtt_GetGlyphBitmapBoxSubpixel(&info, glyph, scale, scale, shift_x, shift_y, &x0, &y0, &x1, &y1);
    const int width = x1 - x0, height = y1 - y0;
    if (width <= 0 || height <= 0) return;
    bitmap.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    stbtt_MakeGlyphBitmapSubpixel(&info, bitmap.data(), width, height, width, scale, scale, shift_x, shift_y, glyph);
    for (std::size_t i = 0; i < bitmap.size(); ++i) {
      const int across = static_cast<int>(i) % width, down = static_cast<int>(i) / width;
      if (bitmap[i])
        cover(static_cast<int>(column) + x0 + across, static_cast<int>(row) + y0 + down,
              static_cast<float>(bitmap[i]) / 255);
    }
  });
}

}  // namespace wale
