#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "runtime/c/call.hpp"

/// Structs of the C interface that begin with their size. The caller's may be older, and end earlier, or newer, and end
/// later than those of this library.
namespace wale::c {

/// No struct will ever be larger, so a size beyond it is no size.
inline constexpr std::size_t largest_struct = 65536;

template <class Struct>
bool has_size(const Struct* given) noexcept {
  static_assert(std::is_trivially_copyable_v<Struct> && offsetof(Struct, size) == 0);
  if (given == nullptr) return false;
  const std::size_t size = given->size;
  return size >= sizeof(std::size_t) && size <= largest_struct && size % alignof(Struct) == 0;
}

/// Whether a struct sets nothing that this library does not know. It has a size. Real-time: allocates nothing, takes no
/// lock, makes no system call, does not throw.
template <class Struct>
bool is_known(const Struct& given) noexcept {
  const auto* bytes = reinterpret_cast<const unsigned char*>(&given);
  for (std::size_t at = sizeof(Struct); at < given.size; ++at)
    if (bytes[at] != 0) return false;
  return true;
}

/// Error: it is NULL, or its size makes no sense.
template <class Struct>
Result<> is_sized(const char* argument, const Struct* given) {
  if (given == nullptr)
    return about_argument(argument, "expected a struct, found NULL", "hand over the address of one");
  if (!has_size(given))
    return about_argument(argument, "expected its size in its first field, found another number",
                          "set all of it to 0, then `size` to its sizeof");
  return {};
}

/// Reads an argument as far as it goes; what it lacks is 0. NULL is all 0. Errors: a wrong size; a part that this
/// library does not know, or a reserved field, that is not 0: so that nothing asked for is passed over.
template <class Struct>
Result<Struct> read_sized(const char* argument, const Struct* given) {
  Struct read{};
  if (given == nullptr) return read;
  if (auto sized = is_sized(argument, given); !sized) return std::move(sized).error();
  if (!is_known(*given))
    return about_argument(argument, "it sets fields that are newer than this library",
                          "update Wale, or leave these fields 0", Code::newer_file);
  std::memcpy(&read, given, std::min(given->size, sizeof(Struct)));
  if constexpr (requires { read.reserved; })
    if (read.reserved != 0) return about_argument("reserved", "expected 0", "set all of the struct to 0 first");
  return read;
}

/// Writes a result as far as the caller's struct goes, and 0 to the parts that this library does not know. The size
/// stays as it is. `to` has a size. Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
template <class Struct>
void write_sized(Struct* to, Struct from) noexcept {
  const std::size_t size = to->size;
  from.size = size;
  std::memcpy(to, &from, std::min(size, sizeof(Struct)));
  if (size > sizeof(Struct))
    std::memset(reinterpret_cast<unsigned char*>(to) + sizeof(Struct), 0, size - sizeof(Struct));
}

/// Copies elements of an array whose elements the caller believes to be `each` bytes long. Error: a wrong size.
template <class Struct, class Element>
Result<> write_elements(std::size_t count, std::size_t each, Struct* to, const Element& element) {
  if (count == 0) return {};
  if (to == nullptr)
    return about_argument("ticks", "expected an array, found NULL", "hand over room for `count` ticks");
  if (each == 0 || each > largest_struct || each % alignof(Struct) != 0)
    return about_argument("each", "expected the size of an element, found another number",
                          "hand over the sizeof of the array's struct");
  auto* bytes = reinterpret_cast<unsigned char*>(to);
  for (std::size_t i = 0; i < count; ++i, bytes += each) {
    const Struct from = element(i);
    std::memcpy(bytes, &from, std::min(each, sizeof(Struct)));
    if (each > sizeof(Struct)) std::memset(bytes + sizeof(Struct), 0, each - sizeof(Struct));
  }
  return {};
}

/// Error: `count` elements from `first` on are not among `all`.
inline Result<> are_there(std::size_t first, std::size_t count, std::size_t all) {
  if (first <= all && count <= all - first) return {};
  return about_argument("first", "it has only " + std::to_string(all), "ask for fewer, or from an earlier one on");
}

/// Error: number `index` is not among `all`.
inline Result<> is_there(std::size_t index, std::size_t all) {
  if (index < all) return {};
  return about_argument("index", "it has only " + std::to_string(all), "count from 0");
}

}  // namespace wale::c
