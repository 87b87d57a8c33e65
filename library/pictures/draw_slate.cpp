// Draws slate.png, the heights of slate.wale: draw_slate library/stone/slate.png
#include <OpenImageIO/imageio.h>

#include <cstdio>

#include "library/pictures/slate_heights.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: draw_slate FILE.png\n", stderr);
    return 2;
  }
  const auto pixels = wale::SlateHeights::draw();
  OIIO::ImageSpec spec(wale::SlateHeights::side, wale::SlateHeights::side, 1, OIIO::TypeUInt16);
  spec.attribute("png:compressionLevel", 9);
  const auto file = OIIO::ImageOutput::create(argv[1]);
  if (!file || !file->open(argv[1], spec) || !file->write_image(OIIO::TypeUInt16, pixels.data()) || !file->close()) {
    std::fprintf(stderr, "%s\n", file ? file->geterror().c_str() : OIIO::geterror().c_str());
    return 1;
  }
}
