/* What a call says about an argument that is NULL, and about a stage without a device: the place, the sentence, and
   what to do about it. */
#include <stdlib.h>

#include "tests/c/check.h"
#include "tests/c/parts.h"
#include "tests/c/placed.h"

/* The call fails so. Without a place for it, the code is the same. */
#define CHECK_SAYS(wanted, where, what, to_do, call)                                                        \
  do {                                                                                                      \
    WaleError* error = NULL;                                                                                \
    WaleErrorDetails said = {.size = sizeof said};                                                          \
    CHECK((call) == (wanted));                                                                              \
    CHECK(wale_error_details(error, &said) == 0);                                                           \
    if (!is_text(said.place, where) || !is_text(said.sentence, what) || !is_text(said.mend, to_do)) {       \
      fprintf(stderr, "%s:%d: %s says at `%s`: %s; %s\n", __FILE__, __LINE__, #call, said.place.data,       \
              said.sentence.data, said.mend.data);                                                          \
      ++failures;                                                                                           \
    }                                                                                                       \
    CHECK(said.severity == WALE_SEVERITY_error && strstr(said.in_words.data, to_do) != NULL);               \
    wale_error_free(error);                                                                                 \
  } while (0)

#define CHECK_NULL(argument, call)                                                                                  \
  CHECK_SAYS(WALE_CODE_malformed_value, argument, "expected a value, found NULL",                                   \
             "hand over a pointer; if an earlier call should have given `" argument "`, look at its error", call)
#define CHECK_NO_STRUCT(argument, call)                                                                             \
  CHECK_SAYS(WALE_CODE_malformed_value, argument, "expected a struct, found NULL", "hand over the address of one", \
             call)
#define CHECK_NO_PLACE(argument, call)                                                                              \
  CHECK_SAYS(WALE_CODE_malformed_value, argument, "expected a place for the result, found NULL",                    \
             "hand over the address of a pointer", call)

static const WaleText name = {"corduroy", WALE_ZERO_ENDED};

static void libraries(void) {
  WaleProgram* program = NULL;
  WaleFuture* future = NULL;
  WaleWorkspace* workspace = NULL;
  WaleDevices* devices = NULL;
  WaleDevice* device = NULL;
  WaleProfile profile = {.size = sizeof profile};
  CHECK_NULL("library", wale_library_find(NULL, name, NULL, &program, &error));
  CHECK_NULL("library", wale_library_level(NULL, name, name, NULL, &program, &error));
  CHECK_NULL("library", wale_library_compile(NULL, name, NULL, &program, &error));
  CHECK_NULL("library", wale_library_open(NULL, name, NULL, &program, &error));
  CHECK_NULL("library", wale_library_open_bytes(NULL, "x", 1, NULL, &program, &error));
  CHECK_NULL("bytes", wale_library_open_bytes(library, NULL, 1, NULL, &program, &error));
  CHECK_NULL("library", wale_library_workspace(NULL, name, NULL, &workspace, &error));
  CHECK_NULL("library", wale_library_open_workspace(NULL, name, NULL, &workspace, &error));
  CHECK_NULL("library", wale_library_find_later(NULL, name, NULL, &future, &error));
  CHECK_NULL("library", wale_library_level_later(NULL, name, name, NULL, &future, &error));
  CHECK_NULL("library", wale_library_compile_later(NULL, name, NULL, &future, &error));
  CHECK_NULL("library", wale_library_open_later(NULL, name, NULL, &future, &error));
  CHECK_NULL("library", wale_library_devices(NULL, &devices, &error));
  CHECK_NULL("library", wale_library_profile(NULL, name, &profile, &error));
  CHECK_NULL("library", wale_library_open_device(NULL, name, NULL, &device, &error));
  CHECK_NULL("future", wale_future_take(NULL, &program, &error));
  WaleMatches* matches = NULL;
  WaleMatch match = {.size = sizeof match};
  CHECK_NULL("library", wale_library_search(NULL, name, NULL, &matches, &error));
  CHECK_NULL("library", wale_library_nearest(NULL, name, NULL, &matches, &error));
  CHECK_NULL("library", wale_library_between(NULL, name, name, NULL, &matches, &error));
  CHECK_NULL("library", wale_library_search_later(NULL, name, NULL, &future, &error));
  CHECK_NULL("library", wale_library_nearest_later(NULL, name, NULL, &future, &error));
  CHECK_NULL("library", wale_library_between_later(NULL, name, name, NULL, &future, &error));
  CHECK_NULL("future", wale_future_take_matches(NULL, &matches, &error));
  CHECK_NULL("matches", wale_matches_match(NULL, 0, &match, &error));
  CHECK_NO_PLACE("matches", wale_library_search(library, name, NULL, NULL, &error));
  CHECK_NO_PLACE("future", wale_library_search_later(library, name, NULL, NULL, &error));
  CHECK(matches == NULL);
  CHECK(program == NULL && future == NULL && workspace == NULL && devices == NULL && device == NULL);

  CHECK_NO_PLACE("library", wale_library_create(NULL, NULL, &error));
  CHECK_NO_PLACE("program", wale_library_find(library, name, NULL, NULL, &error));
  CHECK_NO_PLACE("program", wale_library_level(library, name, name, NULL, NULL, &error));
  CHECK_NO_PLACE("program", wale_library_compile(library, name, NULL, NULL, &error));
  CHECK_NO_PLACE("program", wale_library_open(library, name, NULL, NULL, &error));
  CHECK_NO_PLACE("program", wale_library_open_bytes(library, "x", 1, NULL, NULL, &error));
  CHECK_NO_PLACE("workspace", wale_library_workspace(library, name, NULL, NULL, &error));
  CHECK_NO_PLACE("workspace", wale_library_open_workspace(library, name, NULL, NULL, &error));
  CHECK_NO_PLACE("future", wale_library_find_later(library, name, NULL, NULL, &error));
  CHECK_NO_PLACE("devices", wale_library_devices(library, NULL, &error));
  CHECK_NO_PLACE("device", wale_library_open_device(library, name, NULL, NULL, &error));
  CHECK_NO_STRUCT("profile", wale_library_profile(library, WALE_TEXT("sandpaper"), NULL, &error));

  const WaleLibraryOptions folders = {.size = sizeof folders, .folder_count = 2};
  WaleLibrary* another = NULL;
  CHECK_SAYS(WALE_CODE_malformed_value, "folders", "expected an array, found NULL", "set `folder_count` to 0",
             wale_library_create(&folders, &another, &error));
  const WaleText none = {NULL, 3};
  CHECK_SAYS(WALE_CODE_malformed_value, "name", "expected a text, found NULL with a length",
             "give the length 0 to the empty text", wale_library_find(library, none, NULL, &program, &error));
}

static void programs(void) {
  WaleProgram* program = NULL;
  WaleProgramDetails details = {.size = sizeof details};
  WaleParameter parameter = {.size = sizeof parameter};
  WalePercept percept = {.size = sizeof percept};
  WaleVector place = {0, 0}, force;
  size_t length = 0;
  CHECK_NULL("bytes", wale_program_load(NULL, 8, &program, &error));
  CHECK_NO_PLACE("program", wale_program_load("x", 1, NULL, &error));
  CHECK_NULL("program", wale_program_bytes(NULL, NULL, 0, &length, &error));
  CHECK_NULL("length", wale_program_bytes(corduroy, NULL, 0, NULL, &error));
  CHECK_NULL("program", wale_program_details(NULL, &details, &error));
  CHECK_NO_STRUCT("details", wale_program_details(corduroy, NULL, &error));
  CHECK_NULL("program", wale_program_parameter(NULL, 0, &parameter, &error));
  CHECK_NO_STRUCT("parameter", wale_program_parameter(corduroy, 0, NULL, &error));
  CHECK_NULL("program", wale_program_percept(NULL, 0, &percept, &error));
  CHECK_NO_STRUCT("percept", wale_program_percept(corduroy, 0, NULL, &error));
  WaleFate fate = {.size = sizeof fate};
  CHECK_NULL("program", wale_program_fate(NULL, 0, &fate, &error));
  CHECK_NO_STRUCT("fate", wale_program_fate(corduroy, 0, NULL, &error));

  WaleBatchOptions options = {.size = sizeof options, .hands = 1, .ticks = 1, .position = &place};
  CHECK_NULL("program", wale_batch(NULL, &options, &force, &error));
  CHECK_NULL("options", wale_batch(corduroy, NULL, &force, &error));
  CHECK_NULL("forces", wale_batch(corduroy, &options, NULL, &error));
  options.position = NULL;
  CHECK_SAYS(WALE_CODE_malformed_value, "position", "expected an array, found NULL",
             "give a place for each hand and tick", wale_batch(corduroy, &options, &force, &error));
}

static void devices_and_shapes(void) {
  WaleDeviceInfo info = {.size = sizeof info};
  WaleProfile profile = {.size = sizeof profile};
  WaleDevices* all = NULL;
  WaleShape* shape = NULL;
  CHECK_NO_PLACE("devices", wale_devices(NULL, &error));
  CHECK_NULL("devices", wale_devices_info(NULL, 0, &info, &error));
  CHECK_GOOD(wale_devices(&all, &error));
  CHECK_NO_STRUCT("info", wale_devices_info(all, 0, NULL, &error));
  wale_devices_free(all);
  CHECK_NO_STRUCT("profile", wale_profile(WALE_TEXT("sandpaper"), NULL, &error));
  CHECK_NO_PLACE("device", wale_device_open(WALE_TEXT("simulated"), NULL, NULL, &error));
  CHECK_NULL("program", wale_program_profile(NULL, &profile, &error));
  CHECK_NO_STRUCT("profile", wale_program_profile(corduroy, NULL, &error));
  CHECK_NULL("device", wale_device_profile(NULL, &profile, &error));
  WaleDevice* device = simulated();
  CHECK_NO_STRUCT("profile", wale_device_profile(device, NULL, &error));
  wale_device_free(device);

  const WaleVector corners[3] = {{0, 0}, {1, 0}, {0, 1}};
  CHECK_SAYS(WALE_CODE_malformed_value, "corners", "expected 3 to 256 corners, found 300",
             "leave out corners that lie on a line, or use wale_shape_mask",
             wale_shape_polygon(corners, 300, &shape, &error)); /* they are not read */
  const uint8_t cell = 1;
  CHECK_NO_PLACE("shape", wale_shape_ellipse(1, 1, NULL, &error));
  CHECK_NO_PLACE("shape", wale_shape_polygon(corners, 3, NULL, &error));
  CHECK_NULL("corners", wale_shape_polygon(NULL, 3, &shape, &error));
  CHECK_NO_PLACE("shape", wale_shape_mask(&cell, 1, 1, 1, NULL, &error));
  CHECK_NULL("cells", wale_shape_mask(NULL, 1, 1, 1, &shape, &error));
  CHECK(shape == NULL);
}

static void stages(void) {
  WaleStage *stage = new_stage(), *none = NULL;
  WaleDevice* device = simulated();
  WaleEdit* edit = NULL;
  WaleLoop* loop = NULL;
  WalePatch* patch = NULL;
  WaleSnapshot* snapshot = NULL;
  WaleRunOptions second = {.size = sizeof second, .seconds = 1, .virtual_time = 1};
  CHECK_NULL("device", wale_stage_create(NULL, NULL, &none, &error));
  CHECK_NO_PLACE("stage", wale_stage_create(device, NULL, NULL, &error));
  CHECK_NULL("profile", wale_stage_create_for(NULL, NULL, &none, &error));
  wale_device_free(device);
  CHECK_NULL("stage", wale_stage_add(NULL, corduroy, NULL, &patch, &error));
  CHECK_NULL("program", wale_stage_add(stage, NULL, NULL, &patch, &error));
  CHECK_NULL("stage", wale_stage_run(NULL, &second, NULL, &error));
  CHECK_NULL("options", wale_stage_run(stage, NULL, NULL, &error));
  CHECK_NULL("stage", wale_stage_start(NULL, &error));
  CHECK_NULL("stage", wale_stage_stop(NULL, NULL, &error));
  CHECK_NULL("stage", wale_stage_on_contact(NULL, NULL, NULL, &error));
  CHECK_NULL("stage", wale_stage_poll(NULL, NULL, &error));
  CHECK_NULL("stage", wale_loop_begin(NULL, &loop, &error));
  CHECK_NO_PLACE("loop", wale_loop_begin(stage, NULL, &error));

  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, &patch, &error));
  CHECK_NULL("patch", wale_patch_set(NULL, WALE_TEXT("wale"), 0.003, &error));
  CHECK_NULL("patch", wale_patch_move(NULL, 0, 0, &error));
  CHECK_NULL("patch", wale_patch_resize(NULL, 0.1f, 0.1f, 0, &error));
  CHECK_NULL("patch", wale_patch_replace(NULL, corduroy, &error));
  CHECK_NULL("program", wale_patch_replace(patch, NULL, &error));
  CHECK_NULL("patch", wale_patch_enable(NULL, 1, &error));
  CHECK_NULL("patch", wale_patch_bring(NULL, 0, &error));
  CHECK_NULL("patch", wale_patch_remove(NULL, &error));
  WalePlacement* placement = NULL;
  WalePlacementDetails lies = {.size = sizeof lies};
  WaleProgram* placed = NULL;
  WaleShape* outline = NULL;
  float number = 0;
  CHECK_NULL("patch", wale_patch_placement(NULL, &placement, &error));
  CHECK_NO_PLACE("placement", wale_patch_placement(patch, NULL, &error));
  CHECK_NULL("patch", wale_patch_published(NULL, &placement, &error));
  CHECK_NO_PLACE("placement", wale_patch_published(patch, NULL, &error));
  CHECK_NULL("patch", wale_patch_value(NULL, WALE_TEXT("wale"), &number, &error));
  CHECK_NULL("value", wale_patch_value(patch, WALE_TEXT("wale"), NULL, &error));
  CHECK_NULL("placement", wale_placement_details(NULL, &lies, &error));
  CHECK_GOOD(wale_patch_placement(patch, &placement, &error));
  CHECK_NO_STRUCT("details", wale_placement_details(placement, NULL, &error));
  CHECK_NULL("placement", wale_placement_value(NULL, WALE_TEXT("wale"), &number, &error));
  CHECK_NULL("value", wale_placement_value(placement, WALE_TEXT("wale"), NULL, &error));
  CHECK_NULL("placement", wale_placement_program(NULL, &placed, &error));
  CHECK_NO_PLACE("program", wale_placement_program(placement, NULL, &error));
  CHECK_NULL("placement", wale_placement_shape(NULL, &outline, &error));
  CHECK_NO_PLACE("shape", wale_placement_shape(placement, NULL, &error));
  CHECK(wale_placement_values(NULL, NULL) == NULL);
  wale_placement_free(placement);
  CHECK_NULL("patch", wale_patch_snapshot(NULL, &snapshot, &error));
  CHECK_NO_PLACE("snapshot", wale_patch_snapshot(patch, NULL, &error));

  CHECK_NULL("stage", wale_stage_edit(NULL, &edit, &error));
  CHECK_NO_PLACE("edit", wale_stage_edit(stage, NULL, &error));
  CHECK_NULL("edit", wale_edit_add(NULL, corduroy, NULL, NULL, &error));
  CHECK_NULL("edit", wale_edit_set(NULL, patch, WALE_TEXT("wale"), 0.003, &error));
  CHECK_NULL("edit", wale_edit_move(NULL, patch, 0, 0, &error));
  CHECK_NULL("edit", wale_edit_resize(NULL, patch, 0.1f, 0.1f, 0, &error));
  CHECK_NULL("edit", wale_edit_replace(NULL, patch, corduroy, &error));
  CHECK_NULL("edit", wale_edit_enable(NULL, patch, 1, &error));
  CHECK_NULL("edit", wale_edit_bring(NULL, patch, 0, &error));
  CHECK_NULL("edit", wale_edit_fail(NULL, WALE_CODE_unknown_name, name, name, name, &error));
  CHECK_NULL("edit", wale_edit_remove(NULL, patch, &error));
  CHECK_NULL("edit", wale_edit_commit(NULL, &error));
  CHECK_GOOD(wale_stage_edit(stage, &edit, &error));
  CHECK_NULL("program", wale_edit_add(edit, NULL, NULL, NULL, &error));
  CHECK_NULL("patch", wale_edit_set(edit, NULL, WALE_TEXT("wale"), 0.003, &error));
  CHECK_NULL("patch", wale_edit_move(edit, NULL, 0, 0, &error));
  CHECK_NULL("patch", wale_edit_resize(edit, NULL, 0.1f, 0.1f, 0, &error));
  CHECK_NULL("patch", wale_edit_replace(edit, NULL, corduroy, &error));
  CHECK_NULL("program", wale_edit_replace(edit, patch, NULL, &error));
  CHECK_NULL("patch", wale_edit_enable(edit, NULL, 1, &error));
  CHECK_NULL("patch", wale_edit_bring(edit, NULL, 0, &error));
  CHECK_NULL("patch", wale_edit_remove(edit, NULL, &error));
  wale_edit_free(edit);
  CHECK(wale_stage_size(stage) == 1); /* nothing of all this has changed it */
  wale_patch_free(patch);
  wale_stage_free(stage);
}

static void results(void) {
  WaleStage* stage = new_stage();
  WalePatch* patch = NULL;
  WaleFelt* felt = NULL;
  WaleSnapshot* snapshot = NULL;
  WaleRecording* recording = NULL;
  WaleRunFigures figures = {.size = sizeof figures};
  WaleFeltFigures of_felt = {.size = sizeof of_felt};
  WaleFeltLevel level = {.size = sizeof level};
  WaleRecordingDetails details = {.size = sizeof details};
  WaleReplay replay = {.size = sizeof replay};
  WaleRecordedTick recorded;
  WaleGrid grid = {.size = sizeof grid};
  WaleTick tick;
  WaleVector middle = {0, 0};
  float height = 0;
  size_t count = 0;
  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, &patch, &error));
  WaleRun* run = run_for(stage, 0.1);
  CHECK_NULL("run", wale_run_figures(NULL, &figures, &error));
  CHECK_NO_STRUCT("figures", wale_run_figures(run, NULL, &error));
  CHECK_NULL("run", wale_run_ticks(NULL, 0, 1, sizeof tick, &tick, &error));
  CHECK_SAYS(WALE_CODE_malformed_value, "ticks", "expected an array, found NULL", "hand over room for `count` ticks",
             wale_run_ticks(run, 0, 1, sizeof tick, NULL, &error));
  CHECK_NULL("run", wale_felt_measure(NULL, patch, NULL, &felt, &error));
  CHECK_NULL("patch", wale_felt_measure(run, NULL, NULL, &felt, &error));
  CHECK_NO_PLACE("felt", wale_felt_measure(run, patch, NULL, NULL, &error));
  CHECK_NULL("felt", wale_felt_figures(NULL, &of_felt, &error));
  CHECK_NULL("felt", wale_felt_level(NULL, 0, &level, &error));

  CHECK_GOOD(wale_patch_snapshot(patch, &snapshot, &error));
  WalePlacement* placement = NULL;
  CHECK_NULL("snapshot", wale_snapshot_placement(NULL, &placement, &error));
  CHECK_NO_PLACE("placement", wale_snapshot_placement(snapshot, NULL, &error));
  CHECK_NULL("snapshot", wale_snapshot_grid(NULL, 0, &grid, &error));
  CHECK_NO_STRUCT("grid", wale_snapshot_grid(snapshot, 0, NULL, &error));
  CHECK_NULL("snapshot", wale_snapshot_surface(NULL, &middle, 1, &height, NULL, &error));
  CHECK_NULL("places", wale_snapshot_surface(snapshot, NULL, 1, &height, NULL, &error));
  CHECK_NULL("heights", wale_snapshot_surface(snapshot, &middle, 1, NULL, NULL, &error));
  CHECK_NULL("snapshot", wale_snapshot_show(NULL, middle, middle, 0, NULL, 0, &count, &error));
  CHECK_NULL("count", wale_snapshot_show(snapshot, middle, middle, 0, NULL, 0, NULL, &error));
  wale_snapshot_free(snapshot);

  CHECK_NO_PLACE("recording", wale_recording_open(WALE_TEXT("/does/not/exist"), NULL, &error));
  CHECK_NO_PLACE("recording", wale_recording_open_part(WALE_TEXT("/does/not/exist"), 1, NULL, &error));
  CHECK_NULL("ticks", wale_recording_intact(WALE_TEXT("/does/not/exist"), NULL, &error));
  CHECK_NULL("recording", wale_recording_details(NULL, &details, &error));
  CHECK_NULL("recording", wale_recording_ticks(NULL, 0, 1, sizeof recorded, &recorded, &error));
  CHECK_NULL("recording", wale_recording_replay(NULL, &replay, &error));
  CHECK(recording == NULL && felt == NULL);
  wale_run_free(run);
  wale_patch_free(patch);
  wale_stage_free(stage);
}

static void workspaces(void) {
  WaleWorkspace *workspace = NULL, *none = NULL;
  WaleWorkspaceDetails details = {.size = sizeof details};
  WaleWorkspacePatch placed = {.size = sizeof placed};
  WaleWorkspaceMark mark = {.size = sizeof mark};
  WaleProgram* program = NULL;
  WaleShape* shape = NULL;
  WalePatch* patches[1] = {NULL};
  size_t length = 0;
  CHECK_GOOD(wale_library_workspace(library, WALE_TEXT("wale 1\nworkspace w { patch a = corduroy }\n"), NULL, &workspace,
                                    &error));
  CHECK_NULL("bytes", wale_workspace_load(NULL, 8, &none, &error));
  CHECK_NO_PLACE("workspace", wale_workspace_load("x", 1, NULL, &error));
  CHECK_NULL("workspace", wale_workspace_bytes(NULL, NULL, 0, &length, &error));
  CHECK_NULL("length", wale_workspace_bytes(workspace, NULL, 0, NULL, &error));
  CHECK_NULL("workspace", wale_workspace_details(NULL, &details, &error));
  CHECK_NO_STRUCT("details", wale_workspace_details(workspace, NULL, &error));
  CHECK_NULL("workspace", wale_workspace_patch(NULL, 0, &placed, &error));
  CHECK_NO_STRUCT("patch", wale_workspace_patch(workspace, 0, NULL, &error));
  CHECK_NULL("workspace", wale_workspace_mark(NULL, 0, 0, &mark, &error));
  CHECK_NO_STRUCT("mark", wale_workspace_mark(workspace, 0, 0, NULL, &error));
  CHECK_NULL("workspace", wale_workspace_program(NULL, 0, &program, &error));
  CHECK_NO_PLACE("program", wale_workspace_program(workspace, 0, NULL, &error));
  CHECK_NULL("workspace", wale_workspace_shape(NULL, 0, &shape, &error));
  CHECK_NO_PLACE("shape", wale_workspace_shape(workspace, 0, NULL, &error));
  WaleStage* stage = new_stage();
  CHECK_NULL("stage", wale_stage_add_workspace(NULL, workspace, patches, &error));
  CHECK_NULL("workspace", wale_stage_add_workspace(stage, NULL, patches, &error));
  CHECK(wale_stage_size(stage) == 0);
  wale_stage_free(stage);
  wale_workspace_free(workspace);
}

/* Patches can be placed on it and a loop can serve it; nothing can run on it. */
static void stage_without_a_device(void) {
#define CHECK_NO_DEVICE(call)                                                       \
  CHECK_SAYS(WALE_CODE_wrong_moment, "stage", "the stage has no device",            \
             "make it with a device, or serve its ticks by a `Loop`", call)
  WaleStage* stage = NULL;
  WalePatch* patch = NULL;
  WaleRun* run = NULL;
  WaleLoop* loop = NULL;
  WaleProfile profile = {.size = sizeof profile};
  const WaleRunOptions real = {.size = sizeof real, .seconds = 1};
  const WaleRunOptions unreal = {.size = sizeof unreal, .seconds = 1, .virtual_time = 1};
  CHECK_GOOD(wale_profile(WALE_TEXT("sandpaper"), &profile, &error));
  CHECK_GOOD(wale_stage_create_for(&profile, NULL, &stage, &error));
  CHECK_NO_DEVICE(wale_stage_start(stage, &error)); /* whether anything is on it or not */
  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, &patch, &error));
  CHECK_NO_DEVICE(wale_stage_run(stage, &real, &run, &error));
  CHECK_NO_DEVICE(wale_stage_run(stage, &unreal, &run, &error));
  CHECK_NO_DEVICE(wale_stage_start(stage, &error));
  CHECK_SAYS(WALE_CODE_wrong_moment, "stage", "no run was started on this stage", "start one first",
             wale_stage_stop(stage, &run, &error));
  CHECK(run == NULL && !wale_stage_is_running(stage) && wale_stage_size(stage) == 1);

  /* A program for another device is refused by this one's figures. */
  WaleProgram* other = NULL;
  const WaleCompileOptions for_pad = {.size = sizeof for_pad, .device = WALE_TEXT("touch_pad")};
  CHECK_GOOD(wale_library_find(library, name, &for_pad, &other, &error));
  CHECK_CODE(WALE_CODE_other_device, wale_patch_replace(patch, other, &error));
  wale_program_free(other);

  /* After all these errors, a loop serves it. */
  CHECK_GOOD(wale_loop_begin(stage, &loop, &error));
  CHECK_NO_DEVICE(wale_stage_start(stage, &error));
  wale_loop_free(loop);
  wale_patch_free(patch);
  wale_stage_free(stage);
}

int null_parts(void) {
  run_parts((Part[]){libraries, programs, devices_and_shapes, stages, results, workspaces, stage_without_a_device, NULL});
  return failures;
}
