// A libFuzzer target for the command line with files of somebody else. Each input is a Wale file, or a patch program
// whose bytes or names are changed, and the words of a verb. Whatever they are, the verb ends with a status of its own,
// says why it cannot be carried out, prints nothing that could act on a terminal, and every --json is JSON.

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "schema/patch_program_format.hpp"
#include "tests/schema/example_program.hpp"
#include "wale/memory.hpp"

/// `main` of wale.cpp, which is compiled under this name here.
int wale_main(int argc, char** argv);

namespace {

using namespace wale;

/// A verb with its options. FILE is replaced by the input's name.
struct Command {
  std::vector<std::string> words;
  bool prints_json = false;
  /// Whether its output is the file's own text, which an author may put anything into.
  bool prints_file = false;
};

const std::vector<Command>& commands() {
  static const std::vector<Command> all{
      {{"check", "--json", "FILE"}, true},
      {{"describe", "--json", "FILE"}, true},
      {{"describe", "--exports", "--json", "FILE"}, true},
      {{"describe", "--device", "all", "--json", "FILE"}, true},
      {{"compare", "--json", "FILE", "corduroy"}, true},
      {{"levels", "roughness", "--json", "--count", "2"}, true},
      {{"sample", "--at", "10 mm, 5 mm", "--json", "FILE"}, true},
      {{"replay", "--json", "FILE"}, true},
      {{"check", "FILE"}},
      {{"describe", "FILE"}},
      {{"describe", "--exports", "FILE"}},
      {{"describe", "--device", "all", "FILE"}},
      {{"compare", "FILE", "corduroy"}},
      {{"sample", "--at", "10 mm, 5 mm", "FILE"}},
      {{"sample", "--trace", "FILE", "corduroy"}},
      {{"replay", "FILE"}},
      {{"build", "--emit", "cpp", "FILE"}},
      {{"build", "--emit", "listing", "FILE"}},
      {{"build", "--emit", "checked", "FILE"}},
      {{"build", "--emit", "ir", "FILE"}},
      {{"build", "--all", "-o", "programs", "FILE"}},
      {{"devices", "--devices", "FILE"}},
      {{"format", "--check", "FILE"}},
      {{"build", "--emit", "tree", "FILE"}, false, true},
  };
  return all;
}

/// The fuzzer's bytes, read from the front.
class Choices {
 public:
  explicit Choices(std::span<const unsigned char> bytes) : bytes_(bytes) {}
  unsigned next() {
    if (bytes_.empty()) return 0;
    const unsigned value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  bool left() const { return !bytes_.empty(); }
  std::string text(std::size_t most) {
    const auto taken = bytes_.first(std::min(most, bytes_.size()));
    bytes_ = bytes_.subspan(taken.size());
    return {taken.begin(), taken.end()};
  }

 private:
  std::span<const unsigned char> bytes_;
};

std::string as_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A program whose names are the fuzzer's.
std::string named_program(Choices& choices) {
  PatchProgram program = example::program();
  program.material = choices.text(1 + choices.next() % 32);
  if (choices.next() % 2) program.device.name = choices.text(choices.next() % 16);
  for (auto& parameter : program.parameters)
    if (choices.left()) parameter.name = choices.text(1 + choices.next() % 16);
  return as_text(write_patch_program(program));
}

/// A program with some bytes changed.
std::string changed_program(Choices& choices) {
  std::string bytes = as_text(write_patch_program(example::program()));
  while (choices.left()) {
    const std::size_t place = choices.next() << 8 | choices.next();
    bytes[place % bytes.size()] = static_cast<char>(choices.next());
  }
  return bytes;
}

struct Fed {
  std::string name, content;
};

Fed input_of(Choices& choices) {
  static const std::array<std::string, 6> stems{"hostile",        "two\nlines", "esc\x1b[31m",
                                                "not \xff utf-8", "rtl\u202e",  "\"quoted\\\""};
  const unsigned kind = choices.next();
  const std::string stem = stems[kind / 4 % stems.size()];
  switch (kind % 4) {
    case 0: return {stem + ".wpp", named_program(choices)};
    case 1: return {stem + ".wpp", changed_program(choices)};
    default: return {stem + ".wale", choices.text(4096)};
  }
}

/// A stream of the process as a file in memory, until it is read.
class Caught {
 public:
  explicit Caught(std::FILE* stream)
      : stream_(stream), own_(dup(fileno(stream))), memory_(memfd_create("caught", MFD_CLOEXEC)) {
    std::fflush(stream_);
    dup2(memory_, fileno(stream_));
  }
  /// What was written; the stream is as before.
  std::string read() {
    std::fflush(stream_);
    dup2(own_, fileno(stream_));
    close(own_);
    std::string text(static_cast<std::size_t>(lseek(memory_, 0, SEEK_END)), '\0');
    if (pread(memory_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) std::abort();
    close(memory_);
    return text;
  }

 private:
  std::FILE* stream_;
  int own_, memory_;
};

/// Whether a terminal would only draw this: UTF-8 without control characters other than a line's end, and without marks
/// that turn the direction of what follows.
bool is_harmless(const std::string& text) {
  for (const unsigned char c : text)
    if ((c < 0x20 && c != '\n') || c == 0x7f) return false;
  for (const char* mark : {"\u202a", "\u202b", "\u202c", "\u202d", "\u202e", "\u2066", "\u2067", "\u2068", "\u2069"})
    if (text.find(mark) != std::string::npos) return false;
  for (char c = '\x80'; c != '\xa0'; ++c)
    if (text.find({'\xc2', c}) != std::string::npos) return false;
  try {
    (void)nlohmann::json(text).dump();  // throws if it is not UTF-8
  } catch (const nlohmann::json::exception&) {
    return false;
  }
  return true;
}

struct Outcome {
  int status = 0;
  std::string out, err;
};

Outcome run(const Command& command, const std::string& file) {
  std::vector<std::string> words{"wale"};
  for (const std::string& word : command.words) words.push_back(word == "FILE" ? file : word);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Caught out(stdout), err(stderr);
  Outcome outcome;
  outcome.status = wale_main(static_cast<int>(words.size()), arguments.data());
  outcome.err = err.read();
  outcome.out = out.read();
  return outcome;
}

/// A folder of its own, in which it works from now on.
const std::filesystem::path& own_folder() {
  static const std::filesystem::path folder = [] {
    std::string name = (std::filesystem::temp_directory_path() / "wale-fuzz-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    static const std::string kept = name;
    std::atexit([] {
      std::error_code ignored;
      std::filesystem::remove_all(kept, ignored);
    });
    std::filesystem::current_path(name);
    setenv("HOME", name.c_str(), 1);
    unsetenv("XDG_CONFIG_HOME");
    unsetenv("WALE_LIBRARY");
    return std::filesystem::path(name);
  }();
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  Choices choices({data, size});
  const Command& command = commands()[choices.next() % commands().size()];
  const Fed input = input_of(choices);
  const std::filesystem::path file = own_folder() / input.name;
  std::ofstream(file, std::ios::binary) << input.content;
  const Outcome outcome = run(command, input.name);
  const auto require = [&](bool held, const char* what) {
    if (held) return;
    std::fprintf(stderr, "%s\nverb: %s\nfile: %s\nstatus %d\n--- output\n%s\n--- errors\n%s\n--- content\n%s\n", what,
                 command.words.front().c_str(), input.name.c_str(), outcome.status, outcome.out.c_str(),
                 outcome.err.c_str(), input.content.c_str());
    std::abort();
  };
  require(outcome.status >= 0 && outcome.status <= 2, "the status is none of the verb's");
  require(outcome.status == 0 || !outcome.err.empty() || !outcome.out.empty(), "it was refused without a reason");
  require(is_harmless(outcome.err), "the errors could act on a terminal");
  if (!command.prints_file) require(is_harmless(outcome.out), "the output could act on a terminal");
  if (command.prints_json && !outcome.out.empty())
    require(nlohmann::json::accept(outcome.out), "the output is not JSON");
  if (command.prints_json && outcome.status == 0) require(!outcome.out.empty(), "there is no output");
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  std::filesystem::remove_all(own_folder() / "programs", ignored);
  return 0;
}
