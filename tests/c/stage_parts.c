/* Devices, stages, patches and edits, at their edges. */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "tests/c/check.h"
#include "tests/c/parts.h"
#include "tests/c/placed.h"

static const char rail_stick[] =
    "wale 1\n\ndevice rail_stick {\n  class force_plane\n  workspace disc(100 mm)\n  position 8192 counts\n"
    "  force 4 N, 1000 counts\n  rate 1000 Hz\n  speed assumed 1 m/s\n  slew assumed 100 N/s\n"
    "  velocity_filter 15, 1 counts\n  patch 80 mm, 80 mm, 5 mm\n  mass assumed 0.1 kg\n  damping assumed 1 N s/m\n"
    "  friction assumed 0.05 N\n  delay assumed 1 ms\n  sustained unknown\n  active assumed 1 W\n"
    "  source \"the maker's data sheet\"\n}\n\nmaterial syrup {\n  physical { force = -2 N s/m * velocity }\n}\n";

static void devices(void) {
  WaleDevices* all = NULL;
  CHECK_GOOD(wale_devices(&all, &error));
  WaleDeviceInfo info = {.size = sizeof info};
  int simulations = 0, pointers = 0;
  for (size_t i = 0; i < wale_devices_count(all); ++i) {
    CHECK_GOOD(wale_devices_info(all, i, &info, &error));
    simulations += info.kind == WALE_DEVICE_simulated;
    pointers += info.kind == WALE_DEVICE_pointer;
    CHECK(info.spelling.length > 0);
  }
  CHECK(simulations >= 5 && pointers == 1);
  CHECK_MALFORMED(wale_devices_info(all, wale_devices_count(all), &info, &error));
  wale_devices_free(all);
  wale_devices_free(all); /* freed already */
  CHECK(wale_devices_count(NULL) == 0);
  CHECK_MALFORMED(wale_devices(NULL, &error));
  CHECK_MALFORMED(wale_devices_info(NULL, 0, &info, &error));

  WaleProfile profile = {.size = sizeof profile};
  CHECK_GOOD(wale_profile(WALE_TEXT("sandpaper"), &profile, &error));
  CHECK(is_text(profile.name, "sandpaper") && profile.rate > 100 && profile.force > 1 && !profile.vibrates);
  CHECK_CODE(WALE_CODE_unknown_device, wale_profile(WALE_TEXT("sandpeper"), &profile, &error));
  CHECK_MALFORMED(wale_profile(WALE_TEXT("sandpaper"), NULL, &error));

  CHECK_GOOD(wale_library_profile(library, WALE_TEXT("gamepad"), &profile, &error));
  CHECK(is_text(profile.name, "gamepad") && profile.vibrates);
  CHECK_CODE(WALE_CODE_unknown_device, wale_library_profile(library, WALE_TEXT("sandpeper"), &profile, &error));
  CHECK_MALFORMED(wale_library_profile(NULL, WALE_TEXT("gamepad"), &profile, &error));
  CHECK_MALFORMED(wale_library_profile(library, WALE_TEXT("gamepad"), NULL, &error));
  CHECK_GOOD(wale_library_devices(library, &all, &error));
  CHECK(wale_devices_count(all) > 5);
  wale_devices_free(all);
  CHECK_MALFORMED(wale_library_devices(NULL, &all, &error));
  CHECK_MALFORMED(wale_library_devices(library, NULL, &error));

  WaleDevice* device = simulated();
  CHECK_GOOD(wale_device_profile(device, &profile, &error));
  CHECK(is_text(profile.name, "sandpaper"));
  wale_device_free(device);
  wale_device_free(device); /* freed already */
  CHECK_MALFORMED(wale_device_profile(NULL, &profile, &error));
  /* Of a device that only a text declares. */
  WaleProgram* program = NULL;
  WaleStage* stage = NULL;
  WaleCompileOptions options = {.size = sizeof options, .device = WALE_TEXT("rail_stick")};
  CHECK_GOOD(wale_library_compile(library, WALE_TEXT(rail_stick), &options, &program, &error));
  CHECK_GOOD(wale_program_profile(program, &profile, &error));
  CHECK(is_text(profile.name, "rail_stick") && profile.force == 4 && profile.rate == 1000 && profile.mass == 0.1);
  CHECK(profile.workspace_diameter == 0.1 && !profile.vibrates && profile.has_position);
  CHECK_GOOD(wale_stage_create_for(&profile, NULL, &stage, &error));
  CHECK_GOOD(wale_stage_add(stage, program, NULL, NULL, &error));
  wale_stage_free(stage), wale_program_free(program);
  CHECK_CODE(WALE_CODE_unknown_device, wale_device_open(WALE_TEXT("sandpeper"), NULL, &device, &error));
  CHECK_CODE(WALE_CODE_absent_device, wale_device_open(WALE_TEXT("1-77"), NULL, &device, &error));
  CHECK(device == NULL);
  CHECK_MALFORMED(wale_device_open(WALE_TEXT("simulated"), NULL, NULL, &error));
  WaleDeviceOptions wrong[] = {{.priority = 100},
                               {.max_force = -1},
                               {.max_force = NAN},
                               {.hand_mass = NAN},
                               {.hand_mass = -1},
                               {.motion = 9},
                               {.amplitude = INFINITY},
                               {.motion = WALE_MOTION_trace},
                               {.reserved = 1},
                               {.disregard_owner = 2},
                               {.transport = WALE_TEXT("hidraw")}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
    wrong[i].size = sizeof *wrong;
    CHECK_MALFORMED(wale_device_open(WALE_TEXT("simulated:sandpaper"), &wrong[i], &device, &error));
  }
  const double points[] = {0, 0, 0, 1, 0.01, 0, 1, 0, 0};
  WaleDeviceOptions trace = {
      .size = sizeof trace, .hand_mass = 0.5, .motion = WALE_MOTION_trace, .points = points, .count = 2};
  CHECK_GOOD(wale_device_open(WALE_TEXT("simulated:sandpaper"), &trace, &device, &error));
  wale_device_free(device);
  trace.count = 3; /* the times do not rise */
  CHECK_MALFORMED(wale_device_open(WALE_TEXT("simulated:sandpaper"), &trace, &device, &error));
}

/* How patches lie, on a device that the library was told of. */
static void placements(void) {
  static const char* const declared =
      "wale 1\nexport device my_stick {\n  class force_plane\n  workspace disc(100 mm)\n  position 8192 counts\n"
      "  force 4 N, 1000 counts\n  rate 1000 Hz\n  speed assumed 1 m/s\n  slew assumed 100 N/s\n"
      "  velocity_filter 15, 1 counts\n  patch 80 mm, 80 mm, 5 mm\n  mass 0.1 kg\n  damping assumed 1 N s/m\n"
      "  friction assumed 0.05 N\n}\n";
  WaleLibrary* own = NULL;
  WaleLibraryOptions options = {.size = sizeof options, .devices = WALE_TEXT(declared)};
  CHECK_GOOD(wale_library_create(&options, &own, &error));
  WaleProfile profile = {.size = sizeof profile};
  CHECK_GOOD(wale_library_profile(own, WALE_TEXT("my_stick"), &profile, &error));
  CHECK(profile.force == 4);
  WaleDevice* simulated = NULL;
  CHECK_GOOD(wale_library_open_device(own, WALE_TEXT("simulated:my_stick"), NULL, &simulated, &error));
  WaleProfile of_it = {.size = sizeof of_it};
  CHECK_GOOD(wale_device_profile(simulated, &of_it, &error));
  CHECK(of_it.force == 4 && of_it.rate == 1000);
  wale_device_free(simulated);
  CHECK_CODE(WALE_CODE_unknown_device,
             wale_library_open_device(library, WALE_TEXT("simulated:my_stick"), NULL, &simulated, &error));
  CHECK_CODE(WALE_CODE_unknown_device, wale_device_open(WALE_TEXT("simulated:my_stick"), NULL, &simulated, &error));
  WaleProgram *cloth = NULL, *rough = NULL, *unknown = NULL;
  WaleCompileOptions for_it = {.size = sizeof for_it, .device = WALE_TEXT("my_stick")};
  CHECK_GOOD(wale_library_find(own, WALE_TEXT("corduroy"), &for_it, &cloth, &error));
  CHECK_GOOD(wale_library_level(own, WALE_TEXT("roughness"), WALE_TEXT("0.4"), &for_it, &rough, &error));
  CHECK_CODE(WALE_CODE_unknown_device, wale_library_find(library, WALE_TEXT("corduroy"), &for_it, &unknown, &error));
  WaleLibrary* none = NULL;
  options.devices = WALE_TEXT("wale 1\ndevice my_stick { }\n");
  CHECK_CODE(WALE_CODE_missing_setting, wale_library_create(&options, &none, &error));
  options.devices = WALE_TEXT("wale 1\n");
  CHECK_CODE(WALE_CODE_unknown_device, wale_library_create(&options, &none, &error));
  CHECK(none == NULL);

  WaleStage* stage = NULL;
  WalePatch* patch = NULL;
  WaleShape* oval = NULL;
  CHECK_GOOD(wale_shape_ellipse(0.02f, 0.01f, &oval, &error));
  WalePatchOptions place = {.size = sizeof place, .x = 0.01f, .y = -0.01f, .layer = 2, .shape = oval};
  CHECK_GOOD(wale_stage_create_for(&profile, NULL, &stage, &error));
  CHECK_GOOD(wale_stage_add(stage, cloth, &place, &patch, &error));
  CHECK_GOOD(wale_patch_set(patch, WALE_TEXT("wale"), 0.003, &error));
  CHECK_GOOD(wale_patch_enable(patch, 0, &error));
  float value = 0;
  CHECK_GOOD(wale_patch_value(patch, WALE_TEXT("wale"), &value, &error));
  CHECK(value == 0.003f);
  CHECK_CODE(WALE_CODE_unknown_name, wale_patch_value(patch, WALE_TEXT("whale"), &value, &error));
  CHECK(isnan(value));
  WalePlacement *lies = NULL, *felt = NULL;
  WalePlacementDetails details = {.size = sizeof details};
  CHECK_GOOD(wale_patch_placement(patch, &lies, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_published(patch, &felt, &error));
  CHECK(felt == NULL);
  CHECK_GOOD(wale_placement_details(lies, &details, &error));
  CHECK(details.x == 0.01f && details.y == -0.01f && details.width == 0.04f && details.height == 0.02f);
  CHECK(details.layer == 2 && !details.enabled && details.has_shape);
  size_t count = 0;
  const float* values = wale_placement_values(lies, &count);
  CHECK(count == details.values && count > 0 && values != NULL);
  CHECK_GOOD(wale_placement_value(lies, WALE_TEXT("wale"), &value, &error));
  CHECK(value == 0.003f);
  CHECK_CODE(WALE_CODE_unknown_name, wale_placement_value(lies, WALE_TEXT("whale"), &value, &error));
  WaleProgram* same = NULL;
  WaleShape* its_shape = NULL;
  CHECK_GOOD(wale_placement_program(lies, &same, &error));
  CHECK_GOOD(wale_placement_shape(lies, &its_shape, &error));
  CHECK(wale_shape_size(its_shape).x == 0.04f);
  WaleProgramDetails told = {.size = sizeof told};
  CHECK_GOOD(wale_program_details(same, &told, &error));
  CHECK(is_text(told.device, "my_stick"));
  wale_placement_free(lies), wale_program_free(same), wale_shape_free(its_shape), wale_shape_free(oval);

  WaleLoop* loop = NULL;
  CHECK_GOOD(wale_loop_begin(stage, &loop, &error));
  for (int i = 0; i < 500 && wale_patch_published(patch, &felt, NULL) != 0; ++i) usleep(1000);
  CHECK(felt != NULL);
  wale_placement_free(felt), wale_loop_free(loop);
  WaleSnapshot* snapshot = NULL;
  CHECK_GOOD(wale_patch_snapshot(patch, &snapshot, &error));
  CHECK_GOOD(wale_snapshot_placement(snapshot, &lies, &error));
  CHECK_GOOD(wale_placement_details(lies, &details, &error));
  CHECK(details.x == 0.01f);
  wale_snapshot_free(snapshot), wale_placement_free(lies);
  CHECK_GOOD(wale_patch_remove(patch, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_placement(patch, &lies, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_value(patch, WALE_TEXT("wale"), &value, &error));
  wale_patch_free(patch), wale_stage_free(stage);
  /* Without a slew no loop begins. */
  profile.slew = 0;
  CHECK_GOOD(wale_stage_create_for(&profile, NULL, &stage, &error));
  CHECK_CODE(WALE_CODE_unusable_device, wale_loop_begin(stage, &loop, &error));
  wale_stage_free(stage), wale_program_free(cloth), wale_program_free(rough), wale_library_free(own);
}

static void stages(void) {
  WaleStage *stage = NULL, *second = NULL;
  WaleDevice* device = simulated();
  WaleProfile profile = {.size = sizeof profile};
  CHECK_MALFORMED(wale_stage_create(NULL, NULL, &stage, &error));
  CHECK_MALFORMED(wale_stage_create(device, NULL, NULL, &error));
  CHECK_GOOD(wale_stage_create(device, NULL, &stage, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_stage_create(device, NULL, &second, &error));
  CHECK(second == NULL);
  wale_stage_free(stage);
  CHECK_GOOD(wale_stage_create(device, NULL, &stage, &error)); /* the first one gave it back */
  wale_device_free(device);                                    /* the stage keeps it */

  WaleRunOptions options = {.size = sizeof options, .seconds = 0.1, .virtual_time = 1};
  WaleRun* run = NULL;
  CHECK_CODE(WALE_CODE_wrong_moment, wale_stage_run(stage, &options, &run, &error)); /* nothing is on it */
  CHECK_CODE(WALE_CODE_wrong_moment, wale_stage_stop(stage, NULL, &error));
  WalePatch* patch = NULL;
  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, &patch, &error));
  CHECK(wale_stage_size(stage) == 1 && wale_patch_exists(patch) && wale_patch_id(patch) != 0);
  const double seconds[] = {0, -1, NAN, INFINITY};
  for (size_t i = 0; i < 4; ++i) {
    options.seconds = seconds[i];
    CHECK_MALFORMED(wale_stage_run(stage, &options, NULL, &error));
  }
  CHECK_MALFORMED(wale_stage_run(stage, NULL, NULL, &error));
  CHECK_MALFORMED(wale_stage_run(NULL, &options, NULL, &error));

  run = run_for(stage, 2);
  WaleRunFigures figures = {.size = sizeof figures};
  CHECK_GOOD(wale_run_figures(run, &figures, &error));
  CHECK(figures.ticks_run > 100 && figures.recorded == (uint64_t)figures.ticks_run && figures.problem == NULL);
  WaleTick* ticks = malloc(figures.recorded * sizeof *ticks);
  CHECK_GOOD(wale_run_ticks(run, 0, figures.recorded, sizeof *ticks, ticks, &error));
  double largest = 0;
  for (size_t i = 0; i < figures.recorded; ++i) {
    CHECK(fabs(ticks[i].time - (double)i * figures.seconds_per_tick) < 1e-9);
    if (fabs(ticks[i].force.x) > largest) largest = fabs(ticks[i].force.x);
  }
  CHECK(largest > 1.5 && largest < 2.5); /* N: corduroy pushes with 1.934 N */
  double times[4];                       /* an older caller, for whom a tick was only its time */
  CHECK_GOOD(wale_run_ticks(run, 10, 4, sizeof *times, (WaleTick*)(void*)times, &error));
  for (int i = 0; i < 4; ++i) CHECK(times[i] == ticks[10 + i].time);
  CHECK_MALFORMED(wale_run_ticks(run, figures.recorded, 1, sizeof *ticks, ticks, &error));
  CHECK_MALFORMED(wale_run_ticks(run, SIZE_MAX, 2, sizeof *ticks, ticks, &error));
  CHECK_MALFORMED(wale_run_ticks(run, 0, 1, 5, ticks, &error));
  CHECK_MALFORMED(wale_run_ticks(run, 0, 1, sizeof *ticks, NULL, &error));
  CHECK_MALFORMED(wale_run_ticks(NULL, 0, 1, sizeof *ticks, ticks, &error));
  CHECK_MALFORMED(wale_run_figures(NULL, &figures, &error));
  free(ticks);

  WaleFelt* felt = NULL;
  WaleMeasureOptions measure = {.size = sizeof measure, .settling = 0.5, .least_crossings = 10};
  CHECK_GOOD(wale_felt_measure(run, patch, &measure, &felt, &error));
  WaleMeasureOptions backwards = {.size = sizeof backwards, .least_crossings = -4};
  WaleFelt* none = NULL;
  CHECK_MALFORMED(wale_felt_measure(run, patch, &backwards, &none, &error));
  WaleFeltFigures read = {.size = sizeof read};
  CHECK_GOOD(wale_felt_figures(felt, &read, &error));
  CHECK(read.rubbing_p99 > 1.5 && read.rubbing_p99 < 2.5 && read.levels >= 1 && read.crossings > 10);
  WaleFeltLevel level = {.size = sizeof level};
  CHECK_GOOD(wale_felt_level(felt, 0, &level, &error));
  CHECK(is_text(level.name, "roughness") && level.problem == NULL && fabs(level.level - 0.6) < 0.05);
  CHECK_MALFORMED(wale_felt_level(felt, read.levels, &level, &error));
  CHECK_MALFORMED(wale_felt_level(NULL, 0, &level, &error));
  wale_felt_free(felt);
  measure.settling = NAN;
  CHECK_MALFORMED(wale_felt_measure(run, patch, &measure, &felt, &error));
  CHECK_MALFORMED(wale_felt_measure(NULL, patch, NULL, &felt, &error));
  CHECK_MALFORMED(wale_felt_measure(run, NULL, NULL, &felt, &error));
  CHECK_MALFORMED(wale_felt_figures(NULL, &read, &error));

  wale_stage_free(stage);
  wale_stage_free(stage); /* freed already */
  CHECK_CODE(WALE_CODE_wrong_moment, wale_felt_measure(run, patch, NULL, &felt, &error));
  wale_run_free(run);
  wale_patch_free(patch);

  /* Without a device. */
  CHECK_GOOD(wale_profile(WALE_TEXT("sandpaper"), &profile, &error));
  WaleStageOptions stage_options = {.size = sizeof stage_options, .max_force = 1};
  CHECK_GOOD(wale_stage_create_for(&profile, &stage_options, &stage, &error));
  wale_stage_free(stage);
  WaleStageOptions wrong[] = {{.max_force = -1}, {.max_force = NAN}, {.max_force = INFINITY}, {.priority = 100},
                              {.priority = -1},  {.lock_memory = 2}, {.low_latency = -1},     {.reserved = 1}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
    wrong[i].size = sizeof *wrong;
    CHECK_MALFORMED(wale_stage_create_for(&profile, &wrong[i], &stage, &error));
    CHECK(stage == NULL);
  }
  CHECK_GOOD(wale_profile(WALE_TEXT("touch_pad"), &profile, &error));
  CHECK(profile.vibrates);
  CHECK_GOOD(wale_stage_create_for(&profile, NULL, &stage, &error));
  wale_stage_free(stage);
  profile.name = WALE_TEXT("my pad");
  CHECK_MALFORMED(wale_stage_create_for(&profile, NULL, &stage, &error));
  CHECK_GOOD(wale_profile(WALE_TEXT("sandpaper"), &profile, &error));
  profile.rate = NAN;
  CHECK_MALFORMED(wale_stage_create_for(&profile, NULL, &stage, &error));
  profile.rate = 1e9;
  CHECK_MALFORMED(wale_stage_create_for(&profile, NULL, &stage, &error));
  CHECK_MALFORMED(wale_stage_create_for(NULL, NULL, &stage, &error));
  wale_stage_free(NULL);
  wale_stage_interrupt(NULL);
  CHECK(wale_stage_size(NULL) == 0 && !wale_stage_is_running(NULL));
  CHECK_MALFORMED(wale_stage_start(NULL, &error));
  CHECK_MALFORMED(wale_stage_stop(NULL, NULL, &error));
  WaleNow now = {.size = sizeof now};
  CHECK(wale_stage_now(NULL, &now) == WALE_CODE_malformed_value);
}

static void shapes(void) {
  WaleShape *ellipse = NULL, *polygon = NULL, *mask = NULL, *none = NULL;
  const WaleVector corners[] = {{-0.01f, -0.01f}, {0.01f, -0.01f}, {-0.01f, 0.01f}};
  const uint8_t cells[] = {1, 0, 0, 1, 1, 1};
  CHECK_GOOD(wale_shape_ellipse(0.02f, 0.01f, &ellipse, &error));
  CHECK_GOOD(wale_shape_polygon(corners, 3, &polygon, &error));
  CHECK_GOOD(wale_shape_mask(cells, 3, 2, 0.01f, &mask, &error));
  CHECK(wale_shape_size(ellipse).x == 0.04f && wale_shape_size(mask).y == 0.02f);
  const WaleVector middle = {0, 0}, upper_right = {0.01f, 0.005f};
  CHECK(fabs(wale_shape_edge(ellipse, middle) - 0.01) < 1e-6);
  CHECK(fabs(wale_shape_edge(mask, upper_right) + 0.005) < 1e-6);
  CHECK(fabs(wale_shape_edge(polygon, upper_right) + 0.0106066) < 1e-6);
  CHECK_MALFORMED(wale_shape_ellipse(0, 1, &none, &error));
  CHECK_MALFORMED(wale_shape_ellipse(NAN, 1, &none, &error));
  CHECK_MALFORMED(wale_shape_ellipse(1, 1, NULL, &error));
  CHECK_MALFORMED(wale_shape_polygon(NULL, 3, &none, &error));
  CHECK_MALFORMED(wale_shape_polygon(corners, 2, &none, &error));
  CHECK_MALFORMED(wale_shape_polygon(corners, SIZE_MAX, &none, &error));
  CHECK_MALFORMED(wale_shape_mask(NULL, 3, 2, 0.01f, &none, &error));
  CHECK_MALFORMED(wale_shape_mask(cells, SIZE_MAX, 2, 0.01f, &none, &error));
  CHECK_MALFORMED(wale_shape_mask(cells, 0, 0, 0.01f, &none, &error));
  CHECK_MALFORMED(wale_shape_mask(cells + 1, 2, 1, 0.01f, &none, &error)); /* no cell is set */
  CHECK(none == NULL && isnan(wale_shape_edge(NULL, middle)) && wale_shape_size(NULL).x == 0);

  /* The hand rubs over 40 mm along x, and is on the ellipse for part of its way. */
  WaleStage* stage = new_stage();
  WalePatch* patch = NULL;
  WalePatchOptions options = {.size = sizeof options, .width = 0.02f, .height = 0.02f, .shape = ellipse};
  CHECK_GOOD(wale_stage_add(stage, corduroy, &options, &patch, &error));
  wale_shape_free(ellipse), wale_shape_free(polygon), wale_shape_free(mask), wale_shape_free(NULL);
  wale_shape_free(mask); /* freed already */
  WaleRun* run = run_for(stage, 2);
  WaleTick ticks[1800];
  CHECK_GOOD(wale_run_ticks(run, 0, 1800, sizeof *ticks, ticks, &error));
  for (int i = 0; i < 1800; ++i) {
    const double x = ticks[i].position.x / 0.01, y = ticks[i].position.y / 0.01, from_edge = x * x + y * y - 1;
    CHECK(fabs(from_edge) < 0.01 || ticks[i].inside == (from_edge < 0));
    CHECK(ticks[i].patch == (ticks[i].inside ? wale_patch_id(patch) : 0));
  }
  wale_run_free(run);
  wale_patch_free(patch);
  wale_stage_free(stage);
}

static void patches(void) {
  WaleStage* stage = new_stage();
  WalePatch *patch = NULL, *other = NULL;
  WalePatchOptions options = {.size = sizeof options, .x = 0.01f, .width = 0.02f, .height = 0.02f};
  CHECK_GOOD(wale_stage_add(stage, corduroy, &options, &patch, &error));
  const WalePatchOptions wrong[] = {{.x = NAN}, {.width = 0.01f}, {.width = -1, .height = 1}, {.layer = INFINITY}, {.rim = -1}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
    WalePatchOptions each = wrong[i];
    each.size = sizeof each;
    CHECK_MALFORMED(wale_stage_add(stage, corduroy, &each, &other, &error));
    CHECK(other == NULL);
  }
  CHECK_MALFORMED(wale_stage_add(stage, NULL, NULL, &other, &error));
  CHECK_MALFORMED(wale_stage_add(NULL, corduroy, NULL, &other, &error));

  CHECK_GOOD(wale_patch_set(patch, WALE_TEXT("wale"), 0.003, &error));
  CHECK_CODE(WALE_CODE_unknown_name, wale_patch_set(patch, WALE_TEXT("whale"), 0.003, &error));
  const double values[] = {NAN, INFINITY, 1e300, -1, 1};
  for (size_t i = 0; i < 5; ++i) CHECK_MALFORMED(wale_patch_set(patch, WALE_TEXT("wale"), values[i], &error));
  CHECK_CODE(WALE_CODE_invalid_encoding, wale_patch_set(patch, WALE_TEXT("\xff"), 0.003, &error));
  CHECK_GOOD(wale_patch_move(patch, 0, 0.01f, &error));
  CHECK_MALFORMED(wale_patch_move(patch, NAN, 0, &error));
  CHECK_GOOD(wale_patch_resize(patch, 0.03f, 0.03f, 0, &error));
  CHECK_MALFORMED(wale_patch_resize(patch, -0.03f, 0.03f, 0, &error));
  CHECK_GOOD(wale_patch_enable(patch, 0, &error));
  CHECK_GOOD(wale_patch_bring(patch, 2, &error));
  CHECK_MALFORMED(wale_patch_bring(patch, NAN, &error));
  CHECK_GOOD(wale_patch_replace(patch, corduroy, &error));
  CHECK_MALFORMED(wale_patch_replace(patch, NULL, &error));
  WaleProgram* pad = NULL;
  WaleCompileOptions for_pad = {.size = sizeof for_pad, .device = WALE_TEXT("touch_pad")};
  CHECK_GOOD(wale_library_find(library, WALE_TEXT("corduroy"), &for_pad, &pad, &error));
  CHECK_CODE(WALE_CODE_other_device, wale_patch_replace(patch, pad, &error));
  CHECK_CODE(WALE_CODE_other_device, wale_stage_add(stage, pad, NULL, &other, &error));
  wale_program_free(pad);

  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, &other, &error));
  CHECK(wale_patch_id(patch) != wale_patch_id(other));
  CHECK_GOOD(wale_patch_remove(other, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_remove(other, &error)); /* removed already */
  CHECK(!wale_patch_exists(other) && wale_patch_exists(patch) && wale_stage_size(stage) == 1);
  CHECK(wale_patch_number(NULL) == UINT32_MAX && wale_patch_number(patch) != wale_patch_number(other));
  wale_patch_free(other);

  /* The stage goes from under the patch: every call says so. */
  WaleEdit* edit = NULL;
  WaleSnapshot* snapshot = NULL;
  CHECK_GOOD(wale_stage_edit(stage, &edit, &error));
  wale_stage_free(stage);
  CHECK(!wale_patch_exists(patch));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_set(patch, WALE_TEXT("wale"), 0.003, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_move(patch, 0, 0, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_resize(patch, 1, 1, 0, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_replace(patch, corduroy, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_enable(patch, 1, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_bring(patch, 1, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_remove(patch, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_patch_snapshot(patch, &snapshot, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_edit_add(edit, corduroy, NULL, NULL, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_edit_commit(edit, &error));
  wale_edit_free(edit);
  wale_patch_free(patch);
  wale_patch_free(patch); /* freed already */
  CHECK(wale_patch_id(NULL) == 0 && !wale_patch_exists(NULL));
  CHECK_MALFORMED(wale_patch_set(NULL, WALE_TEXT("wale"), 1, &error));
  CHECK_MALFORMED(wale_patch_move(NULL, 0, 0, &error));
  CHECK_MALFORMED(wale_patch_resize(NULL, 1, 1, 0, &error));
  CHECK_MALFORMED(wale_patch_replace(NULL, corduroy, &error));
  CHECK_MALFORMED(wale_patch_enable(NULL, 1, &error));
  CHECK_MALFORMED(wale_patch_bring(NULL, 1, &error));
  CHECK_MALFORMED(wale_patch_remove(NULL, &error));
  CHECK_MALFORMED(wale_patch_snapshot(NULL, &snapshot, &error));
}

static void edits(void) {
  WaleStage *stage = new_stage(), *another = new_stage();
  WaleEdit* edit = NULL;
  WalePatch *one = NULL, *two = NULL, *strange = NULL;
  CHECK_GOOD(wale_stage_add(another, corduroy, NULL, &strange, &error));
  CHECK_GOOD(wale_stage_edit(stage, &edit, &error));
  CHECK_GOOD(wale_edit_add(edit, corduroy, NULL, &one, &error));
  CHECK_GOOD(wale_edit_add(edit, corduroy, NULL, &two, &error));
  CHECK_GOOD(wale_edit_set(edit, one, WALE_TEXT("wale"), 0.004, &error));
  CHECK_GOOD(wale_edit_move(edit, one, 0.01f, 0, &error));
  CHECK_GOOD(wale_edit_resize(edit, one, 0.01f, 0.01f, 0, &error));
  CHECK_GOOD(wale_edit_replace(edit, one, corduroy, &error));
  CHECK_GOOD(wale_edit_enable(edit, one, 0, &error));
  CHECK_GOOD(wale_edit_bring(edit, two, 1, &error));
  CHECK(wale_stage_size(stage) == 0);
  CHECK_GOOD(wale_edit_commit(edit, &error));
  CHECK(wale_stage_size(stage) == 2);
  CHECK_GOOD(wale_edit_remove(edit, one, &error));
  CHECK_GOOD(wale_edit_move(edit, two, NAN, 0, &error));
  CHECK_MALFORMED(wale_edit_commit(edit, &error)); /* all or nothing */
  CHECK(wale_stage_size(stage) == 2 && wale_patch_exists(one));
  CHECK_GOOD(wale_edit_remove(edit, strange, &error));
  CHECK_CODE(WALE_CODE_wrong_moment, wale_edit_commit(edit, &error));
  /* What a call has refused already is refused by the commit too. */
  const WalePatchOptions nowhere = {.size = sizeof nowhere, .x = NAN};
  CHECK_GOOD(wale_edit_remove(edit, one, &error));
  CHECK_MALFORMED(wale_edit_enable(edit, one, 7, &error));
  CHECK_MALFORMED(wale_edit_commit(edit, &error));
  CHECK_GOOD(wale_edit_remove(edit, one, &error));
  CHECK_MALFORMED(wale_edit_add(edit, corduroy, &nowhere, NULL, &error));
  CHECK_MALFORMED(wale_edit_commit(edit, &error));
  CHECK_GOOD(wale_edit_remove(edit, one, &error));
  CHECK_MALFORMED(wale_edit_set(edit, NULL, WALE_TEXT("wale"), 0.003, &error));
  CHECK_MALFORMED(wale_edit_commit(edit, &error));
  CHECK(wale_stage_size(stage) == 2 && wale_patch_exists(one));
  CHECK_GOOD(wale_edit_remove(edit, one, &error));
  CHECK_GOOD(wale_edit_commit(edit, &error));
  CHECK(wale_stage_size(stage) == 1 && !wale_patch_exists(one));
  CHECK_GOOD(wale_edit_remove(edit, two, &error));
  wale_edit_free(edit); /* without a commit */
  wale_edit_free(edit);
  CHECK(wale_stage_size(stage) == 1);
  CHECK_MALFORMED(wale_stage_edit(NULL, &edit, &error));
  CHECK_MALFORMED(wale_stage_edit(stage, NULL, &error));
  CHECK_MALFORMED(wale_edit_add(NULL, corduroy, NULL, NULL, &error));
  CHECK_MALFORMED(wale_edit_set(NULL, two, WALE_TEXT("wale"), 1, &error));
  CHECK_MALFORMED(wale_edit_move(NULL, two, 0, 0, &error));
  CHECK_MALFORMED(wale_edit_resize(NULL, two, 1, 1, 0, &error));
  CHECK_MALFORMED(wale_edit_replace(NULL, two, corduroy, &error));
  CHECK_MALFORMED(wale_edit_enable(NULL, two, 0, &error));
  CHECK_MALFORMED(wale_edit_bring(NULL, two, 0, &error));
  CHECK_MALFORMED(wale_edit_remove(NULL, two, &error));
  CHECK_MALFORMED(wale_edit_commit(NULL, &error));
  wale_patch_free(two);
  /* Whoever finds out by himself that a change cannot be made says so. */
  const size_t before = wale_stage_size(stage);
  CHECK_GOOD(wale_stage_edit(stage, &edit, &error));
  CHECK_GOOD(wale_edit_add(edit, corduroy, NULL, NULL, &error));
  CHECK_GOOD(wale_edit_fail(edit, WALE_CODE_unknown_name, WALE_TEXT("colour"), WALE_TEXT("no such colour"), WALE_TEXT(""),
                            &error));
  CHECK_CODE(WALE_CODE_unknown_name, wale_edit_commit(edit, &error));
  CHECK(wale_stage_size(stage) == before);
  CHECK_GOOD(wale_edit_commit(edit, &error)); /* it is empty again */
  /* The first error counts, also one that the commit finds. */
  CHECK_GOOD(wale_edit_add(edit, corduroy, NULL, &two, &error));
  CHECK_GOOD(wale_edit_set(edit, two, WALE_TEXT("wale"), 1, &error)); /* beyond its range, as only the commit finds */
  CHECK_GOOD(wale_edit_fail(edit, WALE_CODE_unknown_name, WALE_TEXT("x"), WALE_TEXT("y"), WALE_TEXT("z"), &error));
  CHECK_CODE(WALE_CODE_malformed_value, wale_edit_commit(edit, &error));
  const WaleCode no_errors[] = {0, -1, 99999, WALE_CODE_shadowed_name};
  for (size_t i = 0; i < 4; ++i)
    CHECK_MALFORMED(wale_edit_fail(edit, no_errors[i], WALE_TEXT("x"), WALE_TEXT("y"), WALE_TEXT("z"), &error));
  CHECK_MALFORMED(wale_edit_fail(edit, WALE_CODE_unknown_name, WALE_TEXT("x"), WALE_TEXT(""), WALE_TEXT("z"), &error));
  CHECK_MALFORMED(wale_edit_commit(edit, &error));
  wale_edit_free(edit);
  wale_patch_free(one), wale_patch_free(two), wale_patch_free(strange);
  wale_stage_free(stage), wale_stage_free(another);
}

int stage_parts(void) {
  run_parts((Part[]){devices, placements, stages, shapes, patches, edits, NULL});
  return failures;
}
