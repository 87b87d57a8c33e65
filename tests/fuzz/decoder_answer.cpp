// A libFuzzer target for the answers of the program that decodes pictures, which a picture may have taken over: any
// bytes at all are no answer, an error whose text a terminal may get, or heights that a program may hold.

#include "compiler/image/decoder_answer.hpp"

#include <cstdlib>
#include <span>

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

bool is_plain(const std::string& text) {
  for (const char c : text)
    if (c < 0x20 || c > 0x7e) return false;
  return true;
}

}  // namespace

namespace {

/// The same bytes as an answer in colours.
void read_colours(std::span<const std::byte> bytes) {
  const auto answer = wale::read_colour_answer(bytes);
  if (!answer || !*answer) return;
  const wale::ColourImage& image = **answer;
  demand(image.width >= 1 && image.width <= wale::largest_image_side);
  demand(image.height >= 1 && image.height <= wale::largest_image_side);
  demand(image.pixels.size() == std::size_t{image.width} * image.height);
  demand(image.pixels_per_column >= 1 && image.pixels_per_row >= 1);
  demand(wale::write_colour_answer(image) == std::vector<std::byte>(bytes.begin(), bytes.end()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  read_colours(std::as_bytes(std::span(data, size)));
  const auto answer = wale::read_answer(std::as_bytes(std::span(data, size)));
  if (!answer) return 0;
  const wale::Result<wale::HeightImage>& image = *answer;
  if (!image) {
    demand(!image.error().sentence.empty() && is_plain(image.error().sentence) && is_plain(image.error().mend));
    return 0;
  }
  demand(image->table.width >= wale::smallest_image_side && image->table.width <= wale::largest_image_side);
  demand(image->table.height >= wale::smallest_image_side && image->table.height <= wale::largest_image_side);
  demand(image->table.heights.size() == std::size_t{image->table.width} * image->table.height);
  demand(image->pixels_per_column >= 1 && image->pixels_per_row >= 1);
  demand(wale::write_answer(image) == std::vector<std::byte>(std::as_bytes(std::span(data, size)).begin(),
                                                             std::as_bytes(std::span(data, size)).end()));
  return 0;
}
