/* Real-time calls allocate nothing; other calls survive when there is no memory left, and leave nothing behind. */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>
#include <wale.h>

#include "tests/c/check.h"

/* The C library's own, under the names that it keeps for this. */
extern void* __libc_malloc(size_t size);

static _Thread_local long allocations;  /* of this thread */
static _Thread_local long allowed = -1; /* so many more; -1: all */

void* malloc(size_t size) {
  ++allocations;
  if (allowed == 0) return NULL;
  if (allowed > 0) --allowed;
  return __libc_malloc(size);
}

static WaleLibrary* library;
static WaleProgram* corduroy;
static WaleDevice* device;
static WaleStage* stage;
static WalePatch* patch;
static unsigned char* bytes;
static size_t length;

static WaleCode load(WaleError** error) {
  WaleProgram* program = NULL;
  const WaleCode code = wale_program_load(bytes, length, &program, error);
  wale_program_free(program);
  return code;
}

static WaleCode find(WaleError** error) {
  WaleProgram* program = NULL;
  const WaleCode code = wale_library_find(library, WALE_TEXT("needlecord"), NULL, &program, error);
  wale_program_free(program);
  return code;
}

static WaleCode find_nothing(WaleError** error) {
  WaleProgram* program = NULL;
  const WaleCode code = wale_library_find(library, WALE_TEXT("needlecoat"), NULL, &program, error);
  return code == WALE_CODE_unknown_name ? 0 : code;
}

static WaleCode add(WaleError** error) {
  WalePatch* added = NULL;
  const size_t before = wale_stage_size(stage);
  const WaleCode code = wale_stage_add(stage, corduroy, NULL, &added, error);
  CHECK(wale_stage_size(stage) == before + (code == 0));
  if (code == 0) {
    allowed = -1;
    wale_patch_remove(added, NULL);
  }
  wale_patch_free(added);
  return code;
}

static WaleCode set(WaleError** error) { return wale_patch_set(patch, WALE_TEXT("wale"), 0.002, error); }

static WaleCode edit(WaleError** error) {
  WaleEdit* one = NULL;
  WaleCode code = wale_stage_edit(stage, &one, error);
  if (code == 0) code = wale_edit_move(one, patch, 0, 0, error);
  if (code == 0) code = wale_edit_commit(one, error);
  wale_edit_free(one);
  return code;
}

static WaleCode look(WaleError** error) {
  WaleSnapshot* snapshot = NULL;
  const WaleCode code = wale_patch_snapshot(patch, &snapshot, error);
  wale_snapshot_free(snapshot);
  return code;
}

static WaleCode make_stage(WaleError** error) {
  WaleProfile profile;
  WaleStage* another = NULL;
  memset(&profile, 0, sizeof profile);
  profile.size = sizeof profile;
  WaleCode code = wale_profile(WALE_TEXT("sandpaper"), &profile, error);
  if (code == 0) code = wale_stage_create_for(&profile, NULL, &another, error);
  wale_stage_free(another);
  return code;
}

/* Lets the first allocations of a call succeed, one more each time, until it needs no more. */
static void starve(const char* name, WaleCode (*call)(WaleError**)) {
  const size_t before = wale_handles();
  for (long enough = 0;; ++enough) {
    WaleError* error = NULL;
    allowed = enough;
    const WaleCode code = call(&error);
    allowed = -1;
    CHECK(code == 0 || code == WALE_CODE_short_of_resources);
    CHECK(code == 0 || wale_error_code(error) != 0);
    wale_error_free(error);
    if (wale_handles() != before || failures != 0 || enough > 200000) {
      fprintf(stderr, "%s with %ld allocations: code %d, %ld handles left\n", name, enough, (int)code,
              (long)(wale_handles() - before));
      ++failures;
      return;
    }
    if (code == 0) return;
    if (enough > 400) enough += enough / 50; /* calls that compile allocate much */
  }
}

static void real_time_calls_allocate_nothing(void) {
  WaleStage* own = NULL;
  WaleLoop* loop = NULL;
  WaleProfile profile = {.size = sizeof profile};
  CHECK_GOOD(wale_profile(WALE_TEXT("sandpaper"), &profile, &error));
  CHECK_GOOD(wale_stage_create_for(&profile, NULL, &own, &error));
  CHECK_GOOD(wale_stage_add(own, corduroy, NULL, NULL, &error));
  CHECK_GOOD(wale_loop_begin(own, &loop, &error));
  WaleReading reading = {.size = sizeof reading};
  WaleNow now = {.size = sizeof now};
  float largest = 0;
  for (int i = 0; i < 100000 && largest == 0; ++i) { /* until the patch is felt */
    reading.counts_x = i % 300 - 150;
    largest = fabsf(wale_loop_step(loop, &reading, 1).x);
    usleep(100);
  }
  CHECK(largest > 0 && wale_stage_now(own, &now) == 0);
  const int64_t ticks = now.ticks_run;
  const long before = allocations;
  for (int i = 0; i < 3000; ++i) {
    reading.counts_x = i % 300 - 150;
    const WaleVector force = wale_loop_step(loop, &reading, 1);
    wale_loop_exerted(loop, force);
    wale_stage_now(own, &now);
  }
  CHECK(allocations == before);
  CHECK(now.ticks_run == ticks + 3000);
  wale_loop_free(loop);
  wale_stage_free(own);
}

/* Whoever ends a run ends its force, whether or not there is memory for the figures. */
static void stops_end_the_run(void) {
  for (long enough = 0; enough < 3; ++enough) {
    WaleRun* run = NULL;
    CHECK_GOOD(wale_stage_start(stage, &error));
    allowed = enough;
    const WaleCode code = wale_stage_stop(stage, &run, NULL);
    allowed = -1;
    CHECK(code == 0 || code == WALE_CODE_short_of_resources);
    CHECK(!wale_stage_is_running(stage));
    wale_run_free(run);
  }
}

int main(void) {
  WaleRunOptions options = {.size = sizeof options, .seconds = 0.1, .virtual_time = 1};
  CHECK_GOOD(wale_library_create(NULL, &library, &error));
  CHECK_GOOD(wale_library_find(library, WALE_TEXT("corduroy"), NULL, &corduroy, &error));
  CHECK_GOOD(wale_library_open_device(library, WALE_TEXT("simulated"), NULL, &device, &error));
  CHECK_GOOD(wale_stage_create(device, NULL, &stage, &error));
  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, &patch, &error));
  CHECK_GOOD(wale_stage_run(stage, &options, NULL, &error));
  CHECK_GOOD(wale_program_bytes(corduroy, NULL, 0, &length, &error));
  bytes = malloc(length);
  CHECK_GOOD(wale_program_bytes(corduroy, bytes, length, &length, &error));
  CHECK(allocations > 1000);
  real_time_calls_allocate_nothing();
  starve("load", load);
  starve("find_nothing", find_nothing);
  starve("make_stage", make_stage);
  starve("set", set);
  starve("edit", edit);
  starve("add", add);
  starve("look", look);
  stops_end_the_run();
  starve("find", find);
  CHECK_GOOD(wale_stage_run(stage, &options, NULL, &error)); /* the stage is whole */
  free(bytes);
  wale_patch_free(patch), wale_stage_free(stage), wale_device_free(device), wale_program_free(corduroy);
  wale_library_free(library);
  CHECK(wale_handles() == 0);
  return failures != 0;
}
