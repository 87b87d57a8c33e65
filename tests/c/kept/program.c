/* A program of anyone. It is compiled with each older header, and must run with this library. */
#include <stdio.h>
#include <string.h>
#include <wale.h>

static int entered;

static void hear(const WaleContact* contact, void* user) {
  (void)user;
  entered += contact->kind == WALE_CONTACT_enter && contact->patch != 0;
}

/* Ends with the error in words. */
static int failed(int line, WaleError* error) {
  WaleErrorDetails details = {.size = sizeof details};
  if (wale_error_details(error, &details) == 0) fprintf(stderr, "line %d: %s\n", line, details.in_words.data);
  return 1;
}
#define TRY(call) \
  if ((call) != 0) return failed(__LINE__, error)
#define EXPECT(condition) \
  if (!(condition)) return fprintf(stderr, "line %d: %s\n", __LINE__, #condition)

int main(void) {
  WaleError* error = NULL;
  WaleLibrary* library = NULL;
  WaleDevice* device = NULL;
  WaleProgram *program = NULL, *none = NULL;
  WaleStage* stage = NULL;
  WalePatch* patch = NULL;
  WaleRun* run = NULL;
  WaleFelt* felt = NULL;
  EXPECT(wale_interface() >= WALE_INTERFACE);
  WaleLibraryOptions folders = {.size = sizeof folders};
  folders.reserved = 1; /* the last field that it knows */
  EXPECT(wale_library_create(&folders, &library, NULL) == WALE_CODE_malformed_value);
  folders.reserved = 0;
  TRY(wale_library_create(&folders, &library, &error));
  TRY(wale_library_level(library, WALE_TEXT("roughness"), WALE_TEXT("0.6"), NULL, &program, &error));
  WaleProgramDetails details = {.size = sizeof details};
  details.warnings = 77;
  TRY(wale_program_details(program, &details, &error));
  EXPECT(details.percepts == 1 && details.warnings == 0);
  EXPECT(wale_library_find(library, WALE_TEXT("corduory"), NULL, &none, NULL) == WALE_CODE_unknown_name);
  TRY(wale_library_open_device(library, WALE_TEXT("simulated"), NULL, &device, &error));
  WaleProfile profile = {.size = sizeof profile};
  TRY(wale_device_profile(device, &profile, &error));
  WaleStageOptions options = {.size = sizeof options, .max_force = 5};
  TRY(wale_stage_create(device, &options, &stage, &error));
  WalePatchOptions place = {.size = sizeof place, .x = 0.01f};
  TRY(wale_stage_on_contact(stage, hear, NULL, &error));
  TRY(wale_stage_add(stage, program, &place, &patch, &error));
  TRY(wale_patch_move(patch, 0, 0, &error));
  WaleRunOptions two_seconds = {.size = sizeof two_seconds, .seconds = 2, .virtual_time = 1};
  TRY(wale_stage_run(stage, &two_seconds, &run, &error));
  TRY(wale_stage_poll(stage, NULL, &error));
  EXPECT(entered >= 1);
  WaleNow now = {.size = sizeof now};
  EXPECT(wale_stage_now(stage, &now) == 0 && now.ticks_run == (int64_t)(2 * profile.rate + 0.5));
  WaleTick last;
  TRY(wale_run_ticks(run, (size_t)now.ticks_run - 1, 1, sizeof last, &last, &error));
  EXPECT(last.force.x == now.force.x && last.inside == now.inside);
  WaleMeasureOptions measure = {.size = sizeof measure, .settling = 0.5, .least_crossings = 5};
  TRY(wale_felt_measure(run, patch, &measure, &felt, &error));
  WaleFeltLevel level = {.size = sizeof level};
  TRY(wale_felt_level(felt, 0, &level, &error));
  EXPECT(level.level > 0.5 && level.level < 0.7);
  WaleVector positions[3] = {{0, 0}, {0.001f, 0}, {0.002f, 0}}, forces[3];
  WaleBatchOptions batch = {.size = sizeof batch, .hands = 1, .ticks = 3, .position = positions};
  TRY(wale_batch(program, &batch, forces, &error));
  EXPECT(forces[0].x != forces[1].x || forces[1].x != forces[2].x);
  wale_felt_free(felt), wale_run_free(run), wale_patch_free(patch), wale_stage_free(stage);
  wale_device_free(device), wale_program_free(program), wale_library_free(library);
  EXPECT(wale_handles() == 0);
  return 0;
}
