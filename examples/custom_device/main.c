/* A device that Wale has no driver for: its figures are declared in Wale, so that shipped materials are compiled for it by
   their names, and the program reads its handle and pushes it at every tick. Here the handle is a mass on a spring that was
   pulled aside. */
#include <math.h>
#include <stdio.h>
#include <wale.h>

static const char* const declared =
    "wale 1\n"
    "export device rail_stick {\n"
    "  class     force_plane\n"
    "  workspace disc(100 mm)\n"
    "  position  8192 counts\n"
    "  force     4 N, 1000 counts\n"
    "  rate      1000 Hz\n"
    "  speed     assumed 1 m/s\n"
    "  slew      assumed 100 N/s\n"
    "  velocity_filter 15, 1 counts\n"
    "  patch     80 mm, 80 mm, 5 mm\n"
    "  mass      assumed 0.1 kg\n"
    "  damping   assumed 1 N s/m\n"
    "  friction  assumed 0.05 N\n"
    "  delay     assumed 1 ms\n"
    "  sustained unknown\n"
    "  active    assumed 1 W\n"
    "  source    \"the maker's data sheet\"\n"
    "}\n";

/* Prints what is wrong, and gives the program's exit status. The system frees everything else. */
static int failed(WaleError* error) {
  WaleErrorDetails details = {.size = sizeof details};
  wale_error_details(error, &details);
  fprintf(stderr, "%s\n", details.in_words.data);
  wale_error_free(error);
  return 1;
}

int main(void) {
  const double mass = 0.1, spring = 40;  /* kg, N/m */
  double place = 0.03, velocity = 0;     /* m, m/s */
  double swing = 0;                      /* m, in the last half second */
  long pushed = 0;
  WaleError* error = NULL;

  WaleLibrary* library = NULL;
  WaleProgram* honey = NULL;
  WaleProfile stick = {.size = sizeof stick};
  WaleLibraryOptions own = {.size = sizeof own, .devices = WALE_TEXT(declared)};
  WaleCompileOptions for_it = {.size = sizeof for_it, .device = WALE_TEXT("rail_stick")};
  if (wale_library_create(&own, &library, &error)) return failed(error);
  if (wale_library_profile(library, for_it.device, &stick, &error)) return failed(error);
  if (wale_library_find(library, WALE_TEXT("honey"), &for_it, &honey, &error)) return failed(error);

  WaleStage* stage = NULL;
  WaleLoop* loop = NULL;
  if (wale_stage_create_for(&stick, NULL, &stage, &error)) return failed(error);
  if (wale_stage_add(stage, honey, NULL, NULL, &error)) return failed(error);
  if (wale_loop_begin(stage, &loop, &error)) return failed(error);
  for (int tick = 0; tick < 2 * stick.rate; ++tick) {
    WaleReading reading = {.size = sizeof reading};
    reading.counts_x = (int32_t)lround(place * stick.position_counts / stick.workspace_diameter);
    const WaleVector force = wale_loop_step(loop, &reading, 1);  /* all guards are in it */
    pushed += force.x != 0;
    velocity += (force.x - spring * place) / mass / stick.rate;
    place += velocity / stick.rate;
    if (tick > 1.5 * stick.rate) swing = fmax(swing, fabs(place));
  }
  wale_loop_free(loop);
  printf("in honey the handle swings by %.1f mm after 2 s, and by 30 mm at first\n", 1000 * swing);

  wale_stage_free(stage);
  wale_program_free(honey);
  wale_library_free(library);
  return pushed > 0 && swing < 0.02 ? 0 : 1;
}
