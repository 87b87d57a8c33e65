#include "runtime/c/call.hpp"

#include <cstdint>
#include <exception>
#include <new>
#include <utility>

#include "schema/expectation.hpp"
#include "schema/name_text.hpp"
#include "schema/utf8.hpp"

namespace wale::c {
namespace {

constexpr Code without_memory = Code::short_of_resources;
constexpr const char* text_mend = "count its bytes, or give the length WALE_ZERO_ENDED";

/// Made beforehand, since there is no memory for it when it is needed. Not noted as a handle, so nobody frees it.
WaleError& no_memory() {
  static auto* const error =
      handle_of({.code = without_memory, .sentence = "there is no memory left", .mend = "free some, and call again"})
          .release();
  return *error;
}
[[maybe_unused]] const WaleError& made_early = no_memory();

}  // namespace

std::unique_ptr<WaleError> handle_of(Error error) {
  auto handle = std::make_unique<WaleError>();
  handle->in_words = in_words(error);
  handle->explained = explained(error);
  for (Error& each : error.others) handle->others.push_back(handle_of(std::move(each)));
  handle->error = std::move(error);
  return handle;
}

WaleCode give_error(Error error, WaleError** to) noexcept {
  const auto code = static_cast<WaleCode>(error.code);
  if (to == nullptr) return code;
  try {
    hand_out(handle_of(std::move(error)), to);
  } catch (...) {
    *to = &no_memory();
    return static_cast<WaleCode>(without_memory);
  }
  return code;
}

WaleCode give_thrown(WaleError** to) noexcept {
  try {
    throw;
  } catch (const std::bad_alloc&) {
  } catch (const std::exception& thrown) {
    try {
      return give_error(
          {.code = without_memory, .sentence = thrown.what(), .mend = "free memory and threads, and call again"}, to);
    } catch (...) {
    }
  } catch (...) {
  }
  if (to != nullptr) *to = &no_memory();
  return static_cast<WaleCode>(without_memory);
}

Error about_argument(std::string argument, std::string sentence, std::string mend, Code code) {
  return with_expectation(
      {.code = code, .sentence = std::move(sentence), .mend = std::move(mend), .place = {.name = std::move(argument)}});
}

Error about_bytes(Error error) {
  if (error.place.name.empty()) error.place.name = "bytes";
  return error;
}

Result<> is_given(const char* argument, const void* value) {
  if (value == nullptr)
    return about_argument(argument, "expected a value, found NULL",
                          std::string("hand over a pointer; if an earlier call should have given `") + argument +
                              "`, look at its error");
  return {};
}

Result<> is_place(const char* argument, const void* value) {
  if (value == nullptr)
    return about_argument(argument, "expected a place for the result, found NULL", "hand over the address of a pointer");
  return {};
}

Result<bool> read_flag(const char* argument, std::int32_t value) {
  if (value != 0 && value != 1)
    return about_argument(argument, "expected 0 or 1, found " + std::to_string(value), "write 1 for yes");
  return value == 1;
}

Result<std::string_view> bytes_of(const char* argument, WaleText text) {
  if (text.data == nullptr) {
    if (text.length == 0 || text.length == WALE_ZERO_ENDED) return std::string_view();
    return about_argument(argument, "expected a text, found NULL with a length", "give the length 0 to the empty text");
  }
  if (text.length == WALE_ZERO_ENDED) return std::string_view(text.data);
  if (text.length > PTRDIFF_MAX)
    return about_argument(argument, "expected a length, found one beyond all memory", text_mend);
  return std::string_view(text.data, text.length);
}

Result<std::string> read_path(const char* argument, WaleText text) {
  const auto bytes = bytes_of(argument, text);
  if (!bytes) return bytes.error();
  if (bytes->find('\0') != std::string_view::npos)
    return about_argument(argument, "expected a text, found a zero byte in it", "hand over the text up to there",
                          Code::invalid_encoding);
  return std::string(*bytes);
}

Result<std::string> read_text(const char* argument, WaleText text) {
  auto read = read_path(argument, text);
  if (!read) return read;
  for (std::size_t at = 0; at < read->size();) {
    const Character character = decode(*read, at);
    if (!character.valid)
      return about_argument(argument, "expected UTF-8, found other bytes", "convert the text to UTF-8",
                            Code::invalid_encoding);
    at += character.bytes;
  }
  return read;
}

Result<std::string> read_name(const char* argument, WaleText text, const char* mend, const char* what) {
  auto read = read_text(argument, text);
  if (!read) return read;
  if (auto name = is_name_text(argument, *read, mend, what); !name) return std::move(name).error();
  return read;
}

}  // namespace wale::c
