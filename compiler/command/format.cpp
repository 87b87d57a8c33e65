#include "compiler/format/format.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/text/other_file.hpp"
#include "compiler/text/output_file.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct FormatOptions {
  std::vector<std::string> files;
  bool check_only = false;  ///< writes nothing but the names of the files that formatting would change
};

/// All of standard input, which may be a pipe. Errors: W0501 if it cannot be read, or is larger than a file may be.
Result<ResolvedFile> standard_input() {
  const auto unreadable = [](std::string sentence) {
    return Error{.code = Code::unreadable_file, .sentence = std::move(sentence), .place = {.name = "standard input"}};
  };
  ResolvedFile text{"-", {}};
  std::vector<char> block(1 << 16);
  while (true) {
    const ssize_t count = ::read(STDIN_FILENO, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return unreadable(std::strerror(errno));
    if (count == 0) return text;
    text.bytes.append(block.data(), static_cast<std::size_t>(count));
    if (text.bytes.size() > largest_source)
      return unreadable(fmt::format("it has more than {} MB, the most that Wale reads", largest_source >> 20));
  }
}

/// Formats one file; "-" means from standard input to standard output.
int format_file(const std::string& file, bool check_only) {
  const bool standard = file == "-";
  auto read = standard ? standard_input() : read_file(file);
  if (!read) {
    if (!standard && read.error().mend.empty()) read.error().mend = mend_of_path(file);
    return refuse(read.error());
  }
  if (const auto other = other_file(file, read->bytes))
    return refuse(Error{.code = Code::damaged_file,
                        .sentence = fmt::format("expected a Wale file, found {}", other->what),
                        .mend = std::string(other->mend),
                        .place = {.name = file}});
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add(file, std::move(read->bytes));
  const auto formatted = wale::format(sources, source, diagnostics);
  print_diagnostics(stderr, diagnostics, sources);
  if (!formatted) return refused;
  const bool changes = *formatted != sources[source].text;
  if (check_only) {
    if (changes) print_out("{}\n", visible_text(file));
    return changes ? refused : done;
  }
  if (standard) {
    if (const auto written = write_file("-", *formatted, {}); !written) return refuse(written.error());
  } else if (changes) {
    if (const auto written = replace_file(file, *formatted); !written) return refuse(written.error());
  }
  return done;
}

int format(const FormatOptions& options) {
  int status = done;
  for (const auto& file : options.files)
    if (format_file(file, options.check_only) != done) status = refused;
  return status;
}

Run declare_format(CLI::App& verb) {
  const auto options = std::make_shared<FormatOptions>();
  must_say(verb.add_option("FILE", options->files, "paths of Wale files; - for standard input to standard output"),
           "the path of a Wale file, or -")
      ->required();
  verb.add_flag("--check", options->check_only,
                "changes nothing; lists the files that would change and fails if there are any");
  verb.footer("for example: wale format library/fabric/*.wale");
  return [options] { return format(*options); };
}

}  // namespace

extern const Verb format_verb{"format", "formats Wale files in the standard style", declare_format};

}  // namespace wale::command
