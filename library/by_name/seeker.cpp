#include "library/by_name/seeker.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "compiler/modules/load_modules.hpp"
#include "compiler/text/readable.hpp"
#include "library/by_name/told.hpp"
#include "library/store/kept_index.hpp"
#include "library/store/seek.hpp"
#include "library/store/why_nothing.hpp"
#include "schema/name_text.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

bool is_blank(const std::string& text) { return text.find_first_not_of(" \t\n\r") == std::string::npos; }

/// Errors of the words and the kind that are sought.
Result<> are_sound(const std::string& text, const SearchOptions& options) {
  if (!is_blank(text))
    if (auto name = is_name_text("text", text, "write words, as in \"rough ribbed cotton\"", "words"); !name) return name;
  if (!options.kind.empty())
    if (auto name = is_name_text("kind", options.kind, "write a kind, as in \"fabric\"", "a kind"); !name) return name;
  return {};
}

/// Errors: an unknown percept; levels that are none.
Result<std::vector<SoughtLevel>> sought_levels(const std::vector<PerceptRange>& ranges) {
  std::vector<SoughtLevel> levels;
  const Declarations& known = common_modules()->declarations;
  for (const PerceptRange& each : ranges) {
    if (!known.percept_named(each.percept).percept)
      return unknown(Code::unknown_name, "percept", each.percept, known.percept_spellings());
    if (!std::isfinite(each.low) || !std::isfinite(each.high))
      return Error{.code = Code::malformed_value,
                   .sentence = "expected finite levels",
                   .mend = "write, for example, low 0.4 and high 0.6",
                   .place = {.name = "percepts", .text = each.percept}};
    if (!(each.low >= 0) || !(each.high <= 1) || !(each.low <= each.high))
      return Error{.code = Code::level_out_of_range,
                   .sentence = readable("expected levels from 0 to 1, the lower one first, found {:.6g} and {:.6g}", each.low,
                                        each.high),
                   .mend = "write, for example, low 0.4 and high 0.6",
                   .place = {.name = "percepts", .text = each.percept}};
    levels.push_back({each.percept, each.low, each.high});
  }
  return levels;
}

Match match_of(const Entry& entry) {
  return {.name = entry.name, .module = entry.module, .file = entry.file, .title = entry.title, .kind = entry.kind};
}

Match match_of(const FoundEntry& found, bool by_words) {
  Match match = match_of(found.entry);
  match.score = found.score;
  if (by_words) match.found_by = in_words(found.why.place), match.found_in = found.why.text;
  return match;
}

Match match_of(const FoundMaterial& found, bool by_words) {
  const IndexedMaterial& each = *found.material;
  Match match{.name = each.name, .module = each.module, .file = each.file, .title = each.title, .kind = each.kind};
  if (by_words) match.found_by = in_words(found.by), match.found_in = found.text;
  return match;
}

FeltDistance distance_of(Probe::Told told) {
  return {told.low, told.high, std::move(told.unknown), std::move(told.plainest)};
}

std::optional<std::uint64_t> most_of(const SearchOptions& options) {
  return options.most == 0 ? std::nullopt : std::optional<std::uint64_t>(options.most);
}

/// Error: there is no such kind.
Result<> is_kind(const std::string& kind, const std::vector<std::string>& kinds) {
  if (kind.empty() || std::ranges::find(kinds, kind) != kinds.end()) return {};
  return unknown(Code::unknown_name, "kind", kind, kinds);
}

/// The error about a material that is an argument.
Error about_material(Error error, const char* argument, const std::string& text) {
  if (error.place.name == text && !error.place.number) {
    if (error.code == Code::unreadable_file) {
      error.sentence = "`" + visible_text(text) + "` " + error.sentence;
      error.mend = "name a Wale file that exists, or a material";
    }
    error.place = {.name = argument, .text = text};
  }
  return in_own_words(std::move(error));
}

}  // namespace

Seeker::Opened::Opened() : here(std::make_unique<IndexHere>()) {}
Seeker::Opened::~Opened() = default;

Result<> Seeker::open(Opened& opened, const SearchOptions& options, const FileRequest& request,
                      const std::vector<std::string>& meant) const {
  // It is called by threads that nothing may leave.
  std::exception_ptr thrown;
  const auto go_on = [&](std::size_t done, std::size_t all) {
    if (ends_ || thrown) return false;
    try {
      return !options.progress || options.progress(done, all);
    } catch (...) {
      thrown = std::current_exception();
      return false;
    }
  };
  std::vector<Error> warnings;
  const bool was_open = opened.here->store || opened.here->in_memory;
  const MaterialIndex* const before = was_open ? &opened.here->index() : nullptr;
  auto done = open_index(*opened.here, place_, request, meant,
                         {go_on, [&](Error warning) { warnings.push_back(std::move(warning)); }});
  if (thrown) std::rethrow_exception(thrown);
  if (!done) return done;
  if (!before || before != &opened.here->index() || !warnings.empty()) opened.warnings = std::move(warnings);
  const std::string device = opened.here->index().device();
  if (!options.device.empty() && device != options.device)
    return Error{.code = Code::other_device,
                 .sentence = "the index is for `" + device + "`",
                 .mend = "leave out the device, or make an index for it: `wale library index --device " + options.device + "`",
                 .place = {.name = "device", .text = options.device}};
  return {};
}

Result<SearchResult> Seeker::search(const std::string& text, const SearchOptions& options, const FileRequest& request) {
  if (auto sound = are_sound(text, options); !sound) return sound.error();
  if (!options.near.empty() || !options.percepts.empty() || !place_.empty())
    return by_feel(text, options, request, "near");
  const auto catalogue = library_index(*file_resolver(request.roots), "here");
  if (auto known = is_kind(options.kind, kinds_in(*catalogue)); !known) return known.error();
  Seeking sought{.texts = {}, .kind = options.kind, .near = {}, .levels = {}, .most = most_of(options)};
  const bool by_words = !is_blank(text);
  if (by_words) sought.texts.push_back(text);
  const FoundByWords found = seek_by_words(*catalogue, sought);
  SearchResult result;
  for (const FoundMaterial& each : found.as_they_stand) result.matches.push_back(match_of(each, by_words));
  for (const FoundEntry& each : found.most_words) result.matches.push_back(match_of(each, by_words));
  if (result.matches.empty()) {
    Error why = in_own_words(why_nothing_is_found(*catalogue, sought.texts, options.kind));
    why.place = {.name = "text", .text = text};
    result.warnings.push_back(std::move(why));
  }
  return result;
}

Result<SearchResult> Seeker::nearest(const std::string& material, SearchOptions options, const FileRequest& request) {
  if (auto name = is_name_text("material", material); !name) return name.error();
  if (auto sound = are_sound({}, options); !sound) return sound.error();
  if (!options.near.empty())
    return Error{.code = Code::malformed_value,
                 .sentence = "two materials that the others are to feel like",
                 .mend = "leave `near` out, or ask `between`",
                 .place = {.name = "near", .text = options.near}};
  options.near = material;
  return by_feel({}, options, request, "material");
}

Result<SearchResult> Seeker::by_feel(const std::string& text, const SearchOptions& options, const FileRequest& request,
                                     const char* near) {
  auto levels = sought_levels(options.percepts);
  if (!levels) return levels.error();
  Seeking sought{.texts = {}, .kind = options.kind, .near = options.near, .levels = *std::move(levels), .most = most_of(options)};
  const bool by_words = !is_blank(text);
  if (by_words) sought.texts.push_back(text);
  std::vector<std::string> meant;
  if (!options.near.empty()) meant.push_back(options.near);

  Opened& opened = *opened_;
  const std::lock_guard lock(opened.mutex);
  if (auto open = this->open(opened, options, request, meant); !open) return about_material(open.error(), near, options.near);
  const MaterialIndex& index = opened.here->index();
  if (auto known = is_kind(options.kind, kinds_in(index)); !known) return known.error();
  auto found = seek_by_feel(index, request, sought);
  if (!found) {
    Error error = about_material(found.error(), near, options.near);
    if (error.place.name.starts_with("--"))  // as the command line calls the argument
      error.place = {.name = "percepts", .text = error.place.name.substr(2)};
    return error;
  }
  SearchResult result{.matches = {}, .warnings = opened.warnings};
  for (FoundEntry& each : found->entries) {
    Match& match = result.matches.emplace_back(match_of(each, by_words));
    if (each.apart) match.distance = distance_of(*std::move(each.apart));
  }
  return result;
}

Result<SearchResult> Seeker::between(const std::string& one, const std::string& other, const SearchOptions& options,
                                     const FileRequest& request) {
  if (auto name = is_name_text("one", one); !name) return name.error();
  if (auto name = is_name_text("other", other); !name) return name.error();
  if (auto sound = are_sound({}, options); !sound) return sound.error();
  if (!options.near.empty() || !options.percepts.empty())
    return Error{.code = Code::malformed_value,
                 .sentence = "`between` has no other feel that is sought",
                 .mend = "leave `near` and `percepts` out",
                 .place = {.name = options.near.empty() ? "percepts" : "near"}};
  const auto about = [&](Error error) { return about_material(about_material(std::move(error), "one", one), "other", other); };
  Opened& opened = *opened_;
  const std::lock_guard lock(opened.mutex);
  if (auto open = this->open(opened, options, request, {one, other}); !open) return about(open.error());
  const MaterialIndex& index = opened.here->index();
  if (auto known = is_kind(options.kind, kinds_in(index)); !known) return known.error();
  auto found = seek_between(index, request, one, other, options.kind, most_of(options).value_or(usually_between));
  if (!found) return about(found.error());
  SearchResult result{.matches = {}, .warnings = opened.warnings};
  for (FoundBetween::Each& each : found->found) {
    Match& match = result.matches.emplace_back(match_of(each.found, false));
    match.distance = distance_of(std::move(each.from_one)), match.from_other = distance_of(std::move(each.from_other));
  }
  return result;
}

}  // namespace wale
