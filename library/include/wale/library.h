#ifndef WALE_LIBRARY_H
#define WALE_LIBRARY_H

#include "wale/device.h"
#include "wale/program.h"
#include "wale/workspace.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Materials and levels by name, compiled for a device. The answers are those of the command line. All calls but
   wale_library_free are safe from any thread, also at the same time. They take from a millisecond to a second, and the calling
   thread needs a stack of 8 MB. What they return is independent of the library. */
typedef struct WaleLibrary WaleLibrary;

/* A program that is being made, or a search (wale/search.h). One thread at a time uses it. It may outlive its library. */
typedef struct WaleFuture WaleFuture;

/* All 0 is the default. */
typedef struct WaleLibraryOptions {
  size_t size;
  const WaleText* folders; /* searched for materials and imports besides the shipped library, as are those of the environment
                              variable WALE_LIBRARY; paths count from the current folder of the process now; read during the
                              call only */
  size_t folder_count;
  int32_t unsandboxed_pictures; /* 1: decodes a stranger's picture also where the system offers no sandbox */
  int32_t reserved;             /* 0 */
  WaleText index; /* in which searches look, as it stands: a file, or postgresql://USER@HOST/DATABASE, that `wale library index`
                     makes; empty: one in the user's cache, that of the command line, which is brought up to date */
  WaleText devices; /* a Wale text that declares the application's own devices, each as `export device NAME { … }`: the device of
                       WaleCompileOptions may name one, also for shipped materials and levels. They scale no real device; a stage of
                       wale_stage_create_for serves one, with the profile of wale_library_profile. Empty: none */
} WaleLibraryOptions;

/* All 0 is the default. */
typedef struct WaleCompileOptions {
  size_t size;
  WaleText device;   /* that the program is for, by the name of its profile; empty: "sandpaper", of a patch program its own */
  WaleText material; /* one of the materials of a text that has several; empty: the one that was named, or else the first */
  WaleText name;     /* of a text in memory: what errors call it, one line of UTF-8; imports are looked for beside; empty: "text" */
} WaleCompileOptions;

/* All 0 is the default. */
typedef struct WaleWorkspaceOptions {
  size_t size;
  WaleText device;    /* as in WaleCompileOptions */
  WaleText workspace; /* which of the text; empty: the first */
  WaleText name;      /* as in WaleCompileOptions */
  int32_t legibility; /* 1: warns also of what a hand cannot tell, as `wale check`: it reads every program, up to a second each */
  int32_t reserved;   /* 0 */
} WaleWorkspaceOptions;

/* `options` may be NULL. The owner's devices are read once, here. Errors: malformed_value; unreadable_file for a
   folder of `folders` or of WALE_LIBRARY that does not exist or is none; the first one in the text `devices`, unknown_device if
   that exports no device, and declared_twice for one with the name of a shipped one. */
WALE_API WaleCode wale_library_create(const WaleLibraryOptions* options, WaleLibrary** library, WaleError** error);
/* Waits for the work that is under way, at most. Futures that were not begun then give wrong_moment. */
WALE_API void wale_library_free(WaleLibrary* library);

/* All: `options` may be NULL; `program` gets a handle to free. Errors in a text have its place; those about an argument have the
   argument's name as `place`, its value as `place_text`, and for an unknown name up to three that may have been meant.
   All: unknown_device for a device that nothing declares (an error in the owner's devices.wale is then among the others);
   invalid_encoding for an argument that is not UTF-8; malformed_value for a name that is empty, blank or of several lines. */

/* A material by its name ("corduroy"), title, other name, kind or module ("fabric.denim"), or MODULE:MATERIAL. Materials
   in the current folder of the process take precedence over the shipped ones, and so do those of the whole project if a file
   wale.project lies in that folder or above it, and those of `folders`: `taken` of WaleProgramDetails says so. The name thus
   may mean another material in another folder; wale_library_open does not depend on it.
   Titles and other names are found in any case of letters ("OAK"), names of materials and modules as they are written ("Fractal").
   Errors: unknown_name, for a kind ("fabric") with three of its materials as nearest; ambiguous_material; unknown_material for an
   option `material` that is not in the text of the one that was found. */
WALE_API WaleCode wale_library_find(WaleLibrary* library, WaleText name, const WaleCompileOptions* options,
                                    WaleProgram** program, WaleError** error);
/* A surface with a level of a percept: a named level ("coarse") or a number from 0 to 1 ("0.6").
   Errors: unknown_name, level_out_of_range, malformed_value, percept_unrealised if the device cannot render it. */
WALE_API WaleCode wale_library_level(WaleLibrary* library, WaleText percept, WaleText level,
                                     const WaleCompileOptions* options, WaleProgram** program, WaleError** error);
/* The text of a Wale file. Errors: those in the text; unknown_material for an option `material` that is not in it. */
WALE_API WaleCode wale_library_compile(WaleLibrary* library, WaleText text, const WaleCompileOptions* options,
                                       WaleProgram** program, WaleError** error);
/* A Wale file (.wale) or a patch program (.wpp). The path is any bytes but zero.
   Errors: unreadable_file; damaged_file for binary data that is neither; other_device; those in the text (any text is read as
   Wale: `hello` gives missing_version), and unknown_material; those of wale_program_load. */
WALE_API WaleCode wale_library_open(WaleLibrary* library, WaleText path, const WaleCompileOptions* options,
                                    WaleProgram** program, WaleError** error);
/* The same for the bytes of such a file. */
WALE_API WaleCode wale_library_open_bytes(WaleLibrary* library, const void* bytes, size_t length,
                                          const WaleCompileOptions* options, WaleProgram** program, WaleError** error);

/* A workspace of a Wale text with the programs, places and shapes of its patches; `workspace` gets a handle to free. It takes the
   time of each different material. Errors: those in the text; unknown_workspace. */
WALE_API WaleCode wale_library_workspace(WaleLibrary* library, WaleText text, const WaleWorkspaceOptions* options,
                                         WaleWorkspace** workspace, WaleError** error);
/* The same of a Wale file (.wale), or a workspace file (.wws). Errors also: unreadable_file, damaged_file, newer_file, and
   other_device for a workspace file that is built for another device. */
WALE_API WaleCode wale_library_open_workspace(WaleLibrary* library, WaleText path, const WaleWorkspaceOptions* options,
                                              WaleWorkspace** workspace, WaleError** error);

/* As the calls without `_later`, on a thread of the library's own, one after the other. Arguments are copied. Error: short_of_resources. */
WALE_API WaleCode wale_library_find_later(WaleLibrary* library, WaleText name, const WaleCompileOptions* options,
                                          WaleFuture** future, WaleError** error);
WALE_API WaleCode wale_library_level_later(WaleLibrary* library, WaleText percept, WaleText level,
                                           const WaleCompileOptions* options, WaleFuture** future, WaleError** error);
WALE_API WaleCode wale_library_compile_later(WaleLibrary* library, WaleText text, const WaleCompileOptions* options,
                                             WaleFuture** future, WaleError** error);
WALE_API WaleCode wale_library_open_later(WaleLibrary* library, WaleText path, const WaleCompileOptions* options,
                                          WaleFuture** future, WaleError** error);

/* Whether it is ready: 1, or 0. It does not wait. 0 for NULL; 1 for one that was taken, and in a child of fork for one of its
   parent: wale_future_take then says why there is nothing to take. */
WALE_API int32_t wale_future_poll(const WaleFuture* future);
/* Waits until it is ready, for `seconds` at most (0 or less, or not-a-number: not at all; infinite: for as long as it takes).
   Returns as wale_future_poll. */
WALE_API int32_t wale_future_wait(const WaleFuture* future, double seconds);
/* Waits and gives the program, once. Errors: those of the call that began it; wrong_moment if it was taken already, or if the
   library was freed before the work began. */
WALE_API WaleCode wale_future_take(WaleFuture* future, WaleProgram** program, WaleError** error);
/* Does not wait; the work goes on, and its result is dropped. */
WALE_API void wale_future_free(WaleFuture* future);

/* As wale_devices, with the declarations of the owner of this computer, and a simulation of each device that the library's
   text `devices` declares. Errors also: those in the owner's file. */
WALE_API WaleCode wale_library_devices(WaleLibrary* library, WaleDevices** devices, WaleError** error);
/* As wale_profile, also of a device that the owner declares. The text belongs to the library. */
WALE_API WaleCode wale_library_profile(WaleLibrary* library, WaleText name, WaleProfile* profile, WaleError** error);
/* As wale_device_open, with the declarations of the owner of this computer, and with the devices of the library's text
   `devices`, which are simulated by name. A simulated device is in the hand of a simulated person who rubs to and fro, unless the
   options say otherwise. Errors also: those in the owner's file. */
WALE_API WaleCode wale_library_open_device(WaleLibrary* library, WaleText spelling, const WaleDeviceOptions* options,
                                           WaleDevice** device, WaleError** error);

#ifdef __cplusplus
}
#endif

#endif
