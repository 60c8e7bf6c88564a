/* processors.h - as many processors as a test wants, so that threads are as many as it asks for, on
 * any machine: for test programs whose opening comment holds "link: --wrap=msri_processors". */
#ifndef TESTS_PROCESSORS_H
#define TESTS_PROCESSORS_H

static unsigned processors = 256;

unsigned __real_msri_processors(void);
unsigned __wrap_msri_processors(void);
unsigned __wrap_msri_processors(void) { return processors; }

#endif
