#ifndef WALE_SNAPSHOT_H
#define WALE_SNAPSHOT_H

#include "wale/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A copy of a patch's parameters and memory at one tick, for pictures. It never changes, and outlives patch and stage. One thread
   at a time uses it. */
typedef struct WaleSnapshot WaleSnapshot;

/* A field over the patch that a program remembers. Texts and cells belong to the snapshot. */
typedef struct WaleGrid {
  size_t size;
  WaleText name;
  WaleText si_unit;
  size_t columns, rows;
  const float* cells; /* row by row from the lower left, SI */
} WaleGrid;

enum {
  WALE_MARK_point = 1,      /* place x y, diameter */
  WALE_MARK_circle = 2,     /* place x y, radius */
  WALE_MARK_box = 3,        /* place x y, width, height, angle */
  WALE_MARK_line = 4,       /* from x y, to x y */
  WALE_MARK_spring = 5,     /* from x y, to x y, width */
  WALE_MARK_trajectory = 6  /* place x y, seconds for which its path stays visible */
};

/* A shape that the picture shows now, in m, rad and s from the patch's centre. Its values may be any float. Its layout never
   changes. */
typedef struct WaleMark {
  int32_t kind;     /* WALE_MARK_… */
  uint32_t colour;  /* 0xRRGGBB */
  float values[5];  /* those that the kind does not use are 0 */
} WaleMark;

/* Takes a period or two during a run. Errors: wrong_moment if the patch is gone, or if the run serves no tick for 0.2 s. */
WALE_API WaleCode wale_patch_snapshot(const WalePatch* patch, WaleSnapshot** snapshot, WaleError** error);
WALE_API void wale_snapshot_free(WaleSnapshot* snapshot);

/* How the patch lay then: its place, for hands and places that count from the workspace's centre. A handle to free. */
WALE_API WaleCode wale_snapshot_placement(const WaleSnapshot* snapshot, WalePlacement** placement, WaleError** error);

/* The states' values, SI, in the program's order; `count` may be NULL. They belong to the snapshot. */
WALE_API const float* wale_snapshot_states(const WaleSnapshot* snapshot, size_t* count);
/* The name of a state; empty beyond the last. It belongs to the snapshot. */
WALE_API WaleText wale_snapshot_state_name(const WaleSnapshot* snapshot, size_t index);
/* Error: malformed_value for NULL, a wrong size, or an index that is too large. */
WALE_API WaleCode wale_snapshot_grid(const WaleSnapshot* snapshot, size_t index, WaleGrid* grid, WaleError** error);

/* The surface at `count` places, m from the patch's centre: its height (m, or a plain number), and, unless `colours` is NULL,
   three numbers in 0 .. 1 for each place: red, green, blue; a program without colours leaves them unchanged. */
WALE_API WaleCode wale_snapshot_surface(WaleSnapshot* snapshot, const WaleVector* places, size_t count, float* heights,
                                        float* colours, WaleError** error);
/* The shapes that the picture shows for a hand at `position` with `velocity` at `time` (m from the patch's centre, m/s, s), in
   the order of drawing. The position of WaleNow counts from the workspace's centre: take x and y of wale_snapshot_placement
   from it. Gives their number; writes them if `capacity` is enough, otherwise nothing. */
WALE_API WaleCode wale_snapshot_show(WaleSnapshot* snapshot, WaleVector position, WaleVector velocity, double time,
                                     WaleMark* marks, size_t capacity, size_t* count, WaleError** error);

#ifdef __cplusplus
}
#endif

#endif
