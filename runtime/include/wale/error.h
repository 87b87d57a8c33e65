#ifndef WALE_ERROR_H
#define WALE_ERROR_H

/* What all C headers of Wale share: texts, errors, versions. runtime/C_INTERFACE.md has the conventions: ownership, errors,
   threads, sizes. Unless a function says otherwise, it may be called from any thread but a real-time one; it does not throw;
   and freeing NULL does nothing. */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define WALE_API __attribute__((visibility("default")))
#else
#define WALE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The interface that this header describes. It grows by 1 whenever something is added to it. */
#define WALE_INTERFACE 1

/* A length that means: up to the first zero byte. */
#define WALE_ZERO_ENDED SIZE_MAX

/* A text: UTF-8, not ended by a zero byte unless `length` is WALE_ZERO_ENDED. Data of NULL, with length 0 or WALE_ZERO_ENDED,
   is the empty text. As an argument it is read during the call only. As a result it belongs to the handle that gave it, has
   its length, and a zero byte follows it. */
typedef struct WaleText {
  const char* data;
  size_t length;
} WaleText;

/* The text of a C string. */
#ifdef __cplusplus
#define WALE_TEXT(string) (WaleText{(string), WALE_ZERO_ENDED})
#else
#define WALE_TEXT(string) ((WaleText){(string), WALE_ZERO_ENDED})
#endif

/* Two numbers along x (to the right) and y (away from the person): a place in m, a velocity in m/s, a force in N. The force of
   a pad is its amplitude (m/s^2) and its frequency (Hz). Its layout never changes. */
typedef struct WaleVector {
  float x, y;
} WaleVector;

/* 0: no error. Otherwise the number of a code: 301 is W0301. Numbers never change; new ones come. */
typedef int32_t WaleCode;

/* WALE_CODE_unknown_name and so on. */
enum {
#define WALE_CODE(number, name, severity, title) WALE_CODE_##name = 1##number - 10000, /* a leading 0 would mean octal */
#include "wale/codes.def"
  WALE_CODE_none = 0
};

/* An error or a warning. Functions that can fail return its code and have a last argument `error`: NULL, or the place of a
   handle. They set it to NULL if all is well, otherwise to a new handle that the caller frees. They never read it. */
typedef struct WaleError WaleError;

enum { WALE_SEVERITY_error = 0, WALE_SEVERITY_warning = 1 };

/* All texts belong to the error. */
typedef struct WaleErrorDetails {
  size_t size;
  int32_t code;
  int32_t severity;        /* WALE_SEVERITY_… */
  WaleText sentence;       /* what is wrong: "expected a number, found a vector"; programs never search it */
  WaleText mend;           /* what to do about it; may be empty */
  WaleText expected;       /* what would be right, in a Wale file or as an argument: "a number"; may be empty */
  WaleText found;          /* what the text or the argument has: "a vector"; may be empty */
  WaleText place;          /* the name of a file, an argument or a section; empty if there is none */
  WaleText place_text;     /* the text at that place; may be empty */
  WaleText place_source;   /* the line that it was compiled from, "corduroy.wale:9"; may be empty */
  int64_t number;          /* of its row (from 1), byte or instruction (from 0); -1 if there is none */
  int64_t column;          /* in a Wale file, from 1, in characters; -1 if there is none */
  uint64_t length;         /* bytes of the file from there on; 0 if that is not known */
  WaleText in_words;       /* for a person, in one line but for lines to copy; its place first: "my.wale:2:9: expected …" */
  WaleText explained;      /* the same with the causes, one per line */
  size_t nearest;          /* how many names may have been meant: wale_error_nearest */
  size_t others;           /* how many other errors and warnings the same text has: wale_error_other */
} WaleErrorDetails;

/* Frees an error. Not for one that wale_error_other or wale_program_warning gave: it belongs to its giver. */
WALE_API void wale_error_free(WaleError* error);

/* 0 for NULL. */
WALE_API WaleCode wale_error_code(const WaleError* error);

/* Fills `details` as far as its size goes. Error: malformed_value for NULL or a wrong size. */
WALE_API WaleCode wale_error_details(const WaleError* error, WaleErrorDetails* details);

/* A name that may have been meant, the nearest first; empty beyond the last. */
WALE_API WaleText wale_error_nearest(const WaleError* error, size_t index);

/* Another error or warning of the same text, in the order of their places; it belongs to `error`. NULL beyond the last. */
WALE_API const WaleError* wale_error_other(const WaleError* error, size_t index);

/* "W0301", and one line that describes the code in general; empty for a number that is no code. They last for ever. */
WALE_API WaleText wale_code_name(WaleCode code);
WALE_API WaleText wale_code_title(WaleCode code);
/* WALE_SEVERITY_…; error for a number that is no code. */
WALE_API int32_t wale_code_severity(WaleCode code);

/* The version of the library that runs, "0.1.0", and of its interface: at least the WALE_INTERFACE of every program that was
   linked with it. */
WALE_API WaleText wale_version(void);
WALE_API int32_t wale_interface(void);

/* How many handles are not freed yet in this process, for tests of programs and bindings. */
WALE_API size_t wale_handles(void);

#ifdef __cplusplus
}
#endif

#endif
