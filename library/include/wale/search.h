#ifndef WALE_SEARCH_H
#define WALE_SEARCH_H

#include "wale/library.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The materials that a search found, the best first: by feel in the order of the least that they can differ by, where each cue that
   is unknown counts as one difference more. It does not change; any number of threads may use it at once. Texts of it
   belong to it. */
typedef struct WaleMatches WaleMatches;

/* A level of a percept that is sought, or a range of levels, 0 .. 1. */
typedef struct WalePerceptRange {
  WaleText percept; /* "roughness", or the other end of its scale, "smoothness" */
  double low, high; /* equal: materials near this level; otherwise only those that read within */
} WalePerceptRange;

/* All 0 is the default. What is set must all hold. It is read during the call only. */
typedef struct WaleSearchOptions {
  size_t size;
  WaleText kind;                    /* "fabric", which has "fabric.woven" too; empty: any */
  const WalePerceptRange* percepts; /* levels that the programs read as */
  size_t percept_count;
  WaleText near;   /* a material that the others are to feel like, by its name or a Wale file of one's own; empty: any */
  size_t most;     /* so many are given; 0: by feel 20, of wale_library_between 10, by words all */
  WaleText device; /* on which they are compared; empty: "sandpaper", or that of the named index */
} WaleSearchOptions;

/* A material that was found. Distances are in just noticeable differences at d' = 1; what is not known widens them. */
typedef struct WaleMatch {
  size_t size;
  WaleText name;     /* "corduroy" */
  WaleText module;   /* "fabric.corduroy": "fabric.corduroy:corduroy" is a name for wale_library_find */
  WaleText file;     /* its path; shipped ones are in the library itself, not on the disk */
  WaleText title;    /* may be empty */
  WaleText kind;     /* may be empty */
  WaleText found_by; /* where it has the sought words: "name", "title", "called" and so on; empty if none were sought */
  WaleText found_in; /* its text there */
  double score;      /* of its words; the greater the better; 0 if it has all of them as they stand: then the place orders */
  double low, high;  /* by feel: how much it differs from what was sought, of wale_library_between from the first; `high` is
                        infinite if nothing bounds it; both not-a-number: it was not sought by feel */
  WaleText plainest; /* the cue or percept that differs most; empty if none does */
  size_t unknown;    /* cues or percepts that are not known, and widen it: wale_matches_unknown */
  double other_low, other_high; /* of wale_library_between: from the second; otherwise not-a-number */
  WaleText other_plainest;
  size_t other_unknown;
} WaleMatch;

/* Materials by words, by how they feel, or both, as `wale find`; a blank text means any. By feel, the first search of a library
   reads all of it and keeps that in an index, which takes from seconds to minutes: with `_later` a program sees how far it is
   (wale_future_progress) and may end it (wale_future_cancel), and so does wale_library_free. Searches by feel wait for each
   other. `options` may be NULL; `matches` gets a handle to free, also if nothing was found. Errors: unknown_name for an unknown
   kind, percept or material; ambiguous_material; those in its text; unknown_material for one that pushes nothing; level_out_of_range;
   malformed_value; stopped; other_device if the index is for another device; of an index that was named, unreadable_file,
   damaged_file, newer_file, and missing_library in a Wale that was built without its database. */
WALE_API WaleCode wale_library_search(WaleLibrary* library, WaleText text, const WaleSearchOptions* options,
                                      WaleMatches** matches, WaleError** error);
/* Those that feel most like a material, as `wale find --near`; it is not among them. Errors as above. */
WALE_API WaleCode wale_library_nearest(WaleLibrary* library, WaleText material, const WaleSearchOptions* options,
                                       WaleMatches** matches, WaleError** error);
/* Those that are nearer to each of two materials than these are to each other, as `wale between`. Errors as above. */
WALE_API WaleCode wale_library_between(WaleLibrary* library, WaleText one, WaleText other, const WaleSearchOptions* options,
                                       WaleMatches** matches, WaleError** error);
/* As the calls without `_later`, on the thread of wale_library_find_later. Arguments are copied. */
WALE_API WaleCode wale_library_search_later(WaleLibrary* library, WaleText text, const WaleSearchOptions* options,
                                            WaleFuture** future, WaleError** error);
WALE_API WaleCode wale_library_nearest_later(WaleLibrary* library, WaleText material, const WaleSearchOptions* options,
                                             WaleFuture** future, WaleError** error);
WALE_API WaleCode wale_library_between_later(WaleLibrary* library, WaleText one, WaleText other,
                                             const WaleSearchOptions* options, WaleFuture** future, WaleError** error);

/* How many files of the library are read for its index, of how many. Both 0 before it begins, if there is nothing to read, and
   for a future of a program. Either place may be NULL. */
WALE_API void wale_future_progress(const WaleFuture* future, size_t* done, size_t* all);
/* Ends that reading: the search then gives `stopped`, unless it was ready. What was read is kept, where an index can be. */
WALE_API void wale_future_cancel(WaleFuture* future);
/* As wale_future_take, of a search. Errors also: wrong_moment for the future of a program, as wale_future_take gives it for that
   of a search. */
WALE_API WaleCode wale_future_take_matches(WaleFuture* future, WaleMatches** matches, WaleError** error);

WALE_API void wale_matches_free(WaleMatches* matches);
/* 0 for NULL. */
WALE_API size_t wale_matches_count(const WaleMatches* matches);
WALE_API WaleCode wale_matches_match(const WaleMatches* matches, size_t index, WaleMatch* match, WaleError** error);
/* The name of a cue or percept that is not known of a match; empty where there is none. The other: of the distance from the
   second material of wale_library_between. */
WALE_API WaleText wale_matches_unknown(const WaleMatches* matches, size_t index, size_t which);
WALE_API WaleText wale_matches_other_unknown(const WaleMatches* matches, size_t index, size_t which);
/* What the owner should know: newer_file if the named index is of another build of Wale, unwritable_file if no index can be
   kept; by words, unknown_name if nothing was found: why, and a word that was perhaps meant. NULL behind the last. It belongs to `matches`. */
WALE_API const WaleError* wale_matches_warning(const WaleMatches* matches, size_t index);

#ifdef __cplusplus
}
#endif

#endif
