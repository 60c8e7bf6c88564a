/* csv.h - what a study found, for a program. */
#ifndef CLI_CSV_H
#define CLI_CSV_H

#include "study.h"

/* Lines `# key: value`, a header row, a row per point; a number that isn't finite is left empty. */
void csv_print(FILE *out, const study *st);

#endif
