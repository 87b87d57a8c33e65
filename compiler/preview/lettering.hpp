#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace wale {

/// An installed font. Letters are set one after the other with kerning; scripts that need shaping are not.
///
/// ImageBufAlgo::render_text is not used: up to OpenImageIO 2.4 it garbles every letter outside ASCII.
class Font {
 public:
  /// The first font of these file names ("DejaVuSans.ttf") in the system's and the user's font folders; empty when none
  /// is there.
  static Font find(std::span<const std::string_view> file_names);

  explicit operator bool() const { return face_ != nullptr; }
  /// How far a line of text reaches, in pixels, at letters of `size` pixels.
  double width_of(std::string_view text, double size) const;
  /// Calls `cover(x, y, opacity)` for the pixels of a line of text whose baseline begins at (left, baseline).
  void draw(std::string_view text, double size, double left, double baseline,
            const std::function<void(int x, int y, float opacity)>& cover) const;

 private:
  struct Face;
  std::shared_ptr<const Face> face_;
};

}  // namespace wale
