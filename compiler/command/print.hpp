#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <functional>
#include <string_view>

/// What a command says. No text that it prints makes a terminal do anything but show it (`visible_lines`), whoever
/// wrote the text. A value of several lines that somebody else wrote could still forge a line of ours, so
/// `visible_text` is for values.
namespace wale::command {

/// Prints lines on standard output. Whether it took them, `finish_output` tells.
void print_out(std::string_view lines);
/// Prints lines on standard error.
void print_error(std::string_view lines);

template <class First, class... Parts>
void print_out(fmt::format_string<First, Parts...> format, First&& first, Parts&&... parts) {
  print_out(fmt::format(format, std::forward<First>(first), std::forward<Parts>(parts)...));
}
template <class First, class... Parts>
void print_error(fmt::format_string<First, Parts...> format, First&& first, Parts&&... parts) {
  print_error(fmt::format(format, std::forward<First>(first), std::forward<Parts>(parts)...));
}

/// Prints text that is ours alone, or visible already, with its colours and movements of the cursor.
void print_as_is(std::FILE* stream, std::string_view text);

/// Prepares the streams of this process, at its beginning: a file that it opens never becomes standard output because
/// that was closed; and a pipe whose reader goes away, or a file that may not grow any more, is a failure to write and
/// not the end of the process (SIGPIPE and SIGXFSZ are ignored).
void prepare_streams();

/// Writes what is left for standard output. Returns the exit status of a command that would have ended with `status`:
/// where standard output could not be written, `done` becomes `refused`, and the reason is printed. If its reader has
/// gone away before all was written, nothing is printed, since nobody asked for more. Up to 64 KiB are written at once.
int finish_output(int status);

/// The exit status of a command. An exception that it throws ends it: one about memory with `refused`; any other is an
/// error in Wale, and ends with `failed` and a request to report it.
int status_of(const std::function<int()>& command) noexcept;

}  // namespace wale::command
