#ifndef CHECK_H
#define CHECK_H

/* The least that tests in C need. */

#include <stdio.h>
#include <string.h>
#include <wale.h>

static int failures; /* each file has its own */

#define CHECK(condition)                                              \
  do {                                                                \
    if (!(condition)) {                                               \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
      ++failures;                                                     \
    }                                                                 \
  } while (0)

/* The call gives this code, and as much of an error. Ends with no error left. */
#define CHECK_CODE(code, call)                                                           \
  do {                                                                                   \
    WaleError* error = (WaleError*)(void*)&failures;                                     \
    const WaleCode gave = (call);                                                        \
    if (gave != (code)) {                                                                \
      WaleErrorDetails said;                                                             \
      memset(&said, 0, sizeof said);                                                     \
      said.size = sizeof said;                                                           \
      if (gave != 0) wale_error_details(error, &said);                                   \
      fprintf(stderr, "%s:%d: %s gives %d (%s)\n", __FILE__, __LINE__, #call, (int)gave, \
              said.in_words.data ? said.in_words.data : "");                             \
      ++failures;                                                                        \
    }                                                                                    \
    CHECK((gave == 0) == (error == NULL));                                               \
    CHECK(wale_error_code(error) == gave);                                               \
    wale_error_free(error);                                                              \
  } while (0)

#define CHECK_GOOD(call) CHECK_CODE(0, call)
#define CHECK_MALFORMED(call) CHECK_CODE(WALE_CODE_malformed_value, call)

static inline int is_text(WaleText text, const char* wanted) {
  return text.length == strlen(wanted) && memcmp(text.data, wanted, text.length) == 0 && text.data[text.length] == 0;
}

#endif
