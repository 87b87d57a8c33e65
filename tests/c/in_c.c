/* Every function of wale.h at its edges, from C99. Each part ends without a handle left. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <wale.h>

#include "tests/c/check.h"
#include "tests/c/parts.h"
#include "tests/c/placed.h"
#include "tests/c/readme.h"

WaleLibrary* library;
WaleProgram* corduroy;

static void errors(void) {
  WaleProgram* program = (WaleProgram*)library;
  WaleError* error = NULL;
  WaleErrorDetails details = {.size = sizeof details};
  CHECK(wale_library_find(library, WALE_TEXT("corduory"), NULL, &program, &error) == WALE_CODE_unknown_name);
  CHECK(program == NULL);
  CHECK(wale_error_code(error) == WALE_CODE_unknown_name);
  CHECK(wale_error_details(error, &details) == 0);
  CHECK(details.code == 201 && details.severity == WALE_SEVERITY_error);
  CHECK(is_text(details.place, "name") && is_text(details.place_text, "corduory"));
  CHECK(details.nearest >= 1 && details.nearest <= 3);
  CHECK(is_text(wale_error_nearest(error, 0), "corduroy"));
  CHECK(wale_error_nearest(error, details.nearest).length == 0);
  CHECK(details.number == -1 && details.column == -1);
  CHECK(strstr(details.in_words.data, details.sentence.data) != NULL);
  wale_error_free(error);
  wale_error_free(error); /* freed already */

  /* A place in a text, and the other errors of the same text. */
  CHECK(wale_library_compile(library, WALE_TEXT("wale 1\nmaterial m {\n  physical { force = 1 + nothing  a = b }\n}\n"),
                             NULL, &program, &error) != 0);
  CHECK(wale_error_details(error, &details) == 0);
  CHECK(is_text(details.place, "text") && details.number == 3 && details.column > 1 && details.place_text.length > 0);
  CHECK(wale_error_other(error, details.others) == NULL);
  for (size_t i = 0; i < details.others; ++i) CHECK(wale_error_code(wale_error_other(error, i)) != 0);
  wale_error_free(error);

  CHECK(wale_error_code(NULL) == 0);
  CHECK(wale_error_details(NULL, &details) == WALE_CODE_malformed_value);
  CHECK(is_text(wale_error_nearest(NULL, 0), "") && wale_error_other(NULL, 0) == NULL);
  CHECK(is_text(wale_code_name(301), "W0301") && wale_code_title(301).length > 0);
  CHECK(is_text(wale_code_name(9999), "") && is_text(wale_code_title(-1), ""));
  CHECK(wale_code_severity(WALE_CODE_unused_name) == WALE_SEVERITY_warning);
  CHECK(wale_version().length > 0 && wale_interface() >= WALE_INTERFACE);

  /* Without a place for it, an error is only its code. */
  CHECK(wale_library_find(library, WALE_TEXT("corduory"), NULL, &program, NULL) == WALE_CODE_unknown_name);
}

static void texts(void) {
  WaleProgram* program = NULL;
  const char invalid[] = {(char)0xff, (char)0xfe, 0};
  const WaleText none = {NULL, 0}, wrong = {NULL, 7}, endless = {"x", SIZE_MAX - 1}, with_zero = {"cor\0duroy", 9};
  CHECK_CODE(WALE_CODE_invalid_encoding, wale_library_find(library, WALE_TEXT(invalid), NULL, &program, &error));
  CHECK_CODE(WALE_CODE_invalid_encoding, wale_library_find(library, with_zero, NULL, &program, &error));
  CHECK_MALFORMED(wale_library_find(library, wrong, NULL, &program, &error));
  CHECK_MALFORMED(wale_library_find(library, endless, NULL, &program, &error));
  CHECK_CODE(WALE_CODE_invalid_encoding, wale_library_compile(library, WALE_TEXT(invalid), NULL, &program, &error));
  WaleError* error = NULL;
  CHECK(wale_library_find(library, none, NULL, &program, &error) != 0); /* the empty text is no name */
  wale_error_free(error);
  CHECK(program == NULL);
}

/* A struct of a caller who is newer than the library: known fields, then unknown ones. */
typedef struct NewerOptions {
  WaleCompileOptions known;
  double unknown[3];
} NewerOptions;

static void sizes(void) {
  WaleProgram* program = NULL;
  NewerOptions newer;
  memset(&newer, 0, sizeof newer);
  newer.known.size = sizeof newer;
  newer.known.device = WALE_TEXT("desktop_20N");
  CHECK_CODE(WALE_CODE_unknown_device, wale_library_find(library, WALE_TEXT("oil"), &newer.known, &program, &error));
  newer.known.device = WALE_TEXT("sandpaper");
  CHECK_GOOD(wale_library_find(library, WALE_TEXT("oil"), &newer.known, &program, &error));
  wale_program_free(program);
  newer.unknown[2] = 1; /* something that this library cannot do */
  CHECK_CODE(WALE_CODE_newer_file, wale_library_find(library, WALE_TEXT("oil"), &newer.known, &program, &error));

  /* An older caller: the fields after its end are not read. */
  WaleCompileOptions older = {
      .size = offsetof(WaleCompileOptions, material), .device = WALE_TEXT("sandpaper"), .material = {NULL, 1234}};
  CHECK_GOOD(wale_library_find(library, WALE_TEXT("oil"), &older, &program, &error));
  wale_program_free(program);

  const size_t wrong[] = {0, 1, 4, sizeof older - 1, sizeof older + 3, (size_t)1 << 40, SIZE_MAX};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
    older.size = wrong[i];
    CHECK_MALFORMED(wale_library_find(library, WALE_TEXT("oil"), &older, &program, &error));
    WaleProgramDetails details = {.size = wrong[i], .rate = -7};
    CHECK_MALFORMED(wale_program_details(corduroy, &details, &error));
    CHECK(details.rate == -7);
  }

  /* Results: an older caller's struct is written to its end and no further, a newer one's tail becomes 0. */
  struct {
    WaleProgramDetails known;
    unsigned char more[64];
  } details;
  memset(&details, 0xAA, sizeof details);
  details.known.size = offsetof(WaleProgramDetails, device);
  CHECK_GOOD(wale_program_details(corduroy, &details.known, &error));
  CHECK(is_text(details.known.material, "corduroy"));
  CHECK(details.known.size == offsetof(WaleProgramDetails, device));
  for (size_t i = details.known.size; i < sizeof details; ++i) CHECK(((unsigned char*)&details)[i] == 0xAA);
  details.known.size = sizeof details.known + 32;
  CHECK_GOOD(wale_program_details(corduroy, &details.known, &error));
  CHECK(is_text(details.known.device, "sandpaper") && details.known.rate > 100);
  for (size_t i = 0; i < sizeof details.more; ++i) CHECK(details.more[i] == (i < 32 ? 0 : 0xAA));
}

static void programs(void) {
  WaleProgramDetails details = {.size = sizeof details};
  CHECK_GOOD(wale_program_details(corduroy, &details, &error));
  CHECK(details.parameters == 2 || details.parameters == 1);
  CHECK(details.percepts >= 1 && details.width > 0 && details.height > 0 && !details.vibrates);
  int found = 0;
  WaleParameter parameter = {.size = sizeof parameter};
  for (size_t i = 0; i < details.parameters; ++i) {
    CHECK_GOOD(wale_program_parameter(corduroy, i, &parameter, &error));
    if (!is_text(parameter.name, "wale")) continue;
    found = 1;
    CHECK(is_text(parameter.unit, "mm") && is_text(parameter.si_unit, "m") &&
          fabs(parameter.unit_in_si - 1e-3) < 1e-12);
    CHECK(fabs(parameter.value - 2.5e-3) < 1e-9 && fabs(parameter.low - 1e-3) < 1e-9 &&
          fabs(parameter.high - 5e-3) < 1e-9);
  }
  CHECK(found);
  CHECK_MALFORMED(wale_program_parameter(corduroy, details.parameters, &parameter, &error));
  WalePercept percept = {.size = sizeof percept};
  CHECK_GOOD(wale_program_percept(corduroy, 0, &percept, &error));
  CHECK(is_text(percept.name, "roughness") && is_text(percept.unit, "N"));
  CHECK(fabs(percept.level - 0.6) < 0.01);
  CHECK(fabs(percept.amplitude - 1.934) < 0.002); /* N, schema/LANGUAGE.md */
  CHECK_MALFORMED(wale_program_percept(corduroy, details.percepts, &percept, &error));
  WaleFate fate = {.size = sizeof fate};
  CHECK_GOOD(wale_program_fate(corduroy, 0, &fate, &error));
  CHECK(is_text(fate.name, "roughness") && fate.is_percept == 1 && fate.fate == WALE_FATE_kept);
  CHECK(fabs(fate.asked - 0.6) < 1e-6 && fabs(fate.given - 0.6) < 0.01);
  CHECK_MALFORMED(wale_program_fate(corduroy, details.fates, &fate, &error));

  /* There and back through the bytes of a file. */
  size_t length = 0, again = 0;
  CHECK_GOOD(wale_program_bytes(corduroy, NULL, 0, &length, &error));
  CHECK(length > 100);
  unsigned char* bytes = malloc(length);
  memset(bytes, 0, length);
  CHECK_GOOD(wale_program_bytes(corduroy, bytes, length - 1, &again, &error));
  CHECK(again == length && bytes[0] == 0); /* not enough room: nothing is written */
  CHECK_GOOD(wale_program_bytes(corduroy, bytes, length, &again, &error));
  WaleProgram *loaded = NULL, *opened = NULL;
  CHECK_GOOD(wale_program_load(bytes, length, &loaded, &error));
  CHECK_GOOD(wale_library_open_bytes(library, bytes, length, NULL, &opened, &error));
  CHECK_GOOD(wale_program_bytes(loaded, NULL, 0, &again, &error));
  CHECK(again == length);
  wale_program_free(loaded);
  wale_program_free(loaded); /* freed already */
  wale_program_free(opened);
  bytes[length / 2] ^= 1;
  CHECK_CODE(WALE_CODE_damaged_file, wale_program_load(bytes, length, &loaded, &error));
  CHECK_CODE(WALE_CODE_damaged_file, wale_program_load(bytes, 0, &loaded, &error));
  CHECK_MALFORMED(wale_program_load(NULL, 5, &loaded, &error));
  CHECK_MALFORMED(wale_program_load(bytes, length, NULL, &error));
  CHECK_MALFORMED(wale_program_bytes(NULL, NULL, 0, &length, &error));
  CHECK_MALFORMED(wale_program_bytes(corduroy, NULL, 0, NULL, &error));
  CHECK_MALFORMED(wale_program_details(NULL, &details, &error));
  CHECK_MALFORMED(wale_program_details(corduroy, NULL, &error));
  CHECK_MALFORMED(wale_program_parameter(NULL, 0, &parameter, &error));
  CHECK_MALFORMED(wale_program_percept(corduroy, 0, NULL, &error));
  CHECK(wale_program_warning(NULL, 0) == NULL && wale_program_warning(corduroy, 1000) == NULL);
  free(bytes);
}

static void warnings(void) {
  WaleProgram* program = NULL;
  WaleProgramDetails details = {.size = sizeof details};
  CHECK_GOOD(wale_library_compile(
      library,
      WALE_TEXT("wale 1\nmaterial m {\n  physical {\n    let unused = 0.5 mm\n    force = -1 N/m * hand\n  }\n}\n"),
      NULL, &program, &error));
  if (program == NULL) return;
  CHECK_GOOD(wale_program_details(program, &details, &error));
  CHECK(details.warnings >= 1);
  const WaleError* warning = wale_program_warning(program, 0);
  WaleErrorDetails said = {.size = sizeof said};
  CHECK(wale_error_details(warning, &said) == 0);
  CHECK(said.severity == WALE_SEVERITY_warning && said.number > 0);
  wale_program_free(program);
}

static void libraries(void) {
  WaleLibrary* another = NULL;
  const WaleText folders[] = {WALE_TEXT("/does/not/exist")};
  WaleLibraryOptions options = {.size = sizeof options, .folders = folders, .folder_count = 1};
  CHECK_CODE(WALE_CODE_unreadable_file, wale_library_create(&options, &another, &error));
  CHECK(another == NULL);
  options.folders = NULL;
  CHECK_MALFORMED(wale_library_create(&options, &another, &error));
  CHECK_MALFORMED(wale_library_create(NULL, NULL, &error));

  WaleProgram* program = NULL;
  CHECK_GOOD(wale_library_level(library, WALE_TEXT("roughness"), WALE_TEXT("coarse"), NULL, &program, &error));
  wale_program_free(program);
  CHECK_CODE(WALE_CODE_level_out_of_range,
             wale_library_level(library, WALE_TEXT("roughness"), WALE_TEXT("1.5"), NULL, &program, &error));
  CHECK_CODE(WALE_CODE_unknown_name,
             wale_library_level(library, WALE_TEXT("rougness"), WALE_TEXT("coarse"), NULL, &program, &error));
  CHECK_CODE(WALE_CODE_unreadable_file,
             wale_library_open(library, WALE_TEXT("/does/not/exist.wale"), NULL, &program, &error));
  CHECK_CODE(WALE_CODE_damaged_file, wale_library_open_bytes(library,
                                                             "\x7f"
                                                             "ELF",
                                                             4, NULL, &program, &error));
  CHECK_MALFORMED(wale_library_open_bytes(library, NULL, 4, NULL, &program, &error));
  CHECK_MALFORMED(wale_library_find(NULL, WALE_TEXT("corduroy"), NULL, &program, &error));
  CHECK_MALFORMED(wale_library_find(library, WALE_TEXT("corduroy"), NULL, NULL, &error));
  CHECK_MALFORMED(wale_library_level(NULL, WALE_TEXT("a"), WALE_TEXT("b"), NULL, &program, &error));
  CHECK_MALFORMED(wale_library_compile(NULL, WALE_TEXT("a"), NULL, &program, &error));
  CHECK_MALFORMED(wale_library_open(NULL, WALE_TEXT("a"), NULL, &program, &error));
  wale_library_free(NULL);
}

static void futures(void) {
  WaleLibrary* own = NULL;
  WaleFuture *first = NULL, *second = NULL, *third = NULL, *late = NULL;
  WaleProgram* program = NULL;
  CHECK_GOOD(wale_library_create(NULL, &own, &error));
  CHECK_GOOD(wale_library_find_later(own, WALE_TEXT("corduroy"), NULL, &first, &error));
  CHECK_GOOD(wale_library_level_later(own, WALE_TEXT("roughness"), WALE_TEXT("7"), NULL, &second, &error));
  CHECK_GOOD(wale_library_compile_later(own, WALE_TEXT("no Wale"), NULL, &third, &error));
  CHECK(wale_future_wait(first, INFINITY) == 1 && wale_future_poll(first) == 1);
  CHECK_GOOD(wale_future_take(first, &program, &error));
  wale_program_free(program);
  CHECK_CODE(WALE_CODE_wrong_moment, wale_future_take(first, &program, &error));
  CHECK(wale_future_poll(first) == 1);
  CHECK_CODE(WALE_CODE_level_out_of_range, wale_future_take(second, &program, &error));
  CHECK(wale_future_wait(third, 60) == 1 && wale_future_wait(third, NAN) == 1);
  WaleError* error = NULL;
  CHECK(wale_future_take(third, &program, &error) != 0);
  wale_error_free(error);
  /* The library ends first: what it had not begun says so. */
  for (int i = 0; i < 20; ++i) {
    wale_future_free(late);
    CHECK_GOOD(wale_library_open_later(own, WALE_TEXT("/does/not/exist.wale"), NULL, &late, &error));
    WaleFuture* dropped = NULL;
    CHECK_GOOD(wale_library_find_later(own, WALE_TEXT("slate"), NULL, &dropped, &error));
    wale_future_free(dropped);
  }
  wale_library_free(own);
  const WaleCode gave = wale_future_take(late, &program, NULL);
  CHECK(gave == WALE_CODE_wrong_moment || gave == WALE_CODE_unreadable_file);
  wale_future_free(first), wale_future_free(second), wale_future_free(third), wale_future_free(late);
  wale_future_free(late); /* freed already */
  wale_future_free(NULL);
  CHECK(wale_future_poll(NULL) == 0 && wale_future_wait(NULL, 1) == 0);
  CHECK_MALFORMED(wale_future_take(NULL, &program, &error));
  CHECK_MALFORMED(wale_library_find_later(NULL, WALE_TEXT("a"), NULL, &late, &error));
  CHECK_MALFORMED(wale_library_find_later(library, WALE_TEXT("a"), NULL, NULL, &error));
}

/* By words: what a search by feel finds is tested from Python, which makes the same calls. */
static void searches(void) {
  WaleMatches *matches = NULL, *later = NULL;
  WaleMatch match = {.size = sizeof match};
  WaleFuture *future = NULL, *of_program = NULL;
  WaleProgram* program = NULL;
  size_t done = 7, all = 7;
  CHECK_GOOD(wale_library_search(library, WALE_TEXT("rough ribbed cotton"), NULL, &matches, &error));
  CHECK(wale_matches_count(matches) >= 1 && wale_matches_warning(matches, 0) == NULL);
  CHECK_GOOD(wale_matches_match(matches, 0, &match, &error));
  CHECK(is_text(match.name, "corduroy") && is_text(match.found_by, "called") && is_text(match.found_in, "ribbed cotton"));
  CHECK(match.score > 0 && isnan(match.low) && isnan(match.other_high) && match.unknown == 0);
  CHECK(wale_matches_unknown(matches, 0, 0).length == 0 && wale_matches_other_unknown(matches, 99999, 0).length == 0);
  CHECK_MALFORMED(wale_matches_match(matches, wale_matches_count(matches), &match, &error));
  CHECK_GOOD(wale_library_search_later(library, WALE_TEXT("ribbed"), NULL, &future, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_future_take(future, &program, &error));
  CHECK(wale_future_wait(future, INFINITY) == 1);
  wale_future_progress(future, &done, &all);
  CHECK(done == 0 && all == 0); /* words need no index */
  wale_future_cancel(future);   /* too late */
  CHECK_GOOD(wale_future_take_matches(future, &later, &error));
  CHECK(wale_matches_count(later) > 0);
  wale_matches_free(later);
  CHECK_CODE(WALE_CODE_wrong_moment, wale_future_take_matches(future, &later, &error));
  CHECK_GOOD(wale_library_find_later(library, WALE_TEXT("corduroy"), NULL, &of_program, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_future_take_matches(of_program, &later, &error));
  wale_future_progress(NULL, NULL, NULL), wale_future_cancel(NULL), wale_future_cancel(of_program);
  const WalePerceptRange range = {.percept = WALE_TEXT("roughness"), .low = 0.7, .high = 0.4};
  const WaleSearchOptions wrong = {.size = sizeof wrong, .percepts = &range, .percept_count = 1};
  CHECK_CODE(WALE_CODE_level_out_of_range, wale_library_search(library, WALE_TEXT(""), &wrong, &later, &error));
  CHECK_CODE(WALE_CODE_unknown_name, wale_library_nearest(library, WALE_TEXT("corderoy"), NULL, &later, &error));
  CHECK_CODE(WALE_CODE_unknown_name, wale_library_between(library, WALE_TEXT("slate"), WALE_TEXT("nix"), NULL, &later, &error));
  wale_future_free(future), wale_future_free(of_program), wale_matches_free(matches), wale_matches_free(NULL);
  CHECK(later == NULL && wale_matches_count(NULL) == 0);
}

static void* find_denim(void* found) {
  CHECK_GOOD(wale_library_find(library, WALE_TEXT("denim"), NULL, (WaleProgram**)found, &error));
  return NULL;
}

static void two_threads(void) {
  pthread_t threads[2];
  WaleProgram* found[2] = {NULL, NULL};
  for (int i = 0; i < 2; ++i) CHECK(pthread_create(&threads[i], NULL, find_denim, &found[i]) == 0);
  for (int i = 0; i < 2; ++i) pthread_join(threads[i], NULL);
  for (int i = 0; i < 2; ++i) wale_program_free(found[i]);
}

int main(void) {
  readme_task();
  CHECK(wale_handles() == 0);
  CHECK_GOOD(wale_library_create(NULL, &library, &error));
  CHECK_GOOD(wale_library_find(library, WALE_TEXT("corduroy"), NULL, &corduroy, &error));
  run_parts((Part[]){errors, texts, sizes, programs, warnings, libraries, futures, searches, two_threads, NULL});
  failures += stage_parts() + running_parts() + workspace_parts() + null_parts();
  wale_program_free(corduroy);
  wale_library_free(library);
  CHECK(wale_handles() == 0);
  return failures != 0;
}
