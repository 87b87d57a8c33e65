// wale-decoder: decodes one picture without any rights, and ends. Started by decode_picture.cpp, which says why.
//
// The picture is standard input, the answer goes to standard output. The libraries are loaded before the sandbox is
// entered, and no byte of the picture is read before that.

#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <optional>
#include <span>
#include <string>

#include "compiler/image/decoder/colour_image.hpp"
#include "compiler/image/decoder/height_image.hpp"
#include "compiler/image/decoder/read_picture.hpp"
#include "compiler/image/decoder/sandbox.hpp"
#include "compiler/image/decoder_answer.hpp"

namespace {

using namespace wale;

/// Standard input as bytes; empty where it is no file that holds any.
std::optional<std::span<const std::byte>> mapped_input() {
  struct stat status;
  if (fstat(STDIN_FILENO, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size <= 0) return std::nullopt;
  const auto size = static_cast<std::size_t>(status.st_size);
  void* bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
  if (bytes == MAP_FAILED) return std::nullopt;
  return std::span(static_cast<const std::byte*>(bytes), size);
}

/// Ends the process without anything that libraries do at the end.
[[noreturn]] void answer(const std::vector<std::byte>& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t written = write(STDOUT_FILENO, &bytes[at], bytes.size() - at);
    if (written <= 0) _exit(1);
    at += static_cast<std::size_t>(written);
  }
  _exit(0);
}

Error no_sandbox(const std::string& why) {
  return {Code::no_sandbox, "this system has no sandbox to decode a picture in: " + why,
          "if you trust the picture, decode it without by --unsandboxed-pictures"};
}

}  // namespace

int main(int count, char** words) {
  const auto arguments =
      DecoderArguments::read(std::span<const char* const>(words, static_cast<std::size_t>(count)).subspan(1));
  const auto picture = mapped_input();
  if (!arguments || !picture) {
    std::fputs("wale-decoder decodes the pictures of `wale`, which starts it; it is of no use alone\n", stderr);
    return 2;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  decoder::prepare();
  std::string problem = decoder::limit_resources() ? "" : "its memory and time cannot be limited";
  if (problem.empty()) problem = decoder::enter_sandbox();
  if (!problem.empty() && arguments->sandbox == Sandbox::required) answer(write_answer(no_sandbox(problem)));
  if (arguments->samples == Samples::colours)
    answer(write_colour_answer(decoder::colour_image(*picture, arguments->extension)));
  answer(write_answer(decoder::height_image(*picture, arguments->extension, arguments->smooth_pixels)));
}
