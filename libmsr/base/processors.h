/* processors.h - how many threads can run at the same time. */
#ifndef MSRI_PROCESSORS_H
#define MSRI_PROCESSORS_H

/* Processors that this process may use, as far as the system tells; at least 1. */
unsigned msri_processors(void);

#endif
