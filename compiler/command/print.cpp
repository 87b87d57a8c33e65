#include "compiler/command/print.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "compiler/command/command.hpp"
#include "compiler/text/standard_output.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {

void print_out(std::string_view lines) { write_standard_output(visible_lines(lines)); }
void print_error(std::string_view lines) { print_as_is(stderr, visible_lines(lines)); }

void print_as_is(std::FILE* stream, std::string_view text) {
  if (stream == stdout)
    write_standard_output(text);
  else
    std::fwrite(text.data(), 1, text.size(), stream);
}

void prepare_streams() {
  // In the place of a closed stream comes one that fails in the same way: it cannot be read, or not written.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF)
      ::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);  // takes the lowest number that is free
  // A pipe of the usual size takes an output of up to its size at once, so its reader cannot leave in the middle.
  static std::array<char, 65536> size_of_a_pipe;
  if (isatty(STDOUT_FILENO) == 0) std::setvbuf(stdout, size_of_a_pipe.data(), _IOFBF, size_of_a_pipe.size());
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

int finish_output(int status) {
  const int failure = finish_standard_output();
  if (failure == 0) return status;
  if (failure != EPIPE)
    refuse(Error{.code = Code::unwritable_file,
                 .sentence = failure == EBADF
                                 ? "cannot write to standard output: it is closed"
                                 : "cannot write to standard output: " + std::generic_category().message(failure)});
  return status == done ? refused : status;
}

int status_of(const std::function<int()>& command) noexcept {
  const auto say_failed = [](const char* what) {
    print_error(
        "wale: an error in Wale itself: {}\n  = help: please report it, with the command and its files; "
        "schema/SECURITY.md says how\n",
        visible_text(what));
    return failed;
  };
  const auto say_short = [](const char* what) {
    print_as_is(stderr, what);
    return refused;
  };
  try {
    return command();
  } catch (const std::bad_alloc&) {
    return say_short("wale: there is not enough memory for it\n");
  } catch (const std::system_error& thrown) {
    // What the constructor of a thread throws if it cannot have a stack, or is one more than the user may have.
    const bool is_short =
        thrown.code() == std::errc::resource_unavailable_try_again || thrown.code() == std::errc::not_enough_memory;
    if (!is_short) return say_failed(thrown.what());
    return say_short("wale: the system gives no more memory or threads for it\n");
  } catch (const std::exception& thrown) {
    return say_failed(thrown.what());
  } catch (...) {
    return say_failed("an exception of unknown kind");
  }
}

}  // namespace wale::command
