/* Running stages, loops, snapshots, batches and recordings, at their edges. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/c/check.h"
#include "tests/c/parts.h"
#include "tests/c/placed.h"

typedef struct Heard {
  int entered, left;
  uint64_t patch;
} Heard;

static void hear(const WaleContact* contact, void* user) {
  Heard* heard = user;
  CHECK(contact->size >= sizeof *contact);
  heard->entered += contact->kind == WALE_CONTACT_enter;
  heard->left += contact->kind == WALE_CONTACT_leave;
  heard->patch = contact->patch;
}

static void running(void) {
  WaleStage* stage = new_stage();
  WalePatch* patch = NULL;
  Heard heard = {0, 0, 0};
  WalePatchOptions narrow = {.size = sizeof narrow, .width = 0.01f, .height = 0.03f};
  size_t dropped = 7;
  CHECK_GOOD(wale_stage_on_contact(stage, hear, &heard, &error));
  CHECK_GOOD(wale_stage_add(stage, corduroy, &narrow, &patch, &error));
  wale_run_free(run_for(stage, 2));
  CHECK_GOOD(wale_stage_poll(stage, &dropped, &error));
  /* It begins on the patch and crosses its middle every half second; the last time it may be late. */
  CHECK(heard.entered == 4 || heard.entered == 5);
  CHECK(heard.left == 4 && heard.patch == wale_patch_id(patch) && dropped == 0);
  CHECK_GOOD(wale_stage_on_contact(stage, NULL, NULL, &error));
  CHECK_MALFORMED(wale_stage_on_contact(NULL, hear, NULL, &error));
  CHECK_MALFORMED(wale_stage_poll(NULL, NULL, &error));

  WaleNow now = {.size = sizeof now};
  CHECK(wale_stage_now(stage, &now) == 0);
  CHECK(now.ticks_run > 100 && now.patch == (now.inside ? wale_patch_id(patch) : 0));
  now.size = 3;
  CHECK(wale_stage_now(stage, &now) == WALE_CODE_malformed_value);
  CHECK(wale_stage_now(stage, NULL) == WALE_CODE_malformed_value);

  /* In real time. */
  CHECK_GOOD(wale_stage_start(stage, &error));
  CHECK(wale_stage_is_running(stage));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_stage_start(stage, &error));
  now.size = sizeof now;
  for (int i = 0; i < 15000; ++i) {
    usleep(2000);
    CHECK(wale_stage_now(stage, &now) == 0);
    if (now.ticks_run > 20) break;
  }
  CHECK(now.ticks_run > 20);
  WaleRun* run = NULL;
  WaleRunFigures figures = {.size = sizeof figures};
  CHECK_GOOD(wale_stage_stop(stage, &run, &error));
  CHECK_GOOD(wale_run_figures(run, &figures, &error));
  CHECK(figures.ticks_run > 20 && figures.recorded == 0 && figures.scheduling.length > 0);
  CHECK_CODE(WALE_CODE_wrong_moment, wale_stage_stop(stage, NULL, &error));
  wale_run_free(run);
  wale_patch_free(patch);
  wale_stage_free(stage);
}

static void* run_long(void* stage) {
  WaleRunOptions options = {.size = sizeof options, .seconds = 3600};
  WaleRun* run = NULL;
  CHECK_GOOD(wale_stage_run(stage, &options, &run, &error));
  wale_run_free(run);
  return NULL;
}

static void until_it_runs(WaleStage* stage) {
  for (int i = 0; i < 30000 && !wale_stage_is_running(stage); ++i) usleep(1000);
  CHECK(wale_stage_is_running(stage));
}

static void* change_it(void* patch) {
  for (int i = 0; i < 200; ++i) CHECK_GOOD(wale_patch_set(patch, WALE_TEXT("wale"), i % 2 ? 0.002 : 0.003, &error));
  return NULL;
}

static void from_other_threads(void) {
  WaleStage* stage = new_stage();
  WalePatch* patch = NULL;
  pthread_t runner, changer;
  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, &patch, &error));
  CHECK(pthread_create(&runner, NULL, run_long, stage) == 0);
  until_it_runs(stage);
  CHECK(pthread_create(&changer, NULL, change_it, patch) == 0);
  WaleNow now = {.size = sizeof now};
  for (int i = 0; i < 200; ++i) CHECK(wale_stage_now(stage, &now) == 0);
  pthread_join(changer, NULL);
  wale_stage_interrupt(stage);
  pthread_join(runner, NULL);
  /* A run that another thread has called ends with its stage. */
  CHECK(pthread_create(&runner, NULL, run_long, stage) == 0);
  until_it_runs(stage);
  wale_stage_free(stage);
  pthread_join(runner, NULL);
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_move(patch, 0, 0, &error));
  wale_patch_free(patch);
}

static int of_child(WaleStage* stage, WalePatch* patch, WaleFuture* future, WaleLoop* loop) {
  WaleProgram* program = NULL;
  const WaleReading reading = {.size = sizeof reading};
  if (wale_stage_start(stage, NULL) != WALE_CODE_wrong_moment || wale_stage_stop(stage, NULL, NULL) != WALE_CODE_wrong_moment)
    return 1;
  if (wale_patch_move(patch, 0, 0, NULL) != WALE_CODE_wrong_moment) return 2;
  if (!wale_future_wait(future, INFINITY) || wale_future_take(future, &program, NULL) != WALE_CODE_wrong_moment) return 3;
  if (wale_loop_step(loop, &reading, 1).x != 0) return 4;
  wale_future_free(future), wale_loop_free(loop), wale_patch_free(patch), wale_stage_free(stage);
  future = NULL;
#if !defined(__SANITIZE_THREAD__) /* it allows no threads after a fork */
  if (wale_library_find_later(library, WALE_TEXT("oil"), NULL, &future, NULL)) return 5;
  if (wale_future_take(future, &program, NULL)) return 6;
#endif
  wale_program_free(program), wale_future_free(future), wale_library_free(library);
  return 0;
}

static void forking(void) {
  WaleStage *stage = new_stage(), *plain = NULL;
  WalePatch* patch = NULL;
  WaleFuture* future = NULL;
  WaleLoop* loop = NULL;
  WaleProgram* program = NULL;
  WaleProfile profile = {.size = sizeof profile};
  int status = -1;
  CHECK_GOOD(wale_profile(WALE_TEXT("sandpaper"), &profile, &error));
  CHECK_GOOD(wale_stage_create_for(&profile, NULL, &plain, &error));
  CHECK_GOOD(wale_loop_begin(plain, &loop, &error));
  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, &patch, &error));
  CHECK_GOOD(wale_stage_start(stage, &error));
  CHECK_GOOD(wale_library_find_later(library, WALE_TEXT("corduroy"), NULL, &future, &error));
  const pid_t child = fork();
  if (child == 0) _exit(of_child(stage, patch, future, loop));
  CHECK(waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0);
  CHECK(wale_stage_is_running(stage));
  CHECK_GOOD(wale_future_take(future, &program, &error));
  wale_program_free(program), wale_future_free(future), wale_loop_free(loop), wale_patch_free(patch);
  wale_stage_free(stage), wale_stage_free(plain);
}

static void wrong_readings(void) {
  WaleStage* stage = NULL;
  WaleLoop* loop = NULL;
  WaleProfile profile = {.size = sizeof profile};
  WaleNow now = {.size = sizeof now};
  CHECK_GOOD(wale_profile(WALE_TEXT("sandpaper"), &profile, &error));
  WaleProfile wrong = profile;
  wrong.name = WALE_TEXT("");
  CHECK_MALFORMED(wale_stage_create_for(&wrong, NULL, &stage, &error));
  wrong = profile, wrong.velocity_window = 1e9;
  CHECK_MALFORMED(wale_stage_create_for(&wrong, NULL, &stage, &error));
  wrong = profile, wrong.delay_x = 1e9;
  CHECK_MALFORMED(wale_stage_create_for(&wrong, NULL, &stage, &error));
  CHECK_GOOD(wale_stage_create_for(&profile, NULL, &stage, &error));
  CHECK_GOOD(wale_loop_begin(stage, &loop, &error));
  WaleReading reading = {.size = sizeof reading, .counts_x = INT32_MIN, .measures_interaction = 1, .interaction_x = INFINITY};
  const WaleVector force = wale_loop_step(loop, &reading, 1);
  wale_loop_exerted(loop, (WaleVector){NAN, INFINITY});
  CHECK(force.x == 0 && force.y == 0);
  CHECK(wale_stage_now(stage, &now) == 0 && now.position.x == 0 && now.guards.lost == 1);
  /* A reading that sets a field which this library does not know is not read as if it did not. */
  struct {
    WaleReading known;
    int64_t newer;
  } longer = {.known = {.size = sizeof longer}};
  wale_loop_step(loop, &longer.known, 1);
  CHECK(wale_stage_now(stage, &now) == 0 && now.guards.stale == 0);
  longer.newer = 1;
  wale_loop_step(loop, &longer.known, 1);
  CHECK(wale_stage_now(stage, &now) == 0 && now.guards.stale == 1);
  /* A contact that nobody knows is none. */
  WaleReading unknown = {.size = sizeof unknown, .contact = 77};
  wale_loop_step(loop, &unknown, 1);
  CHECK(wale_stage_now(stage, &now) == 0 && now.guards.stale == 1 && now.guards.lost == 2);
  wale_loop_free(loop), wale_stage_free(stage);
}

static void loops(void) {
  WaleStage* stage = NULL;
  WaleLoop *loop = NULL, *second = NULL;
  WaleProfile profile = {.size = sizeof profile};
  CHECK_GOOD(wale_profile(WALE_TEXT("sandpaper"), &profile, &error));
  CHECK_GOOD(wale_stage_create_for(&profile, NULL, &stage, &error));
  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, NULL, &error));
  CHECK_GOOD(wale_loop_begin(stage, &loop, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_loop_begin(stage, &second, &error));
  CHECK_MALFORMED(wale_loop_begin(NULL, &second, &error));
  CHECK_MALFORMED(wale_loop_begin(stage, NULL, &error));
  WaleReading reading = {.size = sizeof reading};
  double largest = 0;
  for (int i = 0; i < 100000 && (i < 2000 || largest < 1); ++i) {
    reading.counts_x = (int32_t)(profile.position_counts / 8 * sin(i * 2 * 3.14159265 / profile.rate));
    const WaleVector force = wale_loop_step(loop, &reading, 1);
    wale_loop_exerted(loop, force);
    if (fabs(force.x) > largest) largest = fabs(force.x);
    usleep(100); /* so that the bank is there */
  }
  CHECK(largest > 1 && largest < 2.5);
  WaleVector none = wale_loop_step(loop, NULL, 1);
  CHECK(none.x == 0 && none.y == 0);
  reading.contact = 77;
  none = wale_loop_step(loop, &reading, 1);
  CHECK(none.x == 0 && none.y == 0);
  reading.size = 1;
  none = wale_loop_step(loop, &reading, -5);
  CHECK(none.x == 0 && none.y == 0);
  none = wale_loop_step(NULL, &reading, 1);
  CHECK(none.x == 0 && none.y == 0);
  wale_loop_exerted(NULL, none);
  reading.size = sizeof reading;
  WaleNow now = {.size = sizeof now};
  for (int i = 0; i < 3; ++i) { /* no number of periods turns time back */
    const double before = now.time;
    wale_loop_step(loop, &reading, INT64_MAX);
    CHECK(wale_stage_now(stage, &now) == 0 && now.time >= before);
  }
  wale_stage_free(stage); /* the loop goes on, and nothing is felt */
  reading = (WaleReading){.size = sizeof reading};
  for (int i = 0; i < 2000; ++i) {
    reading.counts_x = i * 3 % 600;
    none = wale_loop_step(loop, &reading, 1);
    CHECK(none.x == 0 && none.y == 0);
  }
  wale_loop_free(loop);
  wale_loop_free(loop); /* freed already */
  wale_loop_free(NULL);
}

static void snapshots(void) {
  WaleStage* stage = new_stage();
  WalePatch* patch = NULL;
  WaleProgram* sand = NULL;
  WaleSnapshot* snapshot = NULL;
  CHECK_GOOD(wale_library_find(library, WALE_TEXT("sandpit"), NULL, &sand, &error));
  WaleProgramDetails details = {.size = sizeof details};
  CHECK_GOOD(wale_program_details(sand, &details, &error));
  CHECK_GOOD(wale_stage_add(stage, sand, NULL, &patch, &error));
  wale_run_free(run_for(stage, 2));
  CHECK_GOOD(wale_patch_snapshot(patch, &snapshot, &error));
  CHECK_MALFORMED(wale_patch_snapshot(patch, NULL, &error));
  wale_patch_free(patch), wale_stage_free(stage), wale_program_free(sand); /* it outlives them */

  size_t states = 99;
  const float* values = wale_snapshot_states(snapshot, &states);
  CHECK(states == details.states && (states == 0 || values != NULL));
  for (size_t i = 0; i < states; ++i) CHECK(wale_snapshot_state_name(snapshot, i).length > 0);
  CHECK(is_text(wale_snapshot_state_name(snapshot, states), ""));
  CHECK(details.grids >= 1);
  WaleGrid grid = {.size = sizeof grid};
  CHECK_GOOD(wale_snapshot_grid(snapshot, 0, &grid, &error));
  int furrows = 0;
  for (size_t i = 1; i < grid.columns * grid.rows; ++i) furrows += grid.cells[i] != grid.cells[0];
  CHECK(furrows > 0 && grid.name.length > 0);
  CHECK_MALFORMED(wale_snapshot_grid(snapshot, details.grids, &grid, &error));

  WaleVector places[9000];
  float *heights = malloc(sizeof *heights * 9000), *colours = malloc(sizeof *colours * 3 * 9000);
  for (int i = 0; i < 9000; ++i) places[i] = (WaleVector){(float)(i % 100 - 50) * 4e-4f, (float)(i / 100 - 45) * 4e-4f};
  CHECK_GOOD(wale_snapshot_surface(snapshot, places, 9000, heights, colours, &error));
  int hills = 0;
  for (int i = 1; i < 9000; ++i) hills += heights[i] != heights[0];
  CHECK(hills > 0);
  CHECK_GOOD(wale_snapshot_surface(snapshot, NULL, 0, NULL, NULL, &error));
  CHECK_MALFORMED(wale_snapshot_surface(snapshot, NULL, 1, heights, NULL, &error));
  CHECK_MALFORMED(wale_snapshot_surface(snapshot, places, 1, NULL, NULL, &error));
  CHECK_MALFORMED(wale_snapshot_surface(NULL, places, 1, heights, NULL, &error));
  free(heights), free(colours);

  WaleMark marks[16];
  size_t count = 99;
  const WaleVector hand = {0, 0};
  CHECK_GOOD(wale_snapshot_show(snapshot, hand, hand, 0, marks, 16, &count, &error));
  CHECK(count <= 16);
  CHECK_GOOD(wale_snapshot_show(snapshot, hand, hand, 0, NULL, 0, &count, &error));
  CHECK_MALFORMED(wale_snapshot_show(snapshot, (WaleVector){NAN, 0}, hand, 0, marks, 16, &count, &error));
  CHECK_MALFORMED(wale_snapshot_show(snapshot, hand, hand, NAN, marks, 16, &count, &error));
  CHECK_MALFORMED(wale_snapshot_show(snapshot, hand, hand, 0, marks, 16, NULL, &error));
  CHECK_MALFORMED(wale_snapshot_show(NULL, hand, hand, 0, marks, 16, &count, &error));
  wale_snapshot_free(snapshot);
  wale_snapshot_free(snapshot); /* freed already */
  CHECK(wale_snapshot_states(NULL, NULL) == NULL && is_text(wale_snapshot_state_name(NULL, 0), ""));
  CHECK_MALFORMED(wale_snapshot_grid(NULL, 0, &grid, &error));
}

static void batches(void) {
  enum { hands = 300, ticks = 20 };
  WaleVector *positions = malloc(sizeof *positions * hands * ticks), *forces = malloc(sizeof *forces * hands * ticks),
             *again = malloc(sizeof *again * hands * ticks);
  for (int hand = 0; hand < hands; ++hand)
    for (int tick = 0; tick < ticks; ++tick)
      positions[hand * ticks + tick] = (WaleVector){(float)hand * 2e-5f + (float)tick * 1e-4f, 0};
  WaleBatchOptions options = {.size = sizeof options, .hands = hands, .ticks = ticks, .position = positions};
  CHECK_GOOD(wale_batch(corduroy, &options, forces, &error));
  float largest = 0;
  for (int i = 0; i < hands * ticks; ++i) largest = fabsf(forces[i].x) > largest ? fabsf(forces[i].x) : largest;
  CHECK(largest > 1.8f && largest < 2.2f); /* N: the 99th percentile is 1.934 N */
  /* One hand alone feels the same. */
  options.hands = 1;
  options.position = positions + 7 * ticks;
  CHECK_GOOD(wale_batch(corduroy, &options, again, &error));
  CHECK(memcmp(again, forces + 7 * ticks, sizeof *again * ticks) == 0);
  /* The period of the ribs moves the force. */
  WaleSetting setting = {WALE_TEXT("wale"), 0.005};
  options.settings = &setting;
  options.setting_count = 1;
  CHECK_GOOD(wale_batch(corduroy, &options, again, &error));
  CHECK(memcmp(again, forces + 7 * ticks, sizeof *again * ticks) != 0);
  setting.name = WALE_TEXT("whale");
  CHECK_CODE(WALE_CODE_unknown_name, wale_batch(corduroy, &options, again, &error));
  setting = (WaleSetting){WALE_TEXT("wale"), NAN};
  CHECK_MALFORMED(wale_batch(corduroy, &options, again, &error));
  options.settings = NULL;
  CHECK_MALFORMED(wale_batch(corduroy, &options, again, &error));
  options.setting_count = 0;
  options.width = 0.01f;
  CHECK_MALFORMED(wale_batch(corduroy, &options, again, &error));
  options.height = 0.01f;
  CHECK_GOOD(wale_batch(corduroy, &options, again, &error));
  options.rim = -1;
  CHECK_MALFORMED(wale_batch(corduroy, &options, again, &error));
  options.rim = 0;
  positions[7 * ticks + 3] = (WaleVector){NAN, INFINITY};
  CHECK_MALFORMED(wale_batch(corduroy, &options, again, &error));
  const size_t sizes[][2] = {{0, 1}, {1, 0}, {SIZE_MAX, 1}, {SIZE_MAX / 2, 3}};
  for (int i = 0; i < 4; ++i) {
    options.hands = sizes[i][0], options.ticks = sizes[i][1];
    CHECK_MALFORMED(wale_batch(corduroy, &options, again, &error));
  }
  options.hands = options.ticks = 1;
  CHECK_MALFORMED(wale_batch(corduroy, &options, NULL, &error));
  CHECK_MALFORMED(wale_batch(NULL, &options, again, &error));
  CHECK_MALFORMED(wale_batch(corduroy, NULL, again, &error));
  options.position = NULL;
  CHECK_MALFORMED(wale_batch(corduroy, &options, again, &error));
  free(positions), free(forces), free(again);
}

static void recordings(void) {
  char file[] = "wale_in_c_XXXXXX";
  const int made = mkstemp(file);
  CHECK(made >= 0);
  close(made);
  unlink(file); /* it must not exist */
  WaleDevice* device = simulated();
  WaleStage* stage = NULL;
  WaleStageOptions options = {
      .size = sizeof options, .max_force = 3, .record = WALE_TEXT(file), .record_hand = WALE_TEXT("lateral")};
  CHECK_GOOD(wale_stage_create(device, &options, &stage, &error));
  wale_device_free(device);
  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, NULL, &error));
  WaleRun* run = run_for(stage, 1);
  WaleRunOptions once_more = {.size = sizeof once_more, .seconds = 1, .virtual_time = 1};
  CHECK_CODE(WALE_CODE_unwritable_file, wale_stage_run(stage, &once_more, NULL, &error));
  wale_stage_free(stage);
  WaleRunFigures figures = {.size = sizeof figures};
  CHECK_GOOD(wale_run_figures(run, &figures, &error));
  WaleRecording* recording = NULL;
  WaleRecordingDetails details = {.size = sizeof details};
  CHECK_GOOD(wale_recording_open(WALE_TEXT(file), &recording, &error));
  CHECK_GOOD(wale_recording_details(recording, &details, &error));
  CHECK(details.complete && details.virtual_time && details.ticks == (uint64_t)figures.ticks_run);
  CHECK(is_text(details.hand, "lateral") && is_text(details.device, "sandpaper") && details.max_force == 3);
  WaleRecordedTick tick;
  WaleTick kept;
  CHECK_GOOD(wale_recording_ticks(recording, details.ticks - 1, 1, sizeof tick, &tick, &error));
  CHECK_GOOD(wale_run_ticks(run, details.ticks - 1, 1, sizeof kept, &kept, &error));
  CHECK(tick.force.x == kept.force.x && tick.velocity.x == kept.velocity.x && tick.inside == kept.inside);
  CHECK(fabs(tick.counts_x * details.position_step - kept.position.x) < 1e-6);
  CHECK_MALFORMED(wale_recording_ticks(recording, details.ticks, 1, sizeof tick, &tick, &error));
  WaleReplay replay = {.size = sizeof replay};
  CHECK_GOOD(wale_recording_replay(recording, &replay, &error));
  CHECK(replay.ticks == details.ticks && replay.differing == 0 && replay.largest_force == 0);
  /* Its beginning, as of a file that is cut short. */
  WaleRecording* part = NULL;
  uint64_t intact = 0;
  CHECK_GOOD(wale_recording_intact(WALE_TEXT(file), &intact, &error));
  CHECK(intact == (uint64_t)figures.ticks_run);
  CHECK_CODE(WALE_CODE_unreadable_file, wale_recording_intact(WALE_TEXT("/does/not/exist"), &intact, &error));
  CHECK(intact == 0);
  CHECK_GOOD(wale_recording_open_part(WALE_TEXT(file), 100, &part, &error));
  CHECK_GOOD(wale_recording_details(part, &details, &error));
  CHECK(details.ticks == 100 && !details.complete);
  wale_recording_free(part);
  CHECK_GOOD(wale_recording_open_part(WALE_TEXT(file), SIZE_MAX, &part, &error));
  CHECK_GOOD(wale_recording_details(part, &details, &error));
  CHECK(details.ticks == (uint64_t)figures.ticks_run && details.complete);
  wale_recording_free(part);
  wale_run_free(run);
  unlink(file);
  wale_recording_free(recording);
  wale_recording_free(recording); /* freed already */
  CHECK_CODE(WALE_CODE_unreadable_file, wale_recording_open(WALE_TEXT(file), &recording, &error));
  CHECK_MALFORMED(wale_recording_open(WALE_TEXT(file), NULL, &error));
  CHECK_MALFORMED(wale_recording_details(NULL, &details, &error));
  CHECK_MALFORMED(wale_recording_ticks(NULL, 0, 1, sizeof tick, &tick, &error));
  CHECK_MALFORMED(wale_recording_replay(NULL, &replay, &error));
}

int running_parts(void) {
  run_parts((Part[]){running, from_other_threads, loops, forking, wrong_readings, snapshots, batches, recordings, NULL});
  return failures;
}
