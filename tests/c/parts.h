#ifndef PARTS_H
#define PARTS_H

#include <wale.h>

/* Made once for all parts, since compiling takes a while. */
extern WaleLibrary* library;
extern WaleProgram* corduroy;

/* Each returns how many checks failed. */
int stage_parts(void);
int running_parts(void);
int workspace_parts(void);
int null_parts(void);

#endif
