/* Asks for a roughness by name, puts it under the hand, and reads back what came out of the handle. */
#include <stdio.h>
#include <wale.h>

/* Prints what is wrong, and gives the program's exit status. The system frees everything else. */
static int failed(WaleError* error) {
  WaleErrorDetails details = {.size = sizeof details};
  wale_error_details(error, &details);
  fprintf(stderr, "%s\n", details.in_words.data);
  for (size_t i = 0; i < details.nearest; ++i) fprintf(stderr, "  near: %s\n", wale_error_nearest(error, i).data);
  wale_error_free(error);
  return 1;
}

int main(int count, char** arguments) {
  const char* name = count > 1 ? arguments[1] : "coarse";
  WaleError* error = NULL;

  WaleLibrary* library = NULL;
  WaleProgram* surface = NULL;
  if (wale_library_create(NULL, &library, &error)) return failed(error);
  if (wale_library_level(library, WALE_TEXT("roughness"), WALE_TEXT(name), NULL, &surface, &error))
    return failed(error);

  WaleDevice* joystick = NULL;
  WaleStage* stage = NULL;
  WalePatch* patch = NULL;
  WaleRun* run = NULL;
  WaleRunOptions three_seconds = {.size = sizeof three_seconds, .seconds = 3, .virtual_time = 1};
  if (wale_library_open_device(library, WALE_TEXT("simulated"), NULL, &joystick, &error)) return failed(error);
  if (wale_stage_create(joystick, NULL, &stage, &error)) return failed(error);
  if (wale_stage_add(stage, surface, NULL, &patch, &error)) return failed(error);
  if (wale_stage_run(stage, &three_seconds, &run, &error)) return failed(error);

  WaleFelt* felt = NULL;
  WaleMeasureOptions measure = {.size = sizeof measure, .settling = 0.5};
  WaleFeltFigures figures = {.size = sizeof figures};
  if (wale_felt_measure(run, patch, &measure, &felt, &error)) return failed(error);
  if (wale_felt_figures(felt, &figures, &error)) return failed(error);
  for (size_t i = 0; i < figures.levels; ++i) {
    WaleFeltLevel level = {.size = sizeof level};
    if (wale_felt_level(felt, i, &level, &error)) return failed(error);
    if (level.problem == NULL)
      printf("%s %s: %.3f N at the handle, felt as level %.2f\n", name, level.name.data, figures.rubbing_p99,
             level.level);
  }

  wale_felt_free(felt);
  wale_run_free(run);
  wale_patch_free(patch);
  wale_stage_free(stage);
  wale_device_free(joystick);
  wale_program_free(surface);
  wale_library_free(library);
  return 0;
}
