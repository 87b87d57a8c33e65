#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/c/handle.hpp"
#include "schema/name_text.hpp"
#include "wale/error.h"
#include "wale/result.hpp"

struct WaleError {
  wale::Error error;
  std::string in_words, explained;
  std::vector<std::unique_ptr<WaleError>> others;
};

namespace wale::c {

/// An error as a handle, with the others of its text.
std::unique_ptr<WaleError> handle_of(Error error);

/// Gives an error to the caller, if `to` is a place for it, and returns its code.
WaleCode give_error(Error error, WaleError** to) noexcept;
/// The error for what is being thrown. Call it within `catch` only.
WaleCode give_thrown(WaleError** to) noexcept;

/// The body of a C function that can fail: a function that returns a `Result<>`. Nothing thrown leaves it.
template <class Body>
WaleCode call(WaleError** error, const Body& body) noexcept {
  if (error != nullptr) *error = nullptr;
  try {
    Result<> done = body();
    return done ? 0 : give_error(std::move(done).error(), error);
  } catch (...) {
    return give_thrown(error);
  }
}

/// The error about an argument.
Error about_argument(std::string argument, std::string sentence, std::string mend, Code code = Code::malformed_value);
/// The error about the bytes of a file that are an argument, where it names no part of them.
Error about_bytes(Error error);
/// Error: an argument is NULL.
Result<> is_given(const char* argument, const void* value);
/// Error: there is no place for the result that this argument is for.
Result<> is_place(const char* argument, const void* value);

/// A text of a result: also an empty one has data.
inline WaleText text_of(std::string_view text) { return {text.empty() ? "" : text.data(), text.size()}; }

/// A yes or no of an argument. Error: it is neither 0 nor 1.
Result<bool> read_flag(const char* argument, std::int32_t value);

/// The bytes of an argument. Error: `malformed_value`.
Result<std::string_view> bytes_of(const char* argument, WaleText text);
/// The text of an argument. Errors: `malformed_value`; `invalid_encoding` if it is not UTF-8 or holds a zero byte.
Result<std::string> read_text(const char* argument, WaleText text);
/// The name of an argument. Errors: as for a text, and those of `is_name_text`, with its `mend` and `what`.
Result<std::string> read_name(const char* argument, WaleText text, const char* mend = usual_name_mend,
                              const char* what = "a name");
/// The path of an argument, which need not be UTF-8. Errors: as for a text.
Result<std::string> read_path(const char* argument, WaleText text);

}  // namespace wale::c
