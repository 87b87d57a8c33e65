#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "compiler/image/decoder_answer.hpp"

namespace wale {

/// The longest time for one picture. Its processor time has a smaller limit; this one is for a machine that is busy
/// with other things, and for a decoder that only waits.
inline constexpr int most_seconds_per_picture = 120;

/// Where `wale-decoder` may be, best first.
std::vector<std::string> decoder_programs();

/// Decodes a picture in a process of its own: starts the first of `programs` that there is, and reads and checks its
/// answer. The process has no more than the picture and a pipe, is limited in memory and processor time
/// (decoder/sandbox.hpp), and has ended when this function returns. Signals, their handlers and other children of the
/// calling process stay as they are. May be called from any thread.
///
/// Errors: those of the answer; `Code::unreadable_image` if the decoder crashed, exceeded a limit or answered nonsense,
/// `missing_library` if there is no decoder, `short_of_resources` if the system has no memory or descriptors.
Result<HeightImage> decode_picture(std::span<const std::byte> bytes, const DecoderArguments& arguments,
                                   const std::vector<std::string>& programs = decoder_programs());
/// The same for its colours; `arguments.samples` asks for them.
Result<ColourImage> decode_colours(std::span<const std::byte> bytes, const DecoderArguments& arguments,
                                   const std::vector<std::string>& programs = decoder_programs());

}  // namespace wale
