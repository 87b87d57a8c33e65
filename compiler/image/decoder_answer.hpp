#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/image/image.hpp"

namespace wale {

/// What a picture is decoded to.
enum class Samples { heights, colours };

/// The arguments of `wale-decoder`, the program that decodes one picture (decoder/main.cpp), as texts: EXTENSION
/// SMOOTH SANDBOX SAMPLES. Its standard input is the picture, which must be a file that can be mapped; its standard
/// output is the answer.
struct DecoderArguments {
  std::string extension;     ///< of the picture's name, in lower case and without its dot; may be empty
  double smooth_pixels = 0;  ///< as for `read_height_image`
  Sandbox sandbox = Sandbox::required;
  Samples samples = Samples::heights;

  std::vector<std::string> words() const;
  /// Empty where the words are no such arguments.
  static std::optional<DecoderArguments> read(std::span<const char* const> words);
};

/// The longest answer in bytes: a header, and the 32 bits of a colour for each of the most samples.
inline constexpr std::size_t largest_answer =
    64 + 4 * std::size_t{largest_image_side} * std::size_t{largest_image_side};

/// The decoder's answer as bytes: heights, or an error with `Code::unreadable_image`, `image_size` or `no_sandbox`;
/// any other code becomes `unreadable_image`. Texts are cut at 1000 bytes.
std::vector<std::byte> write_answer(const Result<HeightImage>& image);
/// The same for colours.
std::vector<std::byte> write_colour_answer(const Result<ColourImage>& image);

/// Reads an answer. A picture may have taken over its decoder, so nothing in the bytes is believed: sizes are checked
/// and texts are reduced to printable ASCII. Empty where the bytes are no whole answer.
std::optional<Result<HeightImage>> read_answer(std::span<const std::byte> bytes);
std::optional<Result<ColourImage>> read_colour_answer(std::span<const std::byte> bytes);

}  // namespace wale
