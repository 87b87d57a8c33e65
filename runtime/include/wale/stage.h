#ifndef WALE_STAGE_H
#define WALE_STAGE_H

#include "wale/device.h"
#include "wale/program.h"
#include "wale/run.h"
#include "wale/shape.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Patches on a device's workspace, and the loop that lets the hand feel the front-most one under it. All calls are safe from
   any thread, except that nothing may be called with it while or after it is freed. */
typedef struct WaleStage WaleStage;

/* A patch on a stage. It may outlive the patch and the stage: its calls then give wrong_moment. Freeing the handle leaves the
   patch where it is. */
typedef struct WalePatch WalePatch;

/* How a patch lies and what it is, at one moment. Nothing changes it afterwards; it outlives patch and stage. */
typedef struct WalePlacement WalePlacement;

/* Several changes that are felt at one tick, all or none. One thread at a time uses it; it may outlive its stage. */
typedef struct WaleEdit WaleEdit;

/* What a stage does to its process and to the system; all 0 is the default: it makes threads and nothing else. */
typedef struct WaleStageOptions {
  size_t size;
  int32_t priority;     /* 1 .. 99: SCHED_FIFO for the thread that serves the ticks, if it is permitted; 0: ordinary */
  int32_t lock_memory;  /* 1: locks the pages that the loop itself uses */
  int32_t low_latency;  /* 1: keeps processors out of deep sleep during a run, for the whole system */
  int32_t reserved;     /* 0 */
  double max_force;     /* N (of a pad m/s^2), the largest that the user allows; 0: only the device's own limit */
  WaleText record;      /* records the run in this file, which must not exist yet; empty: does not. Its path counts from the
                           current folder of the process when the stage is made. It is mapped, and
                           read-only to others until the run ends; who truncates it in spite of that, as the superuser
                           may, ends this process (SIGBUS) */
  WaleText record_hand; /* what moves the handle, kept in the recording: "simulated, lateral"; one line, may be empty */
} WaleStageOptions;

/* Where a patch goes. All 0: in the middle, in the program's own size, in layer 0. All finite. */
typedef struct WalePatchOptions {
  size_t size;
  float x, y;          /* m from the workspace's centre, of the patch's centre */
  float width, height; /* m; both 0: the program's own size and rim; otherwise both positive */
  float rim;           /* m, not negative; it counts only with a width and a height */
  float layer;         /* where patches overlap, the hand feels the one with the greatest */
  const WaleShape* shape; /* the part of its rectangle that it covers, stretched to its size; NULL: all of it. Without a width
                             and a height the patch has the shape's */
} WalePatchOptions;

typedef struct WalePlacementDetails {
  size_t size;
  float x, y;               /* m from the workspace's centre, of the patch's centre */
  float width, height, rim; /* m */
  float layer;
  int32_t enabled;          /* 0: it is there and not felt */
  int32_t has_shape;        /* 1: wale_placement_shape gives it; 0: all of its rectangle */
  uint64_t values;          /* how many parameters */
} WalePlacementDetails;

/* `device` is kept by the stage; a device serves one stage at a time. `options` may be NULL.
   Errors: malformed_value; wrong_moment if another stage has the device, or in a child of fork, whose parent has opened it. */
WALE_API WaleCode wale_stage_create(WaleDevice* device, const WaleStageOptions* options, WaleStage** stage,
                                    WaleError** error);
/* Without a device, for a loop of one's own (wale/loop.h). Of a pad the profile must be one that a call of this process gave,
   or have a shipped pad's name: what shakes it is not in it. Of pads of one name it is that of the last one with these figures, or
   else of the last one. Errors: malformed_value, also for a profile without a name or with a figure beyond its range;
   invalid_encoding. */
WALE_API WaleCode wale_stage_create_for(const WaleProfile* profile, const WaleStageOptions* options, WaleStage** stage,
                                        WaleError** error);
/* Ends a run that is under way, also one that another thread has called, and waits for its end. The device then exerts no
   force. */
WALE_API void wale_stage_free(WaleStage* stage);

/* Puts a patch on the stage, in front of all others of its layer. `options` may be NULL; `patch` may be NULL if no handle is
   wanted. Errors: malformed_value; other_device for a program that was built for another device; other_figures for one that
   was built for other figures of this device. */
WALE_API WaleCode wale_stage_add(WaleStage* stage, const WaleProgram* program, const WalePatchOptions* options,
                                 WalePatch** patch, WaleError** error);

/* How many patches there are; 0 for NULL. */
WALE_API size_t wale_stage_size(const WaleStage* stage);

/* Runs for `options->seconds`, in real time or in virtual time on the calling thread, and returns at the end. `run`, which may
   be NULL, gets the figures and the record. Errors:
   - malformed_value: the time is not positive, or longer than can be kept, or an option is out of its range;
   - wrong_moment: nothing is on the stage, it has no device, or another run is under way on it or on its device;
   - unusable_device: the profile lacks a figure that a loop needs, as a slew (`place` is its name), or one is out of its range;
   - unwritable_file: the recording cannot be made; short_of_resources: the system gives no thread. */
WALE_API WaleCode wale_stage_run(WaleStage* stage, const WaleRunOptions* options, WaleRun** run, WaleError** error);
/* Ends the run of wale_stage_run that is under way, if there is one. Also from a signal handler. */
WALE_API void wale_stage_interrupt(WaleStage* stage);

/* Begins an endless run in real time and returns; it may begin without a patch, and keeps no record. Errors as above. */
WALE_API WaleCode wale_stage_start(WaleStage* stage, WaleError** error);
/* Ends the run that wale_stage_start began and waits for its end. `run` may be NULL.
   Errors: wrong_moment if none began since the last stop; short_of_resources if the run failed, or if there is no memory for
   its figures: the run has ended then too. */
WALE_API WaleCode wale_stage_stop(WaleStage* stage, WaleRun** run, WaleError** error);
/* 1 while a run is under way. */
WALE_API int32_t wale_stage_is_running(const WaleStage* stage);

/* The state after the latest tick of the present run or the last one. Never waits for another thread. Real-time: allocates
   nothing, takes no lock, makes no system call. Error: malformed_value for NULL or a wrong size. */
WALE_API WaleCode wale_stage_now(const WaleStage* stage, WaleNow* now);

/* What wale_stage_poll calls for each contact, on its thread; NULL ends it. Contacts are noted only while there is one. It must
   not throw, and must not free the stage; a wale_stage_poll within it does nothing. `contact` lasts for the call. */
typedef void (*WaleReceiveContact)(const WaleContact* contact, void* user);
WALE_API WaleCode wale_stage_on_contact(WaleStage* stage, WaleReceiveContact receive, void* user, WaleError** error);
/* Calls the receiver for all contacts since the last poll, in their order. `dropped`, which may be NULL, says how many were
   dropped because 1024 were waiting. This is the only function of Wale that calls back. */
WALE_API WaleCode wale_stage_poll(WaleStage* stage, size_t* dropped, WaleError** error);

/* The calls of a patch return before the change is felt; C_INTERFACE.md says when it is. Errors of all: wrong_moment if the
   patch was removed or its stage is gone; malformed_value for NULL, or for a value that is not finite or not in its range.
   After an error nothing has changed. Other errors: */
/* In SI units. A value outside the parameter's range is refused and not clamped, since something else would be felt than was asked
   for (wale_batch clamps: among many values by chance one beyond the range must not end an experiment). unknown_name: the program
   has no such parameter. */
WALE_API WaleCode wale_patch_set(WalePatch* patch, WaleText parameter, double value, WaleError** error);
/* m from the workspace's centre. */
WALE_API WaleCode wale_patch_move(WalePatch* patch, float x, float y, WaleError** error);
/* m. No length is too great, here and in WalePatchOptions: a side beyond the workspace's diameter (of a pad without a position
   10 m) counts as that diameter, and a rim of half the smaller side or more as a quarter of it. */
WALE_API WaleCode wale_patch_resize(WalePatch* patch, float width, float height, float rim, WaleError** error);
/* other_device, other_figures. */
WALE_API WaleCode wale_patch_replace(WalePatch* patch, const WaleProgram* program, WaleError** error);
/* A patch that is not enabled is not felt, and keeps its memory. */
WALE_API WaleCode wale_patch_enable(WalePatch* patch, int32_t enabled, WaleError** error);
/* Puts it in front of all patches of a layer. */
WALE_API WaleCode wale_patch_bring(WalePatch* patch, float layer, WaleError** error);
/* Removes the patch from its stage. All handles to it then name nothing; they are freed as before. */
WALE_API WaleCode wale_patch_remove(WalePatch* patch, WaleError** error);

/* The patch as it is wanted: as all calls and commits that have returned have made it, whether the hand feels that yet or not.
   Values are the nearest floats to those that were set. */
WALE_API WaleCode wale_patch_placement(const WalePatch* patch, WalePlacement** placement, WaleError** error);
/* The patch as it was published last: what the loop of the present run has, or that of the last one had. While a bank is prepared
   it is older than the one above. wrong_moment also if no run has had the patch yet. */
WALE_API WaleCode wale_patch_published(const WalePatch* patch, WalePlacement** placement, WaleError** error);
/* The wanted value of a parameter, SI, as in wale_patch_placement; not-a-number after an error. unknown_name. */
WALE_API WaleCode wale_patch_value(const WalePatch* patch, WaleText parameter, float* value, WaleError** error);

WALE_API void wale_placement_free(WalePlacement* placement);
/* Error: malformed_value for NULL or a wrong size. */
WALE_API WaleCode wale_placement_details(const WalePlacement* placement, WalePlacementDetails* details, WaleError** error);
/* The values of the parameters, SI, in the order of the program's; `count` may be NULL. They belong to the placement. */
WALE_API const float* wale_placement_values(const WalePlacement* placement, size_t* count);
/* The value of a parameter, SI. Error: unknown_name. */
WALE_API WaleCode wale_placement_value(const WalePlacement* placement, WaleText parameter, float* value, WaleError** error);
/* Its program; `program` gets a handle to free. */
WALE_API WaleCode wale_placement_program(const WalePlacement* placement, WaleProgram** program, WaleError** error);
/* Its shape as it was given, not stretched to the patch's size; `shape` gets a handle to free, or NULL for all of a rectangle. */
WALE_API WaleCode wale_placement_shape(const WalePlacement* placement, WaleShape** shape, WaleError** error);

/* 1 if it names a patch that is on its stage. */
WALE_API int32_t wale_patch_exists(const WalePatch* patch);
/* What WaleNow and WaleContact call it; never 0, and on its stage unique for ever. 0 for NULL. */
WALE_API uint64_t wale_patch_id(const WalePatch* patch);
/* What WaleRecordedTick calls it. A later patch may get the number of a removed one. 0xffffffff for NULL. */
WALE_API uint32_t wale_patch_number(const WalePatch* patch);
WALE_API void wale_patch_free(WalePatch* patch);

/* Begins an edit. Its calls are those of a stage and of its patches; an error of a change comes from wale_edit_commit, also
   one that the call has given already. A patch that it adds is there from the commit on; within the edit its handle may be
   used at once. */
WALE_API WaleCode wale_stage_edit(WaleStage* stage, WaleEdit** edit, WaleError** error);
WALE_API WaleCode wale_edit_add(WaleEdit* edit, const WaleProgram* program, const WalePatchOptions* options,
                                WalePatch** patch, WaleError** error);
WALE_API WaleCode wale_edit_set(WaleEdit* edit, const WalePatch* patch, WaleText parameter, double value, WaleError** error);
WALE_API WaleCode wale_edit_move(WaleEdit* edit, const WalePatch* patch, float x, float y, WaleError** error);
WALE_API WaleCode wale_edit_resize(WaleEdit* edit, const WalePatch* patch, float width, float height, float rim,
                                   WaleError** error);
WALE_API WaleCode wale_edit_replace(WaleEdit* edit, const WalePatch* patch, const WaleProgram* program, WaleError** error);
WALE_API WaleCode wale_edit_enable(WaleEdit* edit, const WalePatch* patch, int32_t enabled, WaleError** error);
WALE_API WaleCode wale_edit_bring(WaleEdit* edit, const WalePatch* patch, float layer, WaleError** error);
WALE_API WaleCode wale_edit_remove(WaleEdit* edit, const WalePatch* patch, WaleError** error);
/* Makes the next commit fail with this error, unless an earlier call of the edit has failed: for who finds out by himself that a
   change cannot be made. `code` is that of an error; `sentence` says what is wrong, in a line; `argument` and `mend` may be
   empty. Error: malformed_value for another code or no sentence; then the commit fails with that. */
WALE_API WaleCode wale_edit_fail(WaleEdit* edit, WaleCode code, WaleText argument, WaleText sentence, WaleText mend,
                                 WaleError** error);
/* Makes all changes; they are felt together. Errors: those of the changes, of the first that has one; then nothing has changed.
   Afterwards the edit is empty and may be used again. Where memory ended within a call of the edit, that is such an error; where it
   ends within the commit itself, nothing has changed, and the same edit may be committed again. */
WALE_API WaleCode wale_edit_commit(WaleEdit* edit, WaleError** error);
/* Without a commit nothing changes. */
WALE_API void wale_edit_free(WaleEdit* edit);

#ifdef __cplusplus
}
#endif

#endif
