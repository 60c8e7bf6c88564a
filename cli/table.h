/* table.h - what a study found, for a reader. */
#ifndef CLI_TABLE_H
#define CLI_TABLE_H

#include "study.h"

/* What was studied, against which truth, where; a row per point; what is cheapest for each
 * accuracy, with the command line to type. */
void table_print(FILE *out, const study *st);

#endif
