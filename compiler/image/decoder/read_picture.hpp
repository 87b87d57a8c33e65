#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compiler/image/image.hpp"
#include "compiler/image/openimageio.hpp"
#include "wale/result.hpp"

namespace wale::decoder {

// With one thread the order of additions, and so the last bit, is the same on every machine.
inline constexpr int threads = 1;

Error unreadable(std::string sentence);
/// `smallest` is the least number of pixels of a side.
Error of_wrong_size(std::string sentence, int smallest);
/// OpenImageIO's message on one line, or `otherwise` if it gives none.
std::string words_of(std::string error, const std::string& otherwise);

/// The colour channels of a picture: the three that are red, green and blue, or the one that is grey.
std::vector<int> colour_channels(const OIIO::ImageSpec& spec);

/// Loads all that decoding needs, so that `read_picture` opens no file and starts no thread.
void prepare();

/// Opens a picture with the decoders that may read an untrusted file, the likeliest first, until `read` can use what
/// one of them opens. `extension` is in lower case and without its dot. Errors: `Code::unreadable_image`, and those of
/// `read`, without a place.
Result<> read_picture(std::span<const std::byte> bytes, const std::string& extension,
                      const std::function<Result<>(OIIO::ImageInput&)>& read);

/// Some rows of a picture, all channels, each value in 0 .. 1.
struct Band {
  int top = 0, rows = 0;
  std::vector<float>& values;
};

/// Reads an open picture band by band, so that a large one of many channels is never in memory as a whole. First checks
/// from what its header says that it can be used and that no side has fewer pixels than `smallest_side`. Errors:
/// `Code::unreadable_image` and `image_size`.
Result<> read_bands(OIIO::ImageInput& input, int smallest_side, const std::function<Result<>(const Band&)>& take);

}  // namespace wale::decoder
