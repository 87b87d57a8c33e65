/* README's task in C: corduroy on the device that is there. Five seconds of a run in virtual time, so that it needs no
 * clock. */
static void readme_task(void) {
  WaleLibrary* library = NULL;
  WaleDevice* device = NULL;
  WaleProgram* corduroy = NULL;
  WaleStage* stage = NULL;
  WaleRun* run = NULL;
  WaleProfile profile;
  WaleCompileOptions compile;
  WaleRunOptions five_seconds;
  WaleRunFigures figures;
  memset(&profile, 0, sizeof profile);
  memset(&compile, 0, sizeof compile);
  memset(&five_seconds, 0, sizeof five_seconds);
  memset(&figures, 0, sizeof figures);
  profile.size = sizeof profile;
  CHECK_GOOD(wale_library_create(NULL, &library, &error));
  CHECK_GOOD(wale_library_open_device(library, WALE_TEXT("simulated"), NULL, &device, &error));
  CHECK_GOOD(wale_device_profile(device, &profile, &error));
  compile.size = sizeof compile;
  compile.device = profile.name;
  CHECK_GOOD(wale_library_find(library, WALE_TEXT("corduroy"), &compile, &corduroy, &error));
  CHECK_GOOD(wale_stage_create(device, NULL, &stage, &error));
  CHECK_GOOD(wale_stage_add(stage, corduroy, NULL, NULL, &error));
  five_seconds.size = sizeof five_seconds;
  five_seconds.seconds = 5;
  five_seconds.virtual_time = 1;
  CHECK_GOOD(wale_stage_run(stage, &five_seconds, &run, &error));
  figures.size = sizeof figures;
  CHECK_GOOD(wale_run_figures(run, &figures, &error));
  CHECK(figures.ticks_run == (int64_t)(5 * profile.rate + 0.5));
  CHECK(figures.recorded == (uint64_t)figures.ticks_run);
  wale_library_free(library);
  wale_device_free(device);
  wale_program_free(corduroy);
  wale_stage_free(stage);
  wale_run_free(run);
}
