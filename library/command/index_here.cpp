#include "library/command/index_here.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/text/readable.hpp"

namespace wale::command {
FileRequest request_of(const IndexChoice& choice) {
  FileRequest request;
  request.device = choice.device, request.sandbox = choice.sandbox;
  request.roots = library_folders(choice.folders, std::getenv("WALE_LIBRARY"));
  return request;
}

void offer_index(CLI::App& verb, IndexChoice& choice) {
  must_say(verb.add_option("--index", choice.file,
                           "look in this index as it stands, a file or postgresql://USER@HOST/DATABASE, which `wale library "
                           "index` makes (default: one in the user's cache, which is brought up to date)")
               ->type_name("FILE"),
           "the name of an index", "`wale library index -o FILE` makes one");
  offer_library(verb, choice.folders, "a folder whose materials are looked at too, as in my/materials; may be repeated");
  offer_sandbox(verb, choice.sandbox);
}

StoreProgress shown_progress(const std::string& what) {
  using Clock = std::chrono::steady_clock;
  struct Shown {
    Clock::time_point begun = Clock::now(), last = begun;
    bool said = false;
  };
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  return [shown = std::make_shared<Shown>(), is_terminal, what](std::size_t done, std::size_t all) {
    constexpr std::chrono::duration<double> moment(0.7), between(0.1), long_enough(3);
    constexpr std::size_t enough_to_guess = 16;
    const auto now = Clock::now();
    if (is_terminal && done == all) {
      if (shown->said) print_as_is(stderr, "\r\033[K");
    } else if (now - shown->begun > (done < enough_to_guess ? long_enough : moment) && now - shown->last > between) {
      const double seconds = std::chrono::duration<double>(now - shown->begun).count();
      const double left = seconds / static_cast<double>(done) * static_cast<double>(all - done);
      if (is_terminal)
        print_as_is(stderr, fmt::format("\rreading the library for its {}: {} of {} files, {:.0f} s left\033[K", what, done, all, left));
      else if (!shown->said)
        print_as_is(stderr, fmt::format("wale: the library is read for its {}: {} files, about {:.0f} s; the next time "
                                        "only what has changed is read\n", what, all, seconds + left));
      shown->said = true, shown->last = now;
    }
    return true;
  };
}

Result<IndexHere> index_here(const IndexChoice& choice, const std::vector<std::string>& meant) {
  IndexHere here;
  const auto warn = [](const Error& warning) {
    print_error("wale: {}{}\n", warning.sentence, warning.mend.empty() ? "" : "; " + warning.mend);
  };
  if (auto opened = open_index(here, choice.file, request_of(choice), meant, {shown_progress(), warn}); !opened)
    return opened.error();
  return here;
}

std::string distance_text(const Probe::Told& told) {
  const auto number = [](double value) { return readable("{:.1f}", value); };
  const auto plural = [](double value) { return std::abs(value - 1) < 0.05 ? "difference" : "differences"; };
  std::string by = told.plainest.empty() ? "" : fmt::format(" ({})", told.plainest);
  if (told.unknown.empty()) return fmt::format("{} {}{}", number(told.low), plural(told.low), by);
  const std::string most = std::isfinite(told.high) ? fmt::format("{} to {}", number(told.low), number(told.high))
                                                    : fmt::format("at least {}", number(told.low));
  return fmt::format("{} differences{}; unknown: {}", most, by, fmt::join(told.unknown, ", "));
}

nlohmann::ordered_json distance_json(const Probe::Told& told) {
  nlohmann::ordered_json json = {{"low", told.low}, {"high", nullptr}};
  if (std::isfinite(told.high)) json["high"] = told.high;
  json["unknown"] = told.unknown, json["plainest"] = told.plainest;
  return json;
}

}  // namespace wale::command
