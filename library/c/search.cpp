#include "wale/search.h"

#include <limits>
#include <span>
#include <utility>

#include "library/c/future.hpp"
#include "runtime/c/program.hpp"
#include "runtime/c/sized.hpp"

struct WaleMatches {
  wale::SearchResult result;
  std::vector<std::unique_ptr<WaleError>> warnings;
};

namespace wale::c {
namespace {

Result<SearchOptions> read_search_options(const WaleSearchOptions* options) {
  const auto given = read_sized("options", options);
  if (!given) return given.error();
  if (given->percept_count > 0 && given->percepts == nullptr)
    return about_argument("percepts", "expected an array, found NULL", "set `percept_count` to 0");
  SearchOptions read;
  auto kind = read_text("kind", given->kind);
  if (!kind) return std::move(kind).error();
  auto near = read_path("near", given->near);
  if (!near) return std::move(near).error();
  auto device = read_text("device", given->device);
  if (!device) return std::move(device).error();
  read.kind = *std::move(kind), read.near = *std::move(near), read.device = *std::move(device), read.most = given->most;
  for (const WalePerceptRange& each : std::span(given->percepts, given->percept_count)) {
    auto percept = read_text("percepts", each.percept);
    if (!percept) return std::move(percept).error();
    read.percepts.push_back({*std::move(percept), each.low, each.high});
  }
  return read;
}

void hand_out_matches(SearchResult result, WaleMatches** to) {
  std::unique_ptr<WaleMatches> made(new WaleMatches{std::move(result), {}});
  for (Error& each : made->result.warnings) made->warnings.push_back(handle_of(std::move(each)));
  hand_out(std::move(made), to);
}

/// A call of the library that searches: `make(library, options)`.
template <class Make>
WaleCode make_matches(WaleLibrary* library, const WaleSearchOptions* options, WaleMatches** matches, WaleError** error,
                      const Make& make) {
  return call(error, [&]() -> Result<> {
    if (auto clear = clear_result("matches", matches); !clear) return clear;
    if (auto given = is_given("library", library); !given) return given;
    const auto read = read_search_options(options);
    if (!read) return read.error();
    Result<SearchResult> result = make(library->library, *read);
    if (!result) return std::move(result).error();
    hand_out_matches(*std::move(result), matches);
    return {};
  });
}

/// The same, which gives a future.
template <class Make>
WaleCode make_future_matches(WaleLibrary* library, const WaleSearchOptions* options, WaleFuture** future, WaleError** error,
                             const Make& make) {
  return call(error, [&]() -> Result<> {
    if (auto clear = clear_result("future", future); !clear) return clear;
    if (auto given = is_given("library", library); !given) return given;
    auto read = read_search_options(options);
    if (!read) return read.error();
    auto state = std::make_shared<SearchState>();
    read->progress = [state](std::size_t done, std::size_t all) {
      state->all = all, state->done = done;
      return !state->ends;
    };
    Result<std::future<Result<SearchResult>>> begun = make(library->library, *std::move(read));
    if (!begun) return std::move(begun).error();
    std::unique_ptr<WaleFuture> made(new WaleFuture{.matches = *std::move(begun), .state = std::move(state)});
    hand_out(std::move(made), future);
    return {};
  });
}

const Match* match_at(const WaleMatches* matches, std::size_t index) {
  return matches != nullptr && index < matches->result.matches.size() ? &matches->result.matches[index] : nullptr;
}

WaleText unknown_of(const Match* match, std::optional<FeltDistance> Match::*which_distance, std::size_t which) {
  if (match == nullptr || !(match->*which_distance)) return text_of({});
  const std::vector<std::string>& unknown = (match->*which_distance)->unknown;
  return text_of(which < unknown.size() ? std::string_view(unknown[which]) : std::string_view());
}

}  // namespace
}  // namespace wale::c

using namespace wale::c;

WaleCode wale_library_search(WaleLibrary* library, WaleText text, const WaleSearchOptions* options, WaleMatches** matches,
                             WaleError** error) {
  return make_matches(library, options, matches, error,
                      [&](const wale::Library& in, const auto& read) -> wale::Result<wale::SearchResult> {
                        const auto words = read_text("text", text);
                        return words ? in.search(*words, read) : words.error();
                      });
}

WaleCode wale_library_nearest(WaleLibrary* library, WaleText material, const WaleSearchOptions* options,
                              WaleMatches** matches, WaleError** error) {
  return make_matches(library, options, matches, error,
                      [&](const wale::Library& in, const auto& read) -> wale::Result<wale::SearchResult> {
                        const auto name = read_text("material", material);
                        return name ? in.nearest(*name, read) : name.error();
                      });
}

WaleCode wale_library_between(WaleLibrary* library, WaleText one, WaleText other, const WaleSearchOptions* options,
                              WaleMatches** matches, WaleError** error) {
  return make_matches(library, options, matches, error,
                      [&](const wale::Library& in, const auto& read) -> wale::Result<wale::SearchResult> {
                        const auto first = read_text("one", one);
                        if (!first) return first.error();
                        const auto second = read_text("other", other);
                        return second ? in.between(*first, *second, read) : second.error();
                      });
}

using LaterMatches = wale::Result<std::future<wale::Result<wale::SearchResult>>>;

WaleCode wale_library_search_later(WaleLibrary* library, WaleText text, const WaleSearchOptions* options,
                                   WaleFuture** future, WaleError** error) {
  return make_future_matches(library, options, future, error, [&](const wale::Library& in, auto read) -> LaterMatches {
    const auto words = read_text("text", text);
    if (!words) return words.error();
    return in.search_later(*words, std::move(read));
  });
}

WaleCode wale_library_nearest_later(WaleLibrary* library, WaleText material, const WaleSearchOptions* options,
                                    WaleFuture** future, WaleError** error) {
  return make_future_matches(library, options, future, error, [&](const wale::Library& in, auto read) -> LaterMatches {
    const auto name = read_text("material", material);
    if (!name) return name.error();
    return in.nearest_later(*name, std::move(read));
  });
}

WaleCode wale_library_between_later(WaleLibrary* library, WaleText one, WaleText other, const WaleSearchOptions* options,
                                    WaleFuture** future, WaleError** error) {
  return make_future_matches(library, options, future, error, [&](const wale::Library& in, auto read) -> LaterMatches {
    const auto first = read_text("one", one);
    if (!first) return first.error();
    const auto second = read_text("other", other);
    if (!second) return second.error();
    return in.between_later(*first, *second, std::move(read));
  });
}

void wale_future_progress(const WaleFuture* future, size_t* done, size_t* all) {
  const bool searches = future != nullptr && future->state != nullptr;
  if (done != nullptr) *done = searches ? future->state->done.load() : 0;
  if (all != nullptr) *all = searches ? future->state->all.load() : 0;
}

void wale_future_cancel(WaleFuture* future) {
  if (future != nullptr && future->state) future->state->ends = true;
}

WaleCode wale_future_take_matches(WaleFuture* future, WaleMatches** matches, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("matches", matches); !clear) return clear;
    if (auto ready = is_to_take(future, true); !ready) return ready;
    auto result = future->matches.get();
    if (!result) return std::move(result).error();
    hand_out_matches(*std::move(result), matches);
    return {};
  });
}

void wale_matches_free(WaleMatches* matches) { free_handle(matches); }

size_t wale_matches_count(const WaleMatches* matches) {
  return matches == nullptr ? 0 : matches->result.matches.size();
}

WaleCode wale_matches_match(const WaleMatches* matches, size_t index, WaleMatch* match, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("matches", matches); !given) return given;
    if (auto sized = is_sized("match", match); !sized) return sized;
    if (auto there = is_there(index, matches->result.matches.size()); !there) return there;
    const wale::Match& known = matches->result.matches[index];
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    static const wale::FeltDistance unsought{.low = none, .high = none};
    const wale::FeltDistance& distance = known.distance ? *known.distance : unsought;
    const wale::FeltDistance& other = known.from_other ? *known.from_other : unsought;
    write_sized(match, {.name = text_of(known.name),
                        .module = text_of(known.module),
                        .file = text_of(known.file),
                        .title = text_of(known.title),
                        .kind = text_of(known.kind),
                        .found_by = text_of(known.found_by),
                        .found_in = text_of(known.found_in),
                        .score = known.score,
                        .low = distance.low,
                        .high = distance.high,
                        .plainest = text_of(distance.plainest),
                        .unknown = distance.unknown.size(),
                        .other_low = other.low,
                        .other_high = other.high,
                        .other_plainest = text_of(other.plainest),
                        .other_unknown = other.unknown.size()});
    return {};
  });
}

WaleText wale_matches_unknown(const WaleMatches* matches, size_t index, size_t which) {
  return unknown_of(match_at(matches, index), &wale::Match::distance, which);
}

WaleText wale_matches_other_unknown(const WaleMatches* matches, size_t index, size_t which) {
  return unknown_of(match_at(matches, index), &wale::Match::from_other, which);
}

const WaleError* wale_matches_warning(const WaleMatches* matches, size_t index) {
  return matches != nullptr && index < matches->warnings.size() ? matches->warnings[index].get() : nullptr;
}
