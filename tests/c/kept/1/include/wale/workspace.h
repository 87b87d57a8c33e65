#ifndef WALE_WORKSPACE_H
#define WALE_WORKSPACE_H

#include "wale/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Materials that are laid out side by side, compiled for one device: what `wale build --workspace` makes. It does not change;
   any number of threads may use it at once. What it gives is independent of it, but texts belong to it. */
typedef struct WaleWorkspace WaleWorkspace;

typedef struct WaleWorkspaceDetails {
  size_t size;
  WaleText name, documentation;
  WaleText device; /* that its programs are for; empty without a patch */
  size_t patches;
  size_t warnings; /* of the text that it was compiled from */
} WaleWorkspaceDetails;

/* A patch of a workspace. Lengths are m. */
typedef struct WaleWorkspacePatch {
  size_t size;
  WaleText name;    /* that no other patch has */
  WaleText made_of; /* its material as the author wrote it: "denim(roughness: 0.3)" */
  float x, y;       /* from the workspace's centre, of the patch's centre */
  float width, height, rim;
  int32_t has_shape;             /* 0: it covers all of its rectangle */
  size_t marks;                  /* of its sliders */
  size_t text_begin, text_end;   /* bytes of its statement in the text; both 0 for a workspace file */
} WaleWorkspacePatch;

/* A range of a slider that a person has marked: from here to here it still felt like `says`. */
typedef struct WaleWorkspaceMark {
  size_t size;
  WaleText slider;    /* a parameter, or a percept that the material asks for */
  WaleText says;      /* may be empty */
  float low, high;    /* SI, or levels; not-a-number: none. One of them is there */
  int32_t is_percept; /* 1: the range is one of levels, 0 .. 1 */
  int32_t reserved;
} WaleWorkspaceMark;

/* Reads the bytes of a workspace file (.wws). Errors: damaged_file, newer_file, and those of wale_program_load. */
WALE_API WaleCode wale_workspace_load(const void* bytes, size_t length, WaleWorkspace** workspace, WaleError** error);
WALE_API void wale_workspace_free(WaleWorkspace* workspace);
/* The bytes of a workspace file. `length` gets how many they are; they are written if `to` has room for all. */
WALE_API WaleCode wale_workspace_bytes(const WaleWorkspace* workspace, void* to, size_t capacity, size_t* length,
                                       WaleError** error);

WALE_API WaleCode wale_workspace_details(const WaleWorkspace* workspace, WaleWorkspaceDetails* details, WaleError** error);
/* Patch number `index`, from 0; the last lies in front. Error: malformed_value, also in the next three calls. */
WALE_API WaleCode wale_workspace_patch(const WaleWorkspace* workspace, size_t index, WaleWorkspacePatch* patch,
                                       WaleError** error);
WALE_API WaleCode wale_workspace_mark(const WaleWorkspace* workspace, size_t patch, size_t index, WaleWorkspaceMark* mark,
                                      WaleError** error);
/* The program and the shape of a patch: handles to free. `shape` gets NULL for a patch that covers its rectangle. */
WALE_API WaleCode wale_workspace_program(const WaleWorkspace* workspace, size_t patch, WaleProgram** program,
                                         WaleError** error);
WALE_API WaleCode wale_workspace_shape(const WaleWorkspace* workspace, size_t patch, WaleShape** shape, WaleError** error);
/* Warning number `index`, which belongs to the workspace; NULL if there is none. */
WALE_API const WaleError* wale_workspace_warning(const WaleWorkspace* workspace, size_t index);

/* Puts all patches on a stage at once, the last in front. `patches` may be NULL; otherwise it has room for a handle of each, in
   their order. Errors: those of wale_stage_add; then none is there. */
WALE_API WaleCode wale_stage_add_workspace(WaleStage* stage, const WaleWorkspace* workspace, WalePatch** patches,
                                           WaleError** error);

#ifdef __cplusplus
}
#endif

#endif
