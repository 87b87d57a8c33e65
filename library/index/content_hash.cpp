#include "library/index/content_hash.hpp"

#include <nettle/sha2.h>

#include <array>
#include <cstdint>
#include <string_view>

namespace wale {

struct ContentHash::State {
  sha256_ctx context;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) { sha256_init(&state_->context); }
ContentHash::~ContentHash() = default;

ContentHash& ContentHash::take(std::string_view bytes) { return take(std::as_bytes(std::span(bytes))); }

ContentHash& ContentHash::take(std::span<const std::byte> bytes) {
  std::array<std::uint8_t, 8> length;
  for (std::size_t i = 0; i < length.size(); ++i) length[i] = static_cast<std::uint8_t>(bytes.size() >> (8 * i));
  sha256_update(&state_->context, length.size(), length.data());
  sha256_update(&state_->context, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  return *this;
}

std::string ContentHash::digits() {
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest;
  sha256_digest(&state_->context, digest.size(), digest.data());
  constexpr std::string_view hexadecimal = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : digest) text += hexadecimal[byte >> 4], text += hexadecimal[byte & 15];
  return text;
}

extern const char* const name_of_build;  // which the build writes (name_build.cmake)

const std::string& compiler_build() {
  static const std::string build = name_of_build;
  return build;
}

}  // namespace wale
