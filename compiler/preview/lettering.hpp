#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace wale {

/// An installed font. Letters are drawn one after another with kerning; scripts that need shaping are not supported.
///
/// ImageBufAlgo::render_text is not used: up to OpenImageIO 2.4 it garbles every letter outside ASCII.
class Font {
 public:
  /// The first font of these file names ("DejaVuSans.ttf") in the font folders of the system and the user; empty if
  /// there is none.
  static Font find(std::span<const std::string_view> file_names);

  explicit operator bool() const { return face_ != nullptr; }
  /// The width of a line of text in pixels, at letters of `size` pixels.
  double width_of(std::string_view text, double size) const;
  /// Calls `cover(x, y, opacity)` for the pixels of a line of text whose baseline starts at (left, baseline).
  void draw(std::string_view text, double size, double left, double baseline,
            const std::function<void(int x, int y, float opacity)>& cover) const;

 private:
  struct Face;
  std::shared_ptr<const Face> face_;
};

}  // namespace wale
