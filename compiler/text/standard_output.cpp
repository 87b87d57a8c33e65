#include "compiler/text/standard_output.hpp"

#include <cerrno>
#include <cstdio>

namespace wale {
namespace {

int first_failure = 0;

void remember_failure() {
  if (first_failure == 0) first_failure = errno != 0 ? errno : EIO;
}

}  // namespace

void write_standard_output(std::string_view bytes) {
  errno = 0;
  if (first_failure == 0 && std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size()) remember_failure();
}

int finish_standard_output() {
  errno = 0;
  if (std::fflush(stdout) != 0) remember_failure();
  return first_failure;
}

}  // namespace wale
